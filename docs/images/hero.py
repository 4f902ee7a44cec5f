"""Draws the first picture of the pages: python docs/images/hero.py CASE [PNG]

The motor cut open at the end of the test that was never used, labelled by what the model before its last step misses,
and what that step did to the error. CASE has had an effect added, as the demo's has: out/demo/road-test.
"""

import sys
from pathlib import Path
from textwrap import fill

from PIL import Image
from PIL.PngImagePlugin import PngInfo

from thermoscope.case_folder.folder import load_case
from thermoscope.case_folder.runs import before_last, by_interest, comparison_of, fields, step_words, temperature_range
from viz import Comparison, cutaway, sensors, split
from viz.colours import LIGHT
from viz.rendering import scene


def draw(case: Path, png: Path) -> str:
    """What stands beside the machine, for a test that compares it with the text."""
    folder = load_case(case)
    test, earlier, last = by_interest(folder)[0], before_last(folder), folder.history.last
    assert earlier is not None, "a case whose model has had a step"
    now = comparison_of(folder, test)
    wrong = sensors(Comparison(test, now.before, now.limits), folder.positions)  # type: ignore[arg-type]
    nodes = split(folder.built.mesh)  # type: ignore[union-attr]
    before, after = last.rmse_K[test.name]
    title = f"{test.name}: measured minus modelled, mean of the last fifth"
    ends = temperature_range(folder, nodes)
    p = cutaway(nodes, fields(earlier, test, nodes, 1)[1][-1], sensors=wrong, title=title, limits=ends)
    words = fill(f"found missing: {step_words(folder.case, last)}", 33)
    words += f"\nadded: {before:.2f} K → {after:.2f} K rms"
    line = p.add_text(words, position=(0.66, 0.02), viewport=True, font_size=11, color=LIGHT.ink)
    scene.set_font(line.GetTextProperty())
    line.GetTextProperty().SetLineSpacing(1.25)
    scene.save(p, png)
    p.close()
    return words


if __name__ == "__main__":
    target = Path(sys.argv[2]) if len(sys.argv) > 2 else Path(__file__).parent / "road-test.png"
    info = PngInfo()
    info.add_itxt("words", draw(Path(sys.argv[1]), target))
    Image.open(target).convert("RGB").save(target, optimize=True, pnginfo=info)
