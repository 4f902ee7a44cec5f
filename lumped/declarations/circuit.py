"""[circuits.NAME] of network.toml."""

from __future__ import annotations

from collections.abc import Iterable

from lumped.circuits.circuit import PER_M3S, Circuit, Cooler, Pass
from lumped.circuits.hydraulics import Duct
from lumped.declarations.films import read_coolant
from lumped.schemas.reader import Table, suggestion
from lumped.transfer.exchanger import ARRANGEMENTS, Flow
from lumped.transfer.properties import air

AIR_AT_C = 30.0  # where a flow in m3/h becomes W/K; 10 K more carry 3 % less


def read_circuits(top: Table, nodes: Iterable[str], boundaries: Iterable[str]) -> dict[str, Circuit]:
    """All circuits of a file, checked against its nodes and boundaries."""
    names, around = list(nodes), list(boundaries)
    return {name: _circuit(name, table, names, around) for name, table in top.tables("circuits").items()}


def _circuit(name: str, table: Table, nodes: list[str], boundaries: list[str]) -> Circuit:
    flow, of, unit = _flow(table, "flow")
    closed = "reservoir" in table
    inlet = f"{name}.reservoir" if closed else table.word("inlet", None, boundaries)
    cooler = _cooler(table, boundaries) if closed else None
    passes: dict[str, tuple[Pass, ...]] = {}
    for item in table.listed("passes"):
        branch = item.word("branch", "1")
        passes[branch] = (*passes.get(branch, ()), _pass(item, nodes))
        item.close()
    if not passes:
        raise table.error("no passes", "passes = [{ wall = ..., width_mm = ..., height_mm = ..., length_m = ... }]")
    out = Circuit(
        name,
        read_coolant(table),
        table.number("at_degC", 40.0),
        flow,
        passes,
        inlet,
        of,
        unit,
        int(table.number("cells", 8)),
        cooler,
        table.number("pump_efficiency", 0.5),
        table.word("films", "follow", ("follow", "fixed")) == "follow",
        "" if closed or "backwards_from" not in table else table.word("backwards_from", None, boundaries),
    )
    for key in ("prior_sd", "film_prior_sd"):
        table.raw(key)
    table.close()
    return out


def _flow(table: Table, stem: str) -> tuple[float, str | None, str]:
    """Flow (m3/s), the input that carries it if any, and that input's unit."""
    for unit, scale in PER_M3S.items():
        if f"{stem}_{unit}" in table:
            of = table.word(f"{stem}_{unit}_input", "") or None
            return table.number(f"{stem}_{unit}") * scale, of, unit
    raise table.error(f"no {stem}", f"{stem}_l_min or {stem}_m3_h = usual flow; {stem}_l_min_input where it varies")


def _pass(table: Table, nodes: list[str]) -> Pass:
    walls = table.shares("wall")
    for wall in walls:
        if wall not in nodes:
            raise table.error(f"unknown wall '{wall}'", suggestion(wall, nodes))
    if not 0.0 < sum(walls.values()) <= 1.0 + 1e-9 or min(walls.values()) <= 0.0:
        raise table.error(f"shares of 'wall' sum to {sum(walls.values()):g}", "positive shares, 1 at most together")
    duct = Duct(
        1e-3 * table.number("width_mm"),
        1e-3 * table.number("height_mm"),
        table.number("length_m"),
        int(table.number("bends", 0)),
        1e-3 * table.number("coil_diameter_mm", 0.0),
        int(table.number("parallel", 1)),
    )
    return Pass(duct, walls)


def _cooler(table: Table, boundaries: list[str]) -> Cooler:
    inner = Table(table.raw("reservoir"), f"{table.where} reservoir")
    flow, of, unit = _flow(inner, "air_flow")
    carries = air(AIR_AT_C).rho * air(AIR_AT_C).cp
    out = Cooler(
        1e-3 * inner.number("volume_l"),
        inner.number("UA_W_K"),
        inner.word("air", None, boundaries),
        Flow(carries * (PER_M3S[unit] if of else flow), of),
        ARRANGEMENTS[inner.word("arrangement", "crossflow", ARRANGEMENTS)],
    )
    inner.close()
    return out
