"""The tutorial shows what each of its commands prints: scripts/tutorial.py runs them and writes it there."""

import re
import shlex

import pytest
from PIL import Image
from typer.testing import CliRunner

from scripts import tutorial
from thermoscope.cli import whole_app
from thermoscope.console.summary import LINES

PAGE = tutorial.PAGE.read_text(encoding="utf-8")
JOBS = (tutorial.ROOT / "docs" / "ten-jobs.md").read_text(encoding="utf-8")
RUN = [c for c in tutorial.commands(PAGE) if c.startswith("thermoscope")]
SHOWN = re.findall(r"```sh\n(.*?)```\n(?:\n```text\n(.*?)\n```\n)?", PAGE, re.DOTALL)


def test_it_goes_from_the_machine_through_add_to_the_report():
    words = ", ".join(" ".join(c.split()[1:3]) for c in RUN)
    first = "model build, model calibrate, test compare, explain diagnose, model add, test compare"
    assert words == f"{first}, show serve, show report, show render"


@pytest.mark.parametrize("command", RUN)
def test_every_command_exists_with_its_options(command):
    """--help ends before anything is done."""
    done = CliRunner().invoke(whole_app(), [*shlex.split(command)[1:], "--help"])
    assert done.exit_code == 0, done.output


@pytest.mark.parametrize(("commands", "printed"), SHOWN)
def test_what_a_command_prints_stands_under_it_and_fits_a_screen(commands, printed):
    if not commands.startswith("thermoscope") or commands.startswith(tutorial.WAITING):
        assert printed == ""
        return
    lines = printed.splitlines()
    assert lines, "python scripts/tutorial.py writes it"
    assert max(map(len, lines)) <= 80
    count = sum(line.startswith("thermoscope") for line in commands.splitlines())
    assert len(lines) <= count * (LINES + 5), "a sentence of some lines, and at most 25 after it"


def written_into(picture, chunk):
    with Image.open(tutorial.ROOT / "docs/images" / picture) as drawn:
        return drawn.info[chunk]


@pytest.mark.parametrize(
    ("picture", "chunk"), [("road-test.png", "words"), ("road-test.gif", "comment"), ("workbench-added.png", "errors")]
)
def test_pictures_tell_the_errors_of_the_text(picture, chunk):
    """What a picture's script wrote into it: of the held-out test, before and after."""
    words = written_into(picture, chunk)
    before, after = re.findall(r"\d+\.\d+(?=\D*)", words if isinstance(words, str) else words.decode())[-2:]
    assert f"held-out tests {before} -> {after} K" in PAGE
    readme = (tutorial.ROOT / "README.md").read_text(encoding="utf-8")
    assert all(f"**{error}**" in readme for error in (before, after))


def test_every_picture_of_the_workbench_is_of_one_walk():
    """The model before the step misses what the last one says it missed."""
    texts = [written_into(f"workbench-{name}.png", "errors") for name in ("sensor", "diagnosed", "added")]
    start, asked, added = (re.findall(r"\d+\.\d+", text) for text in texts)
    assert start == asked
    assert start[-1] == added[-2]


def test_it_takes_less_than_ten_minutes():
    assert int(re.search(r"need (\d+) min of one core", PAGE)[1]) < 10


def test_outputs_replace_what_stood_there():
    page = "x\n```sh\na b  # said\nc\n```\n\n```text\nold\n```\ny\n```sh\nc\n```\n"
    printed = {"a b": ["one"], "c": ["two", "three"]}
    out = tutorial.with_outputs(page, printed)
    assert out == ("x\n```sh\na b  # said\nc\n```\n\n```text\none\ntwo\n```\ny\n```sh\nc\n```\n\n```text\nthree\n```\n")
    assert tutorial.commands(out) == ["a b", "c", "c"]


def test_there_are_ten_and_each_shows_what_it_prints():
    jobs = re.split(r"(?m)^## ", JOBS)[1:]
    assert [job.split()[0] for job in jobs] == [str(n) for n in range(1, 11)]
    assert all("```text" in job for job in jobs), "python scripts/tutorial.py docs/ten-jobs.md writes it"
    shown = re.findall(r"```sh\nthermoscope.*?```\n\n```text\n(.*?)```", JOBS, re.DOTALL)
    assert max(len(line) for text in shown for line in text.splitlines()) <= 80


@pytest.mark.nightly
def test_every_command_of_the_ten_jobs_runs(tmp_path):
    """At 80 columns, in an empty folder; one that ends with a fault ends this."""
    printed = tutorial.run(tutorial.commands(JOBS), tmp_path)
    ours = [texts for command, texts in printed.items() if command.startswith("thermoscope")]
    lines = [line for texts in ours for text in texts for line in text.splitlines()]
    assert len(lines) > 40
    assert max(map(len, lines)) <= 80


@pytest.mark.nightly
def test_every_command_of_the_tutorial_runs(tmp_path):
    """Seven minutes of a core. Its last comparison has the error of its page, to 0.1 K: other processors round."""
    printed = tutorial.run(tutorial.commands(PAGE), tmp_path)
    last = "thermoscope test compare my-case"
    texts = PAGE[PAGE.rindex(last) :], printed[last][-1]
    shown, now = (re.search(r"Held out ([\d.]+) K", text) for text in texts)
    assert float(now[1]) == pytest.approx(float(shown[1]), abs=0.1)
