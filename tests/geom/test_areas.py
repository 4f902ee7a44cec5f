"""The table of parts: volumes, masses and areas against formulas and against the mesh."""

import math

import pytest

from geom import material, part_table
from geom.description import shapes
from geom.description.machine import Machine
from geom.description.part import Part, fluid


@pytest.fixture(scope="module")
def rod_in_sleeve():
    """A rod of 10 mm radius, 100 mm long, in a sleeve of 20 mm radius over its first 40 mm, oil around that."""
    parts = (
        Part("rod", "steel", ((shapes.disc(0.01), 0.0, 0.1),)),
        Part("sleeve", "copper", ((shapes.ring(0.01, 0.02), 0.0, 0.04),)),
    )
    oil = fluid("oil", (shapes.ring(0.02, 0.03), 0.0, 0.04))
    machine = Machine("small", "none", "", parts, (oil,), {}, None, {("sleeve", "oil"): "sleeve.wet"})
    return {row.name: row for row in part_table(machine)}


def test_volumes_and_masses(rod_in_sleeve):
    rod = rod_in_sleeve["rod"]
    assert rod.volume == pytest.approx(math.pi * 0.01**2 * 0.1)
    assert rod.mass == pytest.approx(rod.volume * material("steel").rho)


def test_contact_is_the_cylinder_seen_from_both_sides(rod_in_sleeve):
    cylinder = math.pi * 0.02 * 0.04
    assert rod_in_sleeve["rod"].contacts == {"sleeve": pytest.approx(cylinder, rel=1e-4)}
    assert rod_in_sleeve["sleeve"].contacts == {"rod": pytest.approx(cylinder, rel=1e-4)}


def test_faces_carry_their_names_and_areas(rod_in_sleeve):
    ends = 2 * math.pi * (0.02**2 - 0.01**2)
    wet = math.pi * 0.04 * 0.04
    faces = rod_in_sleeve["sleeve"].faces
    assert faces == {"sleeve.outer": pytest.approx(ends, rel=1e-3), "sleeve.wet": pytest.approx(wet, rel=1e-4)}


def test_films_and_contacts_make_up_the_whole_surface(rod_in_sleeve):
    whole = 2 * math.pi * 0.01 * (0.1 + 0.01)
    rod = rod_in_sleeve["rod"]
    assert rod.film_area + rod.contact_area == pytest.approx(whole, rel=1e-3)
