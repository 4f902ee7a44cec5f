"""A plain cylinder condensed from a fine mesh against Mellor's closed form.

Source: Mellor, Roberts, Turner 1991, "Lumped parameter thermal model for electrical machines of TEFC design",
IEE Proc. B 138, 205: a face's temperature over the part's mean, for a unit flux through a face taken up uniformly.
"""

import numpy as np
import pytest

from fem.matrices.assembly import assemble
from fem.matrices.grids import ring
from fem.matrices.material import Conductivity
from lumped.condensation.reduction import Recipe, reduce

ri, ro, L, k_r, k_z = 0.03, 0.05, 0.08, 30.0, 4.0


@pytest.fixture(scope="module")
def compliance():
    """Face against face (K/W): sum over shapes of their face means over their conduction."""
    washed = lambda c: np.select(  # noqa: E731
        [c[:, 2] < 1e-6, c[:, 2] > L - 1e-6, c[:, 0] > 0.049, c[:, 0] < 0.031], ["left", "right", "out", "in"], ""
    ).astype(object)
    mesh = ring(np.linspace(ri, ro, 13), 180, np.linspace(0, L, 13), lambda c: np.full(len(c), "ring", object), washed)
    field = assemble(mesh, {"ring": Conductivity(k_r, k_r, k_z)}, {"ring": 3.6e6})
    # Almost no film: the shapes are then those of a given flux.
    films = dict.fromkeys(field.films, 1e-4)
    network = reduce(
        field, films, {}, dict.fromkeys(field.fluids, 0.0), (), Recipe(1e-6, shifts=(), random_points=0)
    ).network()
    (conduction,) = (link for link in network.links if link.kind == "conduction")
    face = {f: network.places[f"ring.{f}"].mean.weights[1:] for f in field.fluids}
    return lambda a, b: float(face[a] @ (face[b] / conduction.vals))


def radial():
    D, q, conductance = ro**2 - ri**2, np.log(ro / ri), 4 * np.pi * k_r * L
    out = (1 - 2 * ri**2 * q / D) / conductance
    inn = (2 * ro**2 * q / D - 1) / conductance
    star = -(ro**2 + ri**2 - 4 * ro**2 * ri**2 * q / D) / (2 * conductance * D)
    return out, inn, star


def axial():
    return L / (k_z * np.pi * (ro**2 - ri**2))


@pytest.mark.parametrize(
    ("a", "b", "expected"),
    [
        ("out", "out", radial()[0] + radial()[2]),
        ("in", "in", radial()[1] + radial()[2]),
        ("in", "out", radial()[2]),
        ("left", "left", axial() / 3),
        ("left", "right", -axial() / 6),
    ],
)
def test_compliance_equals_mellor(compliance, a, b, expected):
    assert compliance(a, b) == pytest.approx(expected, rel=5e-3)


def test_radial_and_axial_heat_do_not_mix(compliance):
    assert abs(compliance("left", "out")) < 1e-3 * axial()
