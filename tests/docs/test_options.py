"""Every option of a command stands on a page: what no page names, nobody finds."""

import re

import typer

from thermoscope.cli import whole_app

SAID_BY_HELP = {"--help", "--out", "--json"}  # every command's, explained once


def options(command):
    """Visible long options of a command and of those below it."""
    for parameter in command.params:
        if not getattr(parameter, "hidden", False):
            yield from (name for name in parameter.opts if name.startswith("--"))
    for below in getattr(command, "commands", {}).values():
        if not below.hidden:
            yield from options(below)


def test_every_option_stands_on_a_page(root):
    pages = [root / "README.md", *root.glob("docs/**/*.md"), *root.glob("cases/*/README.md")]
    named = set(re.findall(r"--[a-z][a-z-]*", "\n".join(page.read_text(encoding="utf-8") for page in pages)))
    known = set(options(typer.main.get_command(whole_app())))
    assert len(known) > 20
    assert known - named - SAID_BY_HELP == set()
