"""thermoscope bench protocol [RECORD.toml]"""

from __future__ import annotations

from typing import Any

from extras.bench.measuring.protocol import Protocol
from thermoscope import plugin as th


def protocol_summary(result: Protocol) -> th.Summary:
    """What to do next; the temperatures with their three uncertainties; then all steps."""
    spreads = [(n, s) for n, s in (("winding", result.winding), ("magnets", result.magnets)) if s is not None]
    headers = ["rise", "K", "worst case", "GUM 95 %", "Monte Carlo 95 %", "largest share"]
    rises = th.Table(
        "Rises over the cold temperature", headers, [_row(n, s) for n, s in spreads], keep=["K", "GUM 95 %"]
    )
    ways = "way=method | at (s)=at_s | degC=value | 1 sigma (K)=sd | how=words"
    off = th.Table.of("Winding when switched off", result.ways, ways)
    steps = th.Table.of("Thermal test", result.steps, "step=name | *state | *when | *what | found=words", ["refused"])
    return th.Summary(_in_short(result), [rises, off, steps], "--json FILE; docs/how-to/thermal-test.md")


def _in_short(result: Protocol) -> str:
    if result.refused:
        return f"{len(result.refused)} steps are refused: no temperature is given."
    rises = [
        f"{n} {s.value:.1f} K" for n, s in (("winding", result.winding), ("magnets", result.magnets)) if s is not None
    ]
    return f"Rises: {', '.join(rises)}." if rises else f"A thermal test has {len(result.steps)} steps."


def _row(name: str, s: th.PropagatedUncertainty) -> list[Any]:
    largest = max(s.budget, key=lambda n: s.budget[n])
    pairs = (s.worst, s.first_order, s.interval)
    return [name, s.value, *(f"{a:.1f} ... {b:.1f}" for a, b in pairs), f"{largest} ({s.budget[largest]:.1f} K)"]
