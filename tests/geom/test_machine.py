"""Machine files: what is right is read, what is wrong is refused in one message that says where."""

import pytest

from geom import InputError, library, load_machine
from geom.machine_file import families, machine_from


def series(**geometry):
    return {"machine": {"family": "series-dc"}, "geometry": geometry}


def like(name="series-dc-100kw", **header):
    return {"machine": {"like": name, **header}}


WRONG = {
    "like no machine that comes along": (like("steam"), ["like", "'steam'", "series-dc-100kw"]),
    "without what is not there": (like(without=["fans", "contacts.wheel"]), ["without", "'contacts.wheel'"]),
    "a key nobody knows": (series(rotor={"slot_count": 46}), ["slot_count", "slots", "[geometry.rotor]"]),
    "another unit": (series(housing={"fin_height_cm": 1.8}), ["fin_height_cm", "fin_height_mm"]),
    "a group nobody knows": (series(rotr={}), ["geometry.rotr", "rotor"]),
    "a family nobody knows": ({"machine": {"family": "steam"}}, ["steam", "series-dc"]),
    "a part nobody knows": (series() | {"materials": {"wheel": "steel"}}, ["wheel", "[materials]", "shaft"]),
    "a material nobody knows": (series() | {"materials": {"shaft": "cheese"}}, ["cheese", "steel"]),
    "text for a number": (series(rotor={"liner_mm": "thin"}), ["liner_mm", "thin", "0.05", "3"]),
    "half a slot": (series(rotor={"slots": 46.5}), ["slots", "46.5", "integer"]),
    "a negative air gap": (series(stator={"air_gap_mm": -1.0}), ["air_gap_mm", "-1.0", "0.3"]),
    "fins that overlap": (series(housing={"fins": 200, "fin_thickness_mm": 9.0}), ["fin_thickness_mm", "overlap"]),
    "a liner thicker than the slot": (
        series(rotor={"slot_width_mm": 4.0, "liner_mm": 2.5}),
        ["liner_mm", "2.5", "less than 1.6"],
    ),
    "a slot that reaches the shaft": (series(rotor={"slot_depth_mm": 110.0}), ["slot_depth_mm", "110"]),
    "coils in the yoke": (
        series(field={"coil_height_mm": 40.0}, stator={"yoke_inner_diameter_mm": 408.0}),
        ["yoke_inner_diameter_mm", "field coils"],
    ),
    "a base narrower than the feet": (series(base={"width_mm": 200.0}), ["base", "width_mm"]),
    "larger than its envelope": (
        series() | {"ratings": {"envelope_mm": [440, 500, 1155]}},
        ["envelope_mm", "width", "700"],
    ),
}


@pytest.mark.parametrize("case", WRONG)
def test_wrong_input_is_one_message_with_place_value_and_range(case):
    table, expected = WRONG[case]
    with pytest.raises(InputError) as caught:
        machine_from(table, "my.toml")
    message = str(caught.value)
    assert "my.toml" in message or case == "a material nobody knows"
    assert "\n" not in message
    for word in expected:
        assert word in message


def test_library_machines_load_and_carry_their_names():
    assert [load_machine(name).name for name in library()] == list(library())


def test_a_file_may_say_only_what_differs_from_a_machine_of_the_library():
    geometry = {"rotor": {"slots": 42}}
    mine = machine_from(like(without=["fans", 'contacts."rotor.core|shaft"']) | {"geometry": geometry}, "mine.toml")
    original = load_machine("series-dc-100kw")
    assert (mine.name, mine.geometry.rotor.slots) == ("mine", 42)
    assert mine.geometry.stator == original.geometry.stator
    contacts = {key: h for key, h in original.sections["contacts"].items() if key != "rotor.core|shaft"}
    expected = {**original.sections, "contacts": contacts}
    del expected["fans"]
    assert mine.sections == expected


def test_material_override_changes_only_that_part():
    machine = machine_from(series() | {"materials": {"housing": "steel"}})
    assert machine.part("housing").material == "steel"
    assert machine.part("flange.left").material == "aluminium-cast"


@pytest.mark.parametrize("family", families().values(), ids=lambda family: family.name)
def test_every_parameter_says_what_it_is_and_accepts_its_default(family):
    for parameter in family.parameters:
        assert parameter.doc, parameter.key
        parameter.checked(parameter.default, "test")
