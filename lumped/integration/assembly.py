"""All links and sources of a network as the kernel follows them: flat arrays, made once for each set of live terms."""

from collections import deque
from collections.abc import Hashable, Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray

from geom.arrays import Array, Ints, Mask
from lumped.model.network import NOTHING, Link, Network, Row, Source
from lumped.numerics.dense import Structure, least_fill
from lumped.numerics.terms import CONSTANT, FILM, INVERSE, LINEAR, POWER, RADIATION, STREAM, TABLE, Terms
from lumped.transfer import laws


@dataclass(frozen=True)
class Pattern:
    """A link or source over z+ = [x; u; 1], without multiplier and input factor; row: its distinct rows, `to` which of
    them an entry stands in; touches: whether any entry stands in a state's column."""

    name: str
    cols: Ints
    vals: Array
    row: Ints
    to: Ints
    law: laws.Law
    hot: Row
    cold: Row
    touches: bool

    @property
    def bends(self) -> bool:
        return not isinstance(self.law.temperature, laws.Constant)

    @cached_property
    def monotone(self) -> bool:
        """Whether at a positive coefficient it only draws its nodes towards others: their maximum principle. The error
        of an exponent does not, which takes from a film as it adds to it."""
        if np.min(getattr(self.law.temperature, "value", 0.0)) < 0.0:
            return False
        P = np.zeros((self.row.size, int(self.cols.max(initial=0)) + 1))
        np.add.at(P, (self.to, self.cols), self.vals)
        diagonal = (np.arange(self.row.size), self.row)
        small = 1e-9 * float(np.abs(self.vals).max(initial=0.0))
        if np.any(self.row >= P.shape[1]) or np.any(np.abs(P.sum(axis=1)) > small):
            return False
        P[diagonal] = np.minimum(P[diagonal], 0.0)
        return bool(np.all(small >= P))

    @property
    def heats(self) -> bool:
        return not self.touches

    @property
    def stiff(self) -> bool:
        return self.bends or self.touches


class Assembly:
    """The patterns of all links, then of all sources."""

    def __init__(self, links: Sequence[Link], sources: Sequence[Source], n: int, size: int) -> None:
        self.patterns = (*(_link(x, n) for x in links), *(_source(x, size) for x in sources))
        self.names = tuple(p.name for p in self.patterns)
        self.bends = np.array([p.bends for p in self.patterns], bool)
        self._shape = n, size + 1
        self._owner = np.repeat(np.arange(len(self.patterns)), [p.cols.size for p in self.patterns])
        self._flat = ints(p.row[p.to] * (size + 1) + p.cols for p in self.patterns)
        self._vals = floats(p.vals for p in self.patterns)
        self._packed: dict[bytes, Terms] = {}
        self._sizes: dict[bytes, tuple[InputSize, ...]] = {}
        self._eliminated: dict[bytes, tuple[Ints, Structure]] = {}

    def matrix(self, coefficient: Array) -> Array:
        """(n, size + 1): the sum of all patterns, each by its coefficient (ne,); zeros change nothing, to the bit."""
        n, width = self._shape
        return np.asarray(np.bincount(self._flat, coefficient[self._owner] * self._vals, n * width), float).reshape(
            n, width
        )

    def elimination(self, acting: Mask) -> tuple[Ints, Structure]:
        """(n,) the order in which the fewest zeros fill in, and what does.

        acting (ne,) : terms whose multiplier is not zero; the others change no sum, not by the order of adding either.
        """
        key = acting.tobytes()
        if key not in self._eliminated:
            touches = self._touched(p for p, acts in zip(self.patterns, acting, strict=True) if acts)
            self._eliminated[key] = _ordered(np.packbits(touches).tobytes(), len(touches))
        return self._eliminated[key]

    def _touched(self, patterns: Iterable[Pattern]) -> Mask:
        """(n, n) where a matrix of these may have entries."""
        touches = np.zeros(self._shape, bool)
        for p in patterns:
            touches[np.ix_(p.row, p.cols)] = True
            for side in (p.hot, p.cold) if p.bends else ():
                touches[np.ix_(p.row, side.index)] = True
        return touches[:, : self._shape[0]]

    def packed(self, live: Mask, steady: Mask) -> Terms:
        """The live terms without multipliers and factors; a steady one stands in the constant matrix (dynamic 0)."""
        key = live.tobytes() + steady.tobytes()
        if key not in self._packed:
            patterns = [p for p, alive in zip(self.patterns, live, strict=True) if alive]
            self._packed[key] = _pack(patterns, steady[live])
        return self._packed[key]

    def input_sizes(self, live: Mask) -> "tuple[InputSize, ...]":
        """What the temperature laws of the live terms see of inputs."""
        key = live.tobytes()
        if key not in self._sizes:
            self._sizes[key] = input_sizes([p for p, alive in zip(self.patterns, live, strict=True) if alive])[0]
        return self._sizes[key]


@lru_cache(maxsize=64)
def _ordered(bits: bytes, n: int) -> tuple[Ints, Structure]:
    """By where entries may be, packed: most effects sit where something couples already, and 240 states take 40 ms."""
    return least_fill(np.unpackbits(np.frombuffer(bits, np.uint8), count=n * n).reshape(n, n).astype(bool))


_LAST: deque[tuple[tuple[Link, ...], tuple[Source, ...], tuple[int, int], Assembly]] = deque(maxlen=32)


def assembly(network: Network) -> Assembly:
    """Of the network's links and sources; networks that differ in parameters alone share one."""
    shape = len(network.states), network.size
    for links, sources, size, pattern in tuple(_LAST):
        if links is network.links and sources is network.sources and size == shape:
            return pattern
    out = Assembly(network.links, network.sources, *shape)
    _LAST.append((network.links, network.sources, shape, out))
    return out


def _link(link: Link, n: int) -> Pattern:
    row, to = np.unique(link.rows, return_inverse=True)
    touches = bool(np.any(link.cols < n))
    return Pattern(link.name, link.cols, link.vals, row, to, link.law, link.hot, link.cold, touches)


def _source(source: Source, size: int) -> Pattern:
    row, to = np.unique(source.index, return_inverse=True)
    cols = np.full(len(source.index), size, np.int64)
    return Pattern(source.name, cols, -source.weights, row, to, source.law, source.probe, NOTHING, False)


def _code(law: laws.TemperatureLaw) -> tuple[int, float, float]:
    if isinstance(law, laws.Power):
        return POWER, law.exponent, 0.0
    if isinstance(law, laws.Radiation):
        return RADIATION, 0.0, 0.0
    if isinstance(law, laws.Linear):
        return LINEAR, law.alpha, law.reference
    if isinstance(law, laws.Conductivity):
        return INVERSE, law.alpha, law.reference
    if isinstance(law, laws.FilmTable):
        return FILM, float(len(law.difference)), 0.0
    if isinstance(law, laws.StreamTable):
        return STREAM, float(len(law.total)), -float(len(law.still.difference)) if law.still else law.stretch
    return (TABLE if isinstance(law, laws.Table) else CONSTANT), 0.0, 0.0


def _table(law: laws.TemperatureLaw) -> Array:
    points: list[tuple[float, ...]] = [(), ()]
    if isinstance(law, laws.Table):
        points = [law.difference, law.value]
    if isinstance(law, laws.FilmTable):
        points = [law.difference * laws.FILMS, law.value]
    if isinstance(law, laws.StreamTable):
        grid = (*law.number, *law.value)
        points = [(*law.total, *grid), (*law.shift, *grid)]
        if law.still:
            points = [(*a, *b, law.exponent) for a, b in zip(points, _table(law.still).T, strict=True)]
    return np.ascontiguousarray(np.array(points, float).T)


def starts(parts: Sequence[Sequence | NDArray]) -> Ints:
    return np.concatenate([[0], np.cumsum([len(p) for p in parts])]).astype(np.int64)


def floats(parts: Iterable[Sequence | NDArray]) -> Array:
    return np.concatenate([np.empty(0), *(np.asarray(p, float) for p in parts)])


def ints(parts: Iterable[Sequence | NDArray]) -> Ints:
    return np.concatenate([np.empty(0, np.int64), *(np.asarray(p, np.int64) for p in parts)])


@dataclass(frozen=True)
class InputSize:
    """An input as temperature laws see it: a column of its own after the factors of all terms."""

    name: str
    law: laws.Law


def input_sizes(patterns: Sequence[Pattern]) -> tuple[tuple[InputSize, ...], Ints]:
    """What temperature laws see of inputs; which column of all that is every pattern's, or 0."""
    columns: dict[tuple[str | None, float], int] = {}
    at = np.zeros(len(patterns), np.int64)
    for e, p in enumerate(patterns):
        if isinstance(law := p.law.temperature, laws.StreamTable):
            key = law.of, 0.0 if law.of else law.usual
            at[e] = len(patterns) + columns.setdefault(key, len(columns))
    out = (laws.InputPower(1.0, ((of, 1.0, 1.0),)) if of else laws.Fixed(usual) for of, usual in columns)
    return tuple(InputSize("what a stream's film follows", law) for law in out), at


def _pack(patterns: Sequence[Pattern], steady: Mask) -> Terms:
    temperatures = [p.law.temperature for p in patterns]  # some laws make theirs when asked: they must stay alive
    tables = {id(law): _table(law) for law in temperatures}
    first = dict(zip(tables, starts(list(tables.values())).tolist(), strict=False))
    spans = [(first[k], first[k] + len(tables[k])) for k in map(id, temperatures)]
    points = np.array(spans, np.int64).reshape(-1, 2)
    codes = [_code(p.law.temperature) for p in patterns]
    pattern_of = _numbered([(p.cols.tobytes(), p.vals.tobytes(), p.row.tobytes(), p.to.tobytes()) for p in patterns])
    distinct = [patterns[k] for k in np.unique(pattern_of, return_index=True)[1]]
    rows = starts([p.row for p in distinct])
    probes = [side if p.bends else NOTHING for p in patterns for side in (p.hot, p.cold)]
    probe_of = _numbered([(x.index.tobytes(), x.weights.tobytes()) for x in probes]).reshape(-1, 2)
    probed = [probes[k] for k in np.unique(probe_of, return_index=True)[1]]
    to = ints(first + p.to for first, p in zip(rows, distinct, strict=False))
    by_row = np.argsort(to, kind="stable")
    kind = [(c[0], not s, p.stiff, p.bends, p.heats) for c, p, s in zip(codes, patterns, steady, strict=True)]
    width = [*np.bincount(to, minlength=rows[-1]), *(x.index.size for x in probed)]
    return Terms(
        begin=np.concatenate([[0], np.cumsum(width)]).astype(np.int64),
        at=ints([ints(p.cols for p in distinct)[by_row], *(x.index for x in probed)]),
        weight=floats([floats(p.vals for p in distinct)[by_row], *(x.weights for x in probed)]),
        row=ints(p.row for p in distinct),
        part=np.column_stack(
            [pattern_of, rows[pattern_of], rows[pattern_of + 1], rows[-1] + probe_of, points, input_sizes(patterns)[1]]
        ),
        order=np.argsort(pattern_of, kind="stable"),
        kind=np.array(kind, np.int64).reshape(-1, 5),
        par=np.array([c[1:] for c in codes], float).reshape(-1, 2),
        point=np.concatenate([np.empty((0, 2)), *tables.values()]),
        m=np.empty(0),
    )


def _numbered(keys: Sequence[Hashable]) -> Ints:
    """Equal keys have equal numbers, in the order in which they appear."""
    numbers: dict[Hashable, int] = {}
    return np.array([numbers.setdefault(key, len(numbers)) for key in keys], np.int64)
