"""Draws the gallery of the README, a machine of every family and cooling: python docs/images/families.py [PNG]"""

import sys
from pathlib import Path

from matplotlib import get_data_path
from PIL import Image, ImageDraw, ImageFont

from extras.portraits.portrait import portrait
from geom import load_machine

SHOWN = {
    "tefc-industrial": "induction, fan-cooled",
    "series-dc-100kw-air": "series-wound DC, forced air",
    "ipmsm-48s8p-jacket": "interior magnets, spiral jacket",
    "tefc-industrial-radial": "induction, radial fins",
    "series-dc-100kw-jacket-two-zigzag": "series-wound DC, two jackets",
    "pmsm-m2": "magnets, on its bench",
}
COLUMNS, SIZE, CAPTION = 3, (560, 420), 40


def gallery(png: Path) -> None:
    rows = -(-len(SHOWN) // COLUMNS)
    page = Image.new("RGB", (COLUMNS * SIZE[0], rows * (SIZE[1] + CAPTION)), "white")
    draw = ImageDraw.Draw(page)
    font = ImageFont.truetype(str(Path(get_data_path()) / "fonts" / "ttf" / "DejaVuSans.ttf"), 20)
    for k, (name, words) in enumerate(SHOWN.items()):
        p = portrait(load_machine(name), size=(2 * SIZE[0], 2 * SIZE[1]), caption="")
        x, y = k % COLUMNS * SIZE[0], k // COLUMNS * (SIZE[1] + CAPTION)
        page.paste(Image.fromarray(p.screenshot(return_img=True)).resize(SIZE, Image.Resampling.LANCZOS), (x, y))
        p.close()
        draw.text((x + SIZE[0] / 2, y + SIZE[1] + CAPTION / 2), words, "#1f2933", font, anchor="mm")
    page.quantize(255, dither=Image.Dither.FLOYDSTEINBERG).save(png, optimize=True)


if __name__ == "__main__":
    gallery(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent / "families.png")
