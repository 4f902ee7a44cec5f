"""The laws of network.toml: mechanisms of a link, flow of a stream, losses by class."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from itertools import pairwise

from lumped.laws import CONSTANT, Fixed, InputPower, Law, Linear, Power, Radiation, TemperatureLaw
from lumped.laws import Table as TableLaw
from lumped.losses import ALPHA_CU, BrushLoss, CopperLoss, IronLoss, MapLoss, MeasuredLoss, PowerLoss, RippleLoss
from lumped.reader import Table

SURFACES = ("horizontal cylinder", "vertical plate", "plate facing up", "plate facing down")
Mechanism = tuple[str, Law, bool]


def _powers(table: Table, key: str = "of") -> tuple[tuple[str, float, float], ...]:
    """[{ input = ..., at = ..., exponent = ... }]: |input / at| ** exponent each."""
    out = []
    for item in table.listed(key):
        out.append((item.word("input"), item.number("at", 1.0, low=1e-12), item.number("exponent", 1.0, low=-10)))
        item.close()
    return tuple(out)


def _coefficient(table: Table, has_area: bool, needed: bool = True) -> tuple[float, bool] | None:
    """The number of a mechanism and whether it is per area."""
    given = [key for key in ("G_W_K", "R_K_W", "h_W_m2K") if key in table]
    if len(given) > 1:
        raise table.error(f"{' and '.join(given)} both given", "one of G_W_K, R_K_W, h_W_m2K")
    if not given:
        if needed:
            raise table.error("no coefficient", "one of G_W_K, R_K_W, h_W_m2K")
        return None
    value = table.number(given[0], low=1e-12 if given[0] == "R_K_W" else 0.0)
    if given[0] == "h_W_m2K" and not has_area:
        raise table.error("h_W_m2K without an area", "area_m2 = ... in the link, or a surface as its first end")
    return (1.0 / value if given[0] == "R_K_W" else value), given[0] == "h_W_m2K"


def _needs_area(table: Table, has_area: bool) -> None:
    if not has_area:
        raise table.error("this mechanism needs an area", "area_m2 = ... in the link, or a surface as its first end")


def _fixed(table: Table, has_area: bool) -> tuple[Law, bool] | None:
    found, powers = _coefficient(table, has_area, needed=False), _powers(table)
    if found is None:
        return None
    return (InputPower(found[0], powers) if powers else Fixed(found[0])), found[1]


def _natural(table: Table, has_area: bool) -> tuple[Law, bool]:
    """Still air by correlation, tabulated over the temperature difference."""
    from lumped.correlations.natural import churchill_chu_cylinder, churchill_chu_plate, mcadams_plate
    from lumped.correlations.tabulate import tabulated

    _needs_area(table, has_area)
    surface, size = table.word("surface", None, SURFACES), table.number("size_m", low=1e-4, high=100)
    of: dict[str, Callable] = {
        SURFACES[0]: lambda s, a: churchill_chu_cylinder(size, s, a),
        SURFACES[1]: lambda s, a: churchill_chu_plate(size, s, a),
        SURFACES[2]: lambda s, a: mcadams_plate(size, s, a, upward=True),
        SURFACES[3]: lambda s, a: mcadams_plate(size, s, a, upward=False),
    }
    return Fixed(table.number("factor", 1.0), tabulated(of[surface])), True


def _radiation(table: Table, has_area: bool) -> tuple[Law, bool]:
    _needs_area(table, has_area)
    return Fixed(table.number("emissivity", high=1.0) * table.number("view_factor", 1.0, high=1.0), Radiation()), True


def _forced(table: Table, has_area: bool) -> tuple[Law, bool]:
    found, powers = _coefficient(table, has_area), _powers(table)
    if not powers:
        raise table.error("forced without an input", 'of = { input = "speed_rpm", at = 1000, exponent = 0.8 }')
    assert found is not None
    return InputPower(found[0], powers), found[1]


def _power(table: Table, has_area: bool) -> tuple[Law, bool]:
    found, law = _coefficient(table, has_area), Power(table.number("exponent", 0.25))
    assert found is not None
    return InputPower(found[0], _powers(table), law), found[1]


def _tabled(table: Table, has_area: bool) -> tuple[Law, bool]:
    difference, per_area = table.numbers("difference_K"), "h_W_m2K" in table
    value = table.numbers("h_W_m2K" if per_area else "G_W_K")
    rising = all(b > a for a, b in pairwise(difference))
    if len(value) != len(difference) or not rising or not value:
        raise table.error("difference_K and its values do not match", "two lists of one length, differences rising")
    if per_area:
        _needs_area(table, has_area)
    return InputPower(1.0, _powers(table), TableLaw(difference, value)), per_area


MECHANISMS = {"natural": _natural, "radiation": _radiation, "forced": _forced, "power": _power, "table": _tabled}


def mechanisms(table: Table, has_area: bool) -> list[Mechanism]:
    """(suffix of the link's name, law, whether in W/m2/K) for every mechanism of a link; they act in parallel."""
    fixed = _fixed(table, has_area)
    out: list[Mechanism] = [] if fixed is None else [("", *fixed)]
    for word, read in MECHANISMS.items():
        if word in table:
            inner = Table(table.raw(word), f"{table.where} {word}")
            out.append((f":{word}", *read(inner, has_area)))
            inner.close()
    if not out:
        table.raw("prior_sd")
        table.close()
        raise table.error("a link without a mechanism", f"G_W_K, R_K_W, h_W_m2K, {', '.join(MECHANISMS)}")
    return out


def flow_law(table: Table) -> Law:
    """Heat capacity rate (W/K) of a stream: fixed, or proportional to a flow input."""
    if "mcp_W_K" in table:
        return InputPower(table.number("mcp_W_K"), _powers(table))
    rate = table.number("density_kg_m3") * table.number("cp_J_kgK")
    if "flow_l_min" in table:
        return Fixed(rate * table.number("flow_l_min") / 60000.0)
    units = {"flow_l_min_input": 1 / 60000.0, "flow_m3_h_input": 1 / 3600.0}
    for key, scale in units.items():
        if key in table:
            return InputPower(rate * scale, ((table.word(key), 1.0, 1.0),))
    raise table.error(
        "no flow", "mcp_W_K, or density_kg_m3 and cp_J_kgK with flow_l_min, flow_l_min_input or flow_m3_h_input"
    )


def _copper(table: Table) -> Law:
    given = [key for key in ("R20_ohm", "R_ohm") if key in table]
    if len(given) != 1:
        raise table.error("resistance is not given once", "R20_ohm, or R_ohm with reference_degC")
    reference = 20.0 if given[0] == "R20_ohm" else table.number("reference_degC", low=-273.15)
    ac = table.raw("ac")
    speed, at, coefficients = _ac(Table(ac, f"{table.where} ac")) if ac is not None else (None, 1.0, (1.0,))
    return CopperLoss(
        table.number(given[0]), table.words("currents"), table.number("factor", 1.0),
        table.number("alpha_1_K", ALPHA_CU), reference, coefficients, speed, at,
    )  # fmt: skip


def _ac(table: Table) -> tuple[str, float, tuple[float, ...]]:
    out = table.word("input"), table.number("at", 1.0, low=1e-12), table.numbers("coefficients")
    table.close()
    return out


def _temperature(table: Table) -> TemperatureLaw:
    if "alpha_1_K" not in table:
        return CONSTANT
    return Linear(table.number("alpha_1_K", low=-1.0), table.number("reference_degC", low=-273.15))


def _iron(table: Table) -> Law:
    excitation = table.word("excitation", "") or None
    return IronLoss(
        table.number("hysteresis_W", 0.0), table.number("eddy_W", 0.0), table.word("speed", "speed_rpm"),
        table.number("speed_at", low=1e-12), excitation, table.number("excitation_at", 1.0, low=1e-12),
        table.number("flux_exponent", 2.0), _temperature(table), table.number("excess_W", 0.0),
        table.number("frequency_exponent", 1.0),
    )  # fmt: skip


def _terms(table: Table) -> Law:
    if "P_W" in table:
        return PowerLoss(((table.number("P_W"), _powers(table)),), _temperature(table))
    terms = tuple((item.number("P_W"), _powers(item)) for item in table.listed("terms"))
    if not terms:
        raise table.error(
            "no power", "P_W = ... with of = { input, at, exponent }, or terms = [{ P_W = ..., of = ... }]"
        )
    return PowerLoss(terms, _temperature(table))


def _brush(table: Table) -> Law:
    friction = table.number("friction_W", 0.0)
    speed = table.word("speed", "speed_rpm") if friction else None
    at = table.number("speed_at", low=1e-12) if friction else 1.0
    return BrushLoss(table.number("drop_V"), table.word("current", "current_A"), friction, speed, at)


def _measured(table: Table) -> Law:
    table.words("less", [])
    return MeasuredLoss(_products(table, "electrical", 1.0) + _products(table, "mechanical", -1.0))


def taken_off(table: Table, kinds: Mapping[str, str]) -> tuple[str, ...]:
    """The losses that a measured one leaves to the model."""
    less = table.words("less", [])
    others = [name for name, kind in kinds.items() if kind != "measured"]
    for name in less:
        if name not in others:
            raise table.error(f"less = '{name}' is no loss", f"a loss that is not measured: {', '.join(others)}")
    return less


def _ripple(table: Table) -> Law:
    return RippleLoss(
        table.number("supply_V", low=1e-9), table.word("voltage", "voltage_V"), table.number("L_H", low=1e-12),
        table.number("switching_Hz", low=1e-9), table.number("R20_ohm"), table.number("factor", 1.0),
        table.number("alpha_1_K", ALPHA_CU),
    )  # fmt: skip


def _map(table: Table) -> Law:
    speed, torque = table.numbers("at_speed"), table.numbers("at_torque")
    watts = tuple(tuple(float(p) for p in row) for row in table.raw("P_W", []))
    rising = all(b > a for at in (speed, torque) for a, b in pairwise(at))
    if not rising or min(len(speed), len(torque)) < 2 or {len(row) for row in watts} != {len(torque)}:
        raise table.error("the map is not a grid", "at_speed and at_torque rising, P_W = [[per torque], per speed]")
    if len(watts) != len(speed):
        raise table.error(f"P_W has {len(watts)} rows", f"one per speed: {len(speed)}")
    return MapLoss(speed, torque, watts, table.word("speed", "speed_rpm"), table.word("torque", "torque_Nm"),
                   _temperature(table))  # fmt: skip


def _products(table: Table, key: str, sign: float) -> tuple[tuple[float, tuple[str, ...]], ...]:
    out = []
    for item in table.listed(key):
        names = item.words("product")
        default = math.pi / 30 if key == "mechanical" and any(name.endswith("_rpm") for name in names) else 1.0
        out.append((sign * item.number("factor", default, low=-1e12), names))
        item.close()
    return tuple(out)


LOSSES = {
    "copper": _copper, "iron": _iron, "brush": _brush, "ripple": _ripple, "map": _map, "measured": _measured,
}  # fmt: skip
PLAIN = ("friction", "windage", "stray", "magnet", "switching", "bearing", "constant")


def loss_kinds(tables: Mapping[str, Table]) -> dict[str, str]:
    """Name -> kind."""
    return {name: table.word("kind", None, (*LOSSES, *PLAIN)) for name, table in tables.items()}


def loss_laws(tables: Mapping[str, Table]) -> dict[str, Law]:
    """Name -> law."""
    return {name: LOSSES.get(kind, _terms)(tables[name]) for name, kind in loss_kinds(tables).items()}
