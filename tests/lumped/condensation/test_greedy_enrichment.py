"""Error against size, and the guard that learns from where the network fails."""

import numpy as np
import pytest

import lumped.condensation.reduction
from fem.matrices.assembly import assemble
from fem.matrices.grids import ring
from fem.matrices.material import isotropic, laminated, wound
from fem.solvers.solve import Solver
from lumped.condensation.greedy_enrichment import checks, enrich, excess
from lumped.condensation.reduction import Recipe, Zone, reduce
from lumped.condensation.reduction_error import Accuracy, point_errors, random_load_cases

CONTACTS = {"coil|core": 400.0, "coil|yoke": 800.0}
LEFT = Zone("coil", lambda c: (c[:, 2] < 0.06).astype(float))


K = {"core": laminated(28.0, 3.0), "coil": wound(250.0, 1.2), "yoke": isotropic(40.0)}


@pytest.fixture(scope="module")
def mesh():
    r = np.concatenate([np.linspace(0.02, 0.04, 3), np.linspace(0.04, 0.05, 2)[1:], np.linspace(0.05, 0.07, 3)[1:]])
    return ring(
        r,
        12,
        np.linspace(0.0, 0.12, 7),
        lambda c: np.select([c[:, 0] < 0.04, c[:, 0] < 0.05], ["core", "coil"], "yoke").astype(object),
        lambda c: np.select([c[:, 0] > 0.067, c[:, 0] < 0.021], ["ambient", "bore"], "air").astype(object),
    )


def conducting(mesh, **changed):
    return assemble(mesh, {**K, **changed}, {"core": 3.6e6, "coil": 2.5e6, "yoke": 3.7e6})


@pytest.fixture(scope="module")
def field(mesh):
    return conducting(mesh)


def films(field):
    return {face: 60.0 if face.endswith("bore") else 25.0 for face in field.films}


def reduction(field, cache=None, contacts=None, changed=None, **recipe):
    recipe = Recipe(**{"tolerance": 0.1, "shifts": (), "random_points": 0, **recipe})
    h = {**films(field), **(changed or {})}
    return reduce(
        field,
        h,
        contacts or CONTACTS,
        {"bore": 50.0, "air": 30.0},
        ("ambient",),
        recipe,
        "ring",
        cache,
        {"coil.left": LEFT},
    )


def cases(found):
    return random_load_cases(list(found.zones), list(found.washing), {"coil": 200.0, "core": 100.0})


def test_guard_learns_until_unseen_points_are_met(field):
    """A basis of nominal solutions alone fails at random coefficients; with what the guard saw it holds at new ones."""
    found, wish = reduction(field, tolerance=0.3), Accuracy(0.2, 1.0, 1.0)
    of_nominal = found.network()
    learned = enrich(found, cases(found), wish, rounds=4)
    assert not learned.rounds[0].met
    assert learned.met
    (unseen,) = checks(found.solved([found.random_point(99)]), cases(found))
    own = point_errors(learned.network, unseen.films, unseen.contacts, unseen.T, cases(found))
    before = point_errors(of_nominal, unseen.films, unseen.contacts, unseen.T, cases(found))
    assert excess(own, wish) < 0.2 * excess(before, wish)


def test_guard_looks_at_a_step_of_loss(field):
    """Shapes of steady solutions hold at steady points they have not seen, and fail 30 s after a step."""
    found, wish = reduction(field, random_points=4), Accuracy()
    network = found.network()
    learned = enrich(found, cases(found), wish, rounds=4)
    steady = checks(found.solved([found.random_point(k) for k in range(3)]), cases(found))
    of_steady = [point_errors(network, p.films, p.contacts, p.T, cases(found)) for p in steady]
    assert max(excess(e, wish) for e in of_steady) < 1.0
    assert [r.met for r in learned.rounds] == [False, True]


def test_early_heat_stays_where_nothing_takes_it(field):
    """Without films every joule of 1 W over the 30 s is in the parts' heat capacity."""
    found = reduction(field)
    alone = found.early_point(1)._replace(films=dict.fromkeys(found.films, 0.0))
    (full,) = found.solved([alone])
    joules = (field.M @ np.asarray(full.X, float)[:, : len(found.zones)]).sum(axis=0)
    np.testing.assert_allclose(joules, 30.0, rtol=1e-5)  # fields are in single precision


@pytest.mark.parametrize(
    ("change", "k"),
    [
        ({"contacts": {"coil|core": 900.0, "coil|yoke": 800.0}}, {}),
        ({"changed": {"yoke.outer": 70.0}}, {}),
        ({}, {"coil": wound(300.0, 2.0)}),
    ],
    ids=["contact", "film", "conductivity"],
)
def test_a_changed_coefficient_costs_no_solve(mesh, field, tmp_path, monkeypatch, change, k):
    """Counted: not one matrix is factorised; the changed values are in the network."""
    reduction(field, tmp_path)
    solves = []
    monkeypatch.setattr(Solver, "factor", lambda *_: solves.append(1))
    again = reduction(conducting(mesh, **k), tmp_path, **change)
    network = again.network()
    assert not solves
    contacts = {key: link.law.value for link in network.links for key in CONTACTS if link.name == f"contact:{key}"}
    assert contacts == change.get("contacts", CONTACTS)
    assert all(again.films[face] == h for face, h in change.get("changed", {}).items())
    with pytest.raises(TypeError):  # the counter is not a factor
        again.solved([again.nominal_point()])
    assert solves


def refused(*_):
    raise AssertionError("solved again")


def test_a_far_away_coefficient_is_solved_anew(field, tmp_path, monkeypatch):
    """Beyond the spread the shapes were made for, they are not trusted."""
    reduction(field, tmp_path)
    monkeypatch.setattr(lumped.condensation.reduction, "snapshots", refused)
    with pytest.raises(AssertionError, match="solved again"):
        reduction(field, tmp_path, {"coil|core": 4000.0, "coil|yoke": 800.0})


def test_shapes_of_another_centre_still_reproduce_the_field(field, tmp_path):
    """Found around one contact, used at another: same mesh, both contacts inside the spread."""
    reduction(field, tmp_path, random_points=4)
    moved = reduction(field, tmp_path, {"coil|core": 900.0, "coil|yoke": 800.0}, random_points=4)
    (point,) = checks(moved.solved([moved.nominal_point()]), cases(moved))
    found = point_errors(moved.network(tolerance=0.003), point.films, point.contacts, point.T, cases(moved))
    assert found.mean < 0.2
    assert max(found.hot, found.point) < 2.0
