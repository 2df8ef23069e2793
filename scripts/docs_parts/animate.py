# SPDX-License-Identifier: GPL-3.0-or-later
"""Puts the frames of the scenario "front" together: crops them, draws the mouse pointer and a caption.

usage: animate.py FOLDER OUT.webp     FOLDER: build/gui, with front.json and front-NN.png. Needs Pillow.
"""

import json
import sys
from pathlib import Path

from PIL import Image, ImageDraw, ImageFont

CROP, SIZE, CAPTION = (120, 90, 890, 692), (640, 500), 34  # pixels
POINTER = [(0, 0), (0, 17), (4, 13), (7, 20), (10, 19), (7, 12), (12, 12)]


def main():
    folder, out = map(Path, sys.argv[1:])
    font = ImageFont.truetype("DejaVuSans.ttf", 18)
    images, durations = [], []
    for number, (milliseconds, caption, x, y) in enumerate(json.loads((folder / "front.json").read_text())):
        window = Image.open(folder / f"front-{number:02}.png").convert("RGB")
        draw = ImageDraw.Draw(window)
        tip = x, window.height - y
        draw.polygon([(tip[0] + 1.3 * dx, tip[1] + 1.3 * dy) for dx, dy in POINTER], fill="white", outline="black")
        image = Image.new("RGB", (SIZE[0], SIZE[1] + CAPTION), "#303030")
        image.paste(window.crop(CROP).resize(SIZE, Image.Resampling.LANCZOS))
        ImageDraw.Draw(image).text((SIZE[0] / 2, SIZE[1] + CAPTION / 2), caption, "white", font, anchor="mm")
        images.append(image)
        durations.append(milliseconds)
    images[0].save(out, save_all=True, append_images=images[1:], duration=durations, loop=0, quality=80, method=4)
    print(f"{out}: {len(images)} frames, {sum(durations) / 1000:.1f} s, {out.stat().st_size / 1e6:.2f} MB")


if __name__ == "__main__":
    main()
