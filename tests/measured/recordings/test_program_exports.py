"""Exports of programs: blocks of marks and set-ups over the data, devices under test, names of simulations."""

import json

import numpy as np
import pytest
from logger_formats import signals
from nptdms import ChannelObject, TdmsWriter
from scipy.io import savemat

from geom.errors import InputError
from measured.headers.cells import split_unit
from measured.importing.aligned import Recording
from measured.importing.case_files import read_runs
from measured.importing.guess import BY_READINGS, guesses, in_memory
from thermoscope.commands.test.new import first_model

S = signals(5.0)
T, W, H, A, J, N, M = (S[letter] for letter in "tWHAInM")


def read(tmp_path, text, name="a.csv"):
    """Column -> its guess, with the first network that is made of the file; and the recording."""
    (tmp_path / name).write_text(text)
    [(source, clock)] = read_runs(tmp_path / name)
    target = first_model([(source, clock)], {}).target
    return {g.column: g for g in guesses(source, clock.columns, target)}, source


def body(*columns, mark=""):
    return "".join(",".join(f"{mark}{v:.4g}{mark}" for v in row) + "\n" for row in zip(*columns, strict=True))


def goes(found):
    return {column: g.place or g.feeds for column, g in found.items() if g.used}


def test_marks_between_names_and_readings(tmp_path):
    head = '"#NAMES"\n"t [s]","Motor/TempEnrolamento","Ambiente/Temperatura","Inversor/Corrente_A"\n'
    head += '"#TYPES"\n"I","D","D","D"\n"#ROWS","90"\n'
    found, _ = read(tmp_path, head + body(T, W, A, J, mark='"'))
    assert [*goes(found).values()] == ["motor-enrolamento", "ambient", "current_A"]


def test_a_set_up_of_channels_as_wide_as_the_table_below_it(tmp_path):
    head = "Channel,Name,Scale,Gain,Offset\n" + "".join(f"{n},{w},Off,1,0\n" for n, w in enumerate(("U", "air", "L1")))
    head += "\nScan Control:\nScan,Time [s],T_winding (C),T_room (C),I (A)\n"
    found, source = read(tmp_path, head + body(np.arange(T.size), T, W, A, J))
    assert goes(found) == {"T_winding (C)": "winding", "T_room (C)": "ambient", "I (A)": "current_A"}
    assert source.rows == T.size


def test_a_break_with_remarks_early_in_a_table_costs_no_rows(tmp_path):
    rows = body(T, W, A, J).splitlines()
    text = ["t [s],T_winding [C],T_room [C],I [A]", *rows[:5], "pump", "by Lee", "and Kim", "then on", *rows[5:]]
    assert read(tmp_path, "\n".join(text))[1].numbers("I [A]").size >= T.size


@pytest.mark.parametrize(("units", "other"), [("s,degC,degC,degC,A\n", 0), ("", 0), ("", 2)])
def test_an_index_among_others_is_no_unit(tmp_path, units, other):
    found, _ = read(tmp_path, f"t,theta_w[{other}],theta_w[1],theta_amb,i_s\n{units}{body(T, W, W + 1, A, J)}")
    assert [found[f"theta_w[{n}]"].quantity for n in (other, 1)] == 2 * ["temperature"]


def test_turns_per_minute_behind_a_number_in_polish(tmp_path):
    lines = [f"t={t:.0f} ms, T_uzwojenie={w:.2f} C, T_otoczenie={a:.2f} C, n={n + 9:.0f} obr/min" for t, w, a, n in
             zip(1000 * T, W, A, N)]  # fmt: skip
    found, source = read(tmp_path, "\n".join(lines), "a.log")
    assert (found["n"].feeds, found["n"].unit) == ("speed_rpm", "rpm")
    assert source.numbers("n")[-1] == 1509


def test_rows_of_statistics_under_a_table_are_not_counted(tmp_path, capsys):
    from thermoscope.commands.test.new import Wishes, new_case

    text = f"t [s],T_winding [C],T_room [C],I [A]\n{body(T, W, A, J)}Mean,50,22,7\nMax,84,22.1,9\n"
    (tmp_path / "a.csv").write_text(text)
    document = tmp_path / "new.json"
    assert new_case([tmp_path / "a.csv"], Wishes(out=tmp_path / "case", yes=True), str(document)) == 0
    (test,) = json.loads(document.read_text())["tests"]
    assert [file["rows"] for file in test["files"]] == [T.size]


def test_a_sign_behind_the_last_name_and_readings_under_it(tmp_path):
    found, _ = read(tmp_path, "t [s],T_coil [degC],I [A],\n" + body(T, W, J, 100 + T))
    assert goes(found) == {"T_coil [degC]": "coil", "I [A]": "current_A"}


def test_remarks_behind_a_row_that_is_not_the_first(tmp_path):
    rows = body(T, W, J).splitlines()
    rows[1] += ",remark,1,2,3"
    found, source = read(tmp_path, "\n".join(["t [s],T_coil [degC],I [A]", *rows]) + "\n")
    assert goes(found) == {"T_coil [degC]": "coil", "I [A]": "current_A"}
    assert source.numbers("T_coil [degC]").size == T.size


def test_few_rows_of_fewer_cells_are_left_out_and_said(tmp_path):
    """The reading that is missing is not the last one: those behind it would stand under other names."""
    rows = body(T, W, H, J).splitlines()
    rows[40] = rows[40].rpartition(",")[0]
    _, source = read(tmp_path, "\n".join(["t [s],T_coil [degC],T_frame [degC],I [A]", *rows]) + "\n")
    assert source.notes[0].endswith(": 1 rows have fewer cells than the others: left out")
    assert np.isfinite(source.numbers("I [A]")).all()
    many = [row.rpartition(",")[0] if k % 2 else row for k, row in enumerate(rows)]  # its end is empty
    _, source = read(tmp_path, "\n".join(["t [s],T_coil [degC],T_frame [degC],I [A]", *many]) + "\n")
    assert source.numbers("T_coil [degC]").size == T.size


def test_names_without_a_blank_over_instants_with_several(tmp_path):
    names = ("motor_winding", "room_air", "supply_current")
    stamps = [f"2025-11-12 17:{k // 60:02d}:{k % 60:02d}.000 UTC" for k in range(T.size)]
    columns = zip(stamps, zip(W, A, J, strict=True), strict=True)
    rows = [f"{stamp},{n},{v:.12f}\n" for stamp, row in columns for n, v in zip(names, row, strict=True)]
    found, _ = read(tmp_path, "time,signal,value\n" + "".join(rows))
    assert [*goes(found).values()] == ["motor-winding", "ambient", "current_A"]


def test_channels_of_one_number_keep_it(tmp_path):
    names = "t [s],Mod1/ai0,Mod1/ai1,Mod2/ai0,Mod2/ai1,I [A]\n"
    found, _ = read(tmp_path, names + body(T, W, H, H + 1.0, W - 0.5, J))
    read_as = [g for name, g in found.items() if "/" in name]
    assert all(g.doubt.startswith(BY_READINGS) for g in read_as)
    assert len({g.place for g in read_as}) == 4


def test_numbered_columns_beside_one_that_reads_like_a_temperature(tmp_path):
    """The others jump, or hardly move, as sensors that are dipped or lie in the room."""
    dipped = np.where(np.arange(T.size) < 30, 22.1, 95.3)
    found, _ = read(
        tmp_path, "t [s],Sensor 1,Sensor 2,Sensor 3\n" + body(T, W, dipped, 22.0 + 0.1 * (np.arange(T.size) > 20))
    )
    assert {name: g.quantity for name, g in found.items()} == dict.fromkeys(found, "temperature")


def test_a_power_in_a_torques_unit_is_doubted(tmp_path):
    found, _ = read(tmp_path, "t [s],T_coil [degC],Torque [N.mm],Power [N.mm]\n" + body(T, W, J, 9 * J))
    assert found["Torque [N.mm]"].doubt == ""
    assert "a power" in found["Power [N.mm]"].doubt


def test_means_and_limits_over_the_readings_are_left_out_and_said(tmp_path):
    """A clock that runs back later is refused, as before."""
    rows = body(T, W, J).splitlines()
    text = ["t [s],T_coil [degC],I [A]", "0.1,25,3", "450,90,9", *rows]
    (tmp_path / "a.csv").write_text("\n".join(text) + "\n")
    [(source, clock)] = read_runs(tmp_path / "a.csv")
    assert source.numbers("T_coil [degC]")[np.isfinite(clock.seconds)] == pytest.approx(W, rel=1e-3)
    assert "2 rows over the clock's start are left out" in clock.doubt
    (tmp_path / "a.csv").write_text("\n".join([text[0], *rows[:5], "0.1,25,3", *rows[5:]]) + "\n")
    with pytest.raises(InputError, match="runs back"):
        read_runs(tmp_path / "a.csv")


def test_remarks_under_hours_and_minutes_do_not_make_them_minutes_and_seconds(tmp_path):
    rows = [f"{8 + k // 6}:{k % 6}0,{v:.1f},{i:.1f}" for k, (v, i) in enumerate(zip(W[:30], J))]
    text = "\n".join(["Time,T_coil [degC],I [A]", *rows, "Seen by: A. Nobody,,", "in Rome,,"])
    (tmp_path / "a.csv").write_text(text + "\n")
    [(_, clock)] = read_runs(tmp_path / "a.csv")
    assert clock.end_s == pytest.approx(29 * 600.0)


def test_quantities_and_units_under_the_names_of_parts(tmp_path):
    head = "Spot,Winding,Bearing,Housing,Ambient,Motor\nNo,1,2,3,4,5\n"
    head += "Time (s),Temp. (°C),Temp. (°C),Temp. (°C),Temp. (°C),Power (W)\n"
    found, source = read(tmp_path, head + body(T, W, S["B"], H, A, 9 * J))
    assert [*goes(found).values()] == ["winding", "bearing", "housing", "ambient", "power_W"]
    assert [*source.units.values()] == ["s", *4 * ["degC"], "W"]


def test_lines_over_a_table_say_what_its_channels_are(tmp_path):
    """With the kind of sensor behind a comma."""
    lines = ["# A1: Winding [°C], type K", "# A2: Lab air [°C], type T", "# A3: Losses [W], 0-10 V", "t [s],A1,A2,A3"]
    found, _ = read(tmp_path, "\n".join(lines) + "\n" + body(T, W, A, 9 * J))
    assert [g.quantity for g in found.values()] == ["temperature", "temperature", "power"]
    assert found["A2 Lab air [°C]"].place == "ambient"


def test_a_logged_line_with_its_instant_in_brackets(tmp_path):
    lines = [
        f"[2026-03-01 10:{k:02d}:00] INFO m: T_coil={w:.1f}C P_loss={9 * i:.1f}W"
        for k, (w, i) in enumerate(zip(W[:50], J))
    ]
    found, source = read(tmp_path, "\n".join(lines) + "\n", "a.log")
    assert goes(found) == {"T_coil": "coil", "P_loss": "power_W"}
    assert source.rows == 50


def test_a_unit_of_a_channel_by_any_name_and_instants_beside_it(tmp_path):
    with TdmsWriter(tmp_path / "a.tdms") as file:
        at = np.datetime64("2026-03-01T10:00:00") + (1e6 * T).astype("m8[us]")
        file.write_segment(
            [ChannelObject("g", "Time", at), ChannelObject("g", "Coil", W, properties={"Unit": "Deg C"})]
        )
    [(source, clock)] = read_runs(tmp_path / "a.tdms")
    assert (source.units["Coil"], source.notes, clock.end_s) == ("Deg C", (), pytest.approx(T[-1]))


def test_cells_in_powers_of_ten_have_their_units_too(tmp_path):
    lines = ["Time [s]\t0 Coil\t1 Air", *(f"{t:g}\t{w:+.5E} C\t{a:+.5E} C" for t, w, a in zip(T, W, A))]
    found, source = read(tmp_path, "\n".join(lines) + "\n", "a.txt")
    assert goes(found) == {"0 Coil": "0-coil", "1 Air": "ambient"}
    assert source.numbers("0 Coil") == pytest.approx(W, rel=1e-5)


def test_a_unit_may_stand_before_a_name_or_be_of_the_old_world(tmp_path):
    assert split_unit("kW Loss") == ("Loss", "kW")
    assert split_unit("ms today") == ("ms today", "")
    found, source = read(tmp_path, "t [s],T_coil [C],Heater (BTU/h)\n" + body(T, W, 3412.14 * J / 9))
    assert found["Heater (BTU/h)"].feeds == "power_W"
    assert in_memory(source, found["Heater (BTU/h)"]).max() == pytest.approx(1000.0, rel=1e-3)


def test_whole_numbers_between_blanks_are_no_frames(tmp_path):
    (tmp_path / "a.txt").write_text("".join(f"{5 * k} 22 {20 + k} 21 30 10\n" for k in range(30)))
    assert len(read_runs(tmp_path / "a.txt")[0][0].cells) == 6


def test_a_struct_of_units_beside_that_of_readings(tmp_path):
    units = {"T_coil": "degC", "T_lab": "degC", "n": "rpm", "time": "s"}
    savemat(tmp_path / "a.mat", {"data": {"time": T, "T_coil": W, "T_lab": A, "n": N}, "units": units})
    [(source, clock)] = read_runs(tmp_path / "a.mat")
    assert (clock.words, source.units) == ("numbers in s", units)


def test_a_few_rows_that_are_lost_are_no_end_of_a_test(tmp_path):
    """Of 30 s each; of ten it would be one."""
    lines = body(30.0 * np.arange(T.size), W, A, J).splitlines()
    for lost, whole in ((4, True), (20, False)):
        rows = [*lines[:40], *(f"{line.partition(',')[0]},,," for line in lines[40 : 40 + lost]), *lines[40 + lost :]]
        (tmp_path / "a.csv").write_text("\n".join(["t [s],T coil [C],T air [C],I [A]", *rows]) + "\n")
        [(source, clock)] = read_runs(tmp_path / "a.csv")
        every = guesses(source, clock.columns, first_model([(source, clock)], {}).target)
        assert (Recording(source, clock, every).gap_s >= 30.0 * (lost + 1)) == whole
