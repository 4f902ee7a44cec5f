"""Commands in groups, the old names with a note, help that is whole at 80 columns."""

import re

import pytest
from typer.testing import CliRunner

from thermoscope.cli import main, whole_app
from thermoscope.console.groups import HOME, narrowed, old_name

whole_app()  # extras have told their groups

RUN = CliRunner()
TOP = {"demo", "check"}


def known():
    return {str(c.name or c.callback.__name__) for c in whole_app().registered_commands}


def test_every_command_has_a_group_or_stands_alone():
    assert known() - TOP <= set(HOME)
    assert not TOP & set(HOME)


@pytest.mark.parametrize(
    "words", [[], *([g] for g in sorted(set(HOME.values()))), *([HOME[n], n] for n in sorted(HOME))]
)
def test_help_is_whole_and_narrow(words):
    if words[1:] and words[1] not in known():
        pytest.skip(f"{words[1]} has a group already, and comes later")
    done = RUN.invoke(whole_app(), [*words, "--help"], prog_name="thermoscope", terminal_width=80)
    assert done.exit_code == 0
    assert not re.search(r"[a-z]\.\.\.", done.output)
    assert max(map(len, done.output.splitlines())) <= 80


@pytest.mark.parametrize("words", [[HOME[n], n] for n in sorted(HOME) if n in known()], ids="-".join)
def test_the_app_of_one_command_says_what_the_whole_says(words):
    one = narrowed(whole_app(), [*words, "case"])
    assert [len(g.typer_instance.registered_commands) for g in one.registered_groups] == [1]
    for tail in (["--help"], ["--no-such-option"]):
        few, every = (
            RUN.invoke(x, [*words, *tail], prog_name="thermoscope", terminal_width=80) for x in (one, whole_app())
        )
        assert (few.exit_code, few.output) == (every.exit_code, every.output)


@pytest.mark.parametrize("words", [[], ["test"], ["test", "nothing"], ["compare"], ["demo"], ["--help"]], ids=str)
def test_what_is_no_command_of_a_group_is_left_to_the_whole_app(words):
    assert narrowed(whole_app(), words) is whole_app()


def test_old_and_new_names_do_the_same(case, monkeypatch, capsys):
    answers = []
    for words in (["quantities"], ["test", "quantities"]):
        monkeypatch.setattr("sys.argv", ["thermoscope", *words])
        with pytest.raises(SystemExit) as end:
            main()
        answers.append((end.value.code, *capsys.readouterr()))
    (old_code, old, said), (code, new, silent) = answers
    assert (old_code, old) == (code, new)
    assert "'thermoscope quantities' is 'thermoscope test quantities' now" in said
    assert silent == ""


def test_a_case_called_like_a_command_is_no_old_name():
    assert old_name(["test", "compare", "build"]) == ""
    assert old_name(["--help"]) == ""
    assert old_name(["two-paths", "case"]).startswith("'thermoscope two-paths' is 'thermoscope bench two-paths'")
