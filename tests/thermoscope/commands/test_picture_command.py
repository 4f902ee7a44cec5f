"""thermoscope show picture: a picture per kind, one message for what it does not know."""

from pathlib import Path

import pytest

from geom.errors import InputError
from thermoscope.commands.show.picture import PICTURES, picture

ROOT = Path(__file__).parents[3]
WITHOUT_GEOMETRY = ["curves", "bands", "residuals", "losses", "sizes"]


@pytest.mark.parametrize("what", WITHOUT_GEOMETRY)
def test_a_case_without_geometry_has_its_plots(case, tmp_path, what):
    file = tmp_path / "shown" / f"{what}.png"
    assert picture(str(case), what, file, None) == 0
    assert file.read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize("what", sorted(set(PICTURES) - set(WITHOUT_GEOMETRY)))
def test_what_a_case_lacks_is_said_and_nothing_written(case, tmp_path, what):
    """No machine, and no revision yet."""
    file = tmp_path / "shown.png"
    with pytest.raises(InputError):
        picture(str(case), what, file, None)
    assert not file.exists()


def test_an_unknown_picture_is_one_message_with_the_known_ones(thermoscope):
    answer = thermoscope("show", "picture", "tclab", "fieldd")
    assert answer.code == 2
    assert len(answer.err.strip().splitlines()) == 1
    assert "field" in answer.err


def test_the_page_names_every_picture():
    page = (ROOT / "docs" / "how-to" / "pictures.md").read_text(encoding="utf-8")
    assert [name for name in PICTURES if f"`{name}`" not in page] == []
