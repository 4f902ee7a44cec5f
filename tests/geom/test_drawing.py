"""The drawing shows every part to scale, and the family pages every parameter."""

import re
import xml.etree.ElementTree as ElementTree

import pytest

from geom import drawing_of, load_machine, shapes, write_pages
from geom.drawing import path
from geom.families import families

SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture(scope="module")
def svg():
    return ElementTree.fromstring(drawing_of(load_machine("series-dc-100kw")))


def test_every_part_is_drawn_and_named(svg, motor):
    drawn = {title.text for shape in svg.iter(f"{SVG}path") for title in shape.iter(f"{SVG}title")}
    # the feet stand beside both sections
    assert drawn == {part.name for part in motor.parts} - {"feet"}


def test_dimensions_are_the_machines_extent(svg, motor):
    numbers = [int(text.text) for text in svg.iter(f"{SVG}text")]
    length, width, height = (round(1e3 * value) for value in motor.extent)
    assert numbers == [width, height, length, height]


def test_arcs_are_drawn_as_arcs_upside_down():
    """SVG counts y downwards, so an anticlockwise arc has sweep flag 0."""
    assert re.fullmatch(r"M50.000 -?0.000A50.000 50.000 0 0 0 -50.000 .*Z", path(shapes.disc(0.05).outer))


@pytest.fixture(scope="module")
def pages(tmp_path_factory):
    return write_pages(tmp_path_factory.mktemp("families"))


@pytest.mark.parametrize("family", families().values(), ids=lambda family: family.name)
def test_page_lists_every_parameter_with_its_range(pages, family):
    (page,) = [page.read_text() for page in pages if page.stem == family.name]
    for parameter in family.parameters:
        assert f"| `{parameter.key}` | {parameter.default} | {parameter.allowed} | {parameter.doc} |" in page


def test_pages_in_the_docs_are_those_the_code_writes(pages, root):
    for page in pages:
        for file in (page, page.with_suffix(".svg")):
            assert (root / "docs" / "families" / file.name).read_text() == file.read_text(), "run geom.write_pages"
