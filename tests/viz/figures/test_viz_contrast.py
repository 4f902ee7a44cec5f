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
    # Colours by name: the light theme, and the dark one over it
    roots = [
        dict(re.findall(r"--(\w+): (#[0-9a-fA-F]{3,6})", block)) for block in re.findall(r":root \{(.*?)\}", css, re.S)
    ]
    colours = [roots[0], {**roots[0], **roots[1]}][dark]
    words = {"ink", "faint", "good", "warn", "info", "link"} & set(colours)
    assert {word: c for word in words if (c := contrast(colours[word], colours["paper"])) < NEEDED} == {}


GRAPHICS = 3.0  # of bars, borders and the mark of the focus against what is beside them (WCAG 2.2, 1.4.11)
EMPHASIS = 0.87  # of Vuetify's usual letters over their ground


def workbench():
    return files("extras.workbench").joinpath("page.css").read_text(encoding="utf-8")


def named_in(block):
    """Names and colours of a block, as #rrggbb, whether written so or as r,g,b."""
    plain = dict(re.findall(r"--([\w-]+): (#[0-9a-fA-F]{6})", block))
    listed = re.findall(r"--v-theme-([\w-]+): (\d+),(\d+),(\d+)", block)
    return {**plain, **{name: "#" + "".join(f"{int(c):02x}" for c in rgb) for name, *rgb in listed}}


def workbench_themes():
    css = workbench()
    usual = named_in(css.partition(":root {")[2].partition("}")[0])
    return {
        name: {**usual, **named_in(css.partition(f".v-theme--{name}.v-theme--{name} {{")[2].partition("}")[0])}
        for name in ("light", "dark")
    }


def over(ink, ground, share):
    """A colour that lets some of its ground through."""
    pair = [(int(ink[i : i + 2], 16), int(ground[i : i + 2], 16)) for i in (1, 3, 5)]
    return "#" + "".join(f"{round(share * a + (1 - share) * b):02x}" for a, b in pair)


@pytest.mark.parametrize("theme", ["light", "dark"])
@pytest.mark.parametrize("ground", ["background", "surface"])
def test_words_of_the_workbench(theme, ground):
    """Usual letters, the faintest class that the page has, and every colour that a rule gives to letters."""
    colours, css = workbench_themes()[theme], workbench()
    faintest = min(float(x) for x in re.findall(r"\.(?:faint|flat) \{[^}]*opacity: ([\d.]+)", css))
    ink = over(colours["on-" + ground], colours[ground], EMPHASIS * faintest)
    assert contrast(ink, colours[ground]) >= NEEDED
    used = re.findall(r"(?<![\w-])color: var\(--([\w-]+)\)", css)
    assert {name for name in used if contrast(colours[name], colours[ground]) < NEEDED} == set()
    assert contrast(colours["on-primary"], colours["primary"]) >= NEEDED


@pytest.mark.parametrize("theme", ["light", "dark"])
def test_bars_borders_and_the_focus_of_the_workbench(theme):
    """The amber of what an error was lies behind the bar that it is now, and its number stands beside it."""
    colours, css = workbench_themes()[theme], workbench()
    used = set(re.findall(r"(?:background|border-color|solid|border-left: 5px solid): ?var\(--([\w-]+)\)", css))
    used |= set(re.findall(r"solid var\(--([\w-]+)\)", css))
    assert {"good", "hot", "cold", "quiet", "focus"} <= used
    low = {n for n in used for g in ("background", "surface") if contrast(colours[n], colours[g]) < GRAPHICS}
    assert low <= {"before"}


def test_rules_for_small_screens_and_for_people_whom_motion_disturbs():
    css = workbench()
    assert re.search(r"@media \(max-width: 900px\)[^@]*grid-template-columns: minmax\(0, 1fr\)", css)
    assert "@media (prefers-reduced-motion: reduce)" in css
