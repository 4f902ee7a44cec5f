"""[circuits.NAME] of network.toml."""

from collections.abc import Iterable

from lumped.circuits.circuit import PER_M3S, Circuit, Cooler, Pass
from lumped.circuits.hydraulics import Bore, Duct, Nozzles
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
        walls = item.shares("wall")
        for wall in walls:
            if wall not in nodes:
                raise item.error(f"unknown wall '{wall}'", suggestion(wall, nodes))
        if not 0.0 < sum(walls.values()) <= 1.0 + 1e-9 or min(walls.values()) <= 0.0:
            raise item.error(f"shares of 'wall' sum to {sum(walls.values()):g}", "positive shares, 1 at most together")
        passes[branch] = (*passes.get(branch, ()), Pass(_passage(item), walls))
        item.close()
    if not passes:
        raise table.error("no passes", "passes = [{ wall = ..., width_mm = ..., height_mm = ..., length_m = ... }]")
    coolant, at = read_coolant(table), table.number("at_degC", 40.0)
    cells, pump = int(table.number("cells", 8)), table.number("pump_efficiency", 0.5)
    follow = table.word("films", "follow", ("follow", "fixed")) == "follow"
    back = "" if closed or "backwards_from" not in table else table.word("backwards_from", None, boundaries)
    out = Circuit(name, coolant, at, flow, passes, inlet, of, unit, cells, cooler, pump, follow, back)
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


def _passage(table: Table) -> Duct | Bore | Nozzles:
    """Nozzles, a round bore, else a rectangular channel, by the keys of the table."""
    n = table.number
    if "nozzles" in table:
        drip = table.flag("drip", False)
        return Nozzles(int(n("nozzles")), 1e-3 * n("nozzle_mm"), n("area_m2"), 1e-3 * n("run_mm"), drip)
    if "diameter_mm" in table:
        return Bore(1e-3 * n("diameter_mm"), n("length_m"), int(n("bends", 0)), int(n("parallel", 1)))
    size = (1e-3 * n("width_mm"), 1e-3 * n("height_mm"), n("length_m"))
    return Duct(*size, int(n("bends", 0)), 1e-3 * n("coil_diameter_mm", 0.0), int(n("parallel", 1)))


def _cooler(table: Table, boundaries: list[str]) -> Cooler:
    inner = Table(table.raw("reservoir"), f"{table.where} reservoir")
    flow, of, unit = _flow(inner, "air_flow")
    carries = air(AIR_AT_C).rho * air(AIR_AT_C).cp
    volume, UA, around = 1e-3 * inner.number("volume_l"), inner.number("UA_W_K"), inner.word("air", None, boundaries)
    arrangement = ARRANGEMENTS[inner.word("arrangement", "crossflow", ARRANGEMENTS)]
    out = Cooler(volume, UA, around, Flow(carries * (PER_M3S[unit] if of else flow), of), arrangement)
    inner.close()
    return out
