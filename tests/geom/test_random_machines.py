"""Random machines: those that fit are built and fit together, those that do not are refused in one clear line."""

import math
from functools import partial

import pytest
import shapely
from hypothesis import HealthCheck, assume, given, settings, strategies as st

from geom import InputError
from geom.description.profile import ArcGrid
from geom.machine_file import families, machine_from
from geom.meshing.partition import filled, partition

# few slots and fins: a machine with 9 slots goes wrong in the same ways as one with 90, ten times as fast
FEW = {
    "series-dc": {"rotor.slots": 12, "housing.fins": 8, "jacket.channels": 5, "rotor.ducts": 3, "fan.blades": 3},
    "pmsm": {"stator.slots": 9, "rotor.poles": 6, "housing.fins": 6, "housing.turns": 3},
    "tefc": {"stator.slots": 9, "rotor.bars": 9, "housing.fins": 6, "housing.turns": 3},
    "cross-section": {"stator.slots": 9, "housing.fins": 6, "housing.turns": 3},
}
OFTEN_ZERO = {"fan.depth_mm": 15.0, "stator.wedge_mm": 0.8, "stator.liner_gap_mm": 0.5, "commutator.bars": 8}
OFTEN_ZERO |= {"rotor.core_diameter_mm": 165.0, "rotor.stack_length_mm": 140.0, "rotor.sleeve_mm": 2.0}
FAMILIES = pytest.mark.parametrize("family", families().values(), ids=lambda family: family.name)
quick = partial(settings, deadline=None, suppress_health_check=list(HealthCheck))


def table_of(values):
    table = {}
    for key, value in values.items():
        group, name = key.split(".")
        table.setdefault(group, {})[name] = value
    return table


@st.composite
def geometry(draw, family):
    """Up to eight values within 12 per cent of the defaults (counts within 2), inside their ranges."""
    values = dict(FEW[family.name])
    for parameter in draw(st.lists(st.sampled_from(family.parameters), max_size=8, unique=True)):
        usual = values.get(parameter.key, OFTEN_ZERO.get(parameter.key, parameter.default))
        if parameter.choices:
            value = draw(st.sampled_from(parameter.choices))
        elif isinstance(parameter.default, int):
            value = draw(st.integers(int(max(parameter.low, usual - 2)), int(min(parameter.high, usual + 2))))
        else:
            value = draw(st.floats(max(parameter.low, 0.88 * usual), min(parameter.high, 1.12 * usual)))
        values[parameter.key] = value
    return values


def build(family, values):
    return machine_from({"machine": {"family": family.name}, "geometry": table_of(values)}, "random.toml")


def built_or_refused(family, values):
    try:
        return build(family, values), ""
    except InputError as refusal:
        return None, str(refusal)


@FAMILIES
@quick(max_examples=20)  # benchmarks/families.py draws a thousand of each
@given(data=st.data())
def test_random_machines_fit_together(family, data):
    machine, refusal = built_or_refused(family, data.draw(geometry(family)))
    assert machine or ("random.toml [geometry." in refusal and "must be" in refusal)
    assume(machine)  # twenty that fit are wanted
    cut = filled(partition((*machine.parts, *machine.fluids), 40))  # 24 chords cut into what clears by 0.5 %
    assert set(range(len(machine.parts))) <= set(cut.labels.ravel().tolist())


@pytest.mark.parametrize("name", ["pmsm", "cross-section"])
@quick(max_examples=10)
@given(data=st.data())
def test_random_hairpin_machines_fit_together(name, data):
    family = families()[name]
    values = {**data.draw(geometry(family)), "winding.kind": "hairpin"}
    machine, refusal = built_or_refused(family, values)
    assert machine or ("random.toml [geometry." in refusal and "must be" in refusal)
    assume(machine)
    cut = filled(partition((*machine.parts, *machine.fluids), 40))
    assert set(range(len(machine.parts))) <= set(cut.labels.ravel().tolist())
    bars = machine.features.bars
    for part in (machine.part(layer) for layer in bars.layers):
        stack = part.span[1] - part.span[0]
        copper = machine.geometry.stator.slots * bars.width * bars.height * stack
        assert part.volume * part.filling[0] == pytest.approx(copper, rel=1e-9)
    ends = [machine.part(f"winding.{end}") for end in ("left", "right")]
    assert all(0.0 < part.filling[0] < 1.0 for part in ends)


HAIRPIN_FAULTS = {
    "a slot that cuts its neighbour": (
        {"stator.slot_shape": "parallel", "stator.slot_width_mm": 65.0},
        "slot_width_mm",
        "to leave teeth",
    ),
    "bars wider than the slot": ({"winding.bar_width_mm": 60.0}, "bar_width_mm", "between the liners"),
    "end turns that cut each other": ({"winding.end_mm": 2.0, "winding.pitch_deg": 170.0}, "end_mm", "cut each other"),
}


@pytest.mark.parametrize("shape", ["flat", "v"])
def test_a_magnet_nearly_as_wide_as_the_rotor_is_one_message(shape):
    """172 mm of rotor, a bridge of 2 mm either side: found by machines beyond the bounds, as a fault of arithmetic."""
    width = {"flat": 170.0, "v": 85.7}[shape]
    rotor = {"rotor.poles": 2, "rotor.magnet_shape": shape, "rotor.magnet_width_mm": width, "rotor.v_deg": 0.0}
    with pytest.raises(InputError, match=r"magnet_width_mm: .* to lie inside the rotor"):
        build(families()["pmsm"], {**FEW["pmsm"], **rotor})


@pytest.mark.parametrize("fault", HAIRPIN_FAULTS)
def test_hairpins_that_do_not_fit_are_one_message(fault):
    values, key, words = HAIRPIN_FAULTS[fault]
    with pytest.raises(InputError, match=words) as caught:
        build(families()["pmsm"], {**FEW["pmsm"], "winding.kind": "hairpin", **values})
    assert f"random.toml [geometry.{next(iter(values)).split('.')[0]}] {key}" in str(caught.value)
    assert "\n" not in str(caught.value)


def out_of_range(parameter):
    if parameter.choices:
        return st.text(max_size=8).filter(lambda word: word not in parameter.choices)
    beyond = st.floats(parameter.high, 1e9, exclude_min=True) | st.floats(-1e9, parameter.low, exclude_max=True)
    return beyond | st.just(math.nan) | st.booleans() | st.text(max_size=8)


@FAMILIES
@quick(max_examples=40)
@given(data=st.data())
def test_random_invalid_values_are_refused_with_key_value_and_range(family, data):
    parameter = data.draw(st.sampled_from(family.parameters))
    value = data.draw(out_of_range(parameter))
    with pytest.raises(InputError) as caught:
        build(family, {**FEW[family.name], parameter.key: value})
    message = str(caught.value)
    assert f"random.toml [geometry.{parameter.group}] {parameter.name}: {value!r}" in message
    assert parameter.allowed in message
    assert "\n" not in message


@pytest.mark.parametrize(("poles", "arc", "rounded"), [(4, 0.65, False), (2, 0.75, True)])
def test_no_shoe_cuts_the_face_of_its_pole(poles, arc, rounded):
    """A straight back from the tips of a wide shoe to a slender body would pass nearer to the axis than the face."""
    stator = {"stator.poles": poles, "stator.pole_arc": arc, "stator.tip_mm": 3.0, "stator.body_width_mm": 60.0}
    machine = build(families()["series-dc"], {**FEW["series-dc"], **stator})
    pole = next(part for part in machine.parts if part.name == "poles").prisms[0][0]
    shape = pole.to_polygon(ArcGrid([pole], 720))
    face, tips = (math.hypot(*pole.outer[i][:2]) for i in (0, 1))
    assert shape.is_valid
    assert shape.area == pytest.approx(pole.area, rel=1e-4)
    assert shapely.Point(0, 0).distance(shape) == pytest.approx(face, rel=1e-4)
    back = shapely.LineString([pole.outer[1][:2], *(v[:2] for v in pole.outer[2:4])])
    assert (len(pole.outer) > 8) == rounded
    assert shapely.Point(0, 0).distance(back) > (0.9 if rounded else 0.999) * tips
