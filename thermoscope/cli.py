"""The command line. Nothing heavy is loaded until a command runs."""

from __future__ import annotations

import io
import os
import sys
from functools import cache
from pathlib import Path
from typing import Annotated, Any

import typer

from geom.errors import ThermoscopeError
from geom.plugins import plugins
from geom.storage import cache_folder
from thermoscope.console.answer import LINES, within
from thermoscope.console.groups import added, grouped, narrowed, old_name
from thermoscope.console.options import Accuracy, Anyway, Case, Effect, Effects, Json, Machine, Out, Sure
from thermoscope.console.terminal import ranges_as_notes
from thermoscope.files import STOPPED, checked_out, message_of, printable
from thermoscope.parts import NEEDS, explained, required

app = typer.Typer(
    help="See where your motor's thermal model is wrong, and why.",
    epilog="Exit codes: 0 done; 1 the model disagrees, or nothing was found; 2 the input is wrong. "
    "--all after any command shows all it knows; --debug where an error came from.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)

UsageError: Any = typer.BadParameter.__base__  # of click, wherever this version of typer keeps it
LATEST_S = 1e9  # as [test] from_s in a sheet
ANYWHERE = ("--all", "--debug")  # options of every command

# Read when NumPy is imported. The matrices of a diagnosis are small: threads of BLAS would mostly wait for each other.
BLAS_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")

Draws = Annotated[int | None, typer.Option("--draws", hidden=True, help="Of older versions; nothing is drawn now.")]


@app.command()
def demo(
    out: Annotated[Path, typer.Option("--out", metavar="DIR", callback=checked_out)] = Path("out/demo"),
    json: Json = None,
) -> None:
    """The whole loop on the shipped case with a hidden effect: the error before and after."""
    from thermoscope.demo import demo as run

    raise typer.Exit(run(out, json))


@app.command()
def new(
    files: Annotated[list[Path], typer.Argument(metavar="FILE...", help="CSV, text, xlsx, TDMS, MF4 or Parquet.")],
    machine: Annotated[str | None, typer.Option(metavar="M", help="Hold them against this machine.")] = None,
    network: Annotated[Path | None, typer.Option(metavar="N", help="Or against this network.toml.")] = None,
    out: Annotated[
        Path | None, typer.Option("--out", metavar="DIR", help="The new case; else the file's name.")
    ] = None,
    yes: Annotated[bool, typer.Option("--yes", help="Ask nothing: take the guesses.")] = False,
    constants: Annotated[
        list[str] | None, typer.Option("--set", metavar="NAME=VALUE", help="What was not recorded: ambient=21.5.")
    ] = None,
    place: Annotated[
        list[str] | None,
        typer.Option(metavar="COLUMN=PLACE", help="Where a column belongs: a place, an input, nothing."),
    ] = None,
    period: Annotated[
        float | None, typer.Option(min=1e-6, max=1e7, help="Seconds between rows without a clock.")
    ] = None,
    start: Annotated[
        float, typer.Option("--from", min=0.0, max=LATEST_S, help="The tests begin here (s from the first row).")
    ] = 0.0,
    end: Annotated[float | None, typer.Option("--to", min=0.0, max=LATEST_S, help="And end here.")] = None,
    json: Json = None,
) -> None:
    """A case from your own recordings: guesses each column, asks what it cannot know. Same columns: one test a file."""
    from thermoscope.commands.test.new import Wishes, places, settings
    from thermoscope.commands.test.new import new as run

    window = (start, end)
    wishes = Wishes(machine, network, out, yes, settings(constants or ()), period, window, places(place or ()))
    raise typer.Exit(run(files, wishes, json))


@app.command()
def build(machine: Machine, out: Out = None, accuracy: Accuracy = 2.0, json: Json = None) -> None:
    """Solids (STEP, STL, GLB), mesh and the smallest network that is accurate enough. Exit code 1 if none is."""
    from thermoscope.commands.model.build import build as run

    raise typer.Exit(run(machine, out, json, accuracy))


@app.command()
def crosscheck(machine: Machine, out: Out = None, accuracy: Accuracy = 2.0, json: Json = None) -> None:
    """Where network and field disagree, which link is responsible, and the hand formula beside the field's value."""
    from thermoscope.commands.model.crosscheck import crosscheck as run

    raise typer.Exit(run(machine, out, accuracy, json))


@app.command()
def simulate(
    case: Case,
    cycle: Annotated[str | None, typer.Option(metavar="FILE|NAME", help="A drive cycle; else all tests.")] = None,
    out: Out = None,
    bands: Sure = None,
    json: Json = None,
) -> None:
    """Drive cycle in, temperatures out: a CSV per run, and how well its heat balance closed."""
    from thermoscope.commands.use.simulate import simulate as run

    raise typer.Exit(run(case, cycle, out, json, bands))


@app.command()
def compare(
    case: Case,
    why: Annotated[
        bool, typer.Option("--why", help="Uncertainty, whiteness, inputs it follows, missing heat.")
    ] = False,
    bands: Sure = None,
    json: Json = None,
) -> None:
    """The model against every test: error per sensor against its uncertainty. Exit code 1 if it disagrees."""
    from thermoscope.commands.test.compare import compare as run

    raise typer.Exit(run(case, json, why, bands))


@app.command()
def diagnose(case: Case, draws: Draws = None, json: Json = None) -> None:
    """Which effect is missing, how sure, what it is confused with, which test would decide. Exit code 1 if none."""
    from thermoscope.commands.explain.diagnose import diagnose as run

    raise typer.Exit(run(case, json, older=draws is not None))


@app.command()
def add(case: Case, effect: Effects, anyway: Anyway = False, json: Json = None) -> None:
    """Add an effect, or several that need each other; recalibrate, and show the error before and after on every test,
    held-out ones too. Accepted is what predicts tests left out of the fit better than before."""
    from thermoscope.commands.model.revise import add as run

    raise typer.Exit(run(case, effect, anyway, json))


@app.command()
def answer(
    case: Case,
    word: Annotated[
        str, typer.Argument(metavar="yes|no|NAME", help="To what `diagnose` asked; or a boundary or sensor.")
    ],
    size: Annotated[
        str | None, typer.Argument(metavar="[[REASON:] 0.3 K]", help="How well NAME is known, and why.")
    ] = None,
    about: Annotated[str | None, typer.Option(metavar="NAME", help="Test, event or fault; else what it asked.")] = None,
    json: Json = None,
) -> None:
    """Answer what `diagnose` asked, or say how well a boundary or sensor is known; `undo` takes it back."""
    from thermoscope.commands.explain.answer import answer as run

    raise typer.Exit(run(case, word, about, json, size))


@app.command()
def remove(case: Case, effect: Effect, json: Json = None) -> None:
    """Take an effect out again and recalibrate."""
    from thermoscope.commands.model.revise import remove as run

    raise typer.Exit(run(case, effect, json))


@app.command()
def undo(
    case: Case,
    to: Annotated[int | None, typer.Option(min=0, help="Revision; 0 is the model as declared. Else the last.")] = None,
    json: Json = None,
) -> None:
    """Step back: one revision more, equal to an earlier one. The history stays whole."""
    from thermoscope.commands.model.revise import undo as run

    raise typer.Exit(run(case, to, json))


@app.command()
def improve(
    case: Case,
    yes: Annotated[bool, typer.Option("--yes", help="Do not ask; add only effects that stand alone.")] = False,
    most: Annotated[int, typer.Option(min=1, help="Effects to add at most.")] = 6,
    json: Json = None,
) -> None:
    """Diagnose, ask, add, again, until the model is adequate. Exit code 1 if it stops before."""
    from thermoscope.commands.explain.improve import improve as run

    raise typer.Exit(run(case, yes, most, json))


@app.command()
def calibrate(
    case: Case,
    anyway: Anyway = False,
    profile: Annotated[list[str] | None, typer.Option(metavar="GLOB", help="Profile these parameters too.")] = None,
    starts: Annotated[int | None, typer.Option(min=1, max=1000, help="Fits from so many points of the prior.")] = None,
    seed: Annotated[int | None, typer.Option(min=0, max=2**32 - 1, help="Of the points.")] = None,
    json: Json = None,
) -> None:
    """Fit the declared parameters to the calibration tests, with intervals and what the data cannot identify."""
    from thermoscope.commands.model.calibrate import calibrate as run

    raise typer.Exit(run(case, anyway, json, tuple(profile or ()), starts, seed))


@app.command()
def report(case: Case, out: Out = None, json: Json = None) -> None:
    """One self-contained HTML page: verdict, pictures, numbers with their uncertainty."""
    from thermoscope.commands.show.pages import report as run

    raise typer.Exit(run(case, out, json))


@app.command()
def render(case: Case, out: Out = None, json: Json = None) -> None:
    """Pictures (PNG) and a recording (.rrd) for the rerun viewer."""
    from thermoscope.commands.show.pages import render as run

    raise typer.Exit(run(case, out, json))


@app.command()
def picture(
    case: Case,
    what: Annotated[
        str,
        typer.Argument(
            metavar="WHAT",
            help="machine, temperature, field, difference, misses, uncertainty, exploded, parts, mesh, flux, network, "
            "losses, curves, bands, residuals or errors.",
        ),
    ],
    out: Annotated[Path | None, typer.Option("--out", metavar="FILE", help="A PNG file.")] = None,
    json: Json = None,
) -> None:
    """One picture: of the temperatures, the parts, the heat, or the model against its most telling test."""
    from thermoscope.commands.show.picture import picture as run

    raise typer.Exit(run(case, what, out, json))


@app.command()
def film(
    case: Case,
    out: Annotated[Path | None, typer.Option("--out", metavar="FILE", help="A GIF or MP4 file.")] = None,
    json: Json = None,
) -> None:
    """The machine warming up in its most telling test, before and after the model's last step."""
    from thermoscope.commands.show.film import film as run

    raise typer.Exit(run(case, out, json))


@app.command()
def viewer(
    case: Case,
    out: Annotated[Path | None, typer.Option("--out", metavar="FILE", help="An HTML file.")] = None,
    json: Json = None,
) -> None:
    """One HTML file: the machine to turn, cut and play in any browser, without a server or network."""
    from thermoscope.commands.show.viewer import viewer as run

    raise typer.Exit(run(case, out, json))


@app.command()
def plan(
    case: Case,
    effect: Annotated[
        list[str] | None,
        typer.Option(metavar="EFFECT@PLACE", help="A hypothesis; several are possible. Else the last diagnosis's."),
    ] = None,
    test: Annotated[str | None, typer.Option(metavar="NAME", help="Candidate test; else the best.")] = None,
    out: Annotated[Path | None, typer.Option("--out", metavar="FILE", help="An HTML file.")] = None,
    json: Json = None,
) -> None:
    """A page to pin on the bench: the test to drive next, and the curves that each hypothesis predicts."""
    from thermoscope.commands.show.plan import plan as run

    raise typer.Exit(run(case, tuple(effect or ()), test, out, json))


@app.command()
def machines(out: Out = None, json: Json = None) -> None:
    """The machines that come along; with --out also a page with a thumbnail of each."""
    from thermoscope.commands.model.machines import machines as run

    raise typer.Exit(run(out, json))


@app.command()
def effects(
    case: Annotated[str | None, typer.Argument(metavar="[CASE]", help="Say where each could sit in this case.")] = None,
    json: Json = None,
) -> None:
    """All effects the diagnosis knows: what each needs, where it could sit in a case, what the others lack."""
    from thermoscope.commands.explain.effects import effects as run

    raise typer.Exit(run(case, json))


@app.command()
def quantities(json: Json = None) -> None:
    """What a column may measure, in which units, and what memory holds."""
    from thermoscope.commands.explain.effects import quantities as run

    raise typer.Exit(run(json))


@app.command()
def doctor(case: Case, json: Json = None) -> None:
    """What looks wrong in a case's files before anything is fitted, with the cure. Exit code 1 if something does."""
    from thermoscope.commands.test.doctor import doctor as run

    raise typer.Exit(run(case, json))


@app.command()
def check(json: Json = None) -> None:
    """What this computer lacks (graphics), each with the command that fixes it."""
    from thermoscope.check import check as run

    raise typer.Exit(run(json))


grouped(app)


@cache
def whole_app() -> typer.Typer:
    """All commands, with those of the installed extras (entry points of the group "thermoscope.commands")."""
    return added(app, plugins("commands").values())


def main() -> None:
    """Run the command line and exit; what is wrong with the input is one message on stderr and exit code 2."""
    for name in BLAS_THREADS:
        os.environ.setdefault(name, "1")
    _open_streams()
    arguments = [a for a in sys.argv[1:] if a not in ANYWHERE]
    one = narrowed(app, arguments)
    if one is app:
        one = narrowed(whole_app(), arguments)
    if note := old_name(arguments):
        print(f"note: {note}", file=sys.stderr)
    try:
        with within(None if "--all" in sys.argv else LINES), explained(), ranges_as_notes():
            if "--help" not in arguments:
                required(package for word in arguments[:2] for package in NEEDS.get(word, ()))
            code = one(arguments, prog_name="thermoscope", standalone_mode=False)
    except typer.Abort:
        raise SystemExit(1) from None
    except Exception as fault:
        if "--debug" in sys.argv:
            raise
        print(one_line(fault), file=sys.stderr)
        raise SystemExit(2) from None
    if code == STOPPED:
        print(
            f"stopped: inputs are as they were; what later commands can go on with is kept in {cache_folder()}",
            file=sys.stderr,
        )
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
    return message if "\n" in message else f"error: {printable(f'{command}: {message}; {command} --help')}"
