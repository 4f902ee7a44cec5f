"""thermoscope use compare-designs MACHINE MACHINE ...: what differs, how hot each gets, what each may carry."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from extras.rating.commands.rate import case_or_machine, is_machine
from extras.rating.envelope import rated
from extras.rating.operation import coolant_boundaries
from extras.rating.optimisation.electrics import auxiliary_power
from extras.rating.points import hot_spots
from extras.rating.request import Rated, RatingRequest, rated_model
from extras.rating.rows import row
from thermoscope import InputError, ThermoscopeError, plugin as th, steady

MOST = 6  # designs side by side: more do not fit on a screen
RUNAWAY_C = 1e3  # no part of a motor gets as hot: it does not settle


@dataclass(frozen=True)
class Design:
    """A machine at its own rated load, with what surrounds it as it surrounds the first.  it : what rates it"""

    folder: th.Folder
    it: Rated

    @property
    def machine(self) -> th.MachineDescription:
        if self.folder.built is None:
            raise InputError("has no machine file to compare", self.folder.case.name, "machine files, or cases of one")
        return self.folder.built.machine


def compared_designs(
    names: Sequence[str],
    limits: Mapping[str, float],
    around: Mapping[str, float],
    sure: bool | None,
    picture: Path | None = None,
) -> dict[str, Any]:
    """Two to six machines, or cases of machines, side by side.

    limits : place -> degC;  around : boundaries (degC) and inputs of all;  sure : whether ratings have bands
    picture : a PNG of all at rest under their rated loads, as large as each other and on one colour scale
    """
    if picture is not None and picture.suffix != ".png":
        raise InputError("is not the name of a picture", f"--picture {picture}", "a file NAME.png")
    if picture is not None:
        th.require_gl()  # before anything is built
    if not 2 <= len(names) <= MOST:
        raise InputError(f"{len(names)} designs are given", "compare-designs", f"two to {MOST} machine files or cases")
    for name in names:  # all are there before the first is built
        if not is_machine(name):
            th.find_case(name, th.library())
    with th.progress() as tell:
        designs: list[Design] = []
        for name in names:
            folder = case_or_machine(name, tell)
            conditions = {**(designs[0].it.op.boundaries if designs else {}), **around}
            designs.append(design(folder, limits, conditions))
        if picture is not None:
            tell("drawing the designs")
            _draw_designs(designs, picture)
        tell("ratings")
        return {
            "designs": [_described(one, limits, sure, tell) for one in designs],
            "dimensions": dimensions([one.machine for one in designs]),
            "boundaries": {n: T for one in reversed(designs) for n, T in one.it.op.boundaries.items()},
        }


def _draw_designs(designs: Sequence[Design], picture: Path) -> None:
    """Every design that settles at its rated load, cut open."""
    rows = []
    for one in designs:
        network, op = one.it.model.network, one.it.op
        try:
            z = steady(network, op.at(1.0, None), op.boundaries, one.it.model.values).z[: len(network.states)]
        except ThermoscopeError:  # one that does not settle has no picture; the first sentence names it
            continue
        assert one.folder.built is not None
        nodes = th.split(one.folder.built.mesh)
        T = network.on_parts(nodes.parts, z)
        rows.append((nodes, T, f"{one.machine.name}: {T.max():.0f} °C at most"))
    if not rows:
        raise InputError(
            "no design settles at its rated load", f"--picture {picture}", "a smaller load: --at NAME=VALUE"
        )
    th.machine_row(rows, png=picture)


class Designs(th.TableResult):
    """Designs side by side.  document : as `use compare-designs --json` gives it"""

    def __init__(self, document: dict[str, Any]) -> None:
        self.document = document

    def __repr__(self) -> str:
        summary = designs_summary(self.document)
        columns, rows = self.tables()[0].columns, self.tables()[0].rows
        return "\n".join([summary.sentence, *("  ".join(map(th.cell, row)) for row in (columns, *rows))])

    def tables(self) -> tuple[th.Table, ...]:
        """Figures, what differs in the files, and masses."""
        return tuple(part for part in designs_summary(self.document).parts if isinstance(part, th.Table))


def compare_designs(
    *machines: str | Path,
    limits: Mapping[str, float] | None = None,
    bands: bool | None = None,
    picture: str | Path | None = None,
    **around: float,
) -> Designs:
    """Two to six machine files, names or cases side by side: dimensions that differ, hottest points, ratings, masses.

    limits : place -> degC, for ratings;  bands : of ratings, else where they cost little
    picture : a PNG of all on one scale
    around : boundaries (degC) and inputs of all, such as ambient=40.0
    """
    files, png = [str(one) for one in machines], None if picture is None else Path(picture)
    return Designs(compared_designs(files, limits or {}, around, bands, png))


def design(folder: th.Folder, limits: Mapping[str, float], around: Mapping[str, float]) -> Design:
    """At its rated load.  around : boundaries (degC) and inputs of all designs; a design takes those that it has"""
    bare = rated_model(folder, RatingRequest(limits, {}))
    mine = {n: u for n, u in around.items() if n in bare.op.boundaries or n in bare.op.inputs}
    boundaries = {n: u for n, u in mine.items() if n in bare.op.boundaries}
    op = bare.op.moved({n: u for n, u in mine.items() if n not in boundaries}, boundaries)
    return Design(folder, replace(bare, op=op))


def _described(one: Design, limits: Mapping[str, float], sure: bool | None, tell: th.Progress) -> dict[str, Any]:
    """One design of the document: masses (kg), powers (W), hottest points (degC), its continuous rating."""
    machine, op, network = one.machine, one.it.op, one.it.model.network
    rows = th.named_rows(network, one.folder)
    heated = [n for n in dict.fromkeys(network.heated) if n in rows]
    spots = hot_spots(network, rows, dict.fromkeys(heated, 0.0))
    T = replace(one.it.model, rows=spots).rest(op, 1.0, None)
    free = sure is None and not one.folder.case.tests  # of priors alone: there is nothing to look at
    banded = limits and (free or th.bands_requested(network, sure))
    posterior = th.posterior_of(one.folder, tell) if banded else None
    rating = rated(one.it.model, op, one.it.limits, "S1", None) if limits else None
    ambient = next((T for b, T in op.boundaries.items() if b not in coolant_boundaries(network)), 20.0)
    return {
        "name": machine.name,
        "family": machine.family,
        "masses_kg": masses(machine),
        "pump_and_fan_W": auxiliary_power(machine, op.inputs, ambient),
        "inputs": dict(op.inputs),
        "boundaries": dict(op.boundaries),
        "settles": bool(np.all(T < RUNAWAY_C)),
        "hottest": [
            {"place": n, "degC": float(t)} for n, t in sorted(zip(heated, T, strict=True), key=lambda r: -r[1])
        ],
        "rating": None if rating is None else {"input": op.main, **row(one.folder, op, rating, None, posterior)},
        "asks_for_bands": bool(limits) and sure is None and not banded,
    }


def masses(machine: th.MachineDescription) -> dict[str, float]:
    """Material -> kg of it in all solids, most first."""
    out: dict[str, float] = {}
    for part in machine.parts:
        out[part.material] = out.get(part.material, 0.0) + part.volume * machine.material_of(part.name).rho
    return dict(sorted(out.items(), key=lambda item: -item[1]))


def dimensions(machines: Sequence[th.MachineDescription]) -> list[dict[str, Any]]:
    """Parameters of their families and keys of [cooling], [fans] and [ratings] that are not the same in all."""
    values = [_values(machine) for machine in machines]
    keys = dict.fromkeys(key for one in values for key in one)
    rows = [{"parameter": key, "values": [one.get(key) for one in values]} for key in keys]
    return [r for r in rows if any(v != r["values"][0] for v in r["values"])]


def _values(machine: th.MachineDescription) -> dict[str, Any]:
    """Key with dots -> value in the key's own unit."""
    out: dict[str, Any] = {"machine.family": machine.family}
    parameters = th.families()[machine.family].parameters if machine.geometry is not None else ()
    for p in parameters:
        value = getattr(getattr(machine.geometry, p.group), p.attribute)
        numeric = isinstance(value, int | float) and not isinstance(value, bool)
        out[f"geometry.{p.key}"] = float(f"{value / th.GEOMETRY_UNITS.get(p.unit, 1.0):.6g}") if numeric else value
    for section in ("cooling", "fans", "ratings"):
        out |= {f"{section}.{k}": v for k, v in machine.sections.get(section, {}).items() if not isinstance(v, dict)}
    return out


def designs_summary(document: Mapping[str, Any]) -> th.Summary:
    """Which carries most, or stays coolest; what was assumed; each figure side by side, what differs in the files."""
    designs = document["designs"]
    around = ", ".join(f"{b} {T:g} degC" for b, T in document["boundaries"].items())
    loads = "; ".join(f"{d['name']}: {_point(d['inputs'])}" for d in designs)
    names = [d["name"] for d in designs]
    figures = [
        *_rating_rows([d["rating"] for d in designs]),
        *((f"{place}, hottest (degC)", *(_at(d, place) for d in designs)) for place in _places(designs)),
        ("pump and fan (W)", *(d["pump_and_fan_W"] for d in designs)),
        ("mass (kg)", *(sum(d["masses_kg"].values()) for d in designs)),
    ]
    every = dict.fromkeys(m for d in designs for m in d["masses_kg"])
    materials = [(m, *(d["masses_kg"].get(m) for d in designs)) for m in every]
    bare = " and ".join(d["name"] for d in designs if d["asks_for_bands"])
    differ = [(r["parameter"], *("" if v is None else v for v in r["values"])) for r in document["dimensions"]]
    return th.Summary(
        f"{_verdict(designs)} Assumed of all: {around}.",
        [
            f"Steady under the rated load, {loads}.",
            f"The rating of {bare} has no band yet: --bands reads the tests for it, a minute or so." if bare else "",
            th.Table("", ["", *names], figures, keep=names),
            th.Table("What differs in the files", ["key", *names], differ, keep=names),
            th.Table("Mass by material (kg)", ["material", *names], materials, keep=names),
        ],
        "--limit PLACE=DEGC for ratings; --at ambient=DEGC for all; --json FILE; --picture FILE.png",
    )


def _verdict(designs: Sequence[Mapping[str, Any]]) -> str:
    """The design that carries most where limits were given; else the one whose hottest point is coolest."""
    astray = [d["name"] for d in designs if not d["settles"]]
    if astray:
        return f"{' and '.join(astray)} {'does' if len(astray) == 1 else 'do'} not settle at the rated load."
    if designs[0]["rating"] is not None:
        best = max(designs, key=lambda d: d["rating"]["value"])
        rating = best["rating"]
        return f"{best['name']} carries most: {rating['input']} = {_rating_words(rating)}, limited by {rating['at']}."
    best = min(designs, key=lambda d: d["hottest"][0]["degC"])
    hottest = best["hottest"][0]
    return f"{best['name']} stays coolest: {hottest['degC']:.1f} degC at its hottest, {hottest['place']}."


def _rating_rows(ratings: Sequence[Mapping[str, Any] | None]) -> list[tuple[str, ...]]:
    """The continuous rating and what limits it; none without limits."""
    present = [r for r in ratings if r is not None]
    if not present:
        return []
    return [
        (f"continuous {present[0]['input']}", *map(_rating_words, present)),
        ("limited by", *(r["at"] or "nothing" for r in present)),
    ]


def _rating_words(rating: Mapping[str, Any]) -> str:
    """'23.1 (21.9 to 24.3)'."""
    if not np.isfinite(rating["value"]):
        return "no limit is reached"
    band = "" if rating["ci95"] is None else f" ({rating['ci95'][0]:.4g} to {rating['ci95'][1]:.4g})"
    return f"{rating['value']:.4g}{band}"


def _point(inputs: Mapping[str, float]) -> str:
    return ", ".join(f"{n} {u:.4g}" for n, u in inputs.items())


def _places(designs: Iterable[Mapping[str, Any]]) -> list[str]:
    """Heated places of all designs, those that are hottest anywhere first."""
    hottest: dict[str, float] = {}
    for d in designs:
        for spot in d["hottest"]:
            hottest[spot["place"]] = max(hottest.get(spot["place"], -np.inf), spot["degC"])
    return sorted(hottest, key=lambda place: -hottest[place])


def _at(design: Mapping[str, Any], place: str) -> float | str:
    return next((f"{s['degC']:.1f}" for s in design["hottest"] if s["place"] == place), "")
