"""Denoises rendered light with the edge-avoiding à-trous wavelet filter of Dammertz et al. 2010.

Debian's Blender has no denoiser. With this filter, images from two light paths per pixel look like those from hundreds.
"""

import numpy

KERNEL = numpy.array([1.0, 2.0, 1.0], numpy.float32) / 4.0


def denoise(light, normal, depth, strength=1.0, passes=5):
    """Smooths light (h, w, channels) between pixels whose normals, depths and brightness are similar.

    normal: (h, w, 3) noise-free surface normals. depth: (h, w) distances from the camera. strength: the largest relative
    difference in brightness that counts as noise; the first pass ignores it, so that no dark specks remain.
    """
    # The renderer may return NaN or infinity at slivers of a hull.
    light = numpy.nan_to_num(light.astype(numpy.float32), posinf=0.0)
    depth = numpy.minimum(depth, depth.min() * 100.0)
    slope = numpy.maximum(*map(abs, numpy.gradient(depth))) + 2e-3 * depth  # change of depth per pixel
    for i in range(passes):
        light = _smooth(light, normal, depth, slope, strength * 0.7 ** i if i else numpy.inf, distance=2 ** i)
    return light


def _smooth(light, normal, depth, slope, strength, distance):
    """One pass: a weighted mean of each pixel and the eight pixels at this distance."""
    brightness = light[..., :3].sum(2)
    pad = ((distance, distance), (distance, distance))
    padded_light = numpy.pad(light, (*pad, (0, 0)), "edge")
    padded_normal = numpy.pad(normal, (*pad, (0, 0)), "edge")
    padded_depth = numpy.pad(depth, pad, "edge")
    padded_brightness = numpy.pad(brightness, pad, "edge")
    total = numpy.zeros_like(light)
    weights = numpy.zeros_like(brightness)
    height, width = brightness.shape
    for i in range(3):
        for j in range(3):
            window = (slice(i * distance, i * distance + height), slice(j * distance, j * distance + width))
            cosine = numpy.einsum("hwc,hwc->hw", normal, padded_normal[window]).clip(0.0, 1.0)
            depth_difference = abs(depth - padded_depth[window]) / (slope * (2 * distance))
            light_difference = (brightness - padded_brightness[window]) / (strength * numpy.sqrt(brightness + 0.15))
            weight = KERNEL[i] * KERNEL[j] * cosine ** 32 * numpy.exp(-depth_difference - light_difference * light_difference)
            if i == 1 and j == 1:
                weight = numpy.full_like(brightness, KERNEL[1] * KERNEL[1])
            total += weight[..., None] * padded_light[window]
            weights += weight
    return total / weights[..., None]
