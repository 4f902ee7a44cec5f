"""A table of steady tests, read and checked: inputs, one heat, the coolant's inlet, ambient, temperatures."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from fnmatch import fnmatchcase
from pathlib import Path

import numpy as np

from thermoscope import InputError, plugin as th

FLUIDS: dict[str, Callable[[float], th.Fluid]] = {"oil": th.oil, "water": th.water}
FLOW_UNITS = {"l/min": th.L_MIN, "l/s": 60.0 * th.L_MIN, "m3/h": 1.0 / 3600.0, "m3/s": 1.0}
FEWEST = 8  # tests
STEP_K = 10.0  # of a coolant without a name
LEAST_RISE = 0.05  # of the usual one: a test with less scatters as one with so much
TINY = 1e-30  # of an input at rest: its logarithm is finite


@dataclass(frozen=True)
class Columns:
    """Names in the table.  inputs : with units;  temperatures : a pattern, e.g. T_layer_*;  ambient : or degC"""

    heat: str
    coolant: str
    inputs: Sequence[tuple[str, str]]
    temperatures: str
    ambient: str | float | None = None
    fluid: str = ""


@dataclass(frozen=True)
class Scales:
    """Of the tests that a law is made from: lowest, highest (k,) input; usual ln conductance, rise (K), inlet (degC)"""

    lowest: th.Array
    highest: th.Array
    log_G: float
    rise: float
    inlet: float


@dataclass(frozen=True)
class SteadyTests:
    """n tests.  inputs (n, k);  heat (W);  coolant : inlet, ambient : degC, the inlet's where nobody knows

    readings : (n, c) degC of sensors `names`;  thinner : ln of how much thinner the coolant is than at the usual inlet,
    in 10 K where it has no name;  mcp : W/K of its flow, infinite where nobody knows
    """

    columns: Columns
    names: tuple[str, ...]
    scales: Scales
    inputs: th.Array
    heat: th.Array
    coolant: th.Array
    ambient: th.Array
    readings: th.Array
    thinner: th.Array
    mcp: th.Array

    @property
    def mean(self) -> th.Array:
        return np.asarray(self.readings.mean(axis=1))

    def levels(self, i: int) -> th.Array:
        """The values of an input."""
        return np.unique(self.inputs[:, i])

    def scatter(self, T: th.Array) -> th.Array:
        """(n,) sd of a test about the law, over that at the usual rise: its square grows with the rise."""
        return np.asarray(np.sqrt(np.maximum((T - self.coolant) / self.scales.rise, LEAST_RISE)))

    def only(self, rows: th.Ints) -> "SteadyTests":
        """Some of the tests, on the scales of all of them."""
        names = ("inputs", "heat", "coolant", "ambient", "readings", "thinner", "mcp")
        return replace(self, **{name: getattr(self, name)[rows] for name in names})


def read_tests(file: Path, columns: Columns, scales: Scales | None = None) -> SteadyTests:
    """Steady tests of a file. InputError for what is missing or makes no sense.

    scales : of the tests whose law is to be used; the file needs no temperatures then
    """
    table = th.read_csv(file)
    names = tuple(name for name in table.columns if fnmatchcase(name, columns.temperatures))
    if not names and scales is None:
        right = th.suggestion(columns.temperatures, table.columns)
        raise InputError(f"no column is called {columns.temperatures!r}", str(file), right)

    def column(name: str) -> th.Array:
        table.require([name], str(file))
        values = [th.as_number(cell) for cell in table[name]]
        for n, v in enumerate(values):
            if v is None or not np.isfinite(v):
                where = f"{file} column '{name}' line {n + table.line}"
                raise InputError(f"'{table[name][n]}' is not a number", where, "a number in every test")
        return np.array(values, float)

    heat, coolant = column(columns.heat), column(columns.coolant)
    inputs = np.column_stack([column(name) for name, _ in columns.inputs])
    readings = np.column_stack([np.empty((heat.size, 0)), *map(column, names)])
    air = coolant if columns.ambient is None else np.full(heat.size, columns.ambient)
    ambient = column(columns.ambient) if isinstance(columns.ambient, str) else air
    return steady_tests(columns, names, inputs, heat, coolant, ambient, readings, scales, str(file))


def steady_tests(
    columns: Columns,
    names: Sequence[str],
    inputs: th.Array,
    heat: th.Array,
    coolant: th.Array,
    ambient: th.Array,
    readings: th.Array,
    scales: Scales | None = None,
    where: str = "tests",
) -> SteadyTests:
    """Arrays as of SteadyTests, checked."""
    for (name, _), u in zip([*columns.inputs, (columns.heat, "W")], [*inputs.T, heat], strict=True):
        if (u < 0.0).any() or (scales is None and not u.any()) or (name == columns.heat and not u.all()):
            right = "heat above 0 in each test, inputs from 0 up that are not all 0"
            raise InputError(f"'{name}' is negative or 0", where, right)
    if scales is None:
        rise = readings.mean(axis=1) - coolant
        cold = np.flatnonzero((rise <= 0.0) & ((ambient >= coolant) | (rise.mean() <= 0.0)))
        if heat.size < FEWEST or cold.size:
            words = f"row {cold[0] + 1} is colder than its coolant" if cold.size else f"has {heat.size} tests"
            raise InputError(words, where, f"{FEWEST} steady tests or more, each warmer than its coolant")
        log_G = float(np.log(heat.mean() / rise.mean()))
        scales = Scales(inputs.min(axis=0), inputs.max(axis=0), log_G, float(rise.mean()), float(coolant.mean()))
    thinner, mcp = (coolant - scales.inlet) / STEP_K, np.full(heat.size, np.inf)
    if columns.fluid:
        if columns.fluid not in FLUIDS:
            raise InputError(f"no fluid '{columns.fluid}'", "--fluid", " or ".join(FLUIDS))
        of = FLUIDS[columns.fluid]
        thinner = np.log(of(scales.inlet).nu / np.array([of(T).nu for T in coolant]))
        for u, (_, unit) in zip(inputs.T, columns.inputs, strict=True):
            if unit.lower() in FLOW_UNITS:
                mcp = np.maximum(u, TINY) * FLOW_UNITS[unit.lower()] * [of(T).rho * of(T).cp for T in coolant]
    return SteadyTests(columns, tuple(names), scales, inputs, heat, coolant, ambient, readings, thinner, mcp)
