"""The drawing shows every part to scale, and the family pages every parameter."""

import re
import xml.etree.ElementTree as ElementTree

import pytest

from geom import load_machine
from geom.description import shapes
from geom.drawings.views import path
from geom.machine_file import families
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


def test_liquids_are_drawn():
    svg = ElementTree.fromstring(drawing_of(load_machine("series-dc-100kw-jacket-two")))
    drawn = {title.text for shape in svg.iter(f"{SVG}path") for title in shape.iter(f"{SVG}title")}
    assert {"jacket.left", "jacket.right", "jacket.left.inlet.tube"} < drawn


def test_dimensions_are_those_of_the_machine_file(svg, motor):
    g, texts = motor.geometry, {text.text for text in svg.iter(f"{SVG}text")}
    length, width, height = (f"{1e3 * value:.0f}" for value in motor.extent)
    assert {width, height, f"overall {length}", f"stack {1e3 * g.rotor.stack_length:g}"} < texts
    bore = 1e3 * (g.rotor.outer_diameter + 2 * g.stator.air_gap)
    assert {f"bore \u2300 {bore:g}", f"rotor \u2300 {1e3 * g.rotor.outer_diameter:g}"} < texts
    assert "4 poles, 46 slots, 36 fins, air gap 2 mm" in texts


def test_dimension_lines_are_as_long_as_they_say(svg):
    """In the drawing's unit, 1 mm."""
    lines = [shape.attrib["d"] for shape in svg.iter(f"{SVG}path") if "marker-end" in shape.attrib]
    level = [re.fullmatch(r"M(.+) .+H(.+)", d).groups() for d in lines if "H" in d]
    lengths = sorted(float(end) - float(start) for start, end in level)
    assert lengths == pytest.approx([200, 290, 416, 440, 700], abs=0.2)


def test_arcs_are_drawn_as_arcs_upside_down():
    """SVG counts y downwards, so an anticlockwise arc has sweep flag 0."""
    assert re.fullmatch(r"M50.00 -?0.00A50.00 50.00 0 0 0 -50.00 .*Z", path(shapes.disc(0.05).outer))


@pytest.fixture(scope="module")
def pages(tmp_path_factory):
    return write_pages(tmp_path_factory.mktemp("families"))


@pytest.mark.parametrize("family", families().values(), ids=lambda family: family.name)
def test_page_lists_every_parameter_with_its_range(pages, family):
    (page,) = [page.read_text() for page in pages if page.stem == family.name]
    for parameter in family.parameters:
        name = parameter.key if parameter.of is None else parameter.name
        assert f"| `{name}` | {parameter.default} | {parameter.allowed} | {parameter.doc} |" in page
        if parameter.of is not None:
            assert f"| `{parameter.group}.{parameter.ratio_name}` | " in page
            assert f"| {parameter.allowed_ratio} | " in page


def test_pages_in_the_docs_are_those_the_code_writes(pages, root):
    for page in pages:
        for file in (page, page.with_suffix(".svg")):
            assert (root / "docs" / "families" / file.name).read_text() == file.read_text(), (
                "run python -m scripts.family_pages"
            )
