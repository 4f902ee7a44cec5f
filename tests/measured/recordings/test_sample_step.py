"""The sample step is the tool's: inputs that switch keep their instants. Results follow neither it nor any unit."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad
from small_case import HEADER, measured, small_case

import thermoscope as ts
from lumped.integration.signals import Signals
from lumped.integration.simulate import Record, simulate
from lumped.model.build import bare_network, node_link, node_source
from lumped.transfer.laws import Fixed, InputPower
from measured.case import Recorded, Test
from measured.sensors.sampling import Modes, interpolation_error, sample_step, sampled
from thermoscope.case_folder.folder import load_case
from validation import diagnose
from validation.comparison.compare import compare

STEPS = (5.0, 10.0, 30.0)


@pytest.fixture(scope="module")
def switched(tmp_path_factory):
    """A case recorded every second, its current and wind switched every few minutes, at three sample steps."""
    case = small_case(tmp_path_factory.mktemp("switched"), step=1.0)
    file = case / "case.toml"
    text = file.read_text()
    out = {}
    for step in STEPS:
        file.write_text(text.replace("sample_s = 20", f"sample_s = {step}"))
        out[step] = load_case(case)
    return out


def test_the_same_errors_at_all_steps(switched):
    """The error over all sensors within 1 %: the sample steps themselves leave a hundredth of a kelvin."""
    rms = [compare(folder.case).rmse_K for folder in switched.values()]
    assert rms == pytest.approx([rms[0]] * 3, rel=0.01)
    steps = [list(folder.steps.values()) for folder in switched.values()]
    assert min(map(len, steps)) > 0
    assert max(s.error_K for own in steps for s in own) < 0.05


@pytest.mark.nightly
def test_the_same_diagnosis_at_all_steps(switched):
    """Same verdict, the effect as probable within 0.01, sizes within 3 % and within 5 % of the truth (6 W/K).

    Whether it is alone may differ by 0.05: six times the instants are more evidence, by which the temper grows.
    """
    found = [diagnose(folder.case).document() for folder in switched.values()]
    leading = [d["odds"][0] for d in found]
    assert {(d["verdict"], d["candidates"][0]["effect"]) for d in found} == {("named", "convection@flange")}
    sure = [d["candidates"][0]["probability"] for d in found]
    assert sure == pytest.approx([sure[0]] * 3, abs=0.01)
    assert [o["probability"] for o in leading] == pytest.approx([leading[0]["probability"]] * 3, abs=0.05)
    sizes = [d["candidates"][0]["amplitude"]["value"] for d in found]
    assert sizes == pytest.approx([sizes[0]] * 3, rel=0.03)
    assert sizes == pytest.approx([6.0] * 3, rel=0.05)


def two_bodies():
    """A winding of a minute in a housing of half an hour, with a fan on it."""
    net = bare_network("two", {"winding": 300.0, "housing": 5000.0}, ("ambient",))
    links = [
        node_link(net, "inside", "link", "winding", "housing", Fixed(5.0)),
        node_link(net, "still", "film", "housing", "ambient", Fixed(2.0)),
        node_link(net, "fan", "film", "housing", "ambient", InputPower(10.0, (("speed_rpm", 1000.0, 0.8),))),
    ]
    copper = node_source(net, "copper", "copper", {"winding": 1.0}, InputPower(100.0, (("current_A", 100.0, 2.0),)))
    return net.extended(links, [copper], ())


def switching(step=1.0):
    """Current and speed that switch at odd seconds, with two per cent of noise."""
    time, rng = np.arange(0.0, 1801.0, step), np.random.default_rng(0)
    current = np.where((time // 137) % 2 == 0, 100.0, 10.0) * (1.0 + 0.02 * rng.standard_normal(time.size))
    return time, {"current_A": current, "speed_rpm": np.where((time // 211) % 3 == 0, 3000.0, 0.0)}


@pytest.mark.parametrize(("step", "within"), [(5.0, 0.01), (10.0, 0.02), (30.0, 0.05)])
def test_wider_instants_keep_what_the_inputs_did_between_them(step, within):
    """Against every recorded second; one value per instant was off by 1 to 6 K."""
    net, (time, inputs) = two_bodies(), switching()
    rows, grid = [net.place(n).mean for n in net.states], np.arange(0.0, 1801.0, step)
    every = simulate(net, Record(time, inputs, {"ambient": 20.0}), rows=rows)
    wide = simulate(net, Record(grid, Signals.recorded(inputs, time, grid), {"ambient": 20.0}), rows=rows)
    assert np.abs(wide.y - every.y[:: int(step)]).max() < within
    assert wide.steps.knot.size < 0.5 * every.steps.knot.size


def test_the_integral_of_a_factor_is_kept_between_all_instants():
    """Heat of a noisy current, instant by instant, against quadrature of its square between the seconds."""
    time, inputs = switching()
    grid, law = np.arange(0.0, 1801.0, 30.0), InputPower(1.0, (("current_A", 1.0, 2.0),))
    signals = Signals.recorded(inputs, time, grid)
    first = signals.curve("copper", law)
    at = np.union1d(np.arange(grid.size), first.inserted)
    fine = signals.finer(at).curve("copper", law)
    width = np.diff(np.interp(at, np.arange(grid.size), grid))
    heat = width * (0.5 * (fine.value[1:] + fine.value[:-1]) + fine.bulge[1:] / 1.5)
    total = np.add.reduceat(heat, np.searchsorted(at, np.arange(grid.size - 1)))
    left, right = inputs["current_A"][:-1], inputs["current_A"][1:]
    exact = ((left**2 + left * right + right**2) / 3.0).reshape(-1, 30).sum(axis=1)
    np.testing.assert_allclose(total, exact, rtol=1e-9)


def test_a_sensor_that_follows_fast_asks_for_short_steps():
    """The winding's own time constant is 58 s, the housing's half an hour: one sensor at either."""
    net, (time, inputs) = two_bodies(), switching()

    def chosen(name, wished=None, lag_s=0.0):
        seen = [(name, net.place(name).mean, 0.05, lag_s)]
        return sample_step(net, time, inputs, {"ambient": 20.0}, seen, 60.0, wished)

    assert chosen("winding").step_s < chosen("housing").step_s == 10.0  # no wider than the instants of a fit
    assert chosen("winding").step_s < chosen("winding", lag_s=600.0).step_s  # one that follows slowly
    assert chosen("winding").node == "winding"
    assert chosen("winding").time_constant_s == pytest.approx(58.0, rel=0.1)
    assert chosen("housing", 5.0).step_s == 5.0
    assert "every 10 s in warm" in sampled({"warm": chosen("housing")})
    assert "time constant of winding is 56.2 s" in sampled({"warm": replace(chosen("winding"), time_constant_s=56.18)})
    assert "time constant of winding is 10 h" in sampled({"warm": replace(chosen("winding"), time_constant_s=36000.0)})


def test_modes_and_what_a_mean_leaves_of_them():
    """One node of C / G; the mean of 1 - exp(-t / tau) over half a step on both sides, by quadrature."""
    modes = Modes.of(np.array([[2.0]]), np.array([4000.0]))
    assert modes.rate == pytest.approx([5e-4])
    assert (modes.shape @ modes.weight).real == pytest.approx(np.array([[0.5]]))
    G = np.array([[2.0, -1.0], [-1.0, 3.0]])  # the first has no capacity: what heat warms both by is the same
    assert (m := Modes.of(G, np.array([0.0, 4000.0]))).shape @ m.weight == pytest.approx(np.linalg.inv(G))
    for x in (0.3, 3.0, 30.0):
        mean = quad(lambda t, x=x: -np.expm1(-x * t), 0.0, 0.5)[0]
        assert interpolation_error(np.array([x]))[0] == pytest.approx(abs(mean + np.expm1(-x) / 12.0), abs=1e-9)
    assert interpolation_error(np.array([1e-6]))[0] == pytest.approx(1e-6 / 24.0, rel=1e-3)


def test_an_input_that_has_no_finer_steps_is_scaled_too():
    """An alternating current is known by its heat in each sample alone, beside inputs as they were recorded."""
    grid, fine = np.arange(4.0), np.linspace(0.0, 3.0, 13)
    inputs = {"current_A": 3.0 + grid, "speed_rpm": 100.0 * grid}
    recorded = Recorded(fine, {"speed_rpm": 100.0 * fine}, grid, {"speed_rpm": inputs["speed_rpm"]})
    more = Test("swinging", "calibrate", grid, inputs, {}, (), recorded=recorded).scaled({"current_A": 2.0})
    assert more.signals["current_A"] == pytest.approx(2.0 * inputs["current_A"])
    assert more.signals["speed_rpm"] == pytest.approx(inputs["speed_rpm"])


def test_what_the_laws_read_has_the_order_of_the_test():
    """Sums and columns over inputs are the same in every process: no set, which Python shuffles, is between."""
    grid, fine = np.arange(4.0), np.linspace(0.0, 3.0, 13)
    inputs = {f"heat_{name}": grid for name in "qwertyuiop"}
    recorded = Recorded(fine, {name: fine for name in sorted(inputs)}, grid, inputs)
    assert list(Test("many", "calibrate", grid, inputs, {}, (), recorded=recorded).signals)[:10] == list(inputs)


# column -> (unit of the small case, another one, from the first to the second)
OTHERS = {
    "time_s": ("s", "min", lambda v: v / 60.0),
    "current": ("A", "mA", lambda v: 1e3 * v),
    "wind": ("km/h", "m/s", lambda v: v / 3.6),
    "air": ("degC", "degF", lambda v: 32.0 + 1.8 * v),
    "T_winding": ("degC", "K", lambda v: v + 273.15),
    "T_yoke": ("K", "degC", lambda v: v - 273.15),
    "T_flange": ("degC", "degF", lambda v: 32.0 + 1.8 * v),
}


def with_units(folder, other):
    """The small case with twelve digits, as it is or in the other units."""
    case = small_case(folder)
    for seed, name in enumerate(["stand", "road", "town"]):
        rows = measured(seed, name != "stand", 6.0)
        sheet = (case / "tests" / f"{name}.toml").read_text()
        if other:
            rows = np.column_stack([change(y) for y, (_, _, change) in zip(rows.T, OTHERS.values(), strict=True)])
            head, *blocks = sheet.split("[columns.")
            units = {f"{column}]": (a, b) for column, (a, b, _) in OTHERS.items()}
            blocks = [b.replace(*(f'unit = "{u}"' for u in units[b.split("\n")[0]])) for b in blocks]
            sheet = "[columns.".join([head.replace('time = "time_s"', 'time = "time_s"\ntime_unit = "min"'), *blocks])
        lines = [HEADER, *(",".join(f"{v:.12g}" for v in row) for row in rows)]
        (case / "tests" / f"{name}.csv").write_text("\n".join(lines) + "\n")
        (case / "tests" / f"{name}.toml").write_text(sheet)
    return ts.open(case)


@pytest.mark.nightly
def test_other_units_change_nothing(tmp_path):
    """Twelve digits are 1e-10 of a temperature; steps of a fit end within 1e-6 of each other."""
    here, there = (with_units(tmp_path / word, word == "other") for word in ("same", "other"))
    assert there.compare().rmse_K == pytest.approx(here.compare().rmse_K, rel=1e-6)
    one, two = here.diagnose().document()["odds"], there.diagnose().document()["odds"]
    assert [o["hypothesis"] for o in two] == [o["hypothesis"] for o in one]
    assert [o["probability"] for o in two] == pytest.approx([o["probability"] for o in one], abs=1e-3)
