"""What readings say of each other, with truths of our own: sensors with noise, and columns that were made of them."""

import re

import numpy as np
import pytest
from scipy.signal import lfilter

from geom.errors import InputError
from measured.headers.cells import split_unit
from measured.importing.aligned import Recording, common, shift
from measured.importing.aloud import first_lines, short_lines
from measured.importing.case_files import read_runs
from measured.importing.draft import Draft, sample_of
from measured.importing.guess import guesses
from measured.importing.relations import functional_relations, is_like_temperature, is_product, misfit
from measured.importing.starter import heating
from measured.importing.target import Target
from thermoscope.commands.test.new import first_model

RNG = np.random.default_rng(7)
T = 5.0 * np.arange(1500)
LOAD = np.where((T > 300) & (T < 3000), 9.0, np.where((T > 4000) & (T < 6000), 5.0, 0.0))


def sensor(tau, size, start=21.0, noise=0.06, digits=2):
    a = -np.expm1(-5.0 / tau)
    rise = size * lfilter([a], [1.0, a - 1.0], (LOAD / 9.0) ** 2)
    return np.round(start + rise + noise * RNG.standard_normal(T.size), digits)


W1, W2, FRAME, ROOM = sensor(400, 40), sensor(450, 38), sensor(1500, 20), sensor(900, 0.0)
SENSORS = {"w1": W1, "w2": W2, "frame": FRAME, "room": ROOM}
LAGGED = lfilter([0.1], [1.0, -0.9], W1, zi=[0.9 * W1[0]])[0]
EVEN = np.convolve(W1, np.ones(12) / 12)[: T.size]


def test_sensors_of_one_machine_are_none_of_each_other():
    """Nor are whole degrees, which are equal too often to say anything."""
    assert functional_relations(SENSORS, {}, ()) == {}
    assert functional_relations({c: np.round(v) for c, v in SENSORS.items()}, {}, ()) == {}


@pytest.mark.parametrize(
    ("column", "words"),
    [
        ((W1 + W2 + FRAME) / 3, "the mean of 'w1', 'w2', 'frame'"),
        (np.maximum(W1, W2), "the largest of 'w1', 'w2'"),
        (np.minimum(W1, W2), "the least of 'w1', 'w2'"),
        *((W1 - ROOM, "'w1' less 'room'"), (W1, "the same readings as 'w1'")),
        *((1.8 * W1 + 32, "the same readings as 'w1'"), (W1 + 273.15, "the same readings as 'w1'")),
        (LAGGED, "'w1', filtered"),
        (np.where(np.arange(T.size) < 12, W1, EVEN), "'w1', filtered"),
    ],
)
def test_a_column_made_of_others_is_told_with_its_function(column, words):
    assert functional_relations({**SENSORS, "made": np.round(column, 2)}, {}, {"made"})["made"] == words


def test_what_starts_and_moves_as_temperatures_do():
    assert is_like_temperature(W1, [21.0])
    assert not is_like_temperature(W1, [80.0])
    assert not is_like_temperature(np.round(LOAD) + 20, [21.0])
    assert not is_like_temperature(21.0 + 30 * RNG.random(T.size), [21.0])


def test_a_power_is_told_by_its_factors_and_the_heat_by_what_follows_it():
    U, current = np.round(300 - LOAD + RNG.random(T.size), 1), LOAD + 0.1 * RNG.random(T.size)
    assert is_product(np.round(1.73 * U * current, 1), [U, current])
    assert not is_product(np.round(1.73 * U * current + 5 * LOAD**2, 1), [U, current])
    assert misfit(T, W1 - ROOM, LOAD, 2.0) < 1.0 < 5.0 < misfit(T, W1 - ROOM, RNG.random(T.size), 2.0)


def record(tmp_path, columns, name="a.csv"):
    rows = zip(*([f"{x:.5g}" for x in v] if not isinstance(v[0], str) else v for v in columns.values()))
    (tmp_path / name).write_text("\n".join([";".join(columns), *map(";".join, rows)]))
    ((source, clock),) = read_runs(tmp_path / name)
    return Recording(
        source,
        clock,
        guesses(source, clock.columns, Target(places_by_header=dict.fromkeys(source.labels.values(), "x"))),
    )


def by_column(tmp_path, columns):
    return {g.column: g for g in record(tmp_path, {"t [s]": T, **columns}).guesses}


def test_a_name_that_nobody_knows_over_readings_like_those_of_others(tmp_path):
    g = by_column(tmp_path, {"T_winding [°C]": W1, "Qwzrt": FRAME, "Flow 2": sensor(900, 3.0), "I [A]": LOAD})
    assert (g["Qwzrt"].quantity, g["Qwzrt"].doubt) == ("temperature", "a temperature, by its readings alone")
    assert g["Flow 2"].doubt.endswith("or a temperature, by its readings alone")


def test_units_in_cells_are_law_and_a_name_may_be_a_unit(tmp_path):
    g = by_column(tmp_path, {"stator winding W": [f"{v} °C" for v in W1], "mA": 1000 * LOAD, "T_room [°C]": ROOM})
    assert (g["stator winding W"].quantity, g["mA"].unit) == ("temperature", "mA")


def test_a_current_by_its_last_letter_that_is_a_mean_of_temperatures(tmp_path):
    g = by_column(tmp_path, {"T_winding [°C]": W1, "T_frame [°C]": FRAME, "T_m_A": (W1 + FRAME) / 2, "I [A]": LOAD})
    assert not g["T_m_A"].used
    assert g["I [A]"].feeds == "current_A"


def test_groups_that_all_names_begin_with_say_nothing(tmp_path):
    names = [f"Root Model/Meas/{name}/Out1[°C]" for name in ("T_winding", "T_Observer_winding", "T_room")]
    g = by_column(tmp_path, {**dict(zip(names, (W1, 0.97 * W1 + 0.5, ROOM))), "Root Model/Meas/I/Out1[A]": LOAD})
    assert [g[name].doubt for name in names] == ["", "modelled, not read", ""]


def test_a_loss_that_is_what_goes_in_less_what_comes_out(tmp_path):
    out, lost = 30 * LOAD, np.round(4 * LOAD**2 + 1)
    g = by_column(tmp_path, {"P_in [W]": out + lost, "P_shaft [W]": out, "P_v [W]": lost, "T_winding [°C]": W1})
    assert g["P_v [W]"].feeds == "power_W"
    assert len(g) == 4


def test_of_two_powers_that_say_no_side_the_larger_goes_in(tmp_path):
    out, lost = 30 * LOAD, np.round(LOAD**2 + 1)
    g = by_column(tmp_path, {"P1 [W]": out, "P2 [W]": out + lost, "T_winding [°C]": W1})
    assert g["loss P2 [W] - P1 [W]"].feeds == "power_W"
    g = by_column(tmp_path, {"P1 [W]": out, "P2 [W]": np.roll(out, 300), "T_winding [°C]": W1})
    assert len(g) == 3


def test_a_sensor_of_the_stator_is_the_windings_where_no_other_is(tmp_path):
    hot = {"stator [°C]": W1, "frame [°C]": FRAME, "T_room [°C]": ROOM, "I [A]": LOAD}
    assert by_column(tmp_path, hot)["stator [°C]"].doubt.endswith("of the stator: taken as the winding")
    assert "taken" not in by_column(tmp_path, {"T_winding [°C]": W2, **hot})["stator [°C]"].doubt


def test_a_comparison_repeats_what_may_change_its_verdict(tmp_path):
    weak = {"T_winding [°C]": W1, "Qwzrt": FRAME, "T_room [°C]": ROOM, "I": LOAD}
    drafts = [Draft("a", (record(tmp_path, {"t [s]": T, **weak}),))]
    assert short_lines(drafts, learnt=True) == ["'Qwzrt': a temperature, by its readings alone; 1 more in tests/*.toml"]
    grave = short_lines(drafts, learnt=False)
    assert grave == ["no unit: 'I' is taken in A", "weaker guesses stand in tests/*.toml"]


def test_what_is_warm_where_all_others_are_cold_is_doubted(tmp_path):
    hot = sensor(900, 2.0, start=38.0)
    g = by_column(tmp_path, {"Oil [°C]": hot, "T_winding [°C]": W1, "T_frame [°C]": FRAME, "T_room [°C]": ROOM})
    assert g["Oil [°C]"].doubt == "starts at 38 degC, all others near 21: is it of this machine?"


def test_of_columns_without_a_part_the_quickest_are_of_the_winding(tmp_path):
    hot = {"Qa [°C]": W1, "Qb [°C]": FRAME, "Qc [°C]": W2, "T_room [°C]": ROOM, "I [A]": LOAD}
    g = by_column(tmp_path, hot)
    assert ["fastest" in g[c].doubt for c in hot] == [True, False, True, False, False]
    g = by_column(tmp_path, {"T_winding [°C]": FRAME, **hot})
    assert not any("fastest" in one.doubt for one in g.values())


def test_powers_on_both_sides_of_a_machine_pass_through(tmp_path):
    powers = {"P_in [W]": 40 * LOAD + 100, "P_out [W]": 30 * LOAD}
    one = record(tmp_path, {"t [s]": T, "T_winding [°C]": W1, "I [A]": LOAD, **powers})
    columns = [(one.source, g) for g in one.guesses]
    assert heating(columns, "power") == []
    assert [g.column for _, g in heating(columns, "current")] == ["I [A]"]


@pytest.mark.parametrize(
    ("columns", "words"),
    [
        ({"I_1 [A]": np.roll(LOAD, 400), "I_2 [A]": LOAD}, "'I_2 [A]' explains the readings better than"),
        ({"shunt [mV]": 5 * LOAD}, "the only heat was left out: 'shunt [mV]'"),
        ({"U [V]": 20 + LOAD}, "no current and no loss is recorded: 'U [V]' alone tells of the heat"),
        ({"pwm": np.round(20 * LOAD)}, "'pwm': goes to 180, so in no percent"),
        ({"I": LOAD}, "no unit: 'I' is taken in A"),
        (
            {"I [A]": LOAD, "Outlet water [°C]": sensor(900, 12)},
            "'Outlet water [°C]': it warms with the machine: an outlet?",
        ),
    ],
)
def test_the_first_lines_name_what_may_matter(tmp_path, columns, words):
    one = record(tmp_path, {"t [s]": T, "T_winding [°C]": W1, "T_room [°C]": ROOM, **columns})
    places = {"T_winding [°C]": "winding", "T_room [°C]": "ambient", "Outlet water [°C]": "coolant"}
    columns_at_places = [
        g if g.feeds or g.column not in places else type(g)(g.column, "temperature", "degC", places[g.column])
        for g in one.guesses
    ]
    lines = first_lines([Draft("a", (Recording(one.source, one.clock, columns_at_places),))])
    assert any(line.startswith(words) for line in lines), lines


def test_a_clock_with_a_zone_beside_one_without(tmp_path):
    stamps = [f"2024-04-17 {9 + k // 720:02d}:{k // 12 % 60:02d}:{5 * k % 60:02d}" for k in range(T.size)]
    first = record(tmp_path, {"Time": stamps, "I [A]": LOAD})
    other = record(tmp_path, {"Zeit": [f"{s}+02:00" for s in stamps], "T_winding [°C]": W1}, "b.csv")
    seconds, how = shift(first, other)
    assert seconds == 0.0
    assert "the whole hours are guessed" in how
    late = record(tmp_path, {"Zeit": stamps[14:], "T_winding [°C]": W1[14:]}, "c.csv")
    assert shift(first, late)[0] == 70.0


def told(tmp_path, header, *columns):
    """Column -> quantity, unit, and the place or the input it goes to."""
    rows = "\n".join(",".join(f"{cell:g}" for cell in row) for row in zip(*columns, strict=True))
    (tmp_path / "a.csv").write_text(f"{header}\n{rows}\n")
    runs = read_runs(tmp_path / "a.csv")
    target, [(source, clock)] = first_model(runs, {}).target, runs
    return {g.column: (g.quantity, g.unit, g.place or g.feeds) for g in guesses(source, clock.columns, target)}


K = np.arange(60.0)
WARM = 20 + 0.5 * K + 0.1 * np.sin(K)
LEVEL = 20.0 + 80 * (K > 30)


@pytest.mark.parametrize(("most", "quantity", "unit"), [(100.0, "flow_share", "%"), (85.0, "air_flow", "m3/h")])
def test_a_fan_that_goes_from_nothing_to_a_hundred_is_in_percent(tmp_path, most, quantity, unit):
    read = told(tmp_path, "t [s],T_winding,fan", K, WARM, np.linspace(0, most, len(K)))
    assert read["fan"][:2] == (quantity, unit)


def test_names_may_begin_with_numbers_that_count_on(tmp_path):
    columns = (WARM + np.cos(k * K) for k in range(1, 5))
    read = told(tmp_path, "1,2,3,4,Oven,Time_(s)", *columns, WARM, 60 * K)
    assert [*read] == ["1", "2", "3", "4", "Oven"]


def runs_of_text(tmp_path, text):
    """Clock and guesses of every run of a file."""
    (tmp_path / "a.csv").write_text(text)
    runs = read_runs(tmp_path / "a.csv")
    target = first_model(runs, {}).target
    return [(clock, {g.column: g for g in guesses(source, clock.columns, target)}) for source, clock in runs]


@pytest.mark.parametrize(("dc", "ac"), [("P DC [W]", "P AC [W]"), ("Pdc [kW]", "Pac [kW]"), ("p_dc [W]", "p_ac [W]")])
def test_what_a_converter_loses_heats_it(tmp_path, dc, ac):
    """Whatever currents were recorded beside its powers, and where one side is held."""
    read = told(
        tmp_path, f"t [s],T_igbt,{ac},{dc},I AC [A]", K, WARM, 0 * K + 5000, 5000 + LEVEL, LEVEL / 7 + np.cos(K)
    )
    assert read[f"loss {dc} - {ac}"] == ("power", split_unit(dc)[1], "power_W")
    assert read[dc][2] != "power_W"


def test_powers_of_a_converter_of_which_no_loss_can_be_made_are_doubted(tmp_path):
    rows = zip(K, WARM, 8000 + LEVEL, 4000 + LEVEL, 4200 + LEVEL)
    text = "\n".join(["t [s],T_top,ACPower,PowerDC1,PowerDC2", *(",".join(f"{c:g}" for c in row) for row in rows)])
    [(_, read)] = runs_of_text(tmp_path, text)
    assert read["ACPower"].doubt.endswith("what is lost in it is the heat")
    (tmp_path / "b.csv").write_text(text)
    one = Recording(*read_runs(tmp_path / "b.csv")[0], [*read.values()])
    assert any(line.startswith("'ACPower': of one side") for line in first_lines([Draft("b", (one,))]))


@pytest.mark.parametrize(
    ("header", "quantity"),
    [
        ("t_s,temp_c,core_v", "voltage"),
        ("t_s,temp_c,wdg_u,wdg_v,wdg_w", "temperature"),
        ("t [s],T,core_v", "temperature"),
    ],
)
def test_where_names_end_on_units_a_v_is_of_volts(tmp_path, header, quantity):
    """But not of three phases, and not where units stand in brackets."""
    hot = [WARM + np.cos(k * K) for k in range(len(header.split(",")) - 1)]
    read = told(tmp_path, header, K, *hot[:-1], hot[-1] - 18 * (quantity == "voltage"))
    assert {what for name, (what, _, _) in read.items() if re.search("_v$", name)} == {quantity}


def test_a_count_since_the_start_without_a_name_begins_anew_with_every_run(tmp_path):
    """A run in which nothing moves has the columns of the others."""
    runs = [(WARM, 22441), (0 * K[:30] + 30.69, 22450)]
    lines = [f"{begin + 5001 * k},{w:.2f}" for hot, begin in runs for k, w in enumerate(hot)]
    read = runs_of_text(tmp_path, "\n".join(lines))
    assert [clock.end_s for clock, _ in read] == pytest.approx([5.001 * 59, 5.001 * 29])
    assert all(columns["column 2"].place for _, columns in read)


@pytest.mark.parametrize(("count", "tests"), [(60, 2), (30, 1)])
def test_rows_of_sensors_in_turns_are_no_one_sensor_s(tmp_path, count, tests):
    """A test of each where there are enough rows, else a doubt; a number of a device is no current."""
    rows = [f"{k},{1 + k % 2},{w + 8 * (k % 2):.2f},{50 + k % 3}" for k, w in enumerate(WARM[:count])]
    read = runs_of_text(tmp_path, "\n".join(["t [s],sensor_id,temperature_c,humidity", *rows]))
    assert len(read) == tests
    assert not any(columns["sensor_id"].used for _, columns in read)
    assert (tests == 2) != ("of several 'sensor_id'" in read[0][1]["temperature_c"].doubt)


def test_remarks_that_come_again_between_rows(tmp_path):
    lines = [f"{t:g},{w:.2f}\n\n# skipped {1 + (t > 50):g} cycles\n# no reply" for t, w in zip(K, WARM)]
    [(clock, read)] = runs_of_text(tmp_path, "\n".join(["# run of a bench", "t [s],T_winding [°C]", *lines]))
    assert clock.seconds == pytest.approx(K)
    assert read["T_winding [°C]"].place


@pytest.mark.parametrize("name", ["erpm", "eRPM", "motor_erpm"])
def test_an_electrical_speed_is_doubted(tmp_path, name):
    rows = [f"{t:g},{w:.2f},{4000 + e:g}" for t, w, e in zip(K, WARM, LEVEL)]
    [(_, read)] = runs_of_text(tmp_path, "\n".join([f"t [s],T_motor,{name}", *rows]))
    assert read[name].feeds == "speed_rpm"
    assert read[name].doubt == "electrical: as of one pole pair, in rpm"


def test_numbers_of_thermocouples_are_no_temperature(tmp_path):
    rows = [f"{k},{k + 1:03d},{w:.2f}" for k, w in enumerate(WARM)]
    [(_, read)] = runs_of_text(tmp_path, "\n".join(["t [s],TC,T_winding", *rows]))
    assert read["TC"].doubt == "counts the rows"


def test_units_under_a_first_line_that_begins_with_a_date(tmp_path):
    """As a program writes it that ends no line behind its date."""
    rows = [f"{t:g}, {1000 * e:g}, {w:.2f}" for t, e, w in zip(K, LEVEL, WARM)]
    text = "\n".join(["2024-04-22 16:10:29.5Time, Input current, Motor", "s, mA, Deg C", *rows])
    [(_, read)] = runs_of_text(tmp_path, text)
    assert [(g.quantity, g.unit) for g in read.values()] == [("current", "mA"), ("temperature", "degC")]


def test_rows_that_grow_without_names_are_doubted(tmp_path):
    lines = [f"{5 * k},{w:.2f},{w + 3:.2f}{',7.5,20.1' * (1 + k // 30)}" for k, w in enumerate(WARM)]
    (tmp_path / "a.csv").write_text("\n".join(lines))
    notes = read_runs(tmp_path / "a.csv")[0][0].notes
    assert any("rows have 5 to 7 cells, so that a column may hold several signals" in note for note in notes)


def test_a_printer_says_how_warm_it_is_between_other_lines(tmp_path):
    """Its log may have instants, or none; what is wanted is no reading."""
    for stamp, clocks in (("2024-04-22 12:00:{:02d},123 - Recv: ", 59.0), ("", 59.0)):
        lines = [
            f"{stamp.format(k)}ok T:{w:.2f} /60.00 B:{w - 5:.2f} /40.00 @:127\n{stamp.format(k)}M105"
            for k, w in enumerate(WARM)
        ]
        [(clock, read)] = runs_of_text(tmp_path, "\n".join(["start", "echo:Marlin 1.1.9", *lines]))
        assert clock.end_s == pytest.approx(clocks)
        assert bool(clock.doubt) == (not stamp)
        assert {c for c, g in read.items() if g.place} == {"nozzle temperature", "bed temperature"}


@pytest.mark.parametrize(("step", "least"), [(1e-4, 1e-3), (0.5, 0.5)])
def test_rows_faster_than_an_analysis_are_averaged(tmp_path, step, least):
    one = Recording(*read_runs(written(tmp_path, step))[0], [])
    assert sample_of([Draft("a", (one,))]) == least


def test_a_test_shorter_than_a_step_is_refused(tmp_path):
    one = Recording(*read_runs(written(tmp_path, 1e-7))[0], [])
    with pytest.raises(InputError, match="too short to see a machine warm"):
        sample_of([Draft("a", (one,))])


def written(folder, step):
    file = folder / "a.csv"
    file.write_text("\n".join(["t [s],T_winding", *(f"{step * k:.8f},{w:.2f}" for k, w in enumerate(WARM))]))
    return file


def test_a_test_begins_with_the_first_reading_of_a_part(tmp_path):
    """Not where its recorder was switched on."""
    rows = [f"{t:g},{f'{w:.2f}' if t > 9 else ''},{e:g}" for t, w, e in zip(K, WARM, LEVEL)]
    (tmp_path / "a.csv").write_text("\n".join(["t [s],T_winding,P_loss [W]", *rows]))
    runs = read_runs(tmp_path / "a.csv")
    [(source, clock)] = runs
    one = Recording(source, clock, guesses(source, clock.columns, first_model(runs, {}).target))
    assert common([one], (0.0, None))[0] == (10.0, 59.0)
    assert common([one], (20.0, 40.0)) == ((20.0, 40.0), ())
