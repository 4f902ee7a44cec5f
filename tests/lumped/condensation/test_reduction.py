"""The condensed network against the full field of the same mesh, and against what must hold by construction."""

import numpy as np
import pytest

from fem.matrices.assembly import assemble
from fem.matrices.grids import ring
from fem.matrices.material import isotropic, laminated, wound
from fem.solvers.solve import Solver, only_fixed, steady
from geom.errors import InputError
from lumped.condensation.linear import linear, unit_load
from lumped.condensation.reduction import Recipe, Zone, reduce
from lumped.condensation.reduction_error import errors
from lumped.transfer.laws import Fixed

FLUIDS = {"bore": 50.0, "air": 30.0}
CONTACTS = {"coil|core": 400.0, "coil|yoke": 800.0}


def machine():
    """A core, a coil around it and a yoke, washed inside, at the ends and outside."""
    r = np.concatenate([np.linspace(0.02, 0.04, 4), np.linspace(0.04, 0.05, 3)[1:], np.linspace(0.05, 0.07, 4)[1:]])

    def part(c):
        return np.select([c[:, 0] < 0.04, c[:, 0] < 0.05], ["core", "coil"], "yoke").astype(object)

    def fluid(c):
        return np.select([c[:, 0] > 0.069, c[:, 0] < 0.0205], ["ambient", "bore"], "air").astype(object)

    return ring(r, 24, np.linspace(0.0, 0.12, 9), part, fluid)


@pytest.fixture(scope="module")
def field():
    k = {"core": laminated(28.0, 3.0), "coil": wound(250.0, 1.2), "yoke": isotropic(40.0)}
    return assemble(machine(), k, {"core": 3.6e6, "coil": 2.5e6, "yoke": 3.7e6}, ["coil"])


@pytest.fixture(scope="module")
def films(field):
    return {face: 60.0 if face.endswith("bore") else 25.0 for face in field.films}


@pytest.fixture(scope="module")
def network(field, films):
    zones = {"coil.left": Zone("coil", lambda c: (c[:, 2] < 0.06).astype(float))}
    return reduce(field, films, CONTACTS, FLUIDS, recipe=Recipe(tolerance=0.003), zones=zones).network()


@pytest.fixture(scope="module")
def solver(field):
    return Solver(field)


def scaled(values, factor, only=None):
    return {k: v * (factor if only in (None, k) else 1.0) for k, v in values.items()}


def cases(films):
    yield "nominal", films, CONTACTS
    yield "films x0.3", scaled(films, 0.3), CONTACTS
    yield "films x3", scaled(films, 3.0), CONTACTS
    yield "one film x10", scaled(films, 10.0, "yoke.outer"), CONTACTS
    yield "contact x0.2", films, scaled(CONTACTS, 0.2, "coil|yoke")
    yield "contact x5", films, scaled(CONTACTS, 5.0, "coil|core")


LOSSES = ({"coil": 300.0}, {"core": 250.0, "yoke": 60.0}, {"coil.left": 200.0, "core": 50.0})


def loaded(field, network, watts):
    """A loss mix on the field (n,) and on all states of the network."""
    full = np.zeros(field.n)
    states = np.zeros(len(network.states))
    for place, q in watts.items():
        density = (lambda c: (c[:, 2] < 0.06).astype(float)) if place == "coil.left" else None
        full += q * field.load(place.split(".")[0], density)
        states += q * unit_load(network, place, np.arange(len(states)))
    return full, states


def test_steady_errors_within_one_and_two_percent(field, films, network, solver):
    """Means within 1 %, hot spots and points within 2 % of the part's rise, whatever film or contact has changed."""
    for name, h, g in cases(films):
        factor, system = solver.factor(field.stiffness(h, g)), linear(network, h, g)
        for watts in LOSSES:
            full, load = loaded(field, network, watts)
            x = np.zeros(len(network.states))
            x[system.solid] = np.linalg.solve(system.A, load[system.solid])
            e = errors(network, factor(full), x)
            assert e.mean < 1.0, (name, watts, str(e))
            assert max(e.hot, e.point) < 2.0, (name, watts, str(e))


def test_loss_step_from_thirty_seconds(field, films, network, solver):
    """The same backward Euler steps in both, so only the condensation is seen."""
    K, system = field.stiffness(films, CONTACTS), linear(network, films, CONTACTS)
    full, load = loaded(field, network, {"coil": 300.0, "core": 100.0})
    T, x, step = np.zeros(field.n), np.zeros(len(system.C)), 5.0
    factor, inverse = solver.factor(K, 1 / step), np.linalg.inv(system.A + np.diag(system.C) / step)
    states = np.zeros(len(network.states))
    for k in range(60):
        T = factor(full + field.M @ T / step)
        x = inverse @ (load[system.solid] + system.C * x / step)
        if k >= 5:
            states[system.solid] = x
            e = errors(network, T, states)
            assert e.mean < 1.0, (k, str(e))
            assert max(e.hot, e.point) < 4.0, (k, str(e))


def test_every_part_balances(field, films, network):
    """Steady: what leaves each part through its faces and contacts is what was lost in it."""
    system = linear(network, films, CONTACTS)
    _, load = loaded(field, network, {"coil": 300.0, "core": 100.0})
    z = np.zeros(network.size)
    z[system.solid] = np.linalg.solve(system.A, load[system.solid])
    left = dict.fromkeys(field.blocks, 0.0)
    for place in network.places.values():
        if place.kind == "surface":
            left[place.part] += films[place.name] * place.area * (place.mean.weights @ z[place.mean.index])
    for link in network.links:
        if link.kind == "contact":
            hot, cold = (row.weights @ z[row.index] for row in (link.hot, link.cold))
            a, b = link.places
            key = f"{a}|{b}"
            flow = CONTACTS[key] * field.contacts[key].area * (hot - cold)
            left[a] += flow
            left[b] -= flow
    assert left == pytest.approx({"coil": 300.0, "core": 100.0, "yoke": 0.0}, abs=1e-8)


def test_mean_nodes_hold_density_times_heat_times_volume(field, network):
    for part, block in field.blocks.items():
        assert network.C[network.column(part)] == pytest.approx(block.rho_cp * block.volume, rel=1e-12)


def test_matrices_are_symmetric_positive_definite(films, network):
    system = linear(network, films, CONTACTS)
    assert np.abs(system.A - system.A.T).max() < 1e-9 * np.abs(system.A).max()
    assert np.linalg.eigvalsh(system.A).min() > 0
    assert system.C.min() > 0


def test_uniform_temperature_moves_no_heat(network):
    z = np.zeros(network.size)
    z[[network.column(n) for n in ("core", "coil", "yoke", *FLUIDS, "ambient")]] = 37.0
    faces = [p for p in network.places.values() if p.kind == "surface"]
    films = [network.surface_link(p.name, "film", p.name, p.fluid, Fixed(1.0)) for p in faces]
    for link in (*network.links, *films):
        flow = np.zeros(network.size)
        np.add.at(flow, link.rows, link.vals * z[link.cols])
        assert np.abs(flow).max() < 1e-9, link.name


def test_conductivity_is_a_factor_on_its_link(field, films, network, solver):
    """The coil's conductivity halved, at no offline cost; shapes were centred on the old value."""
    full, load = loaded(field, network, {"coil": 300.0})
    K = field.stiffness(films, CONTACTS, {"coil": 0.5})
    system = linear(network, films, CONTACTS, {"coil": 0.5})
    x = np.zeros(len(network.states))
    x[system.solid] = np.linalg.solve(system.A, load[system.solid])
    assert errors(network, solver.factor(K)(full), x).mean < 0.5


def test_means_only_then_more_states_then_better(field, films, network, solver):
    """The user chooses the size; the error of the means falls with it."""
    full, _ = loaded(field, network, {"coil": 300.0, "core": 100.0})
    exact = solver.factor(field.stiffness(films, CONTACTS))(full)
    found = []
    for size in (3, 10, 30):
        small = reduce(field, films, CONTACTS, FLUIDS, recipe=Recipe(max_states=size)).network(max_states=size)
        system = linear(small, films, CONTACTS)
        assert len(system.C) <= size
        _, load = loaded(field, small, {"coil": 300.0, "core": 100.0})
        x = np.zeros(len(small.states))
        x[system.solid] = np.linalg.solve(system.A, load[system.solid])
        found.append(errors(small, exact, x).mean)
    assert found[0] > found[1] > found[2]
    assert found[2] < 0.5


def test_pieces_of_one_part_are_told_apart():
    """Two coils, one part: heat in one alone must not warm the other as if they were one."""

    def part(c):
        coil = (c[:, 0] > 0.04) & (c[:, 0] < 0.05) & (np.abs(c[:, 2] - 0.06) > 0.02)
        return np.where(coil, "coil", "core").astype(object)

    field = assemble(
        ring(
            np.linspace(0.02, 0.06, 9),
            16,
            np.linspace(0.0, 0.12, 13),
            part,
            lambda c: np.where(c[:, 0] > 0.055, "ambient", "").astype(object),
        ),
        {"core": isotropic(30.0), "coil": isotropic(2.0)},
        {"core": 3.6e6, "coil": 2.5e6},
    )
    films, contacts = {"core.outer": 30.0}, {"coil|core": 300.0}
    left = Zone("coil", lambda c: (c[:, 2] < 0.06).astype(float))
    recipe = Recipe(tolerance=0.003, random_points=0)
    network = reduce(field, films, contacts, {}, recipe=recipe, zones={"coil.left": left}).network()
    contacts = {"coil|core": 60.0}
    load = 100.0 * field.load("coil", left.density)
    T = steady(Solver(field), films, contacts, load, only_fixed(ambient=0.0)).T
    system = linear(network, films, contacts)
    x = np.linalg.solve(system.A, 100.0 * unit_load(network, "coil.left", system.solid))
    e = errors(network, T, x)
    assert len(set(field.blocks["coil"].pieces)) == 2
    assert e.mean < 0.5, str(e)
    assert max(e.hot, e.point / 2) < 1.0, str(e)


def test_point_reads_the_field_it_sits_in(field, network):
    """A row at a node gives that node's temperature; halfway between two nodes of an edge their average."""
    x = np.random.default_rng(5).normal(size=len(network.states))
    T = network.recovery.field(x)
    block = field.blocks["yoke"]
    a, b = block.tets[100, :2]
    row = network.recovery.row("yoke", block.xyz[[a, b]].mean(0))
    expected = T[block.dofs.start + np.array([a, b])].mean()
    assert row.weights @ x[row.index] == pytest.approx(expected, abs=1e-6)


def test_point_outside_its_part_is_refused(network):
    with pytest.raises(InputError, match="not in part 'core'"):
        network.recovery.row("core", np.array([0.0, 0.065, 0.06]))


def test_cache_gives_the_same_network(field, films, tmp_path):
    recipe = Recipe(tolerance=0.03, random_points=0)
    first, second = (reduce(field, films, CONTACTS, FLUIDS, recipe=recipe, cache=tmp_path).network() for _ in range(2))
    assert len(list(tmp_path.glob("*.npz"))) == 1
    assert np.array_equal(first.C, second.C)
    assert all(np.array_equal(a.vals, b.vals) for a, b in zip(first.links, second.links, strict=True))


def test_means_alone_need_no_solution(field, films, monkeypatch):
    """The same links as those of a network that could have shapes, too."""
    means = reduce(field, films, CONTACTS, FLUIDS, recipe=Recipe(shifts=(), random_points=0)).network(max_states=0)
    monkeypatch.setattr(Solver, "factor", lambda *of: pytest.fail("solved"))
    alone = reduce(field, films, CONTACTS, FLUIDS, recipe=Recipe(max_states=0)).network()
    one, other = (linear(network, films, CONTACTS) for network in (means, alone))
    assert np.array_equal(one.A, other.A)
    assert np.array_equal(one.C, other.C)
