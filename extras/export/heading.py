"""What stands at the top of everything that is exported."""

from __future__ import annotations

from collections.abc import Iterator

from extras.export.model import Model, Output, Signal

REAL = 8  # bytes


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
