"""The drawing shows every part to scale, and the family pages every parameter."""

import xml.etree.ElementTree as ElementTree

import pytest

from geom import load_machine
from scripts.drawing import drawing_of
from scripts.family_pages import write_pages

SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture(scope="module")
def svg():
    return ElementTree.fromstring(drawing_of(load_machine("series-dc-100kw")))


def test_every_part_is_drawn_and_named(svg, motor):
    """The feet stand beside both sections and are drawn behind them."""
    drawn = {title.text for shape in svg.iter(f"{SVG}path") for title in shape.iter(f"{SVG}title")}
    assert drawn == {part.name for part in motor.parts}


def test_dimensions_are_those_of_the_machine_file(svg, motor):
    g, texts = motor.geometry, {text.text for text in svg.iter(f"{SVG}text")}
    length, width, height = (f"{1e3 * value:.0f}" for value in motor.extent)
    assert {width, height, f"overall {length}", f"stack {1e3 * g.rotor.stack_length:g}"} < texts
    bore = 1e3 * (g.rotor.outer_diameter + 2 * g.stator.air_gap)
    assert {f"bore \u2300 {bore:g}", f"rotor \u2300 {1e3 * g.rotor.outer_diameter:g}"} < texts
    assert "4 poles, 46 slots, 36 fins, air gap 2 mm" in texts


@pytest.fixture(scope="module")
def pages(tmp_path_factory):
    return write_pages(tmp_path_factory.mktemp("families"))


def test_pages_in_the_docs_are_those_the_code_writes(pages, root):
    for page in pages:
        for file in (page, page.with_suffix(".svg")):
            assert (root / "docs" / "families" / file.name).read_text() == file.read_text(), (
                "run python -m scripts.family_pages"
            )
