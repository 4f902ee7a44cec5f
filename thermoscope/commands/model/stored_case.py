"""Temperatures that a file of another program stores, as the steady test of a case."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from shlex import quote
from typing import TYPE_CHECKING, Any

from geom.errors import InputError
from geom.escapes import toml_key, toml_value
from geom.importing.draft import COPIED, Draft
from geom.storage import write_whole
from geom.table import Table
from geom.text import counted
from lumped.machine.loss_sources import checked_losses
from thermoscope.console.summary import Summary
from thermoscope.console.terminal import progress

if TYPE_CHECKING:
    from lumped.model.network import Network

TEST = "stored"
READINGS = "stored.temperatures.csv"
ROWS, STEP_S = 10, 86400  # a machine rests after a day; more readings of one state would say no more
PLACES_PAGE = "docs/how-to/import.md lists the names"


def write_stored_case(draft: Draft, text: str, folder: Path) -> dict[str, Any]:
    """A case of the machine and its stored temperatures: what of them can be compared, and at which point.

    text : of the machine file.  InputError where nothing can be compared, or something lies there; nothing is written.
    """
    from geom.machine_file import machine_from
    from lumped.build.pipeline import build
    from lumped.machine.motor import rated_inputs
    from measured.importing.case_files import check_new_folder, folder_whole
    from measured.recordings.data_table import csv_text
    from thermoscope.case_folder.folder import patient_of
    from thermoscope.case_folder.settings import read_settings

    check_new_folder(folder)  # before minutes of building
    if not draft.readings:
        right = "a .mot file with validation temperatures, or no --case"
        raise InputError("stores no temperatures to compare with", str(draft.path), right)
    checked_losses(machine := machine_from(tomllib.loads(text), str(draft.path)))
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
    inputs = {name: value for name, value in rated_inputs(machine).items() if name in network.inputs}
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
    return {"case": str(folder), "readings": rows, "inputs": inputs, "boundaries": around}


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
            place, why = "", f"this network has no place '{place}'"
        rows.append({"sensor": name, "degC": value, "place": place, "doubt": why})
    return rows


def stored_summary(draft: Draft, test: dict[str, Any], rest: Summary) -> Summary:
    """What can be compared, under which losses, and a row per stored temperature; then the rest of the import."""
    rows, around = test["readings"], test["boundaries"]
    compared = sum(bool(row["place"]) and row["place"] not in around for row in rows)
    watts = [e for e in draft.entries if e.section.startswith("losses.") and e.key == "P_W" and e.kind == COPIED]
    names = ", ".join(f"{e.section.partition('.')[2]} {e.value:g} W" for e in watts)
    losses = f"Losses of the file at their reference speeds: {names}" if watts else "The file has no losses: usual ones"
    point = ", ".join(f"{name} {value:g}" for name, value in {**test["inputs"], **around}.items())
    sentence = (
        f"{test['case']}: test '{TEST}' compares {compared} of {counted(len(rows), 'stored temperature')}, "
        f"at {point}. {losses}. If the temperatures belong to others, change [losses] in machine.toml."
    )
    table = Table.of("", rows, "*sensor | degC | *place | *doubt")
    more = f"Next: thermoscope test compare {quote(test['case'])}; --json FILE"
    return Summary(f"{sentence}\n{rest.sentence}", [table, *rest.parts], more)
