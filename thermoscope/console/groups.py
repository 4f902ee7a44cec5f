"""The commands in groups: thermoscope test compare. Names of before the groups work for a version, with a note."""

from __future__ import annotations

import inspect
from collections.abc import Iterable, Sequence
from copy import copy

import typer

GROUPS: dict[str, tuple[str, tuple[str, ...]]] = {
    "model": (
        "Machines, networks, and the model as it stands.",
        ("machines", "build", "crosscheck", "calibrate", "add", "remove", "undo"),
    ),
    "test": (
        "Recordings: bring them in, look at them, hold the model against them.",
        ("new", "doctor", "compare", "quantities"),
    ),
    "explain": ("What is missing, and what would show it.", ("diagnose", "improve", "effects", "answer")),
    "show": (
        "Report, pictures, the workbench in the browser.",
        ("report", "render", "picture", "film", "viewer", "plan"),
    ),
    "use": ("Run the model, and take it elsewhere.", ("simulate",)),
}
HOME = {name: group for group, (_, names) in GROUPS.items() for name in names}
UNTIL = "0.3"  # version from which the old names are gone


def grouped(app: typer.Typer) -> typer.Typer:
    """Every command of the app under its group as well; the old names are hidden, what has no group stays."""
    parts = {
        group: typer.Typer(help=words, no_args_is_help=True, rich_markup_mode=None)
        for group, (words, _) in GROUPS.items()
    }
    for one in app.registered_commands:
        name = str(one.name or getattr(one.callback, "__name__", ""))
        one.short_help = inspect.getdoc(one.callback)  # else the list of commands cuts it
        if name in HOME and one.callback is not None:
            parts[HOME[name]].command(name, short_help=one.short_help)(one.callback)
            one.hidden = True
    for group, part in parts.items():
        app.add_typer(part, name=group, short_help=GROUPS[group][0])
    return app


def added(app: typer.Typer, extras: Iterable[typer.Typer]) -> typer.Typer:
    """The app with what extras declare. The name of an extra's app is its group, a new one brings its help."""
    for extra in extras:
        group = str(extra.info.name)
        part = next((p.typer_instance for p in app.registered_groups if p.name == group), None)
        if part is None:
            part = typer.Typer(help=extra.info.help, no_args_is_help=True, rich_markup_mode=None)
            app.add_typer(part, name=group, short_help=str(extra.info.help))
        for one in extra.registered_commands:
            assert one.callback is not None
            name, words = str(one.name or one.callback.__name__), inspect.getdoc(one.callback)
            part.command(name, short_help=words)(one.callback)
            app.command(name, short_help=words, hidden=True)(one.callback)
            HOME[name] = group
    return app


def narrowed(app: typer.Typer, arguments: Sequence[str]) -> typer.Typer:
    """The app with the one command asked for, where a group has it: reading the options of all takes 0.1 s."""
    group, command = [*arguments, "", ""][:2]
    for part in app.registered_groups:
        commands = (
            [x for x in part.typer_instance.registered_commands if x.name == command] if part.typer_instance else []
        )
        if part.name == group and commands:
            few, one, whole = copy(part.typer_instance), copy(part), copy(app)
            assert few is not None
            few.registered_commands, one.typer_instance = commands, few
            whole.registered_groups, whole.registered_commands = [one], []
            return whole
    return app


def old_name(arguments: Sequence[str]) -> str:
    """What to say where a command was called by its old name; "" where it was not."""
    first = next((word for word in arguments if not word.startswith("-")), "")
    if first not in HOME:
        return ""
    new = f"thermoscope {HOME[first]} {first}"
    return f"'thermoscope {first}' is '{new}' now; the old name works until version {UNTIL}"
