"""What the inputs of a case measure, and which of several currents or speeds is the machine's own."""

from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np

from lumped.model.network import Network
from lumped.model.quantities import INPUTS
from measured.case import Reference, Test
from measured.recordings.sheet import Sheet


def with_quantities(
    network: Network, sheets: Iterable[Sheet], tests: Sequence[Test], reference: Reference | None = None
) -> Network:
    """The network with what its sheets say of the inputs; what network.toml says of them stands.

    reference : what the model said when it was fitted goes before what the tests say now
    """
    by_name: dict[str, str] = {}
    for sheet in sheets:
        columns = {c.name: c.quantity for c in sheet.columns}
        by_name |= {c.feeds: c.quantity for c in sheet.columns if c.feeds}
        by_name |= {name: columns[of[0]] for name, of in sheet.squares.items() if of}
    signals_then = reference.signals if reference else {}
    by_name |= {name: one.quantity for name, one in signals_then.items() if one.quantity}
    network = replace(network, quantities={**by_name, **network.quantities})
    training = [t for t in tests if t.role != "hold-out"] or list(tests)
    signals = {q: name for q in INPUTS if (name := _largest_of(network, training, q)) is not None}
    signals |= {one.quantity: name for name, one in signals_then.items() if one.machine}
    return replace(network, signals=signals)


def _largest_of(network: Network, tests: Sequence[Test], quantity: str) -> str | None:
    """Of the inputs of a quantity those that a loss follows, else all; of these the largest by root mean square.

    The machine's current is never smaller than its components, and a film may follow the speed of another fan.
    """
    names = [n for t in tests for n in t.inputs if network.measures(n) == quantity]
    lossy = {name for source in network.sources for name in source.law.reads}
    level = {n: _level(tests, n) for n in names if n in lossy} or {n: _level(tests, n) for n in names}
    return max(level, key=lambda n: level[n]) if level else None


def _level(tests: Sequence[Test], name: str) -> float:
    record = np.concatenate([np.atleast_1d(t.inputs[name]) for t in tests if name in t.inputs])
    return float(np.sqrt(np.nanmean(np.square(record))))
