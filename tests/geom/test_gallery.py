"""The library at a glance, on screen and in the docs."""

import json

import pytest

from geom import catalogue, library, write_library


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


def test_every_machine_says_where_its_numbers_are_from_and_which_are_assumed():
    for entry in catalogue():
        assert len(entry.source) > 10, entry.name
        assert len(entry.assumed) > 5, entry.name


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
