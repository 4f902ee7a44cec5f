"""Families that can be swept: any draw within the documented bounds builds, and what is not given follows what is."""

import numpy as np
import pytest
from test_random_machines import FAMILIES, FEW, build, table_of

from geom import InputError, check_cad
from geom.description.random_geometry import random_geometry
from geom.description.reading import usual_geometry
from geom.families import families
from geom.machine_file import machine_from
from geom.meshing.partition import partition
from geom.meshing.voids import filled

ROOT = {"series-dc": "rotor", "pmsm": "stator", "tefc": "stator"}


def drawn(family, seed, few=False):
    """A random machine; with `few` counts it goes wrong in the same ways, ten times as fast."""
    table = random_geometry(family, np.random.default_rng(seed))
    counts = FEW[family.name] | ({"commutator.bars": 8, "jacket.turns": 3} if family.name == "series-dc" else {})
    for group, keys in table_of(counts).items() if few else ():
        table[group] |= keys
    return machine_from({"machine": {"family": family.name}, "geometry": table}, "drawn.toml")


@FAMILIES
def test_any_draw_within_the_bounds_builds(family):
    for seed in range(60):
        assert all(part.volume > 0.0 for part in drawn(family, seed).parts), seed


@FAMILIES
def test_drawn_machines_tile_the_plane_and_have_their_volume(family):
    """No overlap, no closed void; each part's faces times lengths within 1 % of its exact volume (arcs are chords)."""
    for seed in range(4):
        machine = drawn(family, seed, few=True)
        cut = filled(partition((*machine.parts, *machine.fluids), 144))
        volume = [float(cut.area() @ (cut.labels == k) @ np.diff(cut.levels)) for k in range(len(machine.parts))]
        assert volume == pytest.approx([part.volume for part in machine.parts], rel=0.01)


@FAMILIES
def test_drawn_solids_are_watertight(family):
    for check in check_cad(drawn(family, 1, few=True), 0.5):
        assert check.watertight, check.part
        assert check.solid_volume == pytest.approx(check.volume, rel=0.01)


@FAMILIES
def test_a_machine_of_twice_the_size_is_similar(family):
    """Only the leading diameter is given: every volume is eight times as large."""
    small = build(family, {})
    group, diameter = ROOT[family.name], small.geometry.__dict__[ROOT[family.name]].outer_diameter
    large = build(family, {f"{group}.outer_diameter_mm": 2e3 * diameter})
    assert [p.volume for p in large.parts] == pytest.approx([8.0 * p.volume for p in small.parts], rel=1e-9)


@FAMILIES
def test_the_default_machine_has_ratios_within_their_bounds(family):
    usual = usual_geometry(family.parameters)
    for p in (p for p in family.parameters if p.of is not None and p.default):
        assert p.of.low <= (p.usual - p.of.start(usual)) / p.of.span(usual) <= p.of.high, p.key


def test_what_is_not_given_follows_what_is():
    pmsm = families()["pmsm"]
    wide = build(pmsm, {"stator.bore_diameter_mm": 348.0}).geometry
    assert wide.stator.outer_diameter == pytest.approx(0.54)
    assert wide.shaft.diameter == pytest.approx(0.1)
    given = build(pmsm, {"stator.bore_diameter_mm": 348.0, "shaft.diameter_mm": 80.0}).geometry
    assert given.bearing.outer_diameter == pytest.approx(0.144)
    half = build(pmsm, {"stator.tooth_ratio": 0.5}).geometry
    assert half.stator.tooth == pytest.approx(0.5 * 0.174 * np.sin(np.pi / 18))


@pytest.mark.parametrize(
    ("values", "says"),
    [
        ({"stator.tooth_ratio": 0.5, "stator.tooth_mm": 15.0}, "tooth_mm and tooth_ratio are both given"),
        (
            {"stator.tooth_ratio": 0.9},
            r"tooth_ratio: 0\.9 is not possible; allowed: from 0\.3 to 0\.6 of the slot pitch",
        ),
        ({"stator.tooth_ratio": "half"}, "'half' is not possible"),
        ({"stator.slot_depth_mm": 60.0}, r"slot_depth_mm: 60 does not fit; must be less than"),
        ({"stator.slots_ratio": 0.5}, "unknown key"),
    ],
)
def test_what_cannot_be_is_refused_with_one_key(values, says):
    with pytest.raises(InputError, match=says):
        build(families()["pmsm"], values)
