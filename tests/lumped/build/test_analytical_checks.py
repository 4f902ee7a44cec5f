"""Hand formulas beside the field, on a machine whose bearings and liners have closed forms."""

import pytest

from lumped.build.analytical_checks import analytical_checks
from lumped.build.crosscheck import crosscheck
from lumped.machine.loss_sources import loss_shares


@pytest.fixture(scope="module")
def check(built):
    point = {"current_A": 8.0, "speed_rpm": 0.0}
    return crosscheck(built.field, built.network, point, shares=loss_shares(built.machine, built.network))


@pytest.fixture(scope="module")
def hand(built, check):
    return {row.link: row for row in analytical_checks(built.machine, built.field, check)}


def test_heat_through_links_leaves_the_machine(check):
    """What the field sheds through the outer faces is what was lost in it; heat into a fluid node comes out of it."""
    outer = sum(link.fem_W for link in check.links if link.link.startswith("film:"))
    assert outer == pytest.approx(check.heat, rel=1e-9)
    assert check.energy_balance < 1e-10
    assert check.links == tuple(sorted(check.links, key=lambda link: -link.percent_of_heat))


def test_films_and_contacts_have_the_area_of_the_drawing(hand):
    """36 chords per turn lose 0.5 % of a circle's length; slots and ends a little more."""
    ratios = {link: row.ratio for link, row in hand.items() if " to " not in link}
    assert len(ratios) > 3
    assert ratios == pytest.approx(dict.fromkeys(ratios, 1.0), abs=0.02)


def test_two_thin_walls_in_series(hand, check):
    """Gap filling and liner carry the slots' heat and have no loss: half of each and the contact between."""
    assert hand["slot.gap to slot.liner"].ratio == pytest.approx(1.0, abs=0.1)
