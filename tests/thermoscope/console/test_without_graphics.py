"""A computer without OpenGL, or without a browser: one message, before anything is run, and all else works."""

from types import SimpleNamespace

import pytest
from motor_case import with_motor

from geom.errors import MissingDependency
from thermoscope import demo
from thermoscope.commands.model import build
from thermoscope.commands.show import film, pages, picture
from thermoscope.console.terminal import notes_once

MESSAGE = "no off-screen OpenGL"
SOLID = sorted(set(picture.PICTURES) - set(picture.FLAT))


@pytest.fixture(autouse=True)
def without_gl(monkeypatch):
    monkeypatch.setattr("viz.rendering.gl.off_screen_window", lambda: None)


@pytest.fixture
def untouched(monkeypatch):
    """An open case with a machine of which nothing can be read: what is looked at too early fails otherwise."""
    case = SimpleNamespace(built=object(), case=SimpleNamespace(name="motor"))
    for module in (film, picture):
        monkeypatch.setattr(module, "open_case", lambda path, tell: case)
    monkeypatch.setattr(film, "needs_geometry", lambda name: None)


@pytest.mark.parametrize("what", SOLID)
def test_pictures_in_space_are_refused_before_anything_is_run(untouched, tmp_path, what):
    with pytest.raises(MissingDependency, match=MESSAGE):
        picture.picture("motor", what, tmp_path / "p.png", None)
    assert list(tmp_path.iterdir()) == []


def test_a_film_is_refused_before_anything_is_run(untouched, tmp_path):
    with pytest.raises(MissingDependency, match=MESSAGE):
        film.film("motor", tmp_path / "f.gif", None)
    assert list(tmp_path.iterdir()) == []


def test_the_message_is_one_line_and_the_exit_code_2(thermoscope, monkeypatch, untouched, tmp_path):
    answer = thermoscope("show", "film", "motor", "--out", str(tmp_path / "f.gif"))
    assert answer.code == 2
    assert [line for line in answer.err.splitlines() if MESSAGE in line] == answer.err.strip().splitlines()


def test_a_report_lacks_its_picture_and_its_print_and_says_so_once(case, tmp_path, monkeypatch, capsys):
    """The page itself is written, and holds the machine that the reader's browser draws."""
    monkeypatch.setattr("shutil.which", lambda *names, **more: None)
    monkeypatch.setattr("viz.pages.html.find_spec", lambda name: None)
    monkeypatch.setattr(pages, "open_case_for_writing", lambda path, tell: with_motor(case))
    assert pages.report(str(case), tmp_path / "r", None) == 0
    said = capsys.readouterr()
    assert said.err.count(MESSAGE) == 1
    assert said.out.count(pages.NO_PDF.split(":")[0]) == 1
    assert "viewer" in (tmp_path / "r" / "report.html").read_text()
    assert not (tmp_path / "r" / "report.pdf").exists()


def test_build_writes_no_pictures_and_says_so_once(tmp_path, capsys):
    assert build.pictures(SimpleNamespace(), tmp_path, lambda message: None) == []
    assert capsys.readouterr().err.count(MESSAGE) == 1


def test_the_demo_goes_on_without_its_pictures_and_says_so_once(tmp_path, capsys):
    with notes_once():
        assert demo._picture(tmp_path / "1.png", lambda png: png.touch()) is None
        assert demo._picture(tmp_path / "2.png", lambda png: png.touch()) is None
    assert capsys.readouterr().err.count(MESSAGE) == 1
    assert list(tmp_path.iterdir()) == []
