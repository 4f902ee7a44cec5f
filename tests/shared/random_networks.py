"""Random networks without end, and what they do by equations of their own: no line here comes from the tool's kernel.

A network is a set of plain arrays (Machine); `built` declares it to the tool, `reference` integrates it by Radau.
"""

from dataclasses import dataclass

import numpy as np
from numba import njit
from scipy.integrate import solve_ivp

from lumped.integration.simulate import Record
from lumped.model.build import bare_network, node_link, node_source, stream
from lumped.model.network import Network, Parameter
from lumped.sources.loss_laws import CopperLoss
from lumped.transfer.laws import Fixed, InputPower, Law, Power, Radiation

SMALLEST = 0.01  # K: |dT|^p is smoothed below, as the tool documents
AMBIENT, INLET, OUTLET = "ambient", "inlet", "outlet"
INPUTS = ("current_A", "speed_rpm", "flow_l_min")
RATE = 60.0  # W/K per l/min


@dataclass(frozen=True)
class Forward(Law):
    """Heat capacity rate of a flow (l/min) that goes the given way, none when it goes the other."""

    sign: float
    reads: tuple[str, ...] = ("flow_l_min",)

    def factor(self, inputs):
        return RATE * np.maximum(self.sign * inputs["flow_l_min"], 0.0)


@dataclass(frozen=True)
class Machine:
    """n nodes and the record that drives them.

    C (n,) J/K;  a, b, G : links, W/K;  forced, natural, radiating (n,) : onto the ambient, W/K at 1000 rpm, at 1 K, m2
    washed (n,) : W/K at 4 l/min of the node onto its cell, to the power 0.8;  cell (n,) : which node that is, or -1
    path : the cells of a stream;  copper, iron (n,) W at 10 A and 20 degC, at 1000 rpm
    time (nt,), inputs (nt, 3), around (nt, 3), start (n,)
    """

    C: np.ndarray
    a: np.ndarray
    b: np.ndarray
    G: np.ndarray
    forced: np.ndarray
    natural: np.ndarray
    radiating: np.ndarray
    washed: np.ndarray
    cell: np.ndarray
    path: np.ndarray
    copper: np.ndarray
    iron: np.ndarray
    time: np.ndarray
    inputs: np.ndarray
    around: np.ndarray
    start: np.ndarray


def machine(seed: int, most: int = 40) -> Machine:
    """3 to `most` nodes, capacities over six decades and none, cells of 0.1 J/K, samples of 1 to 60 s."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(3, most + 1))
    cells = int(rng.integers(0, min(n - 2, 8) + 1))
    C = 10.0 ** rng.uniform(-1.0, 5.0, n)
    path = np.arange(n - cells, n)
    solid = n - cells
    C[path] = rng.choice([0.1, 1.0, 18.0, 300.0, 0.0], cells, p=[0.4, 0.2, 0.2, 0.1, 0.1])
    bare = rng.random(solid) < 0.15
    bare[0] = False
    C[:solid][bare] = 0.0
    a, b = np.arange(1, solid), np.array([rng.integers(0, k) for k in range(1, solid)], np.int64)
    more = rng.integers(0, solid, (2, solid // 2))
    more = more[:, more[0] != more[1]]
    a, b = np.concatenate([a, more[0]]), np.concatenate([b, more[1]])
    G = 10.0 ** rng.uniform(-0.5, 1.7, a.size)
    some = rng.random((3, n)) < 0.3
    some[:, solid:] = False
    forced, natural, radiating = some * np.array([[5.0], [0.5], [0.05]]) * 10.0 ** rng.uniform(-0.7, 0.7, (3, n))
    forced[0] += 1.0
    natural[0] += 0.5
    cell, washed = np.full(n, -1), np.zeros(n)
    for k in range(cells):
        wall = int(rng.integers(0, solid))
        cell[wall], washed[wall] = path[k], 10.0 ** rng.uniform(0.0, 2.0)
    heated = rng.random((2, n)) < 0.4
    heated[:, solid:] = False
    copper, iron = heated * rng.uniform(0.2, 1.0, (2, n))
    time, inputs, around = _record(rng)
    start = rng.uniform(15.0, 60.0) + rng.uniform(0.0, 20.0, n)
    films = forced, natural, radiating, washed, cell
    out = Machine(C, a, b, G, *films, path, copper, iron, time, inputs, around, start)
    return _scaled(out, rng.uniform(5.0, 120.0))


def _record(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    nt = int(rng.integers(8, 25))
    step = 10.0 ** rng.uniform(0.0, np.log10(60.0))
    time = step * np.arange(nt)
    if rng.random() < 0.3:
        time = np.append(0.0, np.cumsum(rng.uniform(0.2, 1.8, nt - 1) * step))
    inputs = np.stack([_signal(rng, nt, *span) for span in ((0.0, 15.0), (0.0, 3000.0), (-8.0, 8.0))], axis=1)
    if rng.random() < 0.5:
        inputs[:, 2] = np.abs(inputs[:, 2])
    around = np.stack([_signal(rng, nt, low, low + rng.uniform(0.0, 20.0)) for low in rng.uniform(10, 40, 3)], axis=1)
    return time, inputs, around


def _signal(rng: np.random.Generator, nt: int, low: float, high: float) -> np.ndarray:
    """Constant, a few steps, a few ramps, or another value at every sample; off at times."""
    kind, levels = rng.integers(0, 4), rng.uniform(low, high, nt)
    if kind == 0:
        return np.full(nt, levels[0])
    corners = np.unique(np.concatenate([[0], rng.integers(0, nt, 3), [nt - 1]]))
    if kind == 1:
        out = levels[np.searchsorted(corners, np.arange(nt), side="right") - 1]
    elif kind == 2:
        out = np.interp(np.arange(nt), corners, levels[corners])
    else:
        out = levels
    return np.where(rng.random() < 0.4, np.where(np.arange(nt) < rng.integers(1, nt), 0.0, out), out)


def _scaled(m: Machine, rise: float) -> Machine:
    """Losses such that the largest rise at rest, still air and no flow, is `rise` (K): no runaway."""
    n = m.C.size
    K = np.diag(0.1 * m.forced + m.natural + 6.0 * m.radiating)
    for i, j, g in zip(m.a, m.b, m.G, strict=True):
        K[[i, j, i, j], [i, j, j, i]] += [g, g, -g, -g]
    for i in range(n):
        if m.cell[i] >= 0:
            K[i, i] += 1e-9
    K[m.path, m.path] += 1.0
    highest = np.linalg.solve(K, 2.25 * m.copper + 5.2 * m.iron).max()
    scale = rise / highest if highest > 0.0 else 0.0
    return Machine(**{**m.__dict__, "copper": scale * m.copper, "iron": scale * m.iron})


def built(m: Machine) -> tuple[Network, Record]:
    """The same, declared to the tool; every link and loss is a parameter."""
    names = [f"n{i}" for i in range(m.C.size)]
    net = bare_network("random", dict(zip(names, m.C, strict=True)), (AMBIENT, INLET, OUTLET))
    links = [
        node_link(net, f"g{k}", "link", names[i], names[j], Fixed(G))
        for k, (i, j, G) in enumerate(zip(m.a, m.b, m.G, strict=True))
    ]
    for i, name in enumerate(names):
        if m.forced[i]:
            law = InputPower(m.forced[i], (("speed_rpm", 1000.0, 0.8),))
            links += [
                node_link(net, f"f{i}", "film", name, AMBIENT, law),
                node_link(net, f"s{i}", "film", name, AMBIENT, Fixed(0.1 * m.forced[i])),
            ]
        if m.natural[i]:
            links.append(node_link(net, f"c{i}", "film", name, AMBIENT, Fixed(m.natural[i], Power(0.25))))
        if m.radiating[i]:
            links.append(node_link(net, f"r{i}", "film", name, AMBIENT, Fixed(m.radiating[i], Radiation())))
        if m.cell[i] >= 0:
            law = InputPower(m.washed[i], (("flow_l_min", 4.0, 0.8),))
            links += [
                node_link(net, f"w{i}", "film", name, names[m.cell[i]], law),
                node_link(net, f"v{i}", "film", name, names[m.cell[i]], Fixed(0.05 * m.washed[i])),
            ]
    if m.path.size:
        cells = [names[k] for k in m.path]
        links += [
            stream(net, "forth", (INLET, *cells), Forward(1.0)),
            stream(net, "back", (OUTLET, *cells[::-1]), Forward(-1.0)),
        ]
        links += [node_link(net, f"leak{k}", "film", cells[k], AMBIENT, Fixed(1.0)) for k in range(len(cells))]
    sources = [
        node_source(net, f"copper{i}", "copper", {names[i]: 1.0}, CopperLoss(P / 100.0, ("current_A",), 1.0, 0.0039))
        for i, P in enumerate(m.copper)
        if P
    ]
    iron = [
        node_source(net, f"iron{i}", "iron", {names[i]: 1.0}, InputPower(P, (("speed_rpm", 1000.0, 1.5),)))
        for i, P in enumerate(m.iron)
        if P
    ]
    given = dict(zip(INPUTS, m.inputs.T, strict=True))
    air = dict(zip((AMBIENT, INLET, OUTLET), m.around.T, strict=True))
    record = Record(m.time, given, air, dict(zip(names, m.start, strict=True)))
    parameters = tuple(Parameter(x.name, ((x.name, 1.0),)) for x in (*links, *sources, *iron))
    return net.extended(links, [*sources, *iron], parameters), record


@njit(cache=True)
def _heat(C, a, b, G, forced, natural, radiating, washed, cell, path, copper, iron, u, air, x, q, J):
    """q = heat into every node (W) and J = dq/dx at inputs u and surroundings air."""
    n = C.size
    current, speed, flow = u
    fan, wash = (speed / 1000.0) ** 0.8 + 0.1, (abs(flow) / 4.0) ** 0.8 + 0.05
    q[:], J[:] = 0.0, 0.0
    for k in range(a.size):
        i, j, g = a[k], b[k], G[k]
        q[i] += g * (x[j] - x[i])
        q[j] += g * (x[i] - x[j])
        J[i, i] -= g
        J[j, j] -= g
        J[i, j] += g
        J[j, i] += g
    for i in range(n):
        d = x[i] - air[0]
        s = d * d + SMALLEST * SMALLEST
        q[i] -= forced[i] * fan * d + natural[i] * s**0.125 * d
        J[i, i] -= forced[i] * fan + natural[i] * (s**0.125 + 0.25 * d * d * s**-0.875)
        h, c = x[i] + 273.15, air[0] + 273.15
        q[i] -= 5.670374419e-8 * radiating[i] * (h**4 - c**4)
        J[i, i] -= 4.0 * 5.670374419e-8 * radiating[i] * h**3
        if cell[i] >= 0:
            j, g = cell[i], washed[i] * wash
            q[i] += g * (x[j] - x[i])
            q[j] += g * (x[i] - x[j])
            J[i, i] -= g
            J[j, j] -= g
            J[i, j] += g
            J[j, i] += g
        q[i] += copper[i] * current**2 / 100.0 * (1.0 + 0.0039 * (x[i] - 20.0)) + iron[i] * (speed / 1000.0) ** 1.5
        J[i, i] += copper[i] * current**2 / 100.0 * 0.0039
    for k in range(path.size):
        i = path[k]
        forth, back = RATE * max(flow, 0.0), RATE * max(-flow, 0.0)
        q[i] -= 1.0 * (x[i] - air[0]) + (forth + back) * x[i]
        J[i, i] -= 1.0 + forth + back
        if k > 0:
            q[i] += forth * x[path[k - 1]]
            J[i, path[k - 1]] += forth
        else:
            q[i] += forth * air[1]
        if k + 1 < path.size:
            q[i] += back * x[path[k + 1]]
            J[i, path[k + 1]] += back
        else:
            q[i] += back * air[2]


@njit(cache=True)
def _balanced(args, u, air, x, q, J):
    """Bring the nodes without capacity to their balance (Newton); q and J are left there."""
    C = args[0]
    bare = np.flatnonzero(C == 0.0)
    for _ in range(100):
        _heat(*args, u, air, x, q, J)
        if bare.size == 0:
            return
        A, r = np.empty((bare.size, bare.size)), np.empty(bare.size)
        for i in range(bare.size):
            r[i] = q[bare[i]]
            for j in range(bare.size):
                A[i, j] = J[bare[i], bare[j]]
        step = np.linalg.solve(A, r)
        for i in range(bare.size):
            x[bare[i]] -= step[i]
        if np.abs(step).max() < 1e-10:
            return


@njit(cache=True)
def _reduced(args, u, air, x):
    """Rates of the nodes with capacity and their Jacobian, the others being at balance."""
    C = args[0]
    n = C.size
    q, J = np.empty(n), np.empty((n, n))
    _balanced(args, u, air, x, q, J)
    warm, bare = np.flatnonzero(C > 0.0), np.flatnonzero(C == 0.0)
    A = np.empty((warm.size, warm.size))
    for i in range(warm.size):
        for j in range(warm.size):
            A[i, j] = J[warm[i], warm[j]]
    if bare.size:
        B, D, E = np.empty((warm.size, bare.size)), np.empty((bare.size, bare.size)), np.empty((bare.size, warm.size))
        for j in range(bare.size):
            for i in range(warm.size):
                B[i, j], E[j, i] = J[warm[i], bare[j]], J[bare[j], warm[i]]
            for i in range(bare.size):
                D[i, j] = J[bare[i], bare[j]]
        A = A - B @ np.linalg.solve(D, E)
    rate = np.empty(warm.size)
    for i in range(warm.size):
        rate[i] = q[warm[i]] / C[warm[i]]
        A[i] /= C[warm[i]]
    return rate, A


def reference(m: Machine, rtol: float = 1e-9) -> np.ndarray:
    """(nt, n) degC by SciPy's Radau, from sample to sample: between two of them all inputs are straight lines."""
    args = (m.C, m.a, m.b, m.G, m.forced, m.natural, m.radiating, m.washed, m.cell, m.path, m.copper, m.iron)
    warm, x = m.C > 0.0, m.start.copy()
    q, J = np.empty(x.size), np.empty((x.size, x.size))
    _balanced(args, m.inputs[0], m.around[0], x, q, J)
    out = [x.copy()]
    for t0, t1, u0, u1, v0, v1 in zip(m.time, m.time[1:], m.inputs, m.inputs[1:], m.around, m.around[1:], strict=False):

        def at(t, y, t0=t0, t1=t1, u0=u0, u1=u1, v0=v0, v1=v1):
            s = (t - t0) / (t1 - t0)
            x[warm] = y
            return _reduced(args, u0 + s * (u1 - u0), v0 + s * (v1 - v0), x)

        # at a flow through zero the right-hand side has a kink
        zero = u0[2] / (u0[2] - u1[2]) if u0[2] * u1[2] < 0.0 else 1.0
        for begin, end in ((t0, t0 + zero * (t1 - t0)), (t0 + zero * (t1 - t0), t1)):
            if end > begin:
                near = {"rtol": rtol, "atol": 1e-8, "jac": lambda t, y: at(t, y)[1]}
                run = solve_ivp(lambda t, y: at(t, y)[0], (begin, end), x[warm], "Radau", **near)
                at(end, run.y[:, -1])
        out.append(x.copy())
    return np.array(out)


def admissible(m: Machine) -> tuple[float, float]:
    """Lowest temperature (degC) that surroundings and start allow, and without losses the highest."""
    given = np.concatenate([m.around.ravel(), m.start[m.C > 0.0]])
    heated = bool(np.any(m.copper) or np.any(m.iron))
    return float(given.min()), np.inf if heated else float(given.max())
