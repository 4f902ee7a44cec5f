"""`thermoscope check`: every gap comes with the command that closes it."""

import pytest

from thermoscope import check


def test_what_is_there_needs_no_command(monkeypatch):
    monkeypatch.setattr(check, "_gl", lambda: True)
    (found,) = [f for f in check.findings() if f.name == "off-screen OpenGL"]
    assert (found.present, found.fix) == (True, "")


def test_missing_gl_is_needed_and_has_a_command(monkeypatch, capsys):
    monkeypatch.setattr(check, "_gl", lambda: False)
    assert check.check() == 1
    assert "libegl1" in capsys.readouterr().out


def test_missing_browser_is_optional(monkeypatch):
    monkeypatch.setattr(check, "_gl", lambda: True)
    monkeypatch.setattr(check.shutil, "which", lambda *_, **__: None)
    assert check.check(target="-") == 0


@pytest.mark.parametrize(("user", "command"), [(0, "apt-get install x"), (1000, "sudo apt-get install x")])
def test_commands_fit_the_user(monkeypatch, user, command):
    monkeypatch.setattr(check.os, "geteuid", lambda: user)
    assert check.as_root("apt-get install x") == command
