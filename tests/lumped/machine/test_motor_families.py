"""Networks of every family: streams, fans, losses and sensors as their machine files declare them."""

import tomllib
from dataclasses import replace

import numpy as np
import pytest
from bare_networks import means_only

from geom import library, load_machine
from geom.errors import InputError
from geom.machine_file import machine_from
from lumped.build.fixed_coefficients import rated_streams
from lumped.build.pipeline import prepared
from lumped.integration.steady import steady
from lumped.machine.films import surroundings
from lumped.machine.jackets import channel_of, cooling_of
from lumped.machine.loss_sources import _declared, loss_watts
from lumped.machine.motor import operating_point
from lumped.machine.outer import outer_films, outer_of
from lumped.machine.part_identities import turning
from lumped.machine.path import path_of
from lumped.machine.settings import read_films
from lumped.machine.zones import motor_zones
from lumped.model.multipliers import multipliers
from lumped.transfer.coolant import glycol
from lumped.transfer.terms_value import coefficient, temperature_value

FAMILIES = ("pmsm-m1", "ipmsm-48s8p-jacket", "tefc-industrial")


@pytest.fixture(scope="module")
def ready():
    return {name: prepared(load_machine(name), 0.1, 36) for name in FAMILIES}


@pytest.fixture(scope="module")
def networks(ready):
    return {name: means_only(one) for name, one in ready.items()}


def rest(network, **inputs):
    return steady(network, inputs, dict.fromkeys(network.boundaries, 20.0))


@pytest.mark.parametrize("name", FAMILIES)
def test_parameters_act_on_what_is_there(networks, name):
    network = networks[name]
    targets = {t for p in network.parameters for t, _ in p.targets if not t.startswith("capacity:")}
    assert targets <= {item.name for item in (*network.links, *network.sources)}
    assert multipliers(network, None)
    films = {link.name for link in network.links if link.kind == "film"}
    assert films <= targets, "a film nothing can calibrate"


@pytest.mark.parametrize("name", list(library()))
def test_losses_of_every_machine_are_all_placed(name):
    for loss, _, shares, _, _ in _declared(load_machine(name)):
        assert sum(shares.values()) == pytest.approx(1.0), loss


def test_meshed_brushes_take_half_of_what_slides_on_the_commutator():
    plain, table = load_machine("series-dc-100kw"), tomllib.loads(library()["series-dc-100kw"].read_text())
    geared = machine_from({**table, "geometry": {**table["geometry"], "brushes": {"arms": 4}}})
    for machine, expected in ((plain, {"commutator": 1.0}), (geared, {"commutator": 0.5, "brushes": 0.5})):
        shares = {name: at for name, _, at, _, _ in _declared(machine)}
        assert shares["brush.drop"] == shares["brush.friction"] == expected


def test_direct_current_heating_at_standstill(networks, ready):
    """8 A through three phases in series: 3 R I^2 with the copper's own resistance, all of it leaves to ambient."""
    network = networks["pmsm-m1"]
    found = rest(network, current_A=8.0, speed_rpm=0.0)
    copper = network.place("winding.copper").mean
    T = float(copper.weights @ found.z[copper.index])
    heat = 3 * 0.88 * 64.0 * (1 + 0.00393 * (T - 20.0))
    left = 0.0
    for link in network.links:
        if "ambient" in link.places:
            hot = float(link.hot.weights @ found.z[link.hot.index])
            h = temperature_value(link.law.temperature, hot, 20.0)
            left += float(link.law.factor({})) * h * network.place(link.places[0]).area * (hot - 20.0)
    assert left == pytest.approx(heat, rel=1e-6)
    assert max(found["winding"], found["winding.left"]) > found["magnets"] > found["base"] > 20.0


def test_resistance_sees_copper_by_volume(networks):
    """In the slots 45 % copper, in the ends 35 %: densities say so."""
    machine, place = load_machine("pmsm-m1"), networks["pmsm-m1"].place("winding.copper")
    rho = {p: machine.material_of(p).rho for p in ("winding", "winding.left")}
    copper = [(rho[p] - 1350.0) * machine.part(p).volume for p in ("winding", "winding.left")]
    assert place.b[0] / place.b[1] == pytest.approx(copper[0] / copper[1])
    assert place.b.sum() == pytest.approx(1.0)


def test_emissivity_of_the_base_is_the_papers(networks):
    (link,) = (link for link in networks["pmsm-m1"].links if link.name == "film:base.outer:radiation")
    assert link.law.factor({}) == 0.1
    plate = load_machine("pmsm-m1-plate")
    assert outer_of(plate, "base", surroundings(plate, ()).films).emissivity == 0.03


def test_what_turns_hangs_on_the_shaft(ready):
    for name, own in {"pmsm-m1": "magnets", "tefc-industrial": "rotor.cage"}.items():
        machine, contacts = ready[name].machine, ready[name].mesh.contacts
        bare = replace(machine, parts=tuple(replace(p, role=None) for p in machine.parts))
        assert turning(machine, contacts) == turning(bare, contacts) == {"shaft", "rotor.core", own}


@pytest.mark.parametrize("degC", [-20.0, 40.0, 90.0])
def test_coolant_warms_by_the_exact_exponential_along_walls_of_one_temperature(networks, degC):
    """T(x) = T_wall - (T_wall - T_in) exp(-h A(x) / mcp) at the end of every cell, at any flow: Incropera 8.41b.

    Heat capacity and film are those of the coolant's own temperature: a litre of glycol takes up 5 % less at -20 degC.
    """
    network, machine = networks["ipmsm-48s8p-jacket"], load_machine("ipmsm-48s8p-jacket")
    cells = [name for name in network.states if name.startswith("jacket@")]
    wall, coolant, channel = 80.0, glycol("ethylene", 50.0)(degC), channel_of(machine, "jacket")
    for flow in (1.0, 5.0, 12.0):
        at, T, area = {"flow_l_min": np.array([flow])}, 20.0, 0.0
        rate = coolant.rho * coolant.cp * flow / 60000.0
        h = channel.film(flow, coolant)[0]
        for cell in cells:
            films = [link for link in network.links if link.kind == "film" and link.places[1] == cell]
            (stream,) = (link for link in network.links if link.name == f"stream:{cell}")
            own = [network.place(film.places[0]).area for film in films]
            area += sum(own)
            films_W_m2K = [coefficient(film.law, at, degC, 0.0) for film in films]
            G = sum(A * film for A, film in zip(own, films_W_m2K, strict=True))
            assert coefficient(stream.law, at, degC, 0.0) == pytest.approx(rate, rel=2e-3)
            T = (rate * T + G * wall) / (rate + G)
            assert wall - T == pytest.approx((wall - 20.0) * np.exp(-h * area / rate), rel=2e-3)


def test_streams_of_a_check_have_the_coolant_at_its_usual_temperature(networks):
    """A machine is built and checked with rises, whose coolant would be 0 degC, and with films of the usual one."""
    machine = load_machine("ipmsm-48s8p-jacket")
    cooling = cooling_of(machine)
    rate = cooling.liquid.rho * cooling.liquid.cp * cooling.flow_l_min / 60000.0
    assert rated_streams(machine, networks["ipmsm-48s8p-jacket"]).sum() == pytest.approx(rate, rel=2e-4)


def test_walls_are_cut_along_the_way_of_the_coolant(ready):
    """Turn by turn from the inlet; channel by channel around the axis; the cells have the area of the whole wall."""
    films = ready["ipmsm-48s8p-jacket"].field.films
    walls = [films[f"jacket.wall@{k}"].trace for k in range(6)]
    z = [float(t.b @ ready["ipmsm-48s8p-jacket"].field.xyz[t.dofs, 2]) / t.area for t in walls]
    assert np.all(np.diff(z) > 0.015)
    assert max(t.area for t in walls) < 1.1 * min(t.area for t in walls)
    zigzag = load_machine("series-dc-100kw-jacket-one")
    path = path_of(zigzag, "jacket.left")
    around = np.array([np.pi / 2, np.pi / 2 + 0.5, np.pi + 1.0, np.pi / 2 - 0.2])  # starts at the top, anticlockwise
    come = path.along(np.column_stack([np.cos(around), np.sin(around), 0 * around]))
    assert path.cells == 6
    assert np.all(np.diff(come) > 0)


def test_jackets_side_by_side_or_one_after_the_other():
    machine = load_machine("series-dc-100kw-jacket-two")
    cooling = cooling_of(machine)
    assert cooling.feeds == {"jacket.left": "coolant", "jacket.right": "coolant"}
    assert cooling.share("jacket.right") == 0.5
    joined = dict(machine.sections["cooling"])
    joined["jacket.right"] = {"inlet": "jacket.left.outlet", "outlet": "out"}
    cooling = cooling_of(replace(machine, sections={**machine.sections, "cooling": joined}))
    assert cooling.feeds["jacket.right"] == "jacket.left"
    assert cooling.share("jacket.right") == 1.0
    joined["jacket.left"] = {"inlet": "out", "outlet": "jacket.left.outlet"}
    with pytest.raises(InputError, match=r"is fed by itself.*an inlet that no jacket feeds"):
        cooling_of(replace(machine, sections={**machine.sections, "cooling": joined}))


def test_spiral_channel_by_hand():
    """10 mm high; six turns and seven ribs of 5 mm over 150 mm leave 19.17 mm of width."""
    channel, wide = channel_of(load_machine("ipmsm-48s8p-jacket"), "jacket"), (150.0 - 7 * 5.0) / 6 * 1e-3
    assert channel.area == pytest.approx(0.010 * wide)
    assert channel.diameter == pytest.approx(2 * 0.010 * wide / (0.010 + wide))
    assert channel.coil == pytest.approx(0.107 + 0.117)


def test_zones_divide_their_parts(ready):
    """Every zone pair or set has the whole volume of its part; the teeth reach from the bore to the slots' bottom."""
    field, zones = ready["pmsm-m1"].field, motor_zones(load_machine("pmsm-m1"))
    assert {"winding.inner", "winding.outer", "stator.core.teeth", "stator.core.back"} <= set(zones)
    for part in ("winding", "stator.core"):
        block = field.blocks[part]
        centres = block.xyz[block.tets].mean(1)
        own = [zone.density(centres) for name, zone in zones.items() if zone.part == part]
        assert np.sum(own, axis=0) == pytest.approx(1.0)
    assert {f"winding.field.{k}" for k in (1, 2, 3, 4)} <= set(motor_zones(load_machine("series-dc-100kw")))
    assert {"poles.shoe", "poles.body", "rotor.core.teeth"} <= set(motor_zones(load_machine("series-dc-100kw")))


def test_a_loss_at_an_unknown_place_is_refused(ready):
    machine = load_machine("pmsm-m1")
    losses = {**machine.sections["losses"], "iron": {**machine.sections["losses"]["iron"], "at": "statr.core"}}
    wrong = replace(machine, sections={**machine.sections, "losses": losses})
    with pytest.raises(InputError, match=r"no place 'statr.core'.*known"):
        means_only(ready["pmsm-m1"], wrong)


def test_a_loss_by_an_input_that_no_rating_gives_is_refused(ready):
    machine = load_machine("pmsm-m1")
    copper = {**machine.sections["losses"]["copper"], "currents": ["i_rms"]}
    wrong = replace(machine, sections={**machine.sections, "losses": {**machine.sections["losses"], "copper": copper}})
    with pytest.raises(InputError, match=r"\[losses.copper\]: the rated point has no input 'i_rms'; known: current_A"):
        loss_watts(wrong, means_only(ready["pmsm-m1"], machine), {"current_A": 16.0, "speed_rpm": 383.0})


def test_a_machine_without_losses_can_be_looked_at(ready):
    machine = load_machine("pmsm-m1")
    bare = replace(machine, sections={k: v for k, v in machine.sections.items() if k != "losses"})
    watts = loss_watts(
        bare, means_only(ready["pmsm-m1"], bare), {k: float(v[0]) for k, v in operating_point(bare).items()}
    )
    assert sum(watts.values()) == pytest.approx(100.0)
    assert set(watts) == {"winding", "winding.left", "winding.right"}


def test_a_part_may_have_its_own_film_of_the_shaft_fan():
    """On the standing foot, which the cowl does not reach, and on the shield in the place of the cowl's film."""
    machine = load_machine("tefc-industrial")
    fan = {"h_W_m2K": 40.0, "at_rpm": 1460.0}
    said = {"outer": {"foot": {"fan": fan}, "endcap.left": {"fan": fan}}}
    machine = replace(machine, sections={**machine.sections, "films": said})
    bare = outer_films(load_machine("tefc-industrial"), "foot", read_films(machine))
    assert "blown" not in bare
    for part in said["outer"]:
        laws = outer_films(machine, part, read_films(machine))
        for speed, forced in ((0.0, 0.0), (730.0, 40.0 * 0.5**0.8)):
            still, added = (
                coefficient(laws[n], {"speed_rpm": np.array(speed)}, 60.0, 20.0) for n in ("natural", "blown")
            )
            assert still + added == pytest.approx((still**3 + forced**3) ** (1 / 3), rel=0.01)
