"""A hairpin machine in the network: layers heat by themselves, their insulation conducts as a slot does."""

import math
from itertools import pairwise

import numpy as np
import pytest
from skfem import Basis, BilinearForm, ElementQuad2, MeshQuad, condense, solve
from skfem.helpers import dot, grad

from geom import InputError, load_machine
from geom.description.materials import material
from geom.machine_file import machine_from
from lumped.machine.hairpin import insulation
from lumped.machine.loss_sources import checked_losses, loss_watts
from lumped.sources.layer_loss import dowell

MACHINE = load_machine("ipmsm-48s8p-hairpin")
BARS = MACHINE.features.bars


def changed(**ac):
    losses = {**MACHINE.sections["losses"]["copper"], "ac": {"input": "speed_rpm", **ac}}
    sections = {**MACHINE.sections, "losses": {"copper": losses}}
    geometry = {"stator": {"slot_shape": "parallel", "slots": 48}, "winding": {"kind": "hairpin"}}
    return machine_from({"machine": {"family": "pmsm"}, "geometry": geometry, **sections}, "pins.toml")


class Means:
    """A network of means alone."""

    def __init__(self, machine):
        from lumped.model.network import Place

        self.states = [part.name for part in (*machine.parts, *machine.fluids)]
        one = np.ones((1, 1))
        self.places = {n: Place(n, "part", n, np.array([i]), one, np.ones(1)) for i, n in enumerate(self.states)}
        self.name = machine.name


def watts(machine, speed):
    return loss_watts(machine, Means(machine), {"current_A": 250.0, "speed_rpm": speed})


def test_copper_at_rest_is_that_of_the_whole_winding():
    copper = {n: w for n, w in watts(MACHINE, 0.0).items() if n.startswith("winding")}
    assert sum(copper.values()) == pytest.approx(3 * 9.2e-3 * 250.0**2, rel=1e-3)
    lengths = {n: MACHINE.part(n).volume * MACHINE.part(n).filling[0] for n in copper}
    for n, w in copper.items():
        assert w / sum(copper.values()) == pytest.approx(lengths[n] / sum(lengths.values()), rel=1e-3)


def test_each_layer_loses_as_dowell_says_and_end_turns_as_direct_current():
    rest, turning = watts(MACHINE, 0.0), watts(MACHINE, 10000.0)
    x = BARS.height * math.sqrt(math.pi * 4 * 10000 / 60 * 4e-7 * math.pi * BARS.width / 4.6e-3 / 1.7241e-8)
    for k, layer in enumerate(BARS.layers):
        assert turning[layer] / rest[layer] == pytest.approx(float(dowell(x, k + 1)), rel=3e-3)
    assert turning["winding.left"] == pytest.approx(rest["winding.left"])


def test_resistance_is_that_of_the_copper():
    volume = sum(p.volume * p.filling[0] for p in MACHINE.parts if p.filling)
    section = BARS.width * BARS.height
    assert 1.7241e-8 * volume / section**2 / 3 / 4 == pytest.approx(9.2e-3, rel=1e-2)  # two ways in parallel


def test_a_map_gives_every_layer_its_own_factors():
    rows = [[1.0, 1.0 + k] for k in range(6)]
    machine = changed(at_speed=[0, 5000], factors=rows)
    rest, turning = watts(machine, 0.0), watts(machine, 5000.0)
    for k, layer in enumerate(machine.features.bars.layers):
        assert turning[layer] / rest[layer] == pytest.approx(1.0 + k, rel=1e-6)


def test_a_map_with_a_layer_missing_is_refused():
    with pytest.raises(InputError, match=r"\[losses.copper\].*factors"):
        checked_losses(changed(at_speed=[0, 5000], factors=[[1.0, 2.0]]))


@BilinearForm
def laplace(u, v, w):
    return dot(grad(u), grad(v))


def conductance(cold_sides):
    """W/m/K of a quarter of a layer: from its bar, all at one temperature, through enamel, resin and corners."""
    enamel, resin = material("enamel").k_plane, MACHINE.material_of(BARS.layers[2]).mixture.k_between
    steps = []
    for half, room in ((BARS.width / 2, BARS.room[2] / 2), (BARS.height / 2, BARS.pitch / 2)):
        inside = half * (1 - np.linspace(1, 0, 9) ** 2)
        edges = (half, half + BARS.enamel, room)
        steps.append(np.array([*inside, *(v for a, b in pairwise(edges) for v in np.linspace(a, b, 7)[1:])]))
    mesh = MeshQuad.init_tensor(*steps)
    x, y = mesh.p[:, mesh.t].mean(1)
    coated = (x < BARS.width / 2 + BARS.enamel) & (y < BARS.height / 2 + BARS.enamel)
    basis = Basis(mesh, ElementQuad2())
    K = sum(
        k * laplace.assemble(Basis(mesh, ElementQuad2(), elements=np.flatnonzero(where)))
        for k, where in ((enamel, coated), (resin, ~coated))
    )
    bar = basis.get_dofs(elements=np.flatnonzero((x < BARS.width / 2) & (y < BARS.height / 2))).all()
    cold = [basis.get_dofs(lambda p, d=d: np.abs(p[d] - steps[d][-1]) < 1e-12).all() for d in cold_sides]
    fixed = np.zeros(basis.N)
    fixed[bar] = 1.0
    T = solve(*condense(K, np.zeros(basis.N), x=fixed, D=np.concatenate([bar, *cold])))
    return float(T @ (K @ T))


def test_insulation_conducts_as_the_slot_in_the_plane():
    """Corners are left out: 9 % of what goes to the liner alone, 8 % to the next layer alone, 3 % to both."""
    h = insulation(MACHINE)
    beside = h["slot.liner|winding.layer-3"] * BARS.pitch / 2  # of a quarter, per m of slot
    above = h["winding.layer-3|winding.layer-4"] * BARS.room[2]  # to the middle: half of the way, half of the width
    for right, cold, more in ((beside, (0,), 0.093), (above, (1,), 0.075), (beside + above, (0, 1), 0.033)):
        assert conductance(cold) / right - 1.0 == pytest.approx(more, abs=2e-3)
