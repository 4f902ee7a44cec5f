"""Draws the film that the README opens with: python docs/images/film.py CASE [GIF]

The hour of the test that was never used, twice: with the model before its last step, then with the effect it found.
Sensors pulse where the model misses. CASE has had an effect added, as the demo's has: out/demo/road-test.
"""

import sys
from pathlib import Path

import numpy as np

from extras.portraits.moving import moving
from thermoscope.case_folder.folder import load_case
from thermoscope.case_folder.runs import before_last, by_interest, fields, temperature_range
from thermoscope.commands.show.film import misses, model_words, title
from viz.rendering.nodes import split

FRAMES, PER_SECOND, WIDTH = 48, 12.0, 640  # 48 pictures for each model: eight seconds
LARGEST = 3e6  # bytes


def draw(case: Path, gif: Path) -> None:
    """The film, with the error before and after as a comment: a test compares it with the text."""
    folder = load_case(case)
    assert folder.built is not None
    test, earlier = by_interest(folder)[0], before_last(folder)
    assert earlier is not None, "a case whose model has had a step"
    limit_K = folder.limits(test)
    nodes, T, titles, seen = split(folder.built.mesh), [], [], []
    for words, model in zip(model_words(folder), (earlier, folder.case), strict=True):
        times, values = fields(model, test, nodes, FRAMES)
        rows = misses(folder, model, test, times, limit_K)
        T.append(values)
        seen += rows
        titles += [title(test, t, words, row) for t, row in zip(times, rows, strict=True)]
    moving(
        folder.built.machine,
        nodes,
        np.concatenate(T),
        gif,
        titles=titles,
        sensors=seen,
        limits=temperature_range(folder, nodes),
        width=WIDTH,
        frames_per_second=PER_SECOND,
        tell=lambda k: print(f"\r{k}", end=""),
    )
    before, after = folder.history.last.rmse_K[test.name]
    gif.write_bytes(commented(gif.read_bytes(), f"{before:.2f} K, {after:.2f} K"))
    assert gif.stat().st_size <= LARGEST, f"{gif.stat().st_size / 1e6:.1f} MB"


def commented(gif: bytes, words: str) -> bytes:
    """A GIF with a comment of less than 256 letters, after its first table of colours."""
    colours = 3 << (gif[10] & 7) + 1 if gif[10] & 128 else 0
    text, at = words.encode(), 13 + colours
    return gif[:at] + bytes([0x21, 0xFE, len(text)]) + text + b"\0" + gif[at:]


if __name__ == "__main__":
    draw(Path(sys.argv[1]), Path(sys.argv[2]) if len(sys.argv) > 2 else Path(__file__).parent / "road-test.gif")
