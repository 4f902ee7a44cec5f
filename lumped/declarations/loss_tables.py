"""The losses of network.toml, by kind."""

import math
from collections.abc import Callable, Collection, Mapping
from functools import partial
from itertools import pairwise

from geom.constants import ALPHA_CU, RPM
from lumped.model.quantities import USUAL
from lumped.schemas.reader import Table, powers
from lumped.sources import loss_laws as laws
from lumped.sources.inverter import InverterLoss, PulseLoss
from lumped.sources.layer_loss import by_dowell, from_map
from lumped.transfer.laws import CONSTANT, Law, Linear, TemperatureLaw

COLDEST, HOTTEST = -60.0, 300.0  # degC: from the coldest place a machine stands in to beyond what insulation bears


def _coefficient(table: Table, reference: float, default: float | None = None) -> float:
    """alpha (1/K) of 1 + alpha (T - reference), which must not turn a loss into cooling between COLDEST and HOTTEST."""
    alpha = table.number("alpha_1_K", default, low=-1.0 if default is None else 0.0)
    zero = reference - 1.0 / alpha if alpha else math.inf
    if COLDEST <= zero <= HOTTEST:
        side, end = ("above", HOTTEST) if alpha < 0 else ("below", COLDEST)
        most = 1.0 / (reference - end)
        raise table.error(
            f"alpha_1_K = {alpha:g} makes heat negative {side} {zero:.4g} degC",
            f"{'more' if alpha < 0 else 'less'} than {most:.4g} 1/K; copper has {ALPHA_CU}",
        )
    return alpha


def _copper(table: Table) -> Law:
    keys = [key for key in ("R20_ohm", "R_ohm") if key in table]
    if len(keys) != 1:
        raise table.error("resistance is not given once", "R20_ohm, or R_ohm with reference_degC")
    reference = 20.0 if keys[0] == "R20_ohm" else table.number("reference_degC")
    number, alpha = table.number, _coefficient(table, reference, ALPHA_CU)
    return laws.CopperLoss(number(keys[0]), table.members("currents"), number("factor", 1.0), alpha, reference)


def _eddy(table: Table, copper: laws.CopperLoss) -> Law:
    """From a polynomial, from a map over speed, or of bars in a slot by Dowell."""
    speed = table.word("input")
    if "factors" in table:
        at, factors = table.numbers("at_speed"), table.numbers("factors")
        if len(at) != len(factors) or len(at) < 2 or at[0] < 0.0 or any(b <= a for a, b in pairwise(at)):
            right = "at_speed rising from 0 or more, one factor per speed; of a hairpin winding a list per layer"
            raise table.error("the AC factors are no table", right)
        out: Law = from_map(copper, speed, at, factors)
    elif "pole_pairs" in table:
        bar = table.number("bar_height_mm") * 1e-3, table.number("porosity"), int(table.number("layer"))
        out = by_dowell(copper, speed, table.number("pole_pairs"), *bar)
    else:
        out = laws.EddyLoss(copper, table.numbers("coefficients"), speed, table.number("at", 1.0))
    table.close()
    return out


def _temperature(table: Table) -> TemperatureLaw:
    if "alpha_1_K" not in table:
        return CONSTANT
    reference = table.number("reference_degC")
    return Linear(_coefficient(table, reference), reference)


def _iron(table: Table) -> Law:
    n, excitation = table.number, table.word("excitation", "") or None
    speed, excited = (table.word("speed", "speed_rpm"), n("speed_at")), (excitation, n("excitation_at", 1.0))
    watts, exponents = (n("hysteresis_W", 0.0), n("eddy_W", 0.0)), (n("flux_exponent", 2.0), _temperature(table))
    return laws.IronLoss(*watts, *speed, *excited, *exponents, n("excess_W", 0.0), n("frequency_exponent", 1.0))


def _terms(table: Table) -> Law:
    if "P_W" in table:
        return laws.PowerLoss(((table.number("P_W"), powers(table)),), _temperature(table))
    terms = tuple((item.number("P_W"), powers(item)) for item in table.listed("terms"))
    if not terms:
        right = "P_W = ... with of = { input, at, exponent }, or terms = [{ P_W = ..., of = ... }]"
        raise table.error("no power", right)
    return laws.PowerLoss(terms, _temperature(table))


def _brush(table: Table) -> Law:
    friction = table.number("friction_W", 0.0)
    speed = table.word("speed", "speed_rpm") if friction else None
    at = table.number("speed_at") if friction else 1.0
    return laws.BrushLoss(table.number("drop_V"), table.word("current", "current_A"), friction, speed, at)


def _measured(table: Table, speeds: Collection[str]) -> Law:
    table.words("less", [])
    # Taken off. speeds : inputs in 1/min, which come with pi/30; a product of several without one needs its factor
    electrical = []
    for item in table.listed("electrical"):
        electrical.append((item.number("factor", 1.0, of="electrical.factor"), item.words("product")))
        item.close()
    out = []
    for item in table.listed("mechanical"):
        names = item.words("product")
        turning = [name for name in names if name in speeds]
        if "factor" not in item and not turning and len(names) > 1:
            right = 'factor = ..., or [inputs.NAME] quantity = "speed"'
            raise item.error("none of these inputs is known as a speed", right)
        out.append((-item.number("factor", RPM if turning else 1.0, of="mechanical.factor"), names))
        item.close()
    return laws.MeasuredLoss((*electrical, *out))


def deducted(table: Table, kinds: Mapping[str, str]) -> tuple[str, ...]:
    """The losses that a measured one leaves to the model."""
    less = table.words("less", [])
    others = [name for name, kind in kinds.items() if kind != MEASURED]
    for name in less:
        if name not in others:
            raise table.error(f"less = '{name}' is not a loss", f"a loss that is not measured: {', '.join(others)}")
    return less


def _ripple(table: Table) -> Law:
    n, alpha = table.number, _coefficient(table, 20.0, ALPHA_CU)
    supply, voltage = n("supply_V"), table.word("voltage", "voltage_V")
    return laws.RippleLoss(supply, voltage, n("L_H"), n("switching_Hz"), n("R20_ohm"), n("factor", 1.0), alpha)


def _inverter(table: Table) -> Law:
    n = table.number
    conducting = (n("factor", 1.5), n("threshold_V"), n("R_on_ohm"))
    switching = (n("switching_Hz"), n("switching_J"), n("reference_A"), n("reference_V"), n("supply_V"))
    return InverterLoss(table.members("currents"), *conducting, *switching, n("standby_W", 0.0), _temperature(table))


def _pulses(table: Table) -> Law:
    n, voltage = table.number, table.word("voltage", "voltage_V")
    ripple = (n("supply_V"), n("L_H"), n("switching_Hz"), n("R_pulse_ohm"))
    return PulseLoss(voltage, *ripple, _temperature(table))


def _map(table: Table) -> Law:
    speed, torque = table.numbers("at_speed"), table.numbers("at_torque")
    watts = tuple(table.rows("P_W"))
    rising = all(b > a for at in (speed, torque) for a, b in pairwise(at))
    if not rising or min(len(speed), len(torque)) < 2 or {len(row) for row in watts} != {len(torque)}:
        raise table.error("the map is not a grid", "at_speed and at_torque rising, P_W = [[per torque], per speed]")
    if len(watts) != len(speed):
        raise table.error(f"P_W has {len(watts)} rows", f"one per speed: {len(speed)}")
    inputs = table.word("speed", "speed_rpm"), table.word("torque", "torque_Nm")
    return laws.MapLoss(speed, torque, watts, *inputs, _temperature(table), powers(table))


LOSSES = {"copper": _copper, "iron": _iron, "brush": _brush, "ripple": _ripple, "inverter": _inverter}
LOSSES |= {"pwm": _pulses, "map": _map}
MEASURED = "measured"
PLAIN = ("friction", "windage", "stray", "magnet", "switching", "bearing", "constant")


def loss_kinds(tables: Mapping[str, Table]) -> dict[str, str]:
    """Name -> kind."""
    return {name: table.word("kind", None, (*LOSSES, MEASURED, *PLAIN)) for name, table in tables.items()}


def loss_laws(tables: Mapping[str, Table], quantities: Mapping[str, str] | None = None) -> dict[str, Law]:
    """Name -> law; of copper at alternating current a second one, NAME:eddy.  quantities : input -> what it measures"""
    speeds = [name for name, quantity in {**USUAL, **(quantities or {})}.items() if quantity == "speed"]
    read: dict[str, Callable[[Table], Law]] = {**LOSSES, MEASURED: partial(_measured, speeds=speeds)}
    out: dict[str, Law] = {}
    for name, kind in loss_kinds(tables).items():
        table = tables[name]
        law = out[name] = read.get(kind, _terms)(table)
        if isinstance(law, laws.CopperLoss) and "ac" in table:
            out[f"{name}{laws.EDDY}"] = _eddy(Table(table.raw("ac"), f"{table.where} ac"), law)
    return out
