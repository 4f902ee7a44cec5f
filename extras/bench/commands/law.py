"""thermoscope bench law TESTS.csv"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer

from extras.bench.steady_law.law import Prediction, SteadyLaw, checks, find_law
from extras.bench.steady_law.steady_tests import Columns, SteadyTests, read_tests
from thermoscope import InputError, plugin as th

MOST_INPUTS = 3  # of a law: with more, forms outnumber the tests of any bench
Predicted = tuple[SteadyTests, Prediction]


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
    columns = law_request(heat, coolant, follows, temperatures, ambient, fluid)
    with th.progress() as tell:
        tell(f"reading {tests}")
        steady = read_tests(tests, columns)
        others = None if predict is None else read_tests(predict, columns, steady.scales)
        result = find_law(steady, tell)
        document = {"file": str(tests), **result.document(), "checks": checks(result, tell)}
    predicted = None if others is None else (others, result.predict(others))
    if predicted and predicted[0].names:
        document["predicted"] = {"left_out": str(predict), **predicted[1].agreement(predicted[0])}
    th.give(document, json, lambda: law_summary(document))
    if out is not None:
        th.notes(f"written: {path}" for path in law_files(result, predicted, out))
    return 0 if document["verdict"] == "law" else 1


def law_request(
    heat: str, coolant: str, follows: Sequence[str], temperatures: str, ambient: str | None, fluid: str
) -> Columns:
    """Options as names of columns. InputError for names that come twice, or too many."""
    pairs = [(name.strip(), unit.strip()) for name, _, unit in (word.partition("=") for word in follows)]
    names = [heat, coolant, *(name for name, _ in pairs)]
    if len(set(names)) < len(names):
        twice = next(n for n in names if names.count(n) > 1)
        raise InputError(f"'{twice}' is given twice", "--heat, --coolant, --follows", "a column for one thing")
    if len(pairs) > MOST_INPUTS:
        raise InputError(f"{len(pairs)} inputs", "--follows", f"at most {MOST_INPUTS}")
    degC = None if ambient is None else th.as_number(ambient)
    return Columns(heat, coolant, pairs, temperatures, ambient if degC is None else degC, fluid)


def law_summary(document: Mapping[str, Any]) -> th.Summary:
    """The law in words, its numbers, how well it agrees with its tests and with what was left out."""
    columns = "number=name | *value | *95 % interval=interval | *unit"
    numbers = th.Table.of("", document["numbers"], columns, interval=lambda n: f"{n['low']:.3g} to {n['high']:.3g}")
    rows = [{"left_out": "nothing", **document["agreement"]}, *document["checks"]]
    rows += [document["predicted"]] if "predicted" in document else []
    columns = "left out=left_out | *tests | *rms (K)=rms_K | worst sensor (K)=worst_K | *in the band=inside | worst"
    errors = th.Table.of("Tests and law, all sensors", rows, columns, inside=lambda r: th.percent(r["inside"]))
    more = [document["formula"], numbers, errors, *document["doubts"]]
    return th.Summary(document["sentence"], more, "--out DIR; --json FILE")


def law_files(law: SteadyLaw, predicted: Predicted | None, out: Path) -> list[Path]:
    """The picture, and the table of what was predicted."""
    from extras.bench.figure import cooling_law

    paths = [out / "law.png"]
    cooling_law(law, predicted and predicted[0], png=paths[0])
    if predicted is not None:
        tests, p = predicted
        columns = law.tests.columns
        head = [*(name for name, _ in columns.inputs), columns.heat, columns.coolant, "mean_degC", *law.tests.names]
        head += [f"{name}_95_K" for name in ("mean", *law.tests.names)]
        table = np.column_stack([tests.inputs, tests.heat, tests.coolant, p.mean, p.readings, p.half, p.halves])
        paths.append(out / "predicted.csv")
        th.write_whole(paths[-1], th.csv_lines([head, *([f"{v:.6g}" for v in row] for row in table)]))
    return paths
