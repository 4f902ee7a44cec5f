"""What a free network needs: which links carry heat, which inputs they follow, which inputs heat."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from geom.arrays import Array
from geom.table import TableRow
from measured.case import Case
from validation.yardstick import free_network
from validation.yardstick.records import Columns, Folds, Record

SHARE = 0.05  # of all that warms and cools a sensor: what carries less is not worth a name


@dataclass(frozen=True)
class Term(TableRow):
    """A link or loss that the free network has in every fit, whichever test is left out.

    place : of the sensor it warms;  kind : "link" | "loss";  other : sensor or boundary at a link's other end
    input : the input or product of inputs that it follows, "" where it is constant
    value, low, high : at the largest input, of all tests and over the fits with one left out
    unit : W/K, W; per capacity (1/s, K/s) where the sensor's heat capacity is not known
    share : of all heat that the sensor exchanges
    """

    place: str
    kind: str
    other: str
    input: str
    value: float
    low: float
    high: float
    unit: str
    share: float


def needed_terms(
    fit: Callable[[Sequence[int]], object], folds: Folds, columns: Columns, case: Case
) -> tuple[Term, ...]:
    """The terms of a free network that no choice of tests does without, those that carry most first."""
    every = range(len(folds))
    whole = fit(every)
    parts = [fit([j for j in every if j != i]) for i in every]
    assert isinstance(whole, free_network.FreeNetwork)
    share = _shares(whole, [r for fold in folds for r in fold])
    names, places = _term_names(whole, columns), {c.name: c.place for t in case.tests for c in t.channels}
    values, others = _vector(whole), np.array([_vector(p) for p in parts])  # type: ignore[arg-type]
    out = []
    for n, sensor in enumerate(columns.sensors):
        capacity = _capacity(case, sensor)
        for k in np.flatnonzero((share[n] > SHARE) & (others[:, n] > 0.0).all(axis=0)):
            kind, other, of = names[k]
            size = capacity or 1.0
            unit = {"link": "1/s", "loss": "K/s"}[kind] if capacity is None else {"link": "W/K", "loss": "W"}[kind]
            low, high = others[:, n, k].min() * size, others[:, n, k].max() * size
            what = (places[sensor], kind, places.get(other, other), of)
            out.append(Term(*what, float(values[n, k] * size), float(low), float(high), unit, float(share[n, k])))
    return tuple(sorted(out, key=lambda term: -term.share))


def _vector(network: free_network.FreeNetwork) -> Array:
    """(n_sensor, n_term): links body by body and factor by factor, then sources."""
    return np.hstack([network.links.reshape(len(network.links), -1), network.sources])


def _term_names(network: free_network.FreeNetwork, columns: Columns) -> list[tuple[str, str, str]]:
    """Kind, other end and input of every term, as `_vector` orders them."""
    powers = [free_network.power_words(of) for of in free_network.link_powers(columns.inputs, network.form.shapes)]
    links = [("link", body, of) for body in (*columns.sensors, *columns.boundaries) for of in powers]
    return [*links, *(("loss", "", free_network.power_words(of)) for of in free_network.loss_powers(columns.inputs))]


def _shares(network: free_network.FreeNetwork, records: Sequence[Record]) -> Array:
    """(n_sensor, n_term): mean size of what each term carries, over the sum of a sensor's."""
    size = np.zeros_like(_vector(network))
    for record in records:
        x, y = free_network.link_factors(record.u, network.form.shapes), free_network.loss_factors(record.u)
        bodies = np.hstack([record.T, record.boundary])
        for n in range(len(size)):
            flow = np.abs(bodies - record.T[:, [n]])[:, :, None] * x[:, None, :]
            size[n] += np.hstack([flow.reshape(len(x), -1), y]).sum(axis=0)
    size *= _vector(network)
    return size / np.maximum(size.sum(axis=1, keepdims=True), 1e-300)


def _capacity(case: Case, sensor: str) -> float | None:
    """Heat capacity (J/K) of the node that a sensor reads; None where it reads several states, or a boundary."""
    row = next(c.row for t in case.tests for c in t.channels if c.name == sensor)
    C = case.model.network.C
    read = row.index[row.weights != 0.0]
    return float(C[read[0]]) if read.size == 1 and read[0] < C.size and C[read[0]] > 0.0 else None
