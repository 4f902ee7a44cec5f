"""The page of ten jobs: every command runs, prints what stands under it in kind, and fits into 80 columns."""

import re

import pytest

from scripts import tutorial

PAGE = tutorial.ROOT / "docs" / "ten-jobs.md"
TEXT = PAGE.read_text(encoding="utf-8")


def test_there_are_ten_and_each_shows_what_it_prints():
    jobs = re.split(r"(?m)^## ", TEXT)[1:]
    assert [job.split()[0] for job in jobs] == [str(n) for n in range(1, 11)]
    assert all("```text" in job for job in jobs), "python scripts/tutorial.py docs/ten-jobs.md writes it"
    shown = "\n".join(re.findall(r"```text\n(.*?)```", TEXT, re.DOTALL))
    assert max(map(len, shown.splitlines())) <= 80


@pytest.mark.nightly
def test_every_command_of_the_ten_jobs_runs(tmp_path):
    """At 80 columns, in an empty folder; one that ends with a fault ends this."""
    printed = tutorial.run(tutorial.commands(TEXT), tmp_path)
    lines = [line for outputs in printed.values() for text in outputs for line in text.splitlines()]
    assert len(lines) > 40
    assert max(map(len, lines)) <= 80
