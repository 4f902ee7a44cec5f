"""The law of steady tests, from tables whose law is known in closed form; and the command that reads them."""

from dataclasses import replace

import numpy as np
import pytest

from extras.bench.steady_law.forms import Form, temperature
from extras.bench.steady_law.law import checks, find_law
from extras.bench.steady_law.steady_tests import Columns, steady_tests

FLOW, SPEED, INLET = (x.ravel() for x in np.meshgrid([1.0, 2.0, 4.0, 6.0], [0.0, 2e3, 5e3, 1e4], [40.0, 80.0]))
COLUMNS = Columns("heat", "inlet", (("flow", "l/min"), ("speed", "rpm")), "T_*", 20.0)
HEAT = 800.0 + 300.0 * np.sqrt(FLOW) + 0.1 * SPEED
ABOVE = np.array([0.1, 0.0, -0.1])  # of the rise: a sensor that sits warmer, one that sits cooler


def table(G, G0=0.0, noise_K=0.0, columns=COLUMNS, inlet=INLET, inputs=(FLOW, SPEED)):
    """heat = G (T - inlet) + G0 (T - 20), three sensors about T"""
    T = (HEAT + G * inlet + G0 * 20.0) / (G + G0)
    noise = noise_K * np.random.default_rng(3).standard_normal((T.size, 3))
    read = T[:, None] + np.outer(T - inlet, ABOVE) + noise
    return steady_tests(
        columns, ("T_a", "T_b", "T_c"), np.column_stack(inputs), HEAT, inlet, np.full(T.size, 20.0), read
    )


POWERS = 60.0 * (FLOW / 6) ** 0.5 + 150.0 * (SPEED / 1e4) ** 1.2


def number(law, start):
    return next(n for n in law.numbers.values() if n["name"].startswith(start))


@pytest.mark.parametrize(
    "form",
    [
        Form(((0,), (1,)), fluid=2, blend=True, ambient=True),
        Form(((), (0, 1)), frozenset({(1, 0)}), fluid=1, limit=(1, "from"), ambient=True),
        Form(((0,), (0, 1)), limit=(0, "up to"), warming=True),
    ],
)
def test_slopes_are_those_of_the_temperature(form):
    """Central differences of 1e-6 err by 1e-6 squared, and by rounding of 1e-13 / 1e-6."""
    tests = table(POWERS, columns=replace(COLUMNS, fluid="water"))
    x = np.random.default_rng(1).uniform(0.2, 0.8, len(form.labels))
    slopes = temperature(form, x, tests)[1]
    for n, step in enumerate(1e-6 * np.eye(x.size)):
        difference = temperature(form, x + step, tests)[0] - temperature(form, x - step, tests)[0]
        assert difference / 2e-6 == pytest.approx(slopes[:, n], abs=1e-5 * max(1.0, np.abs(slopes).max()))


def test_a_sum_of_powers_with_a_loss_to_ambient_is_found():
    """Readings are right to 0.05 K, 17 of them a number: each lies in its interval, which is short."""
    law = find_law(table(POWERS, G0=5.0, noise_K=0.05))
    assert law.best.form == Form(((0,), (1,)), ambient=True)
    for start, true in {"G1": 60.0, "G2": 150.0, "exponent of flow": 0.5, "exponent of speed": 1.2, "G0": 5.0}.items():
        n = number(law, start)
        assert n["low"] < true < n["high"]
        assert n["high"] - n["low"] < 0.1 * true + 1.0
    assert law.verdict == "law"
    assert "A law of 5 numbers" in law.sentence
    assert law.follows == pytest.approx({"flow": 1.0, "speed": 1.0})


def test_a_coolant_that_warms_on_its_way_is_seen():
    """1 / G = 1 / 200 + 1 / (2 m cp), water of 4.1 kJ/kg/K and 0.98 kg/l: 67 W/K for 1 l/min."""
    from thermoscope.plugin import water

    mcp = np.array([water(T).rho * water(T).cp for T in INLET]) * FLOW / 6e4
    law = find_law(table(1.0 / (1.0 / 200.0 + 0.5 / mcp), noise_K=0.02, columns=replace(COLUMNS, fluid="water")))
    assert law.best.form.warming
    assert law.best.form.inputs == frozenset()
    assert law.numbers["G", 0]["value"] == pytest.approx(200.0, rel=0.01)


def test_an_input_that_counts_up_to_a_value_is_found():
    law = find_law(table(100.0 * (np.minimum(SPEED, 6e3) / 1e4) ** 0.8 + 50.0 * (FLOW / 6) ** 0.5, noise_K=0.02))
    assert law.best.form.limit == (1, "up to")
    assert number(law, "speed counts up to")["value"] == pytest.approx(6e3, rel=0.05)


def test_neither_names_nor_order_nor_units_matter():
    one = find_law(table(POWERS, noise_K=0.05))
    tests = table(POWERS, noise_K=0.05)
    back = np.arange(FLOW.size)[::-1]
    columns = replace(COLUMNS, inputs=(("b", "l/s"), ("a", "1/s")))
    rows = [x[back] for x in (tests.inputs / 60.0, tests.heat, tests.coolant, tests.ambient, tests.readings)]
    other = find_law(steady_tests(columns, ("x", "y", "z"), *rows))
    assert other.best.form == one.best.form
    assert other.best.x == pytest.approx(one.best.x, abs=1e-4)  # where a fit ends: 1e-6 of -ln(probability)


def test_what_was_left_out_lies_in_the_band():
    """Sensors sit where they do and are right to 0.05 K; 8 tests of 10,000 rpm, 24 readings: 20 of them in 99 %."""
    tests = table(POWERS, G0=5.0, noise_K=0.05)
    flow, speed = checks(find_law(tests))
    assert [flow["left_out"], speed["left_out"]] == ["flow 6 l/min", "speed 10000 rpm"]
    assert speed["tests"] == 8
    assert speed["inside"] > 20 / 24
    assert speed["rms_K"] < 0.5
    assert speed["law"].startswith("A law of 5 numbers")


OPTIONS = ["--heat", "P", "--coolant", "inlet", "--follows", "flow=l/min", "--follows", "speed=rpm"]
OPTIONS += ["--temperatures", "T_*", "--ambient", "20"]


def written(folder, tests):
    rows, file = np.column_stack([tests.inputs, tests.coolant, tests.heat, tests.readings]), folder / "tests.csv"
    np.savetxt(file, rows, "%.6g", ",", header="flow,speed,inlet,P,T_a,T_b,T_c", comments="")
    return file


@pytest.fixture
def csv_file(tmp_path):
    return written(tmp_path, table(POWERS, G0=5.0, noise_K=0.05))


def test_the_command_gives_law_picture_and_predictions(csv_file, tmp_path, thermoscope):
    out = tmp_path / "out"
    done = thermoscope("law", csv_file, *OPTIONS, "--predict", str(csv_file), "--out", out, "--json", "-")
    assert done.code == 0, done.err
    document = done.document
    assert document["verdict"] == "law"
    assert document["predicted"]["rms_K"] == document["agreement"]["rms_K"] < 0.1
    assert (out / "law.png").stat().st_size > 10_000
    predicted = np.genfromtxt(out / "predicted.csv", delimiter=",", names=True)
    read = np.genfromtxt(csv_file, delimiter=",", names=True)
    assert predicted["T_a"] == pytest.approx(read["T_a"], abs=0.5)
    assert (predicted["T_a_95_K"] > 0.0).all()


def test_cooling_that_follows_nothing_has_no_law_and_exit_code_1(tmp_path, thermoscope):
    done = thermoscope("law", written(tmp_path, table(np.full(FLOW.size, 80.0), noise_K=0.1)), *OPTIONS, "--json", "-")
    assert (done.code, done.document["verdict"]) == (1, "no law")
    no_law = "No law: the readings do not say that the cooling follows flow or speed: about 80"
    assert done.document["sentence"].startswith(no_law)


WRONG = {
    "--heat X": "column 'X' is not in the file",
    "--heat inlet": "'inlet' is given twice",
    "--temperatures Q*": "no column is called 'Q*'",
    "--fluid mercury": "no fluid 'mercury'",
    "--follows P": "'P' is given twice",
    "--follows T_a --follows T_b": "4 inputs",
    "--ambient nosuch": "column 'nosuch' is not in the file",
    "--coolant P": "'P' is given twice",
    "--coolant T_a": "is colder than its coolant",
    "--predict nosuch.csv": "nosuch.csv",
}


@pytest.mark.parametrize("words", WRONG)
def test_what_makes_no_sense_is_refused(words, csv_file, tmp_path, thermoscope):
    out = tmp_path / "out"
    done = thermoscope("law", csv_file, *OPTIONS, *words.split(), "--out", out)
    assert (done.code, WRONG[words] in done.err) == (2, True), done.err
    assert "Traceback" not in done.err
    assert not out.exists()


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("2,0,40,x,60,60,60", "'x' is not a number"),
        ("2,0,40,,60,60,60", "is not a number"),
        ("2,-5,40,900,60,60,60", "'speed' is negative or 0"),
        ("2,0,40,0,60,60,60", "'P' is negative or 0"),
    ],
)
def test_a_row_that_makes_no_sense_is_refused(line, words, csv_file, thermoscope):
    with csv_file.open("a") as file:
        file.write(line + "\n")
    done = thermoscope("law", csv_file, *OPTIONS)
    assert (done.code, words in done.err) == (2, True), done.err


def test_few_tests_are_refused(csv_file, thermoscope):
    csv_file.write_text("".join(csv_file.read_text().splitlines(keepends=True)[::8]))
    done = thermoscope("law", csv_file, *OPTIONS)
    assert (done.code, "has 4 tests" in done.err) == (2, True)
