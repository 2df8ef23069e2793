"""Denoises rendered light with the edge-avoiding à-trous wavelet filter of Dammertz et al. 2010.

Debian's Blender has no denoiser. With this filter, two light paths per pixel look like hundreds.
"""

import numpy

KERNEL = numpy.array([1.0, 2.0, 1.0], numpy.float32) / 4.0


def denoise(light, normal, depth, strength=1.0, passes=5):
    """Smooths light (h, w, channels) between pixels with similar normals, depths and first three channels.

    normal: (h, w, 3) noise-free surface normals. depth: (h, w) distances from the camera. strength: the largest
    relative difference of light that counts as noise; the first pass ignores it, so that no dark specks remain.
    """
    # At slivers of a hull the renderer may return NaN or infinity.
    light = numpy.nan_to_num(light.astype(numpy.float32), posinf=0.0)
    depth = numpy.minimum(depth, depth.min() * 100.0)
    slope = numpy.maximum(*(abs(part) for part in numpy.gradient(depth))) + 2e-3 * depth
    for step in range(passes):
        light = _smooth(light, normal, depth, slope, strength * 0.7 ** step if step else numpy.inf, 2 ** step)
    return light


def _smooth(light, normal, depth, slope, strength, reach):
    brightness = light[..., :3].sum(2)
    pad = ((reach, reach), (reach, reach))
    wide_light = numpy.pad(light, (*pad, (0, 0)), "edge")
    wide_normal = numpy.pad(normal, (*pad, (0, 0)), "edge")
    wide_depth = numpy.pad(depth, pad, "edge")
    wide_brightness = numpy.pad(brightness, pad, "edge")
    total = numpy.zeros_like(light)
    weights = numpy.zeros_like(brightness)
    height, width = brightness.shape
    for i in range(3):
        for j in range(3):
            window = (slice(i * reach, i * reach + height), slice(j * reach, j * reach + width))
            cosine = numpy.einsum("hwc,hwc->hw", normal, wide_normal[window]).clip(0.0, 1.0)
            depth_difference = abs(depth - wide_depth[window]) / (slope * (2 * reach))
            light_difference = (brightness - wide_brightness[window]) / (strength * numpy.sqrt(brightness + 0.15))
            weight = KERNEL[i] * KERNEL[j] * cosine ** 32 * numpy.exp(-depth_difference - light_difference * light_difference)
            if i == 1 and j == 1:
                weight = numpy.full_like(brightness, KERNEL[1] * KERNEL[1])
            total += weight[..., None] * wide_light[window]
            weights += weight
    return total / weights[..., None]
