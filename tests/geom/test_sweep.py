"""Families that can be swept: any draw within the documented bounds builds, and what is not given follows what is."""

import re
from dataclasses import replace
from itertools import count, islice

import numpy as np
import pytest
from test_random_machines import FAMILIES, FEW, build, table_of

from geom import InputError, check_cad
from geom.description.parameters import UNITS
from geom.description.reading import read_geometry
from geom.families.random_geometry import random_geometry
from geom.machine_file import families, machine_from
from geom.meshing.partition import filled, partition

ROOT = {"series-dc": "rotor", "pmsm": "stator", "tefc": "stator", "cross-section": "stator"}


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
        ({"stator.slot_depth_mm": 60.0}, r"slot_depth_mm: 60 does not fit; must be less than"),
    ],
)
def test_what_cannot_be_is_refused_with_one_key(values, says):
    with pytest.raises(InputError, match=says):
        build(families()["pmsm"], values)


def widened(p):
    """Bounds of its ratio half as wide again."""
    if p.of is None:
        return p
    more = (p.of.high - p.of.low) / 4
    return replace(p, of=replace(p.of, low=max(p.of.low - more, p.of.low / 2), high=p.of.high + more))


def lengths_given(family, table, which):
    """The table with these lengths in mm; None if one leaves its own range."""
    values = read_geometry(tuple(map(widened, family.parameters)), table, "")
    for p in (p for p in which if p.ratio_name in table[p.group]):
        length = float(getattr(getattr(values, p.group), p.attribute) / UNITS[p.unit])
        if not (p.low <= length <= p.high or length == 0.0):
            return None
        del table[p.group][p.ratio_name]
        table[p.group][p.name] = length
    return table


def refused(family, table):
    """What the refusal asks for: group, key, value, and whether it says that this fits; None where it is built."""
    try:
        machine_from({"machine": {"family": family.name}, "geometry": table}, "drawn.toml")
    except InputError as refusal:
        return re.search(r"\[geometry\.(\w+)\] (\w+) = (\S+) (fits|is a beginning)$", refusal.right).groups()
    return None


def as_asked(family, table, group, key, value, _):
    """The table with a length changed."""
    p = next(p for p in family.parameters if p.group == group and key in (p.name, p.ratio_name))
    rest = {name: entry for name, entry in table[group].items() if name not in (p.name, p.ratio_name)}
    return {**table, group: {**rest, key: float(value)}}


@FAMILIES
def test_one_length_out_of_proportion_is_built_or_refused_with_what_fits(family):
    rng, times = np.random.default_rng(3), 0
    lengths = [p for p in family.parameters if p.of is not None]
    for _ in range(150):
        table, p = random_geometry(family, rng), lengths[rng.integers(len(lengths))]
        far = widened(p).of
        table[p.group].pop(p.name, None)
        table[p.group][p.ratio_name] = float(rng.choice([far.low, far.high]))
        if lengths_given(family, table, [p]) and (asked := refused(family, table)):
            times += 1
            assert asked[-1] == "fits", table
            assert refused(family, as_asked(family, table, *asked)) is None, table
    assert times >= 5  # one in ten, or more


@pytest.mark.nightly
@FAMILIES
def test_any_lengths_out_of_proportion_end_in_a_machine_as_refusals_ask(family):
    wide, rng, several = replace(family, parameters=tuple(map(widened, family.parameters))), np.random.default_rng(4), 0
    tables = (lengths_given(family, random_geometry(wide, rng), family.parameters) for _ in count())
    for table in islice(filter(None, tables), 120):
        changes = 0
        while asked := refused(family, table):
            table, changes = as_asked(family, table, *asked), changes + 1
            assert changes <= len(family.parameters), table
            assert asked[-1] != "fits" or refused(family, table) is None, table
        several += changes > 1
    assert several > 0


def test_a_length_whose_range_ends_too_early_is_asked_for_as_a_ratio():
    """The longest stack, its windings and end-caps need more than the 3 m that a frame may have in mm."""
    tefc = families()["tefc"]
    table = {"stator": {"outer_diameter_mm": 3000.0, "stack_length_mm": 2000.0}, "frame": {"length_mm": 2990.0}}
    group, key, value, word = refused(tefc, table)
    assert (group, key, word) == ("frame", "length_ratio", "fits")
    assert refused(tefc, as_asked(tefc, table, group, key, value, word)) is None
