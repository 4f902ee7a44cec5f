"""C99 from a model: fixed code (runtime/), the numbers, and the heading of every export: what the model is good for."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from extras.export.model import Model, Output, Signal
from extras.export.products import Function, Mapped, Positive, Powered, Straight, Sum
from thermoscope import plugin as th

RUNTIME = Path(__file__).resolve().parent / "runtime"
SOURCES = ("thermal_network.h", "thermal_network.c")
REAL = 8  # bytes
WIDE = 8  # numbers on a line
EMPTY = ["0"] * 32  # C99 has no empty arrays, and compilers look ahead


def c_files(model: Model) -> dict[str, str]:
    """File name -> text: everything that has to be compiled."""
    fixed = {name: (RUNTIME / name).read_text(encoding="utf-8") for name in SOURCES}
    return {**fixed, "thermal_network_sizes.h": sizes(model), "thermal_network_data.h": data(model)}


def sizes(model: Model) -> str:
    """The header: what the model is, its inputs and outputs, and the sizes of its arrays."""
    T = model.terms
    counts = {
        "STATES": len(model.states),
        "BOUNDARIES": len(model.boundaries),
        "INPUTS": len(model.inputs),
        "SIGNALS": len(model.signals),
        "OUTPUTS": len(model.outputs),
        "TERMS": len(model.factors),
        "FACTORS": len(model.factors) + len(model.sizes),
        "ROWS": T.begin.size - 1,
    }
    numbers = {
        "C21": th.stages.C21,
        "C31": th.stages.C31,
        "C32": th.stages.C32,
        "SLOPE2": th.stages.SLOPE2,
        "END1": th.stages.END1,
        "END2": th.stages.END2,
        "END3": th.stages.END3,
        "ERROR_K": model.tolerance[0],
        "ERROR_SHARE": model.tolerance[1],
        "REST_K": th.CONVERGED_K,
    }
    lines = [f"#define THERMAL_{k} {v}" for k, v in counts.items()]
    lines += [f"#define THERMAL_{k} {v:.17g}" for k, v in numbers.items()]
    macro = "THERMAL_NETWORK_SIZES_H"
    return "\n".join([th.c_comment(heading(model)), f"#ifndef {macro}", f"#define {macro}", *lines, "#endif", ""])


def data(model: Model) -> str:
    """All arrays."""
    signals = [s.name for s in model.signals]
    T, F = model.terms, flat(model.factors, signals)
    rows = [o.row for o in model.outputs]
    parts = [
        reals("C", model.C),
        _matrix("K0", model.K0),
        reals("UNIT", model.unit),
        ints("NODE", model.node),
        ints("ENTRY_START", T.begin),
        ints("ENTRY_AT", T.at),
        reals("ENTRY_WEIGHT", T.weight),
        ints("ROW_FIRST", T.part[:, th.ROW]),
        ints("ROW_END", T.part[:, th.END]),
        ints("ROW", T.row),
        ints("HOT", T.part[:, th.HOT]),
        ints("COLD", T.part[:, th.COLD]),
        ints("LAW", T.kind[:, 0]),
        reals("LAW_A", T.par[:, 0]),
        reals("LAW_B", T.par[:, 1]),
        ints("POINT_START", T.part[:, th.POINT]),
        ints("POINT_END", T.part[:, th.LAST]),
        reals("POINT_X", T.point[:, 0]),
        reals("POINT_Y", T.point[:, 1]),
        ints("PLACE", T.part[:, th.PLACE]),
        ints("SEEN", [-1 if of is None else signals.index(of) for of, _ in model.sizes]),
        reals("SEEN_SIZE", [usual for _, usual in model.sizes]),
        ints("PRODUCT_START", F.product_start),
        reals("PRODUCT", F.coefficient),
        ints("FUNCTION_START", F.function_start),
        _matrix("FUNCTION", F.function, "int"),
        _matrix("FUNCTION_A", F.parameters),
        reals("FUNCTION_X", F.x),
        reals("FUNCTION_Y", F.y),
        ints("OUTPUT_START", th.starts([r.index for r in rows])),
        ints("OUTPUT_AT", joined(r.index for r in rows)),
        reals("OUTPUT_WEIGHT", joined(r.weights for r in rows)),
        f"#define FILMS {th.FILMS}",
        f"#define FILM_FIRST ((thermal_real){th.FIRST_C})",
        f"#define FILM_STEP ((thermal_real){th.STEP_K})",
        f"#define LEAST ((thermal_real){th.LEAST})",
        f"#define FULL_UNITS ((thermal_real){th.FULL_UNITS})",
    ]
    return "\n".join(["/* The numbers of the model; see thermal_network_sizes.h. */", *parts, ""])


def joined(parts: Iterable[np.ndarray]) -> np.ndarray:
    return np.concatenate([np.empty(0), *parts])


def _broken(words: Sequence[str]) -> str:
    return ",\n".join(", ".join(words[i : i + WIDE]) for i in range(0, len(words), WIDE))


def reals(name: str, values: Any) -> str:
    words = [f"{v:.17g}" for v in np.ravel(values)] or EMPTY
    return f"static const thermal_real {name}[] = {{{_broken(words)}}};"


def ints(name: str, values: Any) -> str:
    words = [str(int(v)) for v in np.ravel(values)] or EMPTY
    return f"static const int {name}[] = {{{_broken(words)}}};"


def _matrix(name: str, values: np.ndarray, of: str = "thermal_real") -> str:
    table = values if values.size else np.zeros((1, values.shape[1]), values.dtype)
    rows = ",\n".join("{" + _broken([f"{v:.17g}" for v in row]) + "}" for row in table)
    return f"static const {of} {name}[][{table.shape[1]}] = {{{rows}}};"


def heading(model: Model) -> list[str]:
    """Inputs, outputs, units, limits, validity range, proven error and cost, in lines of text."""
    effects = ", ".join(model.effects) or "none"
    return [
        f"Thermal network '{model.name}', revision {model.revision}, effects added: {effects}.",
        "",
        "Inputs u, in this order (range: what the tests of the case covered; beyond it nothing is proven):",
        *(f"  {i}: {_input(s)}" for i, s in enumerate(model.signals)),
        "",
        "Outputs y (degC), in this order:",
        *(f"  {i}: {_output(o)}" for i, o in enumerate(model.outputs)),
        "",
        *_cost(model),
    ]


def _input(s: Signal) -> str:
    limits = "range not known" if s.low is None or s.high is None else f"{s.low:.5g} to {s.high:.5g}"
    return f"{s.name} ({s.unit}), {limits}"


def _output(o: Output) -> str:
    limit = "" if o.limit is None else f", limit {o.limit:g} degC"
    error = "" if o.error_K is None else f", against measurements {o.error_K:.2f} K rms ({o.role} tests)"
    return f"{o.name}{limit}{error}"


def state_bytes(model: Model) -> int:
    """Of thermal_state: what has to live from step to step."""
    return REAL * (len(model.states) + len(model.signals) + 2)


def step_operations(model: Model) -> int:
    """Multiplications of one step: an LU, four solves, three right-hand sides."""
    n = len(model.states)
    return n**3 // 3 + 7 * n * (n + len(model.boundaries)) + 6 * model.terms.at.size


def _cost(model: Model) -> Iterator[str]:
    yield f"State: {state_bytes(model)} bytes. One inner step: about {step_operations(model)} multiplications;"
    yield "a call takes one, more where inputs or temperatures turn fast (error of a step: "
    yield f"{model.tolerance[0]:g} K and {model.tolerance[1]:g} of the range of temperatures)."


POWERED, STRAIGHT, POSITIVE, TABULATED, MAPPED = range(5)


@dataclass(frozen=True)
class Flat:
    """Sums of products as flat arrays, for languages without objects.

    Products product_start[e]:product_start[e + 1] make up factor e, functions function_start[k]:... product k.

    function (nf, 8) : kind, input, other input, first of x, points along x1 and x2, first of y, whether of the size
    parameters (nf, 2) : (at, exponent), (offset, slope) or (way, 0);  x, y : of all tables
    """

    product_start: th.Ints
    coefficient: th.Array
    function_start: th.Ints
    function: th.Ints
    parameters: th.Array
    x: th.Array
    y: th.Array


def flat(factors: Sequence[Sum], signals: Sequence[str]) -> Flat:
    """All factors, with inputs by their place among the signals."""
    products = [p for total in factors for p in total]
    functions = [f for p in products for f in p.functions]
    xs = [_points(f)[0] for f in functions]
    ys = [_points(f)[1] for f in functions]
    at_x, at_y = th.starts(xs), th.starts(ys)
    table = [_integers(f, signals, at_x[i], at_y[i]) for i, f in enumerate(functions)]
    return Flat(
        th.starts(factors),
        np.array([p.coefficient for p in products]),
        th.starts([p.functions for p in products]),
        np.array(table, np.int64).reshape(-1, 8),
        np.array([_numbers(f) for f in functions], float).reshape(-1, 2),
        np.concatenate([np.empty(0), *xs]),
        np.concatenate([np.empty(0), *ys]),
    )


def _points(f: Function) -> tuple[tuple[float, ...], tuple[float, ...]]:
    if isinstance(f, Powered | Straight | Positive):
        return (), ()
    return ((*f.x1, *f.x2) if isinstance(f, Mapped) else f.x), f.y


def _integers(f: Function, signals: Sequence[str], x: int, y: int) -> list[int]:
    of = signals.index(f.input)
    if isinstance(f, Mapped):
        return [MAPPED, of, signals.index(f.other), x, len(f.x1), len(f.x2), y, f.size]
    if isinstance(f, Powered | Straight | Positive):
        kind = POWERED if isinstance(f, Powered) else STRAIGHT if isinstance(f, Straight) else POSITIVE
        return [kind, of, 0, 0, 0, 0, 0, 0]
    return [TABULATED, of, 0, x, len(f.x), 0, y, f.size]


def _numbers(f: Function) -> tuple[float, float]:
    if isinstance(f, Powered):
        return f.at, f.exponent
    if isinstance(f, Straight):
        return f.offset, f.slope
    return (f.way, 0.0) if isinstance(f, Positive) else (0.0, 0.0)
