"""Commands in groups; help that is whole at 80 columns, from the one declaration of each command."""

import re
from importlib import import_module

import pytest
from command_line import GROUP
from typer.testing import CliRunner

from thermoscope import cli
from thermoscope.cli import home_modules, narrowed_app, whole_app

RUN = CliRunner()
WORDS = [["demo"], ["check"], ["bench", "report"], *([GROUP[name], name] for name in sorted(GROUP))]


def said(app, words):
    done = RUN.invoke(app, words, prog_name="thermoscope", terminal_width=80)
    return done.exit_code, done.output


@pytest.mark.parametrize("words", [[], *([g] for g in sorted(set(GROUP.values()))), *WORDS], ids="-".join)
def test_help_is_whole_and_narrow(words):
    code, text = said(whole_app(), [*words, "--help"])
    assert code == 0
    assert not re.search(r"[a-z]\.\.\.", text)
    assert max(map(len, text.splitlines())) <= 80


@pytest.mark.parametrize("words", WORDS[::6], ids="-".join)
def test_the_app_of_one_command_says_what_the_whole_says(words):
    for tail in (["--help"], ["--no-such-option"]):
        assert said(narrowed_app([*words, "case"]), [*words, *tail]) == said(whole_app(), [*words, *tail])


@pytest.mark.parametrize("words", [[], ["use"], ["test", "nothing"], ["nothing"]], ids=str)
def test_what_is_no_command_is_answered_as_by_the_whole_app(words):
    for tail in ([], ["--help"]):
        assert said(narrowed_app(words), [*words, *tail]) == said(whole_app(), [*words, *tail])


def test_only_the_command_asked_for_is_loaded(monkeypatch):
    loaded = []
    monkeypatch.setattr(cli, "import_module", lambda name: loaded.append(name) or import_module(name))
    narrowed_app(["test", "compare", "case"])
    narrowed_app(["demo"])
    narrowed_app(["--help"])
    assert loaded == [home_modules()["test", "compare"], home_modules()["", "demo"]]


def test_a_command_without_its_group_is_told_where_it_is(thermoscope, monkeypatch, capsys):
    from thermoscope.cli import main

    for word, homes in (
        ("compare", "thermoscope test compare"),
        ("rate", "thermoscope use rate"),
        ("report", "thermoscope show report or thermoscope bench report"),
    ):
        monkeypatch.setattr("sys.argv", ["thermoscope", word, "case"])
        with pytest.raises(SystemExit) as end:
            main()
        assert end.value.code == 2
        assert f"No such command '{word}'; {homes}\n" in capsys.readouterr().err


def test_the_version_is_one_line_with_python_and_system_on_it():
    code, text = said(narrowed_app(["--version"]), ["--version"])
    assert code == 0
    assert re.fullmatch(r"thermoscope \d\S*, Python 3\.\d+\.\d+\S*, \w+ \w+\n", text)
