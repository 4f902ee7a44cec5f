"""Recordings of strangers, from the file to the comparison: what is left out is said first, a bad column costs one."""

import json
import tomllib
from dataclasses import replace
from datetime import UTC, datetime, time, timedelta
from pathlib import Path

import numpy as np
import pytest
from logger_formats import signals, workbook

from geom.errors import InputError
from measured.importing.aligned import Recording, longest_part
from measured.importing.case_files import read_runs
from measured.importing.clock import Clock, clock_of, in_time_order
from measured.importing.guess import guesses
from measured.importing.source import Source, read_source
from measured.importing.target import Target
from measured.recordings.formats import read_recording
from thermoscope.case_folder.folder import load_case
from thermoscope.commands.test.compare import compare as compare_command
from thermoscope.commands.test.new import Wishes, first_model, new_case as new, places
from thermoscope.console.summary import limited_lines
from validation.comparison.compare import compare

S = signals(5.0)
S["K"], S["F"], S["x"] = S["W"] + 273.15, 32 + 1.8 * S["W"], np.where(S["t"] == 50, -400.0, S["W"])
NAMES = ("Winding U", "Ambient", "Current")


def table(header, *columns, sep=","):
    """Text of columns under their names."""
    cells = [[c] * len(S["t"]) if isinstance(c, str) else [f"{v:.2f}" for v in c] for c in columns]
    return "\n".join([header, *(sep.join(row) for row in zip(*cells))]) + "\n"


def of(header, letters="tWHAI", sep=","):
    return table(header, *(S[c] for c in letters), sep=sep)


def written(tmp_path, text, **wishes):
    """The case that is made without a question, and its document."""
    (tmp_path / "a.csv").write_text(text)
    out, document = tmp_path / "made", tmp_path / "new.json"
    assert new([tmp_path / "a.csv"], Wishes(out=out, yes=True, **wishes), str(document)) == 0
    return load_case(out), json.loads(document.read_text())


def test_a_winding_that_was_left_out_stands_in_the_first_line(tmp_path, capsys):
    """A network without a winding; --place puts it where it belongs."""
    model = tmp_path / "network.toml"
    model.write_text(
        '[network]\nname = "n"\nboundaries = ["ambient"]\n[nodes.frame]\nC_J_K = 900\n[nodes.head]\nC_J_K = 300\n'
        '[links.a]\nbetween = ["frame", "ambient"]\nG_W_K = 2\n[links.b]\nbetween = ["head", "frame"]\nG_W_K = 5\n'
        '[losses.heat]\nkind = "constant"\nat = "head"\nP_W = 50\nof = { input = "current_A", at = 9, exponent = 2 }\n'
    )
    text = of("t [s],I [A],T_Wickl_U,frame [°C],room [°C]", "tIWHA")
    _, document = written(tmp_path, text, network=model)
    first = " ".join(capsys.readouterr().out.split())
    assert first.startswith("The winding was not placed: 'T_Wickl_U' looks like winding; --place T_Wickl_U=PLACE")
    assert document["warnings"]
    (tmp_path / "made").rename(tmp_path / "before")
    folder, document = written(tmp_path, text, network=model, places=places(["T_Wickl_U=head"]))
    assert {c.name: c.place for c in folder.case.tests[0].channels} == {"T_Wickl_U": "head", "frame [°C]": "frame"}
    assert document["warnings"] == []


def test_a_place_without_a_column_is_refused_with_its_neighbour(tmp_path):
    with pytest.raises(InputError, match=r"no column 'T_Wikl_U'.*did you mean 'T_Wickl_U'"):
        written(tmp_path, of("t [s],I [A],T_Wickl_U", "tIW"), places={"T_Wikl_U": "winding"})
    with pytest.raises(InputError, match="not of the form COLUMN=PLACE"):
        places(["T_Wickl_U"])


RANGE = range(90)
REFUSED = {
    "rises alone": (
        table("t in s,Übertemperatur Wicklung in K,I in A", S["t"], S["W"] - 22, S["I"]),
        "'Übertemperatur Wicklung in K' is left out: a difference of temperatures",
    ),
    "a room and the instrument": (
        of("t [s],Room temp [C],Internal temp [C],I [A]", "tAWI"),
        r"no column is a temperature.*'Internal temp \[C\]' is left out: of the inst",
    ),
    "a cryostat": (
        table("t [s],T [K],sigma_T [K]", S["t"], 0.02 + S["t"] / 1e6, S["t"] / 1e6),
        r"'T \[K\]' is left out: -27\d.* as temperature cannot be right",
    ),
    "millikelvins": (
        table("t [s],MXC [mK],Still [mK]", S["t"], S["W"], 700 + S["W"]),
        r"'MXC \[mK\]' is left out: -273.* as temperature cannot be right",
    ),
    "names that nobody understood": (
        table("t [s],QX,QY", S["t"], 1000 + S["W"], 900 * S["I"]),
        "'QX', 'QY': neither name nor unit.*--place QX=PLACE",
    ),
    "percents without a name": (
        "".join(f"{29 + k // 9}%,{885 + k}000,{1598098561 + 60 * k}\n" for k in RANGE),
        "no column is a temperature",
    ),
    "rows that are days apart": (
        "date,T_winding [C]\n" + "".join(f"2026-03-{1 + 2 * k:02d},{60 + k}\n" for k in range(12)),
        "172800 s apart, too far",
    ),
    "instants alone before whole numbers": (
        "".join(f"28.03.2026 10:00:{k:02d} {89 - 8 * (k > 2)} {93 - 10 * (k > 2)}\n" for k in range(7)),
        "neither name nor unit",
    ),
    # whether the first column has no name, or a comma stands in a number, nobody can tell
    "a number more than names, first": (
        "t [s],T_coil [C],T_amb [C],I [A]\n" + "".join(f"{3 * k + 7},{5 * k},{20 + k},22,3\n" for k in range(9)),
        "5 values under 4 names",
    ),
    "a number more than names": (
        "t [s],T_coil [C],T_amb [C],I [A]\n" + "".join(f"{5 * k},{20 + k},5,22,3\n" for k in range(9)),
        "5 values under 4 names",
    ),
    "a clock that was set back": (
        "t [s],T_coil [C]\n" + "".join(f"{6 * k - 400 * (k > 60)},{20 + k}\n" for k in range(120)),
        "runs back by 394 s in row 62",
    ),
    "a clock that turns over": ("t [s],T_coil [C]\n" + "".join(f"{2 * k % 60},{20 + k}\n" for k in RANGE), "runs back"),
    "seconds since 1970 without a name that run back": (
        "".join(f"{1692576000 + 3600 * (k % 30)},tank,Tank {k},{20 + k}\n" for k in RANGE),
        "the clock runs back",
    ),
    "frames of a bus": (
        "".join(f"{k + 1:5d} {20 * k}.013 DT 0181 Rx - 8 1A 0{k} FF 00 2C 00 7B 00\n" for k in range(9)),
        "frames of a bus",
    ),
    "a package": ("PK\3\4\0\0", "is packed, as a spreadsheet .ods"),
}


@pytest.mark.parametrize("kind", REFUSED)
def test_what_is_no_recording_of_a_machine_is_refused_by_what_it_is(tmp_path, kind):
    content, words = REFUSED[kind]
    with pytest.raises(InputError, match=words):
        written(tmp_path, content)


@pytest.mark.parametrize(
    ("header", "columns", "words"),
    [
        ("t [s],T_winding [°C],room [°C]", "tWA", "No column says what heats it."),
        ("t [s],Heat flow [kJ],T_winding [°C],room [°C]", "tPWA", "The only heat was left out: 'Heat flow"),
        ("I [A],T_winding [°C],room [°C]", "IWA", "No time column: rows 1 s apart are assumed (--period SECONDS)."),
        ("Time,T_winding [°C],I [A]", "tWI", "No unit of 'Time': seconds are assumed, 5 s from row to row."),
        ("t [s],I [A],T_winding [°C],T_CELL [°C]", "tIWA", "'T_CELL [°C]': hardly warms: taken as the room."),
        ("t [s],I [A],T1 [°C],TC 2 [°C]", "tIWH", "'TC 2 [°C]': place by its number only; --place"),
        ("t [s],I [A],Ch 1 [°C],room [°C]", "tIWA", "'Ch 1 [°C]': place by its number only; --place"),
        (
            "t [s],Current [% of nominal],T_winding [°C]",
            "tIW",
            "'Current [% of nominal]': relative to a nominal current",
        ),
        (
            "t [s],I [A],T_winding [°C],T_room [°C]",
            "tIKK",
            "'T_winding [°C]': degC in its header, but K by its values.",
        ),
        ("t [s],Torque [%],T_winding [°C]", "tMW", "'Torque [%]': relative to a nominal torque that is not given: a"),
        ("t [s],Current [p.u.],T_winding [°C]", "tIW", "The only heat was left out: 'Current [p.u.]'"),
        ("t [s],Current (x!),T_winding [°C]", "tIW", "'Current (x!)': unit 'x!' unknown: A assumed."),
        (
            "t [s],I [A],T_winding [V],frame [°C]",
            "tIWH",
            "The winding was not placed: 'T_winding [V]' looks like winding",
        ),
        ("t [s],I [A],T_Lager_AS [°C],room [°C]", "tIBA", "No winding is measured."),
        (
            "t [s],I [A],Tmotor [°C],T_case [°C]",
            "tIxH",
            "'Tmotor [°C]' is left out: -400 as temperature cannot be right",
        ),
        ("t [s],temperature,current", "tFI", "'temperature': or degF, by its values"),
    ],
)
def test_what_is_missing_stands_in_the_first_line(tmp_path, header, columns, words, capsys):
    written(tmp_path, of(header, columns))
    assert words in " ".join(capsys.readouterr().out.split()).partition(": 1 test")[0]


def test_a_comparison_repeats_the_doubts_until_they_leave_the_case(tmp_path, capsys):
    folder, _ = written(tmp_path, of("t [s],I,T_winding [°C],T_room [°C]", "tIWA"))
    case = folder.settings.path / "case.toml"
    assert capsys.readouterr().out.startswith(doubt := "No unit: 'I' is taken in A.")
    compare_command(str(case.parent), None)
    assert capsys.readouterr().out.startswith(doubt)
    case.write_text("\n".join(line for line in case.read_text().splitlines() if not line.startswith("guesses")))
    compare_command(str(case.parent), None)
    assert doubt not in capsys.readouterr().out


def test_a_machine_judged_by_its_bearing_alone_is_said_by_every_comparison(tmp_path, capsys):
    folder, _ = written(tmp_path, of("t [s],I [A],T_Lager [°C],T_room [°C]", "tIBA"))
    capsys.readouterr()
    compare_command(str(folder.settings.path), None)
    assert "is measured at lager alone" in " ".join(capsys.readouterr().out.split())[:60]
    assert any("measured at lager alone: no reading says how warm the winding is" in note for note in folder.notes)
    with_winding, _ = written(
        (tmp_path / "b").mkdir() or tmp_path / "b", of("t [s],I [A],T_Lager [°C],T_Wicklung [°C]", "tIBW")
    )
    assert not any("alone" in note for note in with_winding.notes)


def test_the_table_of_guesses_keeps_its_doubts_whole_at_80_columns(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)  # a long folder is not part of the table
    written(
        Path(),
        table(
            "t [s],I [A],T_winding [°C],a long name of some angle [rad],c state", S["t"], S["I"], S["W"], S["A"], "3"
        ),
    )
    out = capsys.readouterr().out
    assert max(map(len, out.splitlines())) <= 80
    assert "…" not in out
    assert "its unit 'rad' is of nothing a model reads" in " ".join(out.split())


def test_a_code_makes_no_first_network_of_its_own(tmp_path):
    """One 9999 in a temperature: the capacity is that of the record without it."""
    sizes = []
    for name, winding in (("plain", S["W"]), ("coded", np.where(S["t"] == 250.0, 9999.0, S["W"]))):
        (tmp_path / name).mkdir()
        folder, _ = written(tmp_path / name, table("t [s],I [A],T_winding [°C]", S["t"], S["I"], winding))
        network = tomllib.loads((tmp_path / name / "made" / "network.toml").read_text())
        sizes.append(network["nodes"]["winding"]["C_J_K"])
        assert np.isfinite(compare(folder.case).rmse_K)
    assert sizes[1] == pytest.approx(sizes[0], rel=0.02)


def test_codes_are_codes_of_temperatures_only(tmp_path):
    """A plateau of 1370 rpm is a speed."""
    speed = np.where(S["t"] < 100.0, 0.0, 1370.0)
    folder, _ = written(tmp_path, table("t [s],n [rpm],I [A],T_winding [°C]", S["t"], speed, S["I"], S["W"]))
    assert folder.case.tests[0].inputs["speed_rpm"].max() == 1370.0


@pytest.mark.parametrize("bad", ["1e30", "abc", "", "-5e7"])
def test_one_bad_column_costs_one_column(tmp_path, bad):
    """A temperature that cannot be one is left out and said; the rest is compared."""
    text = table("t [s],I [A],T_winding [°C],T_coil [°C],T_room [°C]", S["t"], S["I"], S["W"], bad, S["A"])
    folder, document = written(tmp_path, text)
    columns = {c["column"]: c for c in document["tests"][0]["columns"]}
    assert [c.name for c in folder.case.tests[0].channels] == ["T_winding [°C]"]
    assert columns["T_coil [°C]"]["doubt"]


@pytest.mark.parametrize(("factor", "offset", "unit"), [(1.0, 273.15, "kelvin"), (1.8, 32.0, "Fahrenheit")])
def test_all_temperatures_in_another_unit_are_seen_by_the_doctor(tmp_path, factor, offset, unit):
    from thermoscope.case_folder.doctor import examined
    from thermoscope.case_folder.folder import patient_of

    folder, _ = written(tmp_path, of("t [s],I [A],T_winding [°C],T_room [°C]", "tIWA"))
    network = folder.case.model.network
    found = lambda: [f.what for f in examined([patient_of(folder.settings.tests[0])], network)]  # noqa: E731
    assert not any(unit in what for what in found())
    file = tmp_path / "made" / "tests" / "a.csv"
    file.write_text(
        table(
            "time_s,I [A],T_winding [°C],T_room [°C]",
            S["t"],
            S["I"],
            S["W"] * factor + offset,
            S["A"] * factor + offset,
        )
    )
    assert any(unit in what for what in found())


def test_two_doubts_of_one_file_are_both_said(tmp_path, capsys):
    """An unclosed quotation mark, and rows that share their minute."""
    stamps = [f"12:{i // 12:02d}" for i in range(len(S["t"]))]
    rows = "\n".join(
        f"{s},{i:.1f},{w:.2f},{'x' if k != 30 else chr(34) + 'fan'}"
        for k, (s, i, w) in enumerate(zip(stamps, S["I"], S["W"]))
    )
    written(tmp_path, f"Time,I [A],T_winding [°C],note\n{rows}\n")
    out = " ".join(capsys.readouterr().out.split())
    assert "a quotation mark in line 32 has no partner" in out
    assert "12 rows share each time" in out


def test_formulas_without_values_are_said(tmp_path):
    rows = [["t [s]", "T_winding [°C]", "I [A]"], *([k, 20.0 + k, f"=B{k + 2}*2"] for k in range(20))]
    notes = read_source(workbook(tmp_path / "a.xlsx", Sheet=rows)).notes
    assert any("20 formulas have no value" in note for note in notes)


def test_times_of_workbooks(tmp_path):
    """Spans and times of the day as cells have them."""
    for cell, step_s in ((lambda k: timedelta(seconds=90 * k), 90.0), (lambda k: time(10, k, 30), 60.0)):
        rows = [["Time", "T_winding [°C]", "I [A]"], *([cell(k), 20.0 + k, 5.0] for k in range(20))]
        source = read_source(workbook(tmp_path / "a.xlsx", Sheet=rows))
        assert np.diff(clock_of(source).seconds) == pytest.approx(step_s)


def test_channels_of_a_tdms_without_increments_have_the_times_of_their_channel(tmp_path):
    """Instants in a channel are its clock; without any that rows are 1 s apart is said."""
    from nptdms import ChannelObject, TdmsWriter

    instants = np.datetime64("2026-03-28T12:00:10") + np.arange(30) * np.timedelta64(5, "s")
    for name, channels in (("with", {"Time": instants}), ("without", {})):
        with TdmsWriter(tmp_path / f"{name}.tdms") as file:
            channels = {**channels, "Wicklung": np.arange(30.0), "Strom": np.ones(30)}
            file.write_segment([ChannelObject("Log", n, v) for n, v in channels.items()])
    source = read_source(tmp_path / "with.tdms")
    assert np.diff(clock_of(source).seconds) == pytest.approx(5.0)
    assert any("rows are taken as 1 s apart" in note for note in read_source(tmp_path / "without.tdms").notes)


def test_channels_of_a_tdms_are_what_their_descriptions_say(tmp_path):
    from nptdms import ChannelObject, TdmsWriter

    with TdmsWriter(tmp_path / "a.tdms") as out:
        out.write_segment(
            [
                ChannelObject("g", name, S[c], {"wf_increment": 5.0, "unit_string": unit, "description": what})
                for name, c, unit, what in (
                    ("ai0", "W", "°C", "Winding U"),
                    ("ai1", "A", "°C", "Room"),
                    ("ai2", "I", "A", ""),
                )
            ]
        )
    source = read_source(tmp_path / "a.tdms")
    assert source.labels == {"time_s": "time", "ai0": "Winding U", "ai1": "Room", "ai2": "ai2"}


def test_a_negative_increment_of_a_waveform_is_refused(tmp_path):
    from nptdms import ChannelObject, TdmsWriter

    with TdmsWriter(tmp_path / "a.tdms") as file:
        file.write_segment([ChannelObject("Log", "T", np.arange(9.0), properties={"wf_increment": -0.1})])
    with pytest.raises(InputError, match=r"channel 'T': its wf_increment is -0\.1 s"):
        read_recording(tmp_path / "a.tdms")


def test_published_recordings_of_a_cell_and_a_house(root, tmp_path):
    """Of others, where they lie beside the project: thermocouples without a header, and four letters for a house."""
    data = root.parent / "shared" / "data"
    if not data.is_dir():
        pytest.skip("the data of others are not here")
    cell, house = tmp_path / "cell", tmp_path / "house"
    files = [data / "leaf-cell/temperature-3c.lvm", data / "leaf-cell/cycler-3c.csv"]
    with limited_lines(None):
        assert new(files, Wishes(out=cell, yes=True), None) == 0
        assert new([data / "house/demo_data.csv"], Wishes(out=house, yes=True), None) == 0
    (test,) = load_case(cell).case.tests
    assert [c.y[0] for c in test.channels] == pytest.approx([24.9, 25.2, 24.7, 25.0], abs=0.6)
    assert abs(test.inputs["current_A"][len(test.time) // 2]) == pytest.approx(91.8, abs=0.1)
    (test,) = load_case(house).case.tests
    assert {c.name for c in test.channels} == {"Ti", "Th"}
    assert test.boundaries["ambient"][0] == pytest.approx(5.4, abs=0.5)
    assert test.inputs["power_W"].max() > 90.0


LONG = {
    "VarName;TimeString;VarValue;Validity;Time_ms": lambda n, k, v: (
        f'"{n}";"28.03.2026 12:{k // 12:02d}:{5 * k % 60:02d}";{v:.2f};1;{46109500.0 + 5 * k:.1f}'.replace(
            ".", ","
        ).replace("28,03,", "28.03.")
    ),
    ",result,table,_time,_value,_field": lambda n, k, v: (
        f",,0,2026-03-28T12:{k // 12:02d}:{5 * k % 60:02d}Z,{v:.2f},{n}"
    ),
    "time_s,sensor,reading": lambda n, k, v: f"{5 * k},{n},{v:.2f}",
    "Channel,Label,Function\n101,Temp_Winding,Temperature\n\nChannel,Label,Reading,Status,time_s": lambda n, k, v: (
        f"{100 + len(n)},{n},{v:.6E},0,{5 * k}"
    ),
    "SECONDS;PID;MEDIDA": lambda n, k, v: f'"{5 * k}";"{n}";"{v:.2f}";',  # words that nobody knows
    "": lambda n, k, v: f"2026-03-28T12:{k // 12:02d}:{5 * k % 60:02d}+0200 {n} {v:.2f}",
}


@pytest.mark.parametrize("header", LONG)
@pytest.mark.parametrize("in_turn", [True, False])
def test_a_row_for_every_reading_becomes_a_column_for_every_signal(tmp_path, header, in_turn):
    signs = {"Temp_Winding": S["W"], "Temp_ambient": S["A"], "Current": S["I"]}
    rows = [(k, LONG[header](name, k, v[k])) for name, v in signs.items() for k in range(len(S["t"]))]
    text = "\n".join([header, *(row for _, row in (sorted(rows, key=lambda r: r[0]) if in_turn else rows))])
    (tmp_path / "a.csv").write_text(text + "\n")
    source = read_source(tmp_path / "a.csv")
    assert clock_of(source).seconds == pytest.approx(S["t"], abs=1e-3)
    for name, values in signs.items():
        assert source.numbers(name) == pytest.approx(values, abs=0.006)


@pytest.mark.parametrize("stamp", [lambda s: f"{s}", lambda s: f"2026-03-28T12:{s // 60:02d}:{s % 60:02d}.500Z"])
def test_signals_with_times_of_their_own_hold_until_the_next(tmp_path, stamp):
    """As homes log what changes: a current with two changes in all is a step, no ramp."""
    rows = [f"{stamp(5 * k)},T_winding,{20 + k}" for k in range(30)]
    rows += [f"{stamp(s)},I_motor,{value}" for s, value in ((1, 0), (51, 9), (121, 2))]
    (tmp_path / "a.csv").write_text("\n".join(["time,sensor,value", *rows]) + "\n")
    source = read_source(tmp_path / "a.csv")
    assert "each at its own times; all but temperatures of parts hold until the next reading" in " ".join(source.notes)
    t, current = clock_of(source).seconds, source.numbers("I_motor")
    assert t[[0, 1, 2, -1]] == pytest.approx([0, 1, 5, 145])
    assert np.array_equal(current[1:], np.select([t[1:] < 51, t[1:] < 121], [0.0, 9.0], 2.0))


def test_the_least_of_a_reading_is_no_clock_beside_one(tmp_path):
    parts = (("T_winding", S["W"]), ("T_room", S["A"]))
    rows = [f"{t},{name},{v[k]:.2f},{v[k] - 1:.2f}" for k, t in enumerate(S["t"]) for name, v in parts]
    (tmp_path / "a.csv").write_text("\n".join(["time_s,sensor,value,min", *rows]) + "\n")
    source = read_source(tmp_path / "a.csv")
    assert [*source.cells] == ["time_s", "T_winding", "T_room"]
    assert clock_of(source).seconds == pytest.approx(S["t"])


def test_a_second_file_says_what_numbers_and_short_names_mean(tmp_path):
    """A table of sensors beside their readings; a list of columns beside them."""
    rows = [f"{k},{n},{v[k]:.2f}" for k in range(len(S["t"])) for n, v in ((1, S["W"]), (2, S["A"]), (3, S["I"]))]
    (tmp_path / "a.csv").write_text("\n".join(["time_s,sensor_id,value", *rows]) + "\n")
    (tmp_path / "b.csv").write_text("sensor_id,at,unit\n1,stator winding,degC\n2,room air,degC\n3,current,A\n")
    columns = (S["t"], S["W"], S["W"] + 1, S["A"], S["I"])
    (tmp_path / "c.csv").write_text(table("Date_s;Wt_avg;Wt_max;Ot_avg;Ia_avg", *columns, sep=";"))
    (tmp_path / "d.csv").write_text("Wt;Winding_temperature;deg_C\nOt;Outdoor_temperature;deg_C\nIa;Current;A\n")
    for names in ("ab", "cd"):
        ((source, clock),) = read_runs(*(tmp_path / f"{name}.csv" for name in names))
        found = guesses(source, clock.columns, first_model([(source, clock)], {}).target)
        hot, *rest, heats = [g for g in found if g.used]
        assert (hot.quantity, *(g.place for g in rest), heats.feeds) == ("temperature", "ambient", "current_A")
        assert f"{names[1]}.csv says what columns are" in source.notes


def test_two_recorders_of_one_input_are_one_input(tmp_path, capsys):
    for name, more in (("a", "I [A],room [°C],T_winding"), ("b", "Current [A],T_frame [°C],T_cover [°C]")):
        (tmp_path / f"{name}.csv").write_text(of(f"time_s,{more}", "tIAW"))
    out, document = tmp_path / "made", tmp_path / "new.json"
    assert new([tmp_path / "a.csv", tmp_path / "b.csv"], Wishes(out=out, yes=True), str(document)) == 0
    (test,) = json.loads(document.read_text())["tests"]
    assert {c["doubt"] for c in test["columns"] if "already" in c["doubt"]} >= {
        "'I [A]' of a.csv gives current_A already"
    }


def test_rows_out_of_order_are_sorted_where_that_makes_an_even_clock(tmp_path):
    """Databases write the newest first; numbers that fall may count down, and a clock that starts anew is two tests."""
    stamps = [f"2026-03-28 12:{k // 60:02d}:{k % 60:02d}" for k in range(90)]
    for times, right in ((stamps[::-1], True), ([*range(90)][::-1], False), ([*range(45)] * 2, False)):
        rows = [f"{t},{20 + k},5" for k, t in enumerate(times)]
        (tmp_path / "a.csv").write_text("\n".join(["time,T_winding,I [A]", *rows]) + "\n")
        source = in_time_order(read_source(tmp_path / "a.csv"))
        assert ("sorted by time" in " ".join(source.notes)) == right
        if right:
            assert clock_of(source).seconds == pytest.approx(np.arange(90.0))
            assert source.numbers("T_winding")[0] == 109


@pytest.mark.parametrize(
    ("header", "encoding"), [("권선온도(℃),주위온도(℃),전류(A)", "utf-8"), ("Обмотка °C,Воздух °C,Ток [A]", "cp1251")]
)
def test_words_of_any_script_are_words(tmp_path, header, encoding):
    """Two headers without a letter that is known would be one place."""
    rows = [f"2026-03-28 12:{k // 60:02d}:{k % 60:02d},{20 + k},21,5" for k in range(90)]
    (tmp_path / "a.csv").write_text("\n".join([f"time,{header}", *rows]) + "\n", encoding)
    source = read_source(tmp_path / "a.csv")
    found = {
        g.place or g.feeds for g in guesses(source, ("time",), first_model([(source, clock_of(source))], {}).target)
    }
    assert {"ambient", "current_A"} < found
    assert len(found) == 3


def test_tenths_of_degrees_are_no_kelvin(tmp_path, capsys):
    """Nor is a unit with a number in it left to guesses."""
    written(tmp_path, table("t [s],T_winding,T_housing", S["t"], 10 * S["W"], 10 * S["W"] + 1))
    assert "'T_winding', 'T_housing': is it in other units?" in capsys.readouterr().out.replace("\n", " ")
    (tmp_path / "b.csv").write_text(of("t [s],T_winding [0.1°C],T_b [x10 °C]", "tWW"))
    source = read_source(tmp_path / "b.csv")
    assert source.notes == ("b.csv: 'T_winding [0.1°C]' is read in units of 0.1 °C",)
    assert "T_b" in source.labels["T_b [x10 °C]"]


def test_channels_are_called_what_their_settings_call_them(tmp_path):
    """Ranges of channels look like readings, and stand in a table of their own before the header."""
    head = ["CH,Name,Input,Filter,Span", *(f'CH{k},{n},TEMP,Off,"-100","1370"' for k, n in enumerate(NAMES, 1))]
    rows = [f"{k},2026/03/28 12:{k // 60:02d}:{k % 60:02d},000,{20 + k},21,5,LLLL" for k in range(90)]
    text = [*head, "Data", "Number,Date&Time,ms,CH1,CH2,CH3,Alarm", "NO.,Time,ms,degC,degC,A,A1234", *rows]
    (tmp_path / "a.csv").write_text("\n".join(text) + "\n")
    source = read_source(tmp_path / "a.csv")
    assert [f"CH{k} {n}" for k, n in enumerate(NAMES, 1)] == [*source.cells][3:6]
    assert source.units["CH3 Current"] == "A"
    assert np.ptp(clock_of(source).seconds) == 89


def test_the_same_clock_beside_every_signal_is_the_clock(tmp_path):
    rows = [f"{500 * k}\t{20 + k}\t{500 * k}\t{k}" for k in range(90)]
    (tmp_path / "a.txt").write_text("\n".join(["Name\tT_winding\tName\tcurrent", *rows]) + "\n")
    clock = clock_of(read_source(tmp_path / "a.txt"))
    assert clock.seconds == pytest.approx(0.5 * np.arange(90.0))
    assert "ms are assumed" in clock.doubt


@pytest.mark.parametrize("stamp", [lambda s: f"{s}", lambda s: f"28.03.2026 12:{s // 60:02d}:{s % 60:02d}"])
def test_clocks_that_differ_are_each_their_own_signals(tmp_path, stamp):
    """Of one rate they would be one clock; the room is read half as often, and its recorder goes on for longer."""
    rows = [f"{stamp(5 * k)};{20 + k};{stamp(10 * k)};{50 - k}" for k in range(60)]
    (tmp_path / "a.csv").write_text("\n".join(["Time;T_winding [°C];Time;T_room [°C]", *rows]) + "\n")
    [(source, clock)] = read_runs(tmp_path / "a.csv")
    read = source.numbers("T_room [°C]")
    assert clock.end_s == 295.0  # where the first of them ends
    assert clock.seconds[np.isfinite(read)] == pytest.approx(np.arange(0.0, 295.0, 10.0))
    assert read[np.isfinite(read)] == pytest.approx(50 - np.arange(30.0))
    assert "each of 2 signals has a clock of its own" in " ".join(source.notes)


def test_a_row_for_every_reading_in_a_parquet_file(tmp_path):
    import pyarrow
    from pyarrow.parquet import write_table

    stamps = np.datetime64("2026-03-17T14:22:35") + np.arange(30) * np.timedelta64(10, "s")
    tags = np.repeat(["T_winding", "T_room", "current"], 30)
    columns = {"ts": np.tile(stamps, 3), "tag": tags, "value": np.arange(90.0)}
    write_table(pyarrow.table(columns), tmp_path / "a.parquet")
    [(source, clock)] = read_runs(tmp_path / "a.parquet")
    assert clock.seconds == pytest.approx(10.0 * np.arange(30))
    assert source.numbers("T_room") == pytest.approx(30.0 + np.arange(30))


def test_signals_of_matlab_that_are_named_in_their_structs(tmp_path):
    from scipy.io import savemat

    signals = [("T_winding", "°C", S["W"]), ("T_amb", "°C", S["A"]), ("i_rms", "A", S["I"])]
    kinds = [("Name", "O"), ("Unit", "O"), ("Data", "O")]
    X, Y = np.array([("", "s", S["t"])], kinds), np.array(signals, kinds)
    savemat(tmp_path / "a.mat", {"rec": {"X": X, "Y": Y, "Description": "run"}})
    source = read_source(tmp_path / "a.mat")
    assert list(source.cells) == ["X [s]", "T_winding [°C]", "T_amb [°C]", "i_rms [A]"]
    assert clock_of(source).seconds == pytest.approx(S["t"])
    savemat(tmp_path / "c.mat", {"m": {"T_coil": {"Time": S["t"], "Data": S["W"], "Unit": "degC"}}})
    assert clock_of(read_source(tmp_path / "c.mat")).seconds == pytest.approx(S["t"])
    names = np.array(["t_s", "T_coil"], object)
    savemat(tmp_path / "b.mat", {"data": np.column_stack([S["t"], S["W"]]), "names": names})
    assert list(read_source(tmp_path / "b.mat").cells) == ["t_s", "T_coil"]


def test_vectors_in_structs_of_matlab(tmp_path):
    from scipy.io import savemat

    signals = [{"values": 20.0 + np.arange(90), "label": "T_winding"}, {"values": np.full(90, 5.0), "label": "I_rms"}]
    savemat(tmp_path / "a.mat", {"run": {"time": np.arange(90.0), "signals": signals}, "n": np.arange(4.0)})
    source = read_source(tmp_path / "a.mat")
    assert [*source.cells] == ["time", "T_winding", "I_rms"]
    assert clock_of(source).end_s == 89
    assert "left out for their length: n" in " ".join(source.notes)
    savemat(tmp_path / "a.mat", {"zeros": np.zeros(2 * 10**7)}, do_compression=True)
    with pytest.raises(InputError, match="holds 20,000,000 rows"):
        read_source(tmp_path / "a.mat")


def test_of_a_recording_with_a_gap_the_longest_part_is_the_test():
    t = np.concatenate([np.arange(0.0, 1000.0, 5.0), np.arange(2200.0, 3600.0, 5.0)])
    record = Recording(Source({}, file=Path("a.csv")), Clock(t, None, (), ""), [])
    window, notes = longest_part(record, 120.0)
    assert window == (2200.0, 3595.0)
    assert "no rows of a.csv from 995 s to 2200 s" in notes[0]
    hourly = replace(record, clock=Clock(3600.0 * np.arange(9), None, (), ""))
    assert longest_part(hourly, 120.0) == ((0.0, None), ())


S["f"] = 1.0 + np.arange(len(S["t"]))
WHAI = [*zip(*(S[c] for c in "WHAI"), strict=True)]
PLACES, FOUR = ("winding", "frame", "room"), ("winding_C", "frame_C", "room_C", "I_A")
PLAIN = "t [s],T_winding [C],T_frame [C],T_amb [C],I [A]"
SHORT = "No.;;T winding;T frame;T room;Current\nUnit:;;°C;°C;°C;A\nDate;Time;;;;\n"
LEGEND = "# T1 = Winding head\n# T2 = Frame\n# T3 = Ambient air\n# I1 = Phase current\n"
BED = "Test bed 3/"


def each(row, letters="WHAI"):
    """A line for every row of the table.  row(k, minutes, seconds, *readings)"""
    return "".join(row(k, k // 12, 5 * k % 60, *(S[c][k] for c in letters)) for k in range(len(S["t"])))


WRITTEN = {  # each is a winding, a frame, the room and a current
    "labels before numbers": "Name:\tTime\tWinding\tFrame\tRoom\tCurrent\nUnit:\ts\t°C\t°C\t°C\tA\nStep:\t5\t5\t5\t5\t5"
    + of("", sep="\t").replace("\n", "\n\t").rstrip("\t"),
    "a clock's name in a row of its own": SHORT
    + each(lambda k, m, s, w, h, a, i: f"03.11.25;08:{m:02d}:{s:02d};{w:.2f};{h:.2f};{a:.2f};{i:.2f}\n"),
    "lines that say what a channel is": LEGEND + of("time_s\tT1_C\tT2_C\tT3_C\tI1_A", sep="\t"),
    "the test bed before every name": of(
        f"t [s],{BED}Motor/Winding [C],{BED}Motor/Frame [C],{BED}Room/Air [C],{BED}Supply/I [A]"
    ),
    "Korean": of("시간(s),권선 온도(℃),하우징 온도(℃),주위 온도(℃),전류(A)").encode("cp949"),
    "Hungarian": of("Idő;Tekercs (°C);Ház (°C);Környezeti hőmérséklet (°C);Áram (A)", sep=";").encode("cp1250"),
    "Turkish": of("Zaman (s),Sargı (°C),Gövde (°C),Ortam sıcaklığı (°C),Akım (A)").encode("cp1254"),
    "time in one word of Japanese": of("経過時間[秒],巻線[℃],機壳[℃],室温[℃],電流[A]").encode("cp932", "ignore"),
    "columns of JSON": json.dumps({n: [*S[c]] for n, c in zip(("time_s", *FOUR), "tWHAI")}),
    "millivolts beside degrees": of(f"{PLAIN},T_winding [mV]", "tWHAIW"),
    "a path above names that repeat": "File,C:/m.csv\nStep [ms],5000\n"
    + of("Name,Twdg,Name,Thsg,Name,Tamb,Name,Irms", "tWtHtAtI"),
    "topics and payloads": "ts,topic,payload\n"
    + each(
        lambda k, m, s, *of: "".join(
            f"{5 * k},{topic},{v:.2f}\n"
            for topic, v in zip(("motor/winding", "motor/frame", "hall/ambient", "motor/current"), of)
        )
    ),
    "fields that are called elsewhere": json.dumps(
        {
            "about": {"field1": "Winding", "field2": "Frame", "field3": "Room", "field4": "Current", "id": "x"},
            "feeds": [
                {"time_s": str(5 * k), "id": str(k), **{f"field{j}": str(v) for j, v in enumerate(row, 1)}}
                for k, row in enumerate(WHAI)
            ],
        }
    ),
    "lines of a program": each(
        lambda k, m, s, w, h, a, i: (
            f"2026-03-17 14:{m:02d}:{s:02d},250 INFO: winding={w:.2f} frame={h:.2f} room={a:.2f} I={i:.2f}\n"
        )
    ),
    "a data frame": json.dumps({n: dict(zip(map(str, S["t"]), S[c])) for n, c in zip(FOUR, "WHAI")}),
    "rows of a data frame": json.dumps({"columns": FOUR, "index": [*S["t"]], "data": WHAI}),
    "extremes beside readings": of(f"{PLAIN},T_winding max [C],T_winding min [C]", "tWHAIHB"),
    "a serial number behind the first row": of(f"{PLAIN},serial").replace("\n", ",4711\n", 2).replace(",4711", "", 1),
    "a camera that counts its frames": of(f"Frame,{PLAIN}", "ftWHAI"),
    "remarks under the names": of("Time[s],U1-1[C],U1-2[C],U1-3[C],U2-1[A]\nComment,Winding,Frame,Room,Current"),
    "a unit over a group of names": of(",Temperatures [°C],,,Electrical\nt [s],Winding U,Frame,Room,I1 [A]"),
    "few units under names that repeat": of(
        f"Bench,,Winding,,Frame,,Room,,Supply,\nTime,No{',Temp,Status' * 3},Current,Status\ns,,degC,,degC,,degC,,A,",
        "tfWfHfAfIf",
    ),
    "settings of every column": '"TraceName","T_COIL","T_FRAME","T_AMB","I"\n"VUnit","C","C","C","A"\n'
    '"HResolution",5.0,5.0,5.0,5.0\n"HUnit","s","s","s","s"\n"Date","2025/03/14","2025/03/14"\n'
    '"Time","08:52:31.0","08:52:31.0"\n' + table("", "", *(S[c] for c in "WHAI")),
    "tags of instruments": of(
        "time_s,M101.TI_Winding.PV,M101.TI_Winding.Q,M101.TI_Frame.PV,P.TI_Ambient.PV,M101.II_Current.PV", "tWfHAI"
    ),
    "a model's short name": of(f"{PLAIN},T_winding_mdl [C]", "tWHAIH"),
    "tenths of degrees": table(
        "t [s],T_winding (x0.1 °C),T_frame [1/10 °C],T_amb [0.1°C],I [10 mA]",
        *(S["t"], *(10 * S[c] for c in "WHA"), 100 * S["I"]),
    ),
    "an instant in several columns": table(
        "Year,DOY,HHMM,Sec,Winding_C,Frame_C,Room_C,I_A",
        *("2025", "73", 2355 + (S["t"] // 60) % 5 if S["t"][-1] < 300 else 800 + S["t"] // 60, S["t"] % 60),
        *(S[c] for c in "WHAI"),
    ),
    "a place beside what is measured": "#group,false,false\n,_time,_value,_field,location\n"
    + "".join(
        f",{5 * k},{S[c][k]:.2f},{field},{place}\n"
        for c, field, place in zip("WHAI", ["temperature"] * 3 + ["current"], [*PLACES, "L1"])
        for k in range(len(S["t"]))
    ),
    "a limit beside readings": table(f"{PLAIN},T_winding max allowed [C]", *(S[c] for c in "tWHAI"), "155.0"),
    "settings over the names": "Start:08:15,Winding:C,Speed:0,Current:5,Torque:,Voltage:12,Frame:3\n" + of(PLAIN),
    "all rows so far written again": of(PLAIN).rsplit("\n", 30)[0] + of(PLAIN).removeprefix(PLAIN),
    "signals of JSON by their names": json.dumps(
        {
            "device": "X",
            "channels": [
                {"name": name, "unit": unit, "data": [*S[c]]}
                for name, unit, c in zip(("time", *PLACES, "current"), ("s", *["degC"] * 3, "A"), "tWHAI")
            ],
        }
    ),
    "wanted and read in a group": of(
        ",Temperatures,,,Current,\nt [s],Winding °C,Frame °C,Room °C,Soll A,Ist A", "tWHAHI"
    ),
    "spots of a camera": of("t [s],Bx1 winding [C],El1 frame [C],Sp1 ambient [C],I [A]"),
    "a signal in every row": "".join(
        ",".join([name, *(f"{v:.2f}" for v in S[c])]) + "\n" for name, c in zip(PLAIN.split(","), "tWHAI", strict=True)
    ),
    "columns told by their numbers": "".join(f"# column {k}: {n}\n" for k, n in enumerate(PLAIN.split(","), 1))
    + of("").lstrip("\n"),
    "an estimate of no part, and a spread": of(f"{PLAIN},Motor temp estimated [C],T_winding_Std [C]", "tWHAIHB"),
    "a model beside readings": of(f"{PLAIN},T_winding_model [C],T_frame_est [C]", "tWHAIHB"),
}


@pytest.mark.parametrize("kind", WRITTEN)
def test_a_winding_a_frame_the_room_and_a_current(tmp_path, kind):
    text = WRITTEN[kind]
    (tmp_path / "a.csv").write_bytes(text if isinstance(text, bytes) else text.encode())
    assert new([tmp_path / "a.csv"], Wishes(out=tmp_path / "made", yes=True), str(tmp_path / "new.json")) == 0
    test = load_case(tmp_path / "made").case.tests[0]
    assert test.time[-1] == pytest.approx(S["t"][-1])
    assert np.array([c.y for c in test.channels]) == pytest.approx(np.array([S["W"], S["H"]]), abs=0.006)
    assert test.boundaries["ambient"] == pytest.approx(S["A"], abs=0.006)
    assert test.inputs["current_A"] == pytest.approx(S["I"], abs=0.006)


def test_lines_without_the_names_of_most_are_no_rows(tmp_path):
    """A serial monitor's log of a sketch that first says what it found."""
    rows = [(f"12:{k // 12:02d}:{5 * k % 60:02d}.120", w, i) for k, (w, i) in enumerate(zip(S["W"], S["I"]))]
    lines = [f"{at} -> Tmotor={w:.2f}C I={i:.2f}A" for at, w, i in rows]
    head = ["=~=~ log 2026.03.28 =~=~", "11:59:58.000 -> heat run", "11:59:59.000 -> found 3 sensors"]
    (tmp_path / "a.log").write_text("\n".join([*head, *lines[:50], "12:04:10.000 -> retry", *lines[50:]]))
    [(source, clock)] = read_runs(tmp_path / "a.log")
    assert clock.seconds == pytest.approx(S["t"])
    assert source.numbers("Tmotor") == pytest.approx(S["W"], abs=0.006)
    assert source.units["I"] == "A"


@pytest.mark.parametrize("between", [" - bench - INFO - ", " INFO:bench: ", " "])
def test_a_blank_between_number_and_unit_in_a_line_of_names(tmp_path, between):
    stamps = [datetime.fromtimestamp(1762157670 + t, UTC).strftime("%Y-%m-%d %H:%M:%S,250") for t in S["t"]]
    lines = [f"{at}{between}winding={w:.2f} degC I={i:.2f} A" for at, w, i in zip(stamps, S["W"], S["I"])]
    (tmp_path / "a.log").write_text("\n".join([*lines[:5], f"{stamps[5]} - bench - DEBUG - output on", *lines[5:]]))
    [(source, clock)] = read_runs(tmp_path / "a.log")
    assert clock.seconds == pytest.approx(S["t"])
    assert source.numbers("winding") == pytest.approx(S["W"], abs=0.006)
    assert (source.units["winding"], source.units["I"]) == ("degC", "A")


@pytest.mark.parametrize("code", [-127.0, -9999.0, 1372.0])
def test_one_bad_reading_costs_one_reading_whatever_the_span_of_its_column(tmp_path, code):
    hot = 22.0 + 3.0 * (S["W"] - 22.0)
    text = table("t [s],T_winding [°C],I [A]", S["t"], np.where(S["t"] % 100 == 50, code, hot), S["I"])
    folder, _ = written(tmp_path, text)
    (y,) = (c.y for c in folder.case.tests[0].channels)
    assert np.ptp(hot) > 150.0
    assert np.nanmin(y) > 20.0
    assert np.nanmax(y) == pytest.approx(hot.max(), abs=0.006)


@pytest.mark.parametrize(
    "word", ["DMD", "Demand", "Cmd", "Req", "Soll", "Consigne", "Consigna", "impostata", "设定", "設定"]
)
def test_a_set_point_gives_way_to_a_reading_and_is_doubted_without_one(tmp_path, word, capsys):
    wanted = f"I {word} [A]"
    written(tmp_path, of(f"t [s],{wanted},T_winding [°C],T_room [°C]", "tIWA"))
    assert f"'{wanted}': a set point, no reading" in " ".join(capsys.readouterr().out.split())
    (tmp_path / "made").rename(tmp_path / "before")
    text = table(f"t [s],{wanted},I 1 [A],T_winding [°C],T_room [°C]", S["t"], S["I"] + 1, *(S[c] for c in "IWA"))
    folder, document = written(tmp_path, text)
    assert folder.case.tests[0].inputs["current_A"] == pytest.approx(S["I"], abs=0.006)
    assert [c["column"] for c in document["tests"][0]["columns"] if c["doubt"]] == [wanted]
    assert document["warnings"] == []


@pytest.mark.parametrize(
    "own", ["CJC_temp", "T_Vergleichsstelle", "Soudure froide", "Cold junction", "Giunto freddo", "Board temp", "CPU_T"]
)
def test_the_temperature_of_the_instrument_is_none_of_the_machine(tmp_path, own, capsys):
    written(tmp_path, of(f"t [s],T_coil [°C],{own} [°C],T_room [°C],I [A]", "tWAAI"))
    assert capsys.readouterr().out.startswith(f"'{own} [°C]' is left out: of the instrument itself")
    (tmp_path / "made").rename(tmp_path / "before")
    written(tmp_path, of(f"t [s],{own} [°C],I [A]", "tWI"))
    assert (
        "of the instrument itself or another device, by its name"
        in " ".join(capsys.readouterr().out.split()).partition(": 1 test")[0]
    )


CHINESE = ("时间(s)", "绕组温度(℃)", "机壳温度(℃)", "环境温度(℃)", "定子电流(A)", "状态")
POLISH = ("Czas (s)", "Temp. uzwojenia (°C)", "Temp. obudowy (°C)", "Temp. otoczenia (°C)", "Prąd (A)", "Próba")
CZECH = ("Čas (s)", "Teplota vinutí (°C)", "Teplota pláště (°C)", "Teplota okolí (°C)", "Proud (A)", "Měření")


@pytest.mark.parametrize(
    ("names", "state", "page"),
    [
        (CHINESE, "停止", "gb18030"),
        (CHINESE, "正常", "gbk"),
        (POLISH, "wyłączony", "cp1250"),
        (CZECH, "běží", "cp1250"),
    ],
)
def test_a_code_page_is_told_by_words_of_headers_whatever_a_column_repeats(tmp_path, names, state, page):
    (tmp_path / "a.csv").write_bytes(table(",".join(names), *(S[c] for c in "tWHAI"), state).encode(page))
    assert tuple(read_source(tmp_path / "a.csv").cells) == names


@pytest.mark.parametrize(
    ("header", "unit", "quantity"),
    [
        ("GPS Speed (Meters/second)", "m/s", "vehicle_speed"),
        *(("Speed (kilometers/hour)", "km/h", "vehicle_speed"), ("Speed (Revolutions/minute)", "rpm", "speed")),
        *(("Load (Amperes)", "A", "current"), ("Bus (Volts)", "V", "voltage")),
        *(("Case (Fahrenheit)", "degF", "temperature"), ("Case (degrees Celsius)", "degC", "temperature")),
        *(("Speed (knots)", "", ""), ("Motor speed (actual)", "rpm", "speed")),
    ],
)
def test_units_that_are_spelled_out_and_a_speed_in_an_unknown_one(tmp_path, header, unit, quantity):
    (tmp_path / "a.csv").write_text(of(f"t [s],{header},T_coil [°C]", "tWW"))
    g = guesses(read_source(tmp_path / "a.csv"), ["t [s]"], Target())[0]
    assert (g.quantity, g.unit) == (quantity, unit)
    assert bool(quantity) or "unit 'knots' unknown" in g.doubt


@pytest.mark.parametrize(
    "header", ["Fan PWM [%]", "Kühlstufe", "fan stage", "Pumpe [%]", "Lüfter", "xFanOn", "zeta", "eta"]
)
def test_stages_and_shares_of_a_flow_cool_and_heat_nothing(tmp_path, header):
    """Stages 0 and 1 of a fan: two nodes by hand, from the second on with three times the film at the core."""
    step, rng = 30.0, np.random.default_rng(1)
    for run in range(4):
        load, stage = (np.repeat(rng.permutation(6) % n, 60) for n in (3, 2))
        if run == 0:
            assert {*stage} == {0, 1}
        P, T = 40.0 * (1.0 + load) ** 2, np.full((len(load) + 1, 2), 20.0)
        for k, (heat, on) in enumerate(zip(P, stage)):
            W, H = T[k]
            out = (8.0 + 16.0 * on) * (H - 20.0)
            T[k + 1] = W + step / 4000.0 * (heat - 15.0 * (W - H)), H + step / 9000.0 * (15.0 * (W - H) - out)
        readings = T[:-1] + rng.normal(0.0, 0.1, (len(load), 2))
        states = [("FALSE", "TRUE")[on] if header == "xFanOn" else on for on in stage]
        rows = [(k * step, 1 + load[k], states[k], *readings[k], 20.0) for k in range(len(load))]
        lines = [",".join(v if isinstance(v, str) else f"{v:.6g}" for v in row) for row in rows]
        names = f"t [s],I [A],{header},T_winding [degC],T_core [degC],T_room [degC]"
        (tmp_path / f"run{run}.csv").write_text("\n".join([names, *lines]) + "\n")
    to = {"zeta": "flow_share", "eta": "flow_percent"}  # a quantity, or the input that is its usual one
    fixed = {header: to[header]} if header in to else {}
    assert new(sorted(tmp_path.glob("run*.csv")), Wishes(out=tmp_path / "case", yes=True, places=fixed), None) == 0
    network = tomllib.loads((tmp_path / "case" / "network.toml").read_text())

    def follows(kind):
        of = [one.get("of", []) for one in network[kind].values()]
        return {f["input"] for fs in of for f in ([fs] if isinstance(fs, dict) else fs)}

    assert follows("losses") == {"current_A"}
    (cooling,) = follows("links")
    assert load_case(tmp_path / "case").case.model.network.measures(cooling) == "flow_share"


def test_a_quantity_is_no_place_of_a_network_that_is_there(tmp_path):
    """--place with a word that is neither: the message lists what the model has."""
    (tmp_path / "a.csv").write_text(of("t [s],I [A],winding [°C],room [°C]", "tIWA"))
    model = tmp_path / "network.toml"
    model.write_text(
        '[network]\nname = "n"\nboundaries = ["ambient"]\n[nodes.winding]\nC_J_K = 900\n[links.a]\n'
        'between = ["winding", "ambient"]\nG_W_K = 2\n[losses.h]\nkind = "constant"\nat = "winding"\nP_W = 50\n'
    )
    wishes = Wishes(out=tmp_path / "made", yes=True, network=model, places={"I [A]": "stage"})
    with pytest.raises(InputError, match="no 'stage'"):
        new([tmp_path / "a.csv"], wishes, None)


def test_a_table_s_name_over_a_current_makes_no_temperature_of_it(tmp_path):
    """Dataloggers write the table's name behind their own, over whatever column stands there."""
    head = '"TOA5","CR6","CR6","12345","Tab30s"\n"TIMESTAMP","Tcoil_Avg","Tair_Avg","Pel_Avg","Iline_Avg"\n'
    units = '"TS","Deg C","Deg C","W","Amps"\n"","Avg","Avg","Avg","Avg"'
    text = table(head + units, S["t"], S["W"], S["A"], S["I"] ** 2, S["I"])
    case, document = written(tmp_path, text)
    assert {"current_A", "power_W"} <= set(case.case.tests[0].inputs), document


def test_a_header_may_name_more_than_its_rows_fill(tmp_path):
    text = of("t [s],T_winding [degC],T_room [degC],I [A],T_spare [degC],Remark", "tWAI")
    case, _ = written(tmp_path, text)
    (test,) = case.case.tests
    assert [c.name for c in test.channels] == ["T_winding [degC]"]
    assert test.channels[0].y[-1] == pytest.approx(S["W"][-1], abs=0.01)


def test_lines_of_a_time_series_database(tmp_path):
    """Of one series; of several the rows of one instant are several, which are no clock."""
    lines = [
        f"bench,machine=M7 winding_degC={w:.2f},room_degC={a:.2f},I_A={i:.2f},turns={k}i {10**9 * (1774697470 + 5 * k)}"
        for k, (w, a, i) in enumerate(zip(S["W"], S["A"], S["I"]))
    ]
    (tmp_path / "a.txt").write_text("\n".join(lines) + "\n")
    [(source, clock)] = read_runs(tmp_path / "a.txt")
    assert (clock.start, clock.end_s) == (1774697470, S["t"][-1])
    assert source.numbers("winding_degC") == pytest.approx(S["W"], abs=0.006)
    assert source.numbers("turns") == pytest.approx(np.arange(len(S["t"])))


def of_lines(tmp_path, lines, **wishes):
    """As `written`, of lines."""
    return written(tmp_path, "\n".join(lines) + "\n", **wishes)


def goes(document):
    """Column -> where it goes, of those used in the first test."""
    return {c["column"]: c["place"] or c["feeds"] for c in document["tests"][0]["columns"] if c["place"] or c["feeds"]}


def test_a_date_and_a_blank_before_cells_with_signs(tmp_path):
    stamps = [datetime.fromtimestamp(1762157670 + t, UTC).strftime("%m/%d/%Y %H:%M:%S") for t in S["t"]]
    (tmp_path / "a.txt").write_text("".join(f"{at} {w:.2f}C, {h:.2f}C\n" for at, w, h in zip(stamps, S["W"], S["H"])))
    [(source, clock)] = read_runs(tmp_path / "a.txt")
    assert clock.seconds == pytest.approx(S["t"])
    assert [*source.units.values()][1:] == ["degC", "degC"]
    assert source.numbers("column 2") == pytest.approx(S["W"], abs=0.006)


@pytest.mark.parametrize(("names", "values"), [(";", ","), (",", ";"), ("\t", ",")])
def test_names_may_stand_between_other_signs_than_readings(tmp_path, names, values):
    rows = [values.join(f"{v:.2f}" for v in row) for row in zip(*(S[c] for c in "tWAI"))]
    header = names.join(("time (s)", "Temperatura bobinado (°C)", "T ambiente (°C)", "Corriente (A)"))
    folder, _ = of_lines(tmp_path, [header, *rows])
    assert folder.case.tests[0].boundaries["ambient"] == pytest.approx(S["A"], abs=0.006)


@pytest.mark.parametrize("named", [lambda k: f"M00{k}", str])
def test_machines_of_one_table_that_were_read_at_the_same_instants_are_tests(tmp_path, named):
    """Six rows each, one temperature, and one of them hardly warms."""
    rows = [(k, n) for k in (1, 2, 3) for n in range(6)]
    lines = [f"2026-03-28 {8 + n:02d}:00,{named(k)},{10 * k + n % 3},{20 + (k - 1) * n}" for k, n in rows]
    folder, _ = of_lines(tmp_path, ["time,motor_id,current [A],temperature [C]", *lines])
    assert [test.inputs["current_A"][0] for test in folder.case.tests] == [10.0, 20.0, 30.0]


def test_vessels_that_one_thermometer_reads_in_turn_are_columns(tmp_path):
    lines = [f"{10 + k // 60:02d}:{k % 60:02d}:00 {k % 3 + 1}: {20 + 60 * 0.98**k + k % 3:.1f}" for k in range(90)]
    folder, _ = of_lines(tmp_path, lines)
    assert [c.name for c in folder.case.tests[0].channels] == ["1:", "2:", "3:"]
    assert not any("hold until" in note for note in read_runs(tmp_path / "a.csv")[0][0].notes)


@pytest.mark.parametrize("most", [255, 1023])
def test_whole_bytes_of_a_heater_and_a_fan_are_shares(tmp_path, most):
    duty, steps = most * (np.arange(len(S["t"])) // 30 % 2), np.arange(len(S["t"])) // 20 % 9
    lines = [f"{t},{h},{f},{w:.2f}" for t, h, f, w in zip(S["t"], duty, steps, S["W"])]
    _, document = of_lines(tmp_path, ["t [s],heat,fan,T_plate [C]", *lines])
    quantities = {c["column"]: c["quantity"] for c in document["tests"][0]["columns"]}
    assert (quantities["heat"], quantities["fan"]) == ("share", "flow_share")


def test_a_flow_that_is_recorded_twice_is_no_clock(tmp_path):
    flow = np.where(S["t"] > S["t"][-1] / 2, 8.0, 5.0)
    text = table("Q [l/min],Q set [l/min],T_winding [C],T_room [C]", flow, flow, S["W"], S["A"])
    (tmp_path / "a.csv").write_text(text)
    assert clock_of(read_source(tmp_path / "a.csv")).columns == ()


def test_without_names_readings_of_tenths_are_temperatures_and_few_whole_numbers_are_not(tmp_path):
    room = 19.0 + 0.1 * (np.arange(90) // 20)
    (tmp_path / "a.csv").write_text("".join(f"{v:.1f},{k // 45},3,{10 * k}\n" for k, v in enumerate(room)))
    source = read_source(tmp_path / "a.csv")
    assert [g.quantity for g in guesses(source, ["column 4"], Target())] == ["temperature", "share", ""]


def test_the_sun_is_an_input_in_parts_of_1000_watts(tmp_path):
    header = "t [s],T_ambient [C],T_module [C],{}"
    folder, _ = written(tmp_path, table(header.format("Irradiance [W/m2]"), S["t"], S["A"], S["W"], 80 * S["I"]))
    assert folder.case.tests[0].inputs["share_percent"].max() == pytest.approx(8 * S["I"].max())
    (tmp_path / "made").rename(tmp_path / "before")
    written(tmp_path, table(header.format("Solar radiation (W/m^2)"), S["t"], S["A"], S["W"], 80 * S["I"]))
    assert goes(json.loads((tmp_path / "new.json").read_text()))["Solar radiation (W/m^2)"] == "share_percent"


@pytest.mark.parametrize("line", ["{d}@10:{m:02d}:{s} - Temp Top :{c:.2f} C"])
@pytest.mark.parametrize("name", ["", "INFO:root:"])
def test_a_date_and_a_time_with_another_sign_between(tmp_path, line, name):
    rows = [line.format(d="2026-03-21", m=k // 6, s=10 * (k % 6), c=20 + k**0.7) for k in range(40)]
    _, document = of_lines(tmp_path, [f"{name}{row}" for row in rows])
    assert document["tests"][0]["duration_s"] == pytest.approx(390.0)


def test_commas_between_names_over_blanks_between_readings(tmp_path):
    lines = ["timestamp,temperature", *(f"2026-03-21T10:{k:02d}:05.25 {20 + k**0.7:.3f}" for k in range(40))]
    assert goes(of_lines(tmp_path, lines)[1]) == {"temperature": "part"}


def test_microamperes_and_a_letter_behind_temp_are_units(tmp_path):
    header = "t [s],Current (µA),Voltage (µV),temp c,temp f"
    text = table(header, S["t"], 1e6 * S["I"], 1e6 * (16 - S["I"] / 50), S["W"], 32 + 1.8 * S["W"] + np.sin(S["t"]))
    folder, document = written(tmp_path, text)
    assert folder.case.tests[0].inputs["current_A"].max() == pytest.approx(S["I"].max(), rel=1e-3)
    assert {c["column"]: c["unit"] for c in document["tests"][0]["columns"]}["temp f"] == "degF"


def test_a_fan_that_is_on_and_off_in_words_is_an_input(tmp_path):
    fan = "\n".join(f"{t},{w:.1f},{'on' if i else 'off'}" for t, w, i in zip(S["t"], S["W"], S["I"] > 0))
    _, document = written(tmp_path, f"t [s],Current Temp,Fan Status\n{fan}\n")
    assert goes(document) == {"Current Temp": "part", "Fan Status": "flow_percent"}


def test_zones_with_two_readings_in_every_row_are_tests(tmp_path):
    rows = [
        f"2026-03-21 {h:02d}:00:00,{z},{20 + n + h**0.5:.2f},{h % 7}"
        for h in range(24)
        for n, z in enumerate(["Hall", "Court", "Quad"])
    ]
    folder, document = of_lines(tmp_path, ["timestamp,zone,temp,uv", *rows])
    assert len(folder.case.tests) == 3
    assert goes(document) == {"temp": "part"}


def test_probes_that_are_moved_once_are_temperatures_by_their_readings(tmp_path):
    moved = [
        np.where(S["t"] > at * S["t"][-1], 70 * np.exp(-S["t"] / 3 / S["t"][-1]), 22 + n)
        for n, at in ((0, 0.1), (3, 0.2))
    ]
    _, document = written(
        tmp_path, table("t [s],Sensor 2,Sensor 5", S["t"], moved[0] + S["t"] / 1e4, moved[1] + S["t"] / 1e4)
    )
    assert goes(document) == {"Sensor 2": "part-2", "Sensor 5": "part-5"}


def test_a_cell_of_a_hundred_thousand_digits_is_one_cell(tmp_path):
    """Looked at for readings with their units digit after digit it would take hours."""
    file = tmp_path / "hostile.csv"
    rows = [f"{t},{'1' * 10**5},{20 + t / 60}\n" for t in range(0, 600, 60)]
    file.write_text("time_s,note,T_winding_C\n" + "".join(rows))
    assert "note" in read_source(file).labels
