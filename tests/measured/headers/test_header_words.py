"""What a header says by itself: its unit, the part, the quantity, and whether it was asked for or read."""

import pytest

from geom.description.roles import Role
from measured.headers.cells import number, split_unit, unit_of
from measured.headers.words import is_setpoint, quantities_of, roles_of, tokens


@pytest.mark.parametrize(
    ("header", "name", "unit"),
    [
        *(("T1 [°C]", "T1", "degC"), ("T_yoke / °C", "T_yoke", "degC"), ("P (kW)", "P", "kW"), ("t in s", "t", "s")),
        *(("Speed (1/min)", "Speed", "1/min"), ("speed_rpm", "speed", "rpm"), ("coil A1", "coil A1", "")),
        # ratios, spelled out or not
        *(("shaft_speed_rad_s", "shaft_speed", "rad/s"), ("Flow rate, l/min", "Flow rate", "l/min")),
        *(("flow_l_per_min", "flow", "l/min"), ("flow_litres_per_minute", "flow", "l/min")),
        *(("speed_metres_per_sec", "speed", "m/s"), ("Flow (liters/minute)", "Flow", "l/min")),
        *(("Torque [N.mm]", "Torque", "mN*m"), ("mdot_kg_h", "mdot", "kg/h"), ("t_s", "t", "s")),
        *(("Speed [r/s]", "Speed", "Hz"), ("I_U [Aef]", "I_U", "A")),
        *(("Частота вращения, об/мин", "Частота вращения", "rpm"), ("Мощность, кВт", "Мощность", "kW")),
        # the end of a name is no unit of time; a small letter is the unit of the quantity before it
        *(("Wicklung US", "Wicklung US", ""), ("I_sek", "I_sek", ""), ("T_wdg_min", "T_wdg_min", "")),
        *(("t_min", "t", "min"), ("loss_w", "loss", "W"), ("temp_c", "temp", "degC"), ("T_f", "T_f", "")),
        *(("T_coil_w", "T_coil_w", ""), ("kW Loss", "Loss", "kW"), ("ms today", "ms today", "")),
        ("Y[1] Frame", "Y[1] Frame", ""),  # a number in brackets is no unit but at the end
    ],
)
def test_a_header_and_its_unit(header, name, unit):
    assert split_unit(header) == (name, unit)


def test_words_that_are_units_and_tenths_that_are_none():
    assert (unit_of("分"), unit_of("h:min"), unit_of(split_unit("T_winding [0.1 degC]")[1])) == ("min", "", "")


NAMES = {  # of other shops, in their languages, without accents or with joints
    Role.WINDING: "stator_winding_temp; Nut 3; TEMP_STATOR_V1; 코일 온도; Ext T winding; Wicklungstemperatur",
    Role.IRON: "EM_StatorTemp; 铁芯温度; 鉄心温度; Stator",
    Role.COOLANT: "T_w_in; tCool_EmOut; T_VL; tRL_Pack; oil inlet; T_Ruecklauf",
    Role.HOUSING: "DB10.Temp_Carcaca; Temp_Gehause; Hölje; Korpus; frame DE; อุณหภูมิตัวถัง",
    Role.ROTOR: "T induit; EmTRtr_T",
    Role.BEARING: "fTempSpindleNut; T_lozysko; T_DE; Temp. NDE; T_AS; Rulman sıcaklığı; อุณหภูมิตลับลูกปืน",
    Role.END_SHIELD: "příruba; kolnierz",
    Role.SHAFT: "axle; T polea",
    Role.COMMUTATOR: "T escobillas",
    Role.AMBIENT: "teplota okolia; 실내 온도; airtemp; T ext; Umgebungstemp",
    Role.TEST_BED: "template",  # a plate, and no temperature
    None: "gearbox oil; Bain d'huile; Olie boven; temp de culasse",  # boven is no oven
}


@pytest.mark.parametrize(("role", "name"), [(role, name) for role, of in NAMES.items() for name in of.split("; ")])
def test_the_part_that_a_name_is_of(role, name):
    assert next(iter(roles_of(name)), None) is role
    assert name not in ("T_DE", "Temp. NDE", "T_AS", "frame DE") or roles_of(name) == [role]  # its end, no other part


@pytest.mark.parametrize(
    ("name", "quantity"),
    [
        *(("Vdot_fluid", ["water_flow"]), ("P1_Prad_silnika", ["current"]), ("冷却水流量", ["water_flow"])),
        *(("p_loss", ["power"]), ("p_in_bar", [])),
    ],
)
def test_quantities_without_accents_and_units(name, quantity):
    assert quantities_of(name) == quantity


@pytest.mark.parametrize(("name", "asked"), [("trqEM_Des", True), ("n_des [rpm]", True), ("T_des_bobines", False)])
def test_what_is_desired_is_asked_for(name, asked):
    assert is_setpoint(name) == asked


def test_german_letters_spelled_out_are_the_same_words():
    assert tokens("T_Kuehlkoerper") == tokens("T_Kühlkörper") == ("t", "heatsink")


@pytest.mark.parametrize(
    ("cell", "value"),
    [
        *(("1.234,5", 1234.5), ("1,234.5", 1234.5), ("1 234,5", 1234.5), ("1'234'567", 1234567.0), ("1.5", 1.5)),
        *(("1.234.567", 1234567.0), ("-12.345,25", -12345.25), ("1,5", 1.5), ("1,500", 1.5)),
    ],
)
def test_digits_in_threes(cell, value):
    assert number(cell) == value
