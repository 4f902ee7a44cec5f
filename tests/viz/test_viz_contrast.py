"""Text can be read: contrast of at least 4.5 (WCAG 2.2, AA) on every ground and in both themes."""

import re
from importlib.resources import files

import pytest

from viz.colours import DARK, LIGHT, VERDICT

NEEDED = 4.5


def luminance(colour: str) -> float:
    """Relative luminance of sRGB, WCAG 2.2."""
    colour = colour.lstrip("#")
    colour = "".join(c * 2 for c in colour) if len(colour) == 3 else colour
    channels = [int(colour[i : i + 2], 16) / 255 for i in (0, 2, 4)]
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(one: str, other: str) -> float:
    light, dark = sorted((luminance(one), luminance(other)), reverse=True)
    return (light + 0.05) / (dark + 0.05)


def themes(css: str) -> list[dict[str, str]]:
    """Colours by name: the light theme, and the dark one over it."""
    roots = [
        dict(re.findall(r"--(\w+): (#[0-9a-fA-F]{3,6})", block)) for block in re.findall(r":root \{(.*?)\}", css, re.S)
    ]
    return [roots[0], {**roots[0], **roots[1]}]


def test_the_formula_is_that_of_the_standard():
    assert contrast("#ffffff", "#000000") == pytest.approx(21.0)
    assert contrast("#777777", "#ffffff") == pytest.approx(4.48, abs=0.01)


@pytest.mark.parametrize("verdict", VERDICT)
def test_white_letters_on_labels(verdict):
    assert contrast(VERDICT[verdict], "#ffffff") >= NEEDED


@pytest.mark.parametrize("theme", [LIGHT, DARK])
def test_ink_on_paper(theme):
    assert contrast(theme.ink, theme.paper) >= NEEDED


@pytest.mark.parametrize("room", ["viewer", "pages"])
@pytest.mark.parametrize("dark", [0, 1])
def test_words_of_pages(room, dark):
    css = files(f"viz.{room}").joinpath("viewer.css" if room == "viewer" else "page.css").read_text(encoding="utf-8")
    colours = themes(css)[dark]
    words = {"ink", "faint", "good", "warn", "info", "link"} & set(colours)
    assert {word: c for word in words if (c := contrast(colours[word], colours["paper"])) < NEEDED} == {}
