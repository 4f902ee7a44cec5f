"""A first network from readings alone: which links and losses they need, and how large these are.

The free network fits each sensor for itself, per its own heat capacity. Here the same terms are held together by what
a network is: heat that leaves one node arrives at the other, and each node has one capacity,

    C_n (T_n(t + h) - T_n(t)) = sum_jg G_njg int (T_j - T_n) x_g dt + sum_k P_nk int y_k dt,

all of them at least 0, and G_njg = G_jng. With the capacities known this is one non-negative least squares; with all
else known each capacity is one, too, so the two are solved in turn. Rises alone tell nothing of how large all of it is
together: one number, the mean heat, is given.
"""

from __future__ import annotations

from collections.abc import Callable, Container, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from geom.arrays import Array, Mask
from geom.one_thread import one_blas_thread
from lumped.model.quantities import FLOWS
from lumped.model.topology import reached
from measured.case import Case
from measured.importing.starter import FirstNetwork, FirstTerm
from validation.yardstick import free_network
from validation.yardstick.records import Columns, Folds
from validation.yardstick.yardstick import best_free_network, error_of, folds_of, rms

ELECTRICAL = ("current", "torque", "power", "voltage", "frequency", "share")  # no film follows what these measure
UNDRIVEN = 0.6  # price of heat that follows no input: above that of a square, so that a constant current heats
TRIALS = 2  # terms of each node at a time: those that the increments ask for most
BETTER, WORSE = 0.97, 1.02  # times the error left out: what a term must buy, and what may be lost without it
FEW_NODES = 4  # with more of them only the second way is gone: trying terms one by one would take minutes
MANY = 0.9  # times the error of the simpler network: what a network of more terms must come to
MAIN = 0.3  # of what moves a node: such a term is tried last, whatever it follows
TURNS, STILL = 12, 3e-3  # of capacities and coefficients, and the relative change that ends them
SPREAD = (0.2, 1.0)  # prior of a number, in powers of e: the folds share most of their tests; a first network's own
FEWEST_FOLDS, OUTLYING = 3, 3.0  # of two nobody knows which is right; three times the usual misfit counts in full
ODD = 2.5  # times the others' error is that of a test in which something else held
ODD_GAIN = 0.8  # times their error with it is what the others come to without
ODD_COUNTS = 0.1  # of a test: what counts less teaches nothing
ROUNDS = 3  # of such weights: a bad test is in the fits by which the good ones are judged
LEAST_K = 0.01  # an error below it is as good as none: readings are rounded to more
SLOW = 3.0  # records long is the time constant given to what the readings tie to nothing


@one_blas_thread
def learn_network(case: Case, first: FirstNetwork) -> FirstNetwork:
    """The network that the tests a fit may use ask for; `first` itself where they are too short to ask for any.

    case : its nodes, one for each sensor's place, and its tests;  first : says how much heat there is altogether
    """
    case = replace(case, tests=case.usable)  # a held-out test that lacks an input must not take it from the others
    prepared = folds_of(case)
    if prepared is None:
        return first
    folds, columns = prepared
    form = best_free_network(folds, columns)
    places = {c.name: c.place for t in case.tests for c in t.channels}
    every_test = _TermTable.of(folds, columns, form, places, case.model.network.measures)
    heat = np.mean([free_network.loss_factors(r.u).mean(axis=0) for fold in folds for r in fold], axis=0)
    every = range(len(folds))
    needed, table, left_out = _least_terms(every_test.credible(), folds)
    while (fewer := _without_odd(table, folds, left_out)) is not None:
        needed, table, left_out = fewer
    fits = [table.fit(every, needed), *(table.fit([j for j in every if j != i], needed) for i in every)]
    warm = [(theta, C, watts) for theta, C in fits if (watts := table.mean_heat(theta, heat)) > 0.0]
    if len(warm) < 2 or warm[0][0] is not fits[0][0]:
        return first  # nothing heats it: there is no size to give to anything
    (theta, C), *parts = [(s * theta, s * C) for theta, C, watts in warm for s in [first.watts / watts]]
    scale = dict(zip(columns.inputs, map(float, columns.scale), strict=True))
    follows = [tuple((f.input, scale[f.input], f.exponent) for f in of) for _, of in table.candidates]
    spreads = [_spread(values) for values in zip(*(part for part, _ in parts), strict=True)]
    candidates = zip(table.candidates, theta, follows, spreads, strict=True)
    terms = [FirstTerm(ends, float(size), of, spread) for (ends, _), size, of, spread in candidates if size > 0.0]
    sizes = {node: (float(C[n]), _spread([part[n] for _, part in parts])) for n, node in enumerate(table.nodes)}
    capacities = {**first.capacities, **sizes}  # also of what no thermometer can have shown, such as tenths of a degree
    length = max(r.time[-1] - r.time[0] for fold in folds for r in fold)
    alone = [node for node in capacities if not _reaches(node, terms, first.boundaries)]
    terms += [FirstTerm((node, first.boundaries[0]), capacities[node][0] / (SLOW * length)) for node in alone]
    taught = {r.name for fold, counts in zip(folds, table.credit, strict=True) for r in fold if counts >= ODD_COUNTS}
    learnt = [t.name for t in case.usable if t.name in taught]
    return replace(first, capacities=capacities, terms=terms, learnt=learnt)


def _least_terms(tables: Sequence[_TermTable], folds: Folds) -> tuple[Mask, _TermTable, Array]:
    """The terms that predict best, the table that they come from, and the error of each fold left out (K).

    tables : all are judged by what the last one says that each fold counts
    """
    credit = tables[-1].credit
    ways = [[(*way, table) for way in _needed_terms(table, folds, credit)] for table in tables]
    few, many = (min(alike, key=lambda way: way[0]) for alike in zip(*ways, strict=True))
    _, needed, table = many if many[0] < MANY * few[0] else few
    each = _errors_left_out(table, folds, needed)
    return needed, replace(table, credit=credit), np.array([np.exp(np.mean(np.log(e))) for e in each])


def _without_odd(table: _TermTable, folds: Folds, left_out: Array) -> tuple[Mask, _TermTable, Array] | None:
    """The same learnt without the fold that is predicted worst, if something else held there: the others predict each
    other much better without it, and it far worse than each other. None if not, and where too few others are left.

    left_out : (n_fold,) error (K) of each
    """
    members = np.flatnonzero(table.credit > 0.0)
    if members.size <= FEWEST_FOLDS:
        return None
    worst = members[np.argmax(left_out[members])]
    others, alone = members[members != worst], np.arange(len(folds)) == worst
    weights = np.where(alone, 0.0, np.ones((len(table.nodes), 1)))
    needed, candidate, errors = _least_terms([table.weighted(weights, np.where(alone, 0.0, table.credit))], folds)
    now, before = (np.exp(np.mean(np.log(e[others]))) for e in (errors, left_out))
    return (needed, candidate, errors) if now < ODD_GAIN * before and errors[worst] > ODD * now else None


def _errors_left_out(table: _TermTable, folds: Folds, active: Mask) -> list[list[float]]:
    """Of each record of each fold (K), predicted from the others."""
    every = range(len(folds))
    models = [table.free(*table.fit([j for j in every if j != i], active)) for i in every]
    return [[max(rms([error_of(m, r)]), LEAST_K) for r in fold] for m, fold in zip(models, folds, strict=True)]


def _needed_terms(table: _TermTable, folds: Folds, credit: Array) -> tuple[tuple[float, Mask], tuple[float, Mask]]:
    """The few terms (n_term,) with which what was left out is predicted best and their error (K), found in two ways.

    One way there begins with constant links between all nodes and takes in, one by one, the loss or the input that a
    link follows which helps most: the increments say which to try, what is left out decides. The other way begins with
    all that the increments want. On both, each term that is not missed then goes. The first is simpler. Tests count by
    how many times better each is predicted: one in which something else held, such as half the air, is predicted badly
    by every network and must not choose between them.

    credit : (n_fold,) how much each test counts
    """
    every = range(len(folds))
    counts = np.concatenate([[c] * len(fold) for c, fold in zip(credit, folds, strict=True)])

    def left_out(active: Mask) -> float:
        return float(np.exp(np.average(np.log(np.concatenate(_errors_left_out(table, folds, active))), weights=counts)))

    def grown() -> tuple[float, Mask]:
        needed = np.array([len(ends) == 2 and not of for ends, of in table.candidates])
        least = left_out(needed)
        while trials := [_with(needed, k) for k in table.steepest_terms(every, needed)]:
            errors = [left_out(trial) for trial in trials]
            if min(errors) > BETTER * least:
                break
            close = [k for k, error in enumerate(errors) if BETTER * error <= min(errors)]
            best = min(close, key=lambda k: (float(table.price[trials[k] & ~needed][0]), errors[k]))  # the simplest
            needed, least = trials[best], errors[best]
        return pruned(needed, least)

    def pruned(needed: Mask, least: float) -> tuple[float, Mask]:
        shares, last = table.shares(every, *table.fit(every, needed)), least
        order = sorted(np.flatnonzero(needed), key=lambda k: (-table.price[k] * (shares[k] < MAIN), shares[k]))
        count = max(len(order) // 2, 1)
        while count:  # many at a time, then each half of those that are missed together
            for some in [order[i : i + count] for i in range(0, len(order), count)]:
                without = needed.copy()
                without[some] = False
                if (error := left_out(without)) <= WORSE * least:
                    needed, last, least = without, error, min(error, least)
                    order = [k for k in order if k not in some]
            count = 0 if count == 1 else -(-count // 2)
        return last, needed

    whole = table.fit(every, np.ones(len(table.candidates), bool))[0] > 0.0
    many = pruned(whole, left_out(whole))
    return (many if len(table.nodes) > FEW_NODES else grown()), many


def _with(selection: Mask, k: int) -> Mask:
    """The selection and one term more."""
    out = selection.copy()
    out[k] = True
    return out


def _spread(values: Sequence[float]) -> float:
    """Standard deviation of the logarithm over the fits with one test left out, within SPREAD."""
    logs = np.log(np.maximum(values, 1e-300))
    return float(np.clip(np.std(logs) * np.sqrt(max(len(logs) - 1, 1)), *SPREAD))  # jackknife


def _reaches(node: str, terms: Sequence[FirstTerm], boundaries: Sequence[str]) -> bool:
    """Does heat find a way from a node to a boundary?"""
    links = [set(term.ends) for term in terms if len(term.ends) == 2]
    there = reached([node], lambda here: () if here in boundaries else set().union(*(x for x in links if here in x)))
    return not set(boundaries).isdisjoint(there)


@dataclass(frozen=True)
class _TermTable:
    """All terms that may be in the network, and where each stands in the tables of a node.

    candidates : (ends, what it follows);  rows[n] : (term, column) of node n's table;  normal : of each fold and node
    weight : (n_node,) of a node's residual (1/K2): one over what its own free fit leaves
    sensors : of every sensor the number of its node;  bodies : (n_body,) where the others stand among all bodies
    shape : numbers of all bodies, of what a link may follow, and of losses
    credit : (n_fold,) how much each fold counts in what is predicted: 1, or its least weight of any node
    """

    nodes: tuple[str, ...]
    candidates: list[tuple[tuple[str, ...], free_network.Powers]]
    rows: list[tuple[NDArray[np.intp], NDArray[np.intp]]]
    normal: list[list[Array]]
    weight: Array
    sensors: tuple[int, ...]
    bodies: NDArray[np.intp]
    shape: tuple[int, int, int]
    form: free_network.Form
    credit: Array

    @staticmethod
    def of(
        folds: Folds,
        columns: Columns,
        form: free_network.Form,
        places: Mapping[str, str],
        measures: Callable[[str], str],
    ) -> _TermTable:
        lessons = free_network.NetworkLessons.of(folds, columns, form)
        first = {places[s]: i for i, s in reversed(list(enumerate(columns.sensors)))}  # a node is its first sensor
        nodes = [s for i, s in enumerate(columns.sensors) if first[places[s]] == i]
        links, losses = free_network.link_powers(columns.inputs, form.shapes), free_network.loss_powers(columns.inputs)
        stirs = [may_stir([measures(f.input) for f in of]) for of in links]
        quantities = {measures(name) for name in columns.inputs}
        heats = [may_heat([measures(f.input) for f in of], quantities) for of in losses]
        bodies = [s for s, steady in zip(columns.sensors, columns.steady, strict=True) if steady]
        bodies += columns.boundaries
        number: dict[tuple[tuple[str, ...], free_network.Powers], int] = {}
        rows = []
        for sensor in nodes:
            node = places[sensor]
            keys = [(_ends(node, places.get(body, body)), of) for body in bodies for of in links]
            others = [body in columns.boundaries or (body in nodes and body != sensor) for body in bodies]
            active = [join and stir for join in others for stir in stirs]
            keys += [((node,), of) for of in losses]
            active += heats
            selection = np.flatnonzero(active)
            rows.append((np.array([number.setdefault(keys[c], len(number)) for c in selection], int), selection))
        index = [columns.sensors.index(s) for s in nodes]
        normal = [[fold[i] for i in index] for fold in lessons.normal]
        weight = _weights(normal)
        names = tuple(places[s] for s in nodes)
        where = np.append(np.flatnonzero(columns.steady), len(columns.sensors) + np.arange(len(columns.boundaries)))
        shape = (len(columns.sensors) + len(columns.boundaries), len(links), len(losses))
        owner = tuple(names.index(places[s]) for s in columns.sensors)
        return _TermTable(names, list(number), rows, normal, weight, owner, where, shape, form, np.ones(len(folds)))

    def credible(self) -> list[_TermTable]:
        """This one; and one in which readings that the other tests' fit explains far worse than is usual count less,
        where there are such: a sensor that slipped off in one test says nothing of the network."""
        if len(self.normal) < FEWEST_FOLDS:
            return [self]
        weights = np.array([_weights_of_folds(each, -1 - self.shape[2]) for each in zip(*self.normal, strict=True)])
        if (weights == 1.0).all():
            return [self]
        credit = weights.min(axis=0)
        if credit.sum() < FEWEST_FOLDS - 1:  # what most tests do is the rule
            credit = self.credit
        return [self, self.weighted(weights, credit)]

    def weighted(self, weights: Array, credit: Array) -> _TermTable:
        """The same with its lessons counted less.  weights : (n_node, n_fold)"""
        normal = [
            [w * N for w, N in zip(ws, fold, strict=True)] for ws, fold in zip(weights.T, self.normal, strict=True)
        ]
        return replace(self, normal=normal, weight=_weights(normal), credit=credit)

    def fit(self, lessons: Sequence[int], active: Mask) -> tuple[Array, Array]:
        """Coefficients of all terms and capacities of the nodes, whose geometric mean is 1.  active : may be > 0"""
        place = np.cumsum(active) - 1  # of an active term among these
        parts = []
        for n, (term, column) in enumerate(self.rows):
            N, some = self._table(n, lessons), active[term]
            parts.append((N[np.ix_(column[some], column[some])], N[column[some], -1], place[term[some]]))
        C, a = np.ones(len(self.nodes)), np.zeros(int(active.sum()))
        for _ in range(TURNS):
            AA, Ab = np.zeros((a.size, a.size)), np.zeros(a.size)
            for (N, b, term), w, c in zip(parts, self.weight, C, strict=True):
                AA[np.ix_(term, term)] += N * (w / c**2)
                Ab[term] += b * (w / c)
            a = free_network.nonnegative(AA, Ab, a)
            new = np.array([_capacity(N, b, a[term], c) for (N, b, term), c in zip(parts, C, strict=True)])
            new /= np.exp(np.mean(np.log(new)))
            if np.allclose(new, C, rtol=STILL):
                break
            C = new
        theta = np.zeros(len(self.candidates))
        theta[active] = a
        return theta, C

    def _table(self, node: int, lessons: Sequence[int]) -> Array:
        return np.sum([self.normal[i][node] for i in lessons], axis=0)

    def steepest_terms(self, lessons: Sequence[int], active: Mask) -> list[int]:
        """Of each node the terms outside `active` that would explain most of what is left of its rises, by price."""
        theta, C = self.fit(lessons, active)
        out: dict[int, None] = {}
        for n, ((term, column), c) in enumerate(zip(self.rows, C, strict=True)):
            N = self._table(n, lessons)
            table = N[np.ix_(column, column)]
            left = N[column, -1] - table @ (theta[term] / c)
            gain = np.maximum(left, 0.0) / np.sqrt(np.maximum(np.diag(table), 1e-300)) / self.price[term]
            gain[active[term]] = 0.0
            out |= dict.fromkeys(int(term[i]) for i in np.argsort(-gain, kind="stable")[:TRIALS] if gain[i] > 0.0)
        return list(out)

    @property
    def price(self) -> Array:
        """(n_term,): what follows one input is likelier than what follows two, or a square, or heat of nothing."""
        heat = np.array([len(ends) == 1 and not of for ends, of in self.candidates])
        return np.array([1.0 + 0.25 * sum(f.exponent for f in of) for _, of in self.candidates]) + UNDRIVEN * heat

    def shares(self, lessons: Sequence[int], theta: Array, C: Array) -> Array:
        """(n_term,): of what moves a node, root mean squares; of a link's two nodes the larger."""
        out = np.zeros(theta.size)
        for n, (term, column) in enumerate(self.rows):
            N = self._table(n, lessons)
            size = theta[term] * np.sqrt(np.maximum(np.diag(N)[column], 0.0))
            np.maximum.at(out, term, size / max(float(size.sum()), 1e-300))
        return out

    def free(self, theta: Array, C: Array) -> free_network.FreeNetwork:
        """The same network node by node, per capacity."""
        bodies, factors, k = self.shape
        links, sources = np.zeros((len(self.sensors), bodies, factors)), np.zeros((len(self.sensors), k))
        for n, sensor in enumerate(self.sensors):
            row = self._row(sensor, theta) / C[sensor]
            links[n, self.bodies], sources[n] = row[:-k].reshape(-1, factors), row[-k:]
        return free_network.FreeNetwork(self.form, links, sources)

    def mean_heat(self, theta: Array, heat: Array) -> float:
        """All losses together.  heat : (n_loss,) mean of each loss's factor"""
        return float(sum(self._row(n, theta)[-len(heat) :] @ heat for n in range(len(self.nodes))))

    def _row(self, node: int, theta: Array) -> Array:
        """Coefficients as the columns of a node's table have them."""
        term, column = self.rows[node]
        row = np.zeros(self.normal[0][node].shape[0] - 1)
        row[column] = theta[term]
        return row


def may_stir(quantities: Sequence[str]) -> bool:
    """May a film follow these?"""
    return not set(quantities) & set(ELECTRICAL)


def may_heat(quantities: Sequence[str], beside: Container[str] = ()) -> bool:
    """May a loss follow these together?  Two currents do not, a current and a speed, or a voltage, do.

    beside : all that was recorded; beside a current a voltage alone heats nothing
    """
    electrical = [q for q in quantities if q in ELECTRICAL]
    if electrical == ["voltage"] and "current" in beside:
        return False
    return not set(quantities) & set(FLOWS) and (len(electrical) < 2 or set(electrical) == {"current", "voltage"})


def _ends(node: str, other: str) -> tuple[str, ...]:
    return (node, other) if node <= other else (other, node)


def _capacity(N: Array, b: Array, a: Array, before: float) -> float:
    """The capacity with which a node's heat explains most of its rises."""
    explained = float(a @ b)
    return float(a @ N @ a) / explained if explained > 0.0 else before


def _weights_of_folds(each: Sequence[Array], constant: int) -> Array:
    """(n_fold,) of one node's tables: below 1 where the others' fit explains them far worse than is usual.

    constant : column of constant heat, which counts the windows
    """
    weights, windows = np.ones(len(each)), np.array([N[constant, constant] for N in each])
    for _ in range(ROUNDS if windows.any() else 0):
        some = [w * N for w, N in zip(weights, each, strict=True)]
        left = np.array([_misfit(N, sum(some, -M)) for N, M in zip(each, some)]) / np.where(windows > 0.0, windows, 1.0)
        usual = float(np.median(left[windows > 0.0]))  # not of tests in which the node was not read
        weights = np.maximum(1.0, left / max(OUTLYING**2 * usual, 1e-300)) ** -2.0
    return weights


def _weights(normal: Sequence[Sequence[Array]]) -> Array:
    """(n_node,) 1/K2: one over what each node's own free fit leaves."""
    whole = [np.sum(each, axis=0) for each in zip(*normal, strict=True)]
    return np.array([1.0 / max(_misfit(N, N), 1e-12) for N in whole])


def _misfit(N: Array, others: Array) -> float:
    """Sum of squares (K2) that a free fit to some windows leaves of others, or of the same."""
    a = free_network.nonnegative(others[:-1, :-1], others[:-1, -1])
    return float(N[-1, -1] - 2.0 * a @ N[:-1, -1] + a @ N[:-1, :-1] @ a)
