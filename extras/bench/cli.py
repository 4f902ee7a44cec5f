"""The commands of this extra; nothing heavy is loaded until one runs."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from thermoscope import plugin as th

commands = typer.Typer(name="bench", help="The published test procedure, from resistances to screened models.")


@commands.command()
def protocol(
    record: Annotated[Path | None, typer.Argument(metavar="RECORD.toml", help="A test's record so far.")] = None,
    json: th.JsonOption = None,
) -> int:
    """The thermal test: what to measure when, what is wrong with a record, and the temperatures it gives."""
    from extras.bench.commands.protocol import protocol_summary
    from extras.bench.measuring import protocol as procedure
    from extras.bench.measuring.record_file import read_record
    from thermoscope import InputError

    with th.progress() as tell:
        tell("checking the record")
        result = procedure.protocol(procedure.Record(1.0) if record is None else read_record(record))
    th.give(result.document(), json, lambda: protocol_summary(result))
    if result.refused:
        first = result.refused[0]
        more = f" (and {len(result.refused) - 1} more)" if len(result.refused) > 1 else ""
        raise InputError(first.words.split(";")[0], f"{record} [{first.name}]", first.words.partition("; ")[2] + more)
    return 0 if record is None or result.complete else 1


@commands.command()
def report(
    record: Annotated[Path, typer.Argument(metavar="RECORD.toml|CASE", help="A heat run, or a case with one.")],
    out: th.OutOption = None,
    json: th.JsonOption = None,
) -> int:
    """The heat run by IEC 60034-1 on a page to sign: rise against its class's limit. Exit code 1 unless it passes."""
    from extras.bench.commands.report import report_files, report_summary

    with th.progress() as tell:
        document, paths = report_files(record, out or Path("out"), tell)
    th.give(document, json, lambda: report_summary(document, paths))
    return 0 if document["verdict"] == "passes" else 1


@commands.command()
def curves(
    case: th.CaseArgument,
    resolution: Annotated[float, typer.Option(min=1e-3, max=100.0, help="K, of the thermocouples.")] = 0.5,
    against: Annotated[str | None, typer.Option(metavar="TEST|CASE", help="An earlier test, or its case.")] = None,
    test: Annotated[str | None, typer.Option(help="The later test, with --against; by default the last one.")] = None,
    out: th.OutOption = None,
    json: th.JsonOption = None,
) -> int:
    """Warming curves: equilibrium, tau_95, the 3 to 4 % rule, equal tests pooled; --against finds what changed since.

    Exit code 1 if the rule fails, equal tests differ, or the later test is not equal to the earlier one.
    """
    from thermoscope import InputError

    if against is None:
        from extras.bench.commands.curves import curves_summary
        from extras.bench.measuring.curves import curves as found_in

        if test or out:
            raise InputError("is for two tests", "--test" if test else "--out", "--against TEST beside it")
        with th.progress() as tell:
            folder = th.open_case(case, tell)
            tell("fitting the warming curves")
            result = found_in(folder.case, resolution)
        document = result.document()
        th.give(document, json, lambda: curves_summary(document))
        return 0 if result.agrees else 1

    from extras.bench.commands.drift import drift_between, drift_picture, drift_summary

    with th.progress() as tell:
        difference = drift_between(case, test, against, tell)
    th.give(difference.document(), json, lambda: drift_summary(difference.document()))
    if out is not None:
        th.notes([f"written: {drift_picture(difference, out)}"])
    return 0 if difference.verdict == "equal" else 1


@commands.command()
def law(
    tests: Annotated[Path, typer.Argument(metavar="TESTS.csv", help="A row for each steady test.")],
    heat: Annotated[str, typer.Option(metavar="COLUMN", help="The heat, in W.")],
    coolant: Annotated[str, typer.Option(metavar="COLUMN", help="The coolant's inlet, in degC.")],
    follows: Annotated[list[str], typer.Option(metavar="COLUMN[=UNIT]", help="What may set the cooling: 1 to 3.")],
    temperatures: Annotated[str, typer.Option(metavar="PATTERN", help="Columns in degC, e.g. 'T_*'.")],
    ambient: Annotated[str | None, typer.Option(metavar="COLUMN|DEGC", help="Where heat may go too.")] = None,
    fluid: Annotated[str, typer.Option(help="oil or water: counts with its viscosity, and warms.")] = "",
    predict: Annotated[Path | None, typer.Option(metavar="FILE.csv", help="Tests of the same columns.")] = None,
    out: th.OutOption = None,
    json: th.JsonOption = None,
) -> int:
    """One law of at most seven numbers from a table of steady tests, and what it predicts. Exit code 1 without one."""
    from extras.bench.commands.law import law_document, law_files, law_request, law_summary

    columns = law_request(heat, coolant, follows, temperatures, ambient, fluid)
    with th.progress() as tell:
        result, document, predicted = law_document(tests, columns, predict, tell)
    th.give(document, json, lambda: law_summary(document))
    if out is not None:
        th.notes(f"written: {path}" for path in law_files(result, predicted, out))
    return 0 if document["verdict"] == "law" else 1


@commands.command()
def bases(case: th.CaseArgument, json: th.JsonOption = None) -> int:
    """Which base a machine stood on in each test. Exit code 1 if the readings exclude the one that a sheet says."""
    from extras.bench.commands.bases import bases_summary

    with th.progress() as tell:
        folder = th.open_case(case, tell)
        hypotheses = th.which_base(folder.case, progress=tell)
    wrong = [h for h in hypotheses if h.declared and h.excluded]
    document = {
        "case": folder.case.name,
        "revision": folder.case.model.revision,
        "wrong": [h.test for h in wrong],
        "hypotheses": [h.document() for h in hypotheses],
    }
    th.give(document, json, lambda: bases_summary(document))
    return 1 if wrong else 0


@commands.command()
def screen(
    machine: Annotated[str, typer.Argument(metavar="MACHINE", help="A machine file, or a name that comes along.")],
    design: Annotated[str, typer.Option(help="full (128 runs), half (64), gap (256), morris or sobol.")] = "full",
    out: th.OutOption = None,
    json: th.JsonOption = None,
) -> int:
    """Which factors move the temperatures of a PM machine: effects with Lenth's limits, Morris or Sobol."""
    from extras.bench.commands.screen import plots, screening_document, screening_summary

    with th.progress() as tell:
        tell(f"screening {machine}")
        document = screening_document(machine, design)
    th.give(document, json, lambda: screening_summary(document))
    if out is not None:
        th.notes(f"written: {path}" for path in plots(document, out))
    return 0


@commands.command("two-paths")
def two_paths(
    case: th.CaseArgument,
    winding: Annotated[str, typer.Option(help="Place of the winding's mean.")] = "winding.copper",
    machine: Annotated[str, typer.Option(help="Place of the machine's inside.")] = "magnets",
    json: th.JsonOption = None,
) -> int:
    """The network of a case as two resistances: machine to ambient, winding to machine."""
    from extras.bench.commands.screen import paths
    from extras.bench.reduction.two_paths import of_test
    from thermoscope import InputError

    if winding == machine:
        raise InputError(f"'{winding}' is both", "--winding, --machine", "two places of the network")
    with th.progress() as tell:
        folder = th.open_case(case, tell)
        by_test = {t.name: of_test(folder.case, t, winding, machine).document() for t in folder.case.tests}
    th.give({"case": folder.case.name, "tests": by_test}, json, lambda: paths(by_test))
    return 0


@commands.command()
def carry(
    source: th.CaseArgument,
    targets: Annotated[list[str], typer.Argument(metavar="CASE...", help="Cases of other machines.")],
    json: th.JsonOption = None,
) -> int:
    """The calibrated model of one case on other machines. Exit code 1 if one disagrees beyond its uncertainty."""
    from extras.bench.commands.screen import show_transfer
    from extras.bench.reduction.transfer import transferred

    with th.progress() as tell:
        calibrated = th.open_case(source, tell)
        transfers = [transferred(calibrated.case, th.open_case(name, tell).case) for name in targets]
    document = {
        "source": calibrated.case.name,
        "revision": calibrated.case.model.revision,
        "targets": [one.document() for one in transfers],
    }
    th.give(document, json, lambda: show_transfer(document))
    return 0 if all(one.agrees for one in transfers) else 1


@commands.command()
def live(
    case: th.CaseArgument,
    follow: Annotated[str, typer.Option("--follow", metavar="ROWS", help="FILE, -, tcp://HOST:PORT or mqtt://HOST.")],
    test: Annotated[str, typer.Option(metavar="NAME", help="The test of the case that the rows become.")] = "live",
    drive: Annotated[bool, typer.Option("--drive", help="Send the set points; else a person sets them.")] = False,
    out: th.OutOption = None,
    json: th.JsonOption = None,
) -> int:
    """A test that steers itself: rows come in, the next set point goes out, until one cause has 90 %.

    Exit code 1 if it ends without an answer.
    """
    from extras.bench.commands.live import live_document, live_picture, live_summary

    document, events = live_document(case, follow, test, drive, json)
    th.give(document, json, lambda: live_summary(document))
    if out is not None:
        th.notes([f"written: {live_picture(events, test, out)}"])
    return 0 if document["decided"] else 1
