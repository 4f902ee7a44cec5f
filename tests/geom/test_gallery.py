"""The library at a glance, on screen and in the docs."""

import json
import xml.etree.ElementTree as ElementTree

import pytest

from geom import catalogue, library, load_machine, part_table, write_library

SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    return write_library(tmp_path_factory.mktemp("library"))


def test_page_in_the_docs_is_the_one_the_code_writes(page, root):
    docs = root / "docs" / "families"
    files = [page, *sorted((page.parent / "thumbnails").iterdir())]
    for file in files:
        there = docs / file.relative_to(page.parent)
        assert there.read_text() == file.read_text(), "run geom.write_library('docs/families')"
    assert len(list((docs / "thumbnails").iterdir())) == len(files) - 1


def test_every_machine_has_a_thumbnail_of_its_parts(page):
    for name in library():
        svg = ElementTree.parse(page.parent / "thumbnails" / f"{name}.svg").getroot()
        drawn = {title.text for shape in svg.iter(f"{SVG}path") for title in shape.iter(f"{SVG}title")}
        machine = load_machine(name)
        assert {part.name for part in machine.parts} <= drawn <= {p.name for p in (*machine.parts, *machine.fluids)}


def test_thumbnails_show_the_machine_and_not_the_plate(page):
    """M1 is 350 mm long and 270 mm wide; its plate of 1500 x 400 mm does not make the picture any wider."""
    size = {}
    for name in ("pmsm-m1-plate", "pmsm-m1-no-base"):
        svg = ElementTree.parse(page.parent / "thumbnails" / f"{name}.svg").getroot()
        size[name] = float(svg.get("viewBox").split()[2])
    assert 620.0 < size["pmsm-m1-plate"] < 1.1 * 620.0
    assert size["pmsm-m1-plate"] == size["pmsm-m1-no-base"]


def test_every_machine_says_where_its_numbers_are_from_and_which_are_assumed():
    for entry in catalogue():
        assert len(entry.source) > 10, entry.name
        assert len(entry.assumed) > 5, entry.name


def test_masses_are_those_of_the_table_of_parts():
    entries = {entry.name: entry for entry in catalogue()}
    for name in ("series-dc-100kw", "tefc-industrial"):
        rows = part_table(load_machine(name), segments=36)
        assert entries[name].mass == pytest.approx(sum(row.mass for row in rows))
        assert entries[name].parts == len(rows)


def test_cooling_in_words():
    words = {entry.name: entry.cooling for entry in catalogue()}
    assert "fan, 138 m3/h" in words["series-dc-100kw"]
    assert words["series-dc-100kw-jacket-two"].startswith("jacket.left and jacket.right with glycol-50, 8 L/min")
    assert words["pmsm-m1-no-base"] == "still air"
    assert words["tefc-industrial-radial"] == "18 radial fins; base plate"


def test_command_lists_the_library_as_document_and_as_table(page, tmp_path, capsys):
    from thermoscope.commands.model.machines import machines
    from thermoscope.console.summary import limited_lines

    assert machines(None, tmp_path / "lib", "-") == 0
    document = json.loads(capsys.readouterr().out)
    assert [row["name"] for row in document["machines"]] == list(library())
    assert all((tmp_path / "lib" / "thumbnails" / f"{name}.svg").is_file() for name in library())
    with limited_lines(None):
        assert machines(None, None, None) == 0
    shown = capsys.readouterr().out
    assert all(name in shown for name in library())
