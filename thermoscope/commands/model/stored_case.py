"""Temperatures that a file of another program stores, as the steady test of a case."""

import math
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from shlex import quote
from typing import Any

from geom.errors import InputError
from geom.escapes import toml_key, toml_value
from geom.importing.draft import COPIED, Draft
from geom.machine_file import machine_from
from geom.storage import write_whole
from geom.table import Table
from geom.text import counted
from lumped.build.pipeline import build
from lumped.machine.loss_sources import checked_losses
from lumped.machine.path import stem
from lumped.model.network import Network
from thermoscope.commands.model.stored_losses import NEGLIGIBLE_W, loss_words, nearest_losses, rms_ratio, steady_rises
from thermoscope.console.summary import Summary
from thermoscope.console.terminal import progress

TEST = "stored"
READINGS = "stored.temperatures.csv"
ROWS, STEP_S = 10, 86400  # a machine rests after a day; more readings of one state would say no more
FOREIGN = math.log(2.0)  # rises off so far (rms of logarithms): films and contacts together are seldom
ONE_STATE = "One steady state tells no loss from the films that it passes: where losses were measured, write those."
PLACES_PAGE = "docs/how-to/import.md lists the names"


def write_stored_case(draft: Draft, folder: Path) -> dict[str, Any]:
    """A case of the machine and its stored temperatures: what of them can be compared, at which point and losses.

    Where the losses of the file cannot have made its temperatures, those that come nearest stand in the draft instead.
    InputError where nothing can be compared, or something lies there; nothing is written.
    """
    from measured.importing.case_files import check_new_folder, folder_whole
    from measured.recordings.data_table import csv_text
    from thermoscope.case_folder.folder import patient_of
    from thermoscope.case_folder.settings import read_settings

    check_new_folder(folder)  # before minutes of building
    if not draft.readings:
        right = "a .mot file with validation temperatures, or no --case"
        raise InputError("stores no temperatures to compare with", str(draft.path), right)
    checked_losses(machine := machine_from(draft.sections(), str(draft.path)))
    with progress() as tell:
        network = build(machine, progress=tell).network
    rows = stored_rows(draft, network)
    compared = {row["sensor"]: row for row in rows if row["place"] and row["place"] not in network.boundaries}
    if not compared:
        raise InputError("none of its stored temperatures can be compared", str(draft.path), PLACES_PAGE)
    around = draft.surroundings | {row["place"]: row["degC"] for row in rows if row["place"] in network.boundaries}
    if lost := [name for name in network.boundaries if name not in around]:
        raise InputError(f"no temperature of {lost[0]!r}", str(draft.path), "T_Ambient and the coolant's inlet")
    around = {name: around[name] for name in network.boundaries}
    with progress() as tell:
        tell("looking for the losses of the stored temperatures")
        search = nearest_losses(steady_rises(draft, around))
    rises = steady_rises(draft, around, unit_losses=False)
    if foreign := rms_ratio(rises.misfit()) > FOREIGN:
        take_losses(draft, search["losses_W"])
    inputs, text = rises.inputs, draft.toml()
    times = [STEP_S * k for k in range(ROWS + 1)]
    point: dict[str, Any] = {"time_s": times, **{name: [around[name]] * len(times) for name in network.boundaries}}
    readings: dict[str, Any] = {"time_s": times[1:], **{name: [row["degC"]] * ROWS for name, row in compared.items()}}
    case = ["[case]", f"name = {toml_value(folder.name)}", 'machine = "machine.toml"', f"sample_s = {STEP_S}"]
    case += ["", f"[tests.{TEST}]", 'role = "calibrate"', ""]
    with folder_whole(folder) as partial:
        write_whole(partial / "machine.toml", text)
        write_whole(partial / "case.toml", "\n".join(case))
        write_whole(partial / f"tests/{TEST}.csv", csv_text(point))
        write_whole(partial / f"tests/{READINGS}", csv_text(readings))
        write_whole(partial / f"tests/{TEST}.toml", "\n".join(_sheet(draft, compared, inputs, network.boundaries)))
        for entry in read_settings(partial).tests:
            patient_of(entry)  # it is read as compare will
    ratios = {row["place"]: row["ratio"] for row in search["rows"]}
    rows = [{**row, "ratio": ratios.get(row["sensor"])} for row in rows]
    point = {"inputs": dict(inputs), "boundaries": around, "foreign_losses": foreign, "nearest": search}
    return {"case": str(folder), "readings": rows, **point}


def take_losses(draft: Draft, watts: Mapping[str, float]) -> None:
    """Losses that were looked for in place of the file's, which are said."""
    for e in [e for e in draft.entries if e.section.startswith("losses.")]:
        draft.entries.remove(e)
        if e.key == "P_W":
            draft.leave(e.section, e.value, "W: did not make the stored temperatures, which differ by more than twice")
    large = [(place, loss) for place, loss in watts.items() if loss >= NEGLIGIBLE_W]
    for k, (place, loss) in enumerate(large):
        values = {"kind": "stray", "at": place, "P_W": round(loss, 3)}
        draft.assume(f"losses.nearest-{k + 1}", "comes nearest to the stored temperatures", **values)


def _sheet(
    draft: Draft, places: Mapping[str, Mapping[str, Any]], inputs: Mapping[str, float], boundaries: Sequence[str]
) -> Iterator[str]:
    """The operating point is one recording, the temperatures another that begins a day later."""
    first = {row["place"]: row["degC"] for row in places.values()}
    yield f"# Stored in {draft.path.name}: a steady state, so every row is the same, a row a day."
    yield from ("", "[test]", 'time = "time_s"', f"max_gap_s = {STEP_S}")
    yield f"initial = {{ {', '.join(f'{toml_key(name)} = {value:g}' for name, value in first.items())} }}"
    yield from ("", "[inputs]", *(f"{toml_key(name)} = {value:g}" for name, value in inputs.items()))
    yield from ("", "[recorders.temperatures]", f"file = {toml_value(READINGS)}", 'time = "time_s"')
    for name, place in [*((b, b) for b in boundaries), *((name, row["place"]) for name, row in places.items())]:
        yield from ("", f"[columns.{toml_key(name)}]", 'quantity = "temperature"', 'unit = "degC"')
        yield f"place = {toml_value(place)}"
    yield ""


def stored_rows(draft: Draft, network: Network) -> list[dict[str, Any]]:
    """Each stored temperature with its place in the network; without one, and the reason, where it has none."""
    rows = []
    for name, value in draft.readings.items():
        place, why = draft.places.get(name, ""), ""
        if not place:
            why = "its name is not understood"
        elif place not in {*network.places, *network.boundaries}:
            cells = any(stem(p) == place for p in network.places)
            why = "lies in several cells: in the ratio alone" if cells else f"this network has no place '{place}'"
            place = ""
        rows.append({"sensor": name, "degC": value, "place": place, "doubt": why})
    return rows


def stored_summary(draft: Draft, test: dict[str, Any], rest: Summary) -> Summary:
    """What can be compared, under which losses, and a row per stored temperature; then the rest of the import."""
    rows, around = test["readings"], test["boundaries"]
    compared = sum(bool(row["place"]) and row["place"] not in around for row in rows)
    search, foreign = test["nearest"], test["foreign_losses"]
    watts = [e for e in draft.entries if e.section.startswith("losses.") and e.key == "P_W" and e.kind == COPIED]
    names = ", ".join(f"{e.section.partition('.')[2]} {e.value:g} W" for e in watts)
    losses = f"Losses of the file at their reference speeds: {names}" if watts else "The file has no losses: usual ones"
    if foreign:
        losses = "Losses of the file did not make these temperatures: machine.toml has those that come nearest"
    point = ", ".join(f"{name} {value:g}" for name, value in {**test["inputs"], **around}.items())
    sentence = (
        f"{test['case']}: test '{TEST}' compares {compared} of {counted(len(rows), 'stored temperature')}, "
        f"at {point}. {losses}. {' '.join(loss_words(search))} {ONE_STATE}"
    )
    table = Table.of("", rows, "*sensor | degC | *ratio | *place | *doubt")
    more = f"Next: thermoscope test compare {quote(test['case'])}; --json FILE"
    return Summary(f"{sentence}\n{rest.sentence}", [table, *rest.parts], more)
