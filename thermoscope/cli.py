"""The command line. Nothing heavy is loaded until a command runs: the help of the others is read from their files."""

import gc
import io
import os
import signal
import sys
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from importlib.abc import InspectLoader
from importlib.util import find_spec
from inspect import cleandoc
from keyword import iskeyword
from types import CodeType
from typing import Annotated, Any, cast

import typer

from geom.errors import ThermoscopeError
from geom.plugins import plugins
from geom.storage import cache_folder
from thermoscope.console.summary import LINES, limited_lines
from thermoscope.console.terminal import ranges_as_notes, versions
from thermoscope.files import STOPPED, message_of, printable
from thermoscope.parts import NEEDS, explained, required

UsageError: Any = typer.BadParameter.__base__  # of click, wherever this version of typer keeps it
ANYWHERE = ("--all", "--debug")  # options of every command
PLAIN: dict[str, Any] = {"no_args_is_help": True, "rich_markup_mode": None}
ABOUT = "See where your motor's thermal model is wrong, and why."
CODES = """Exit codes: 0 done; 1 the model disagrees, or nothing was found; 2 the input is wrong.
--all after any command shows all it knows; --debug where an error came from."""

# Read when NumPy is imported. The matrices of a diagnosis, and most fronts of a field, are small: threads of BLAS would
# mostly wait for each other. A build of `pmsm-m1` takes 160 s of one thread, and 420 s of two.
BLAS_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


@dataclass(frozen=True)
class CommandGroup:
    """Commands of one group, of the core or of an extra: each a function, loaded when it is asked for.

    Its signature and docstring are what the command line takes and says of it.
    name : word before the commands;  package : of their modules;  help : what they are for, "" where another says it
    commands : MODULE, or MODULE.COMMAND where they have not one name
    """

    name: str
    package: str
    commands: str
    help: str = ""


CORE = {
    "": ("", "demo,check"),
    "model": (
        "Machines, networks, and the model as it stands.",
        "machines,import_file.import,build,crosscheck,calibrate,revise.add,revise.remove,revise.undo",
    ),
    "test": (
        "Recordings: bring them in, look at them, hold the model against them.",
        "new,doctor,compare,doctor.quantities",
    ),
    "explain": ("What is missing, and what would show it.", "diagnose,improve,effects,answer"),
    "show": ("Report, pictures, the workbench in the browser.", "pages.report,pages.render,picture,film,viewer,plan"),
    "use": ("Run the model, and take it elsewhere.", "simulate"),
}
GROUPS = [
    CommandGroup(n, f"thermoscope.commands.{n}" if n else "thermoscope", c, words) for n, (words, c) in CORE.items()
]


def home_modules(groups: Iterable[CommandGroup] = GROUPS) -> dict[tuple[str, str], str]:
    """(group, command) -> the module that has it."""
    out = {}
    for group in groups:
        for module, _, name in (word.partition(".") for word in group.commands.split(",")):
            out[group.name, name or module] = f"{group.package}.{module}"
    return out


def command_line(
    requested: Callable[[str, str], bool], extras: Sequence[CommandGroup | typer.Typer] = ()
) -> typer.Typer:
    """The program in which the requested commands (group, name) can run; of the others it knows the help alone.

    extras : groups of further commands, or apps of typer, which are loaded already; a new group brings its help
    """
    app = typer.Typer(help=ABOUT, epilog=CODES, add_completion=False, pretty_exceptions_enable=False, **PLAIN)
    app.callback(help=ABOUT)(_of_every_command)
    parts, apps = {"": app}, [e for e in extras if isinstance(e, typer.Typer)]
    groups = [*GROUPS, *(e for e in extras if isinstance(e, CommandGroup))]
    for name, words in [*((g.name, g.help) for g in groups), *((str(a.info.name), str(a.info.help)) for a in apps)]:
        if name not in parts:
            parts[name] = typer.Typer(help=words, **PLAIN)
            app.add_typer(parts[name], name=name, short_help=words)
    for (group, name), module in home_modules(groups).items():
        function = f"{name}_" if iskeyword(name) else name.replace("-", "_")
        run = getattr(import_module(module), function) if requested(group, name) else _help_alone(module, function)
        parts[group].command(name, short_help=run.__doc__)(run)  # else the list of commands cuts it
    for extra in apps:
        for one in extra.registered_commands:
            assert one.callback is not None
            name, words = str(one.name or one.callback.__name__), str(one.callback.__doc__)
            parts[str(extra.info.name)].command(name, short_help=words)(one.callback)
    return app


def _say_version(value: bool) -> None:
    if value:
        print(versions())
        raise typer.Exit


def _of_every_command(
    version: Annotated[
        bool, typer.Option("--version", is_eager=True, callback=_say_version, help="The version, Python and system.")
    ] = False,
) -> None:
    """Options before the command."""


def _help_alone(module: str, name: str) -> Callable[[], None]:
    """A stand-in that says what the command says of itself; the module is read, not loaded."""
    spec = find_spec(module)
    assert spec is not None
    program = cast(InspectLoader, spec.loader).get_code(module)  # its bytecode, where that was kept
    assert program is not None
    function = next(c for c in program.co_consts if isinstance(c, CodeType) and c.co_name == name)

    def stand_in() -> None:
        """Nothing is run."""

    stand_in.__doc__ = cleandoc(function.co_consts[0])  # where a function keeps what it says of itself
    return stand_in


@cache
def whole_app() -> typer.Typer:
    """All commands, with those of the installed extras (entry points of the group "thermoscope.commands")."""
    return command_line(lambda group, name: True, list(plugins("commands").values()))


def narrowed_app(arguments: Sequence[str]) -> typer.Typer:
    """The app for these words: the one command asked for loaded, the extras only where it may be one of theirs."""
    words = [word for word in arguments if not word.startswith("-")]
    group, name = ("", words[0]) if words and ("", words[0]) in home_modules() else (*words, "", "")[:2]
    extras = [] if (group, name) in home_modules() else list(plugins("commands").values())
    return command_line(lambda *this: this == (group, name), extras)


def main() -> None:
    """Run the command line and exit; what is wrong with the input is one message on stderr and exit code 2."""
    arguments = [a for a in sys.argv[1:] if a not in ANYWHERE]
    for name in BLAS_THREADS:
        os.environ.setdefault(name, "1")
    _open_streams()
    if "--debug" not in sys.argv:
        sys.unraisablehook = lambda _: None  # of half-made objects of a package whose message has been given
    stopped: list[int] = []

    def stop(*_: object) -> None:
        stopped.append(STOPPED)
        raise KeyboardInterrupt

    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, stop)
    try:
        with limited_lines(None if "--all" in sys.argv else LINES), explained(), ranges_as_notes():
            if "--help" not in arguments:
                required(package for word in arguments[:2] for package in NEEDS.get(word, ()))
            gc.disable()  # of what is being loaded nothing is garbage: looking for it takes a sixth of a short command
            try:
                app = narrowed_app(arguments)
            finally:
                gc.freeze()
                gc.enable()
            code = app(arguments, prog_name="thermoscope", standalone_mode=False)
    except typer.Abort:
        raise SystemExit(1) from None
    except KeyboardInterrupt:  # while the command's modules are loaded
        code = STOPPED
    except Exception as fault:
        if "--debug" in sys.argv:
            raise
        if not stopped:
            print(one_line(fault), file=sys.stderr)
            raise SystemExit(2) from None
        code = STOPPED  # what a package makes of Ctrl-C while it is loaded
    if code == STOPPED:
        files = cache_folder()
        rest = f"; what later commands can go on with is kept in {files}" if files.is_dir() else ""
        print(f"stopped: inputs are as they were{rest}", file=sys.stderr)
    raise SystemExit(code if isinstance(code, int) else 0)


def _open_streams() -> None:
    """Both are there, and take any name that a disk has: what no UTF-8 can say is written as its escape."""
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, "w"))  # noqa: SIM115
        if isinstance(stream := getattr(sys, name), io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")


def one_line(fault: Exception) -> str:
    """One line that says what is wrong; the help itself where nothing at all was asked for."""
    if not isinstance(fault, ThermoscopeError | OSError | UsageError):
        return f"error: {printable(f'{type(fault).__name__}: {fault}')}; a fault of the program: --debug shows where"
    if not isinstance(fault, UsageError):
        return f"error: {printable(message_of(fault))}"
    message, command = fault.format_message().rstrip("."), fault.ctx.command_path if fault.ctx else "thermoscope"
    groups = whole_app().registered_groups if message.startswith("No such command") else []
    apps = [(g.name, g.typer_instance) for g in groups if g.typer_instance]
    homes = [f"thermoscope {g} {c.name}" for g, a in apps for c in a.registered_commands if f"'{c.name}'" in message]
    right = " or ".join(homes) or f"{command} --help"
    return message if "\n" in message else f"error: {printable(f'{command}: {message}; {right}')}"
