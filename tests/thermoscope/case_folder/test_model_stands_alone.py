"""A model.toml is one model: whatever tests stand beside it, simulate, compare, export and rate say the same."""

import json
import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from geom.errors import InputError
from thermoscope.case_folder.folder import load_case
from validation.comparison.compare import errors
from validation.parameters.unknowns import standing

NETWORK = """
[network]
name = "two"
boundaries = ["ambient"]
[nodes.coil]
C_J_K = 800
prior_sd = 0.1
[nodes.body]
C_J_K = 3000
[links.coil-body]
between = ["coil", "body"]
G_W_K = 4
[links.body-air]
between = ["body", "ambient"]
G_W_K = 1.5
of = { input = "speed_rpm", at = 2000, exponent = 0.5 }
prior_sd = 0.1
[links.foot]
between = ["body", "ambient"]
G_W_K = 0.4
[losses.copper]
kind = "copper"
at = "coil"
R20_ohm = 0.03
currents = ["current_A"]
[losses.windage]
kind = "windage"
at = "body"
P_W = 60
of = { input = "speed_rpm", at = 2000, exponent = 1.5 }
prior_sd = 0.3
"""
SHEET = """
[test]
time = "time_s"
initial = "first-readings"
[boundaries]
ambient = {ambient}
[columns.T_body]
quantity = "temperature"
unit = "degC"
place = "body"
sigma_K = 0.2
[columns.T_coil]
quantity = "temperature"
unit = "degC"
place = "coil"
sigma_K = 0.2
[columns.n]
quantity = "speed"
unit = "rpm"
input = "speed_rpm"
[columns.i]
quantity = "current"
unit = "A"
input = "current_A"
"""
TESTS = {  # role, slowest and fastest speed (rpm), current (A), ambient (degC)
    "slow": ("calibrate", (800, 1600), 20, 22),
    "mid": ("calibrate", (1200, 2400), 40, 22),
    "check": ("validate", (900, 1900), 30, 25),
    "fast": ("hold-out", (3000, 6000), 60, 15),
    "rest": ("hold-out", (100, 300), 10, 35),
}
FITTED = ("slow", "mid", "check", "fast")


def driven(seed: int, speeds: tuple[int, int], current: float, ambient: float) -> str:
    """A test of an hour as CSV: windage of the machine in truth ~ speed^1.8, AC loss that its network lacks."""
    rng, t = np.random.default_rng(seed), np.arange(0.0, 3600.0, 30.0)
    n = np.where(np.sin(t / 500 + seed) > 0, *speeds)
    i = current * np.where(t < 60, 0.0, 1.0 + 0.3 * np.sin(t / 900))
    T = np.full((t.size, 2), float(ambient))
    for k in range(t.size - 1):
        step, (coil, body), lost = 30.0 / 20, T[k], 0.4 + 1.5 * (n[k] / 2000) ** 0.5
        extra = 0.0005 * (n[k] / 1000) ** 2
        for _ in range(20):
            through = 4 * (coil - body)
            coil += step / 800 * (0.03 * (1 + 0.00393 * (coil - 20)) * i[k] ** 2 + extra * i[k] ** 2 - through)
            body += step / 3000 * (60 * (n[k] / 2000) ** 1.8 + through - lost * (body - ambient))
        T[k + 1] = coil, body
    T += rng.normal(0, 0.05, T.shape)
    rows = zip(t, T[:, 1], T[:, 0], n, i, strict=True)
    return "time_s,T_body,T_coil,n,i\n" + "".join(f"{','.join(f'{x:.3f}' for x in row)}\n" for row in rows)


def written(folder: Path, names, model: str = "") -> Path:
    """The case with some of the tests, in that order."""
    (folder / "tests").mkdir(parents=True)
    (folder / "network.toml").write_text(NETWORK)
    text = '[case]\nname = "two"\nnetwork = "network.toml"\n'
    for name in names:
        role, *drive, ambient = TESTS[name]
        text += f'[tests.{name}]\nrole = "{role}"\n'
        (folder / "tests" / f"{name}.csv").write_text(driven([*TESTS].index(name), *drive, ambient))
        (folder / "tests" / f"{name}.toml").write_text(SHEET.replace("{ambient}", f"{ambient}.0"))
    (folder / "case.toml").write_text(text)
    if model:
        (folder / "model.toml").write_text(model)
    return folder


@pytest.fixture(scope="module")
def fitted(tmp_path_factory, thermoscope):
    """A case with its calibration, then with an effect that was added."""
    case = written(tmp_path_factory.mktemp("fitted") / "two", FITTED)
    assert thermoscope("model", "calibrate", case).code == 0
    thermoscope("model", "add", case, "copper.ac@coil", "--anyway")
    return (case / "model.toml").read_text()


def said(thermoscope, case: Path, band: str = "--no-bands") -> dict:
    """All that the commands say of the model; of tests by their names. With bands those of tests alone."""
    out = {}
    compared = thermoscope("test", "compare", case, band, "--json", "-").document
    simulated = thermoscope("use", "simulate", case, band, "--json", "-").document
    for test in compared["tests"]:
        out["compare", test["name"]] = test
    for run in simulated["runs"]:
        out["simulate", run["name"]] = Path(run.pop("file")).read_text(), run
    if band == "--bands":
        return out
    rated = thermoscope("use", "rate", case, "--limit", "coil=120", band, "--json", "-")
    assert rated.code == 0, rated.err
    out["rate"] = rated.document
    for form in ("json", "c"):
        into = case / "code" / form
        assert thermoscope("use", "export", case, "--as", form, "--out", into).code == 0
        out[form] = {f.name: f.read_bytes() for f in sorted(into.iterdir())}
    return out


def assert_same(one: dict, other: dict) -> None:
    """What both say is the same to the bit; of the model as such both say all."""
    assert {k for k in one if isinstance(k, str)} == {k for k in other if isinstance(k, str)}
    for key in one.keys() & other.keys():
        assert json.dumps(one[key], default=repr) == json.dumps(other[key], default=repr), key


VARIANTS = [("rest", "fast", "check", "mid", "slow"), ("rest", "fast")]


@pytest.fixture(scope="module")
def as_fitted(tmp_path_factory, thermoscope, fitted):
    return said(thermoscope, written(tmp_path_factory.mktemp("as") / "two", FITTED, fitted))


@pytest.mark.parametrize("names", VARIANTS, ids="-".join)
def test_tests_that_come_go_or_change_places_change_nothing(tmp_path, thermoscope, fitted, as_fitted, names):
    case = written(tmp_path / "two", names, fitted)
    assert_same(said(thermoscope, case), as_fitted)


def test_random_tests_beside_a_model_change_no_network(tmp_path, fitted):
    """Laws, multipliers, bounds and levels, over any choice and order of tests."""
    rng, reference = np.random.default_rng(0), None
    for k in range(6):
        names = rng.permutation([*TESTS])[: rng.integers(1, len(TESTS) + 1)]
        case = load_case(written(tmp_path / str(k) / "two", names, fitted)).case
        network = standing(case)
        heat = [p for p in network.parameters if " of " not in p.name]
        now = repr((network.links, network.sources, heat, case.model.values))
        reference = reference or now
        assert now == reference


def test_bands_do_not_depend_on_tests_that_were_not_fitted(tmp_path, thermoscope, fitted):
    one = said(thermoscope, written(tmp_path / "one" / "two", FITTED, fitted), "--bands")
    other = said(thermoscope, written(tmp_path / "other" / "two", (*reversed(FITTED), "rest"), fitted), "--bands")
    assert_same(one, other)


def test_the_reference_is_of_the_tests_that_a_fit_may_use(fitted):
    revision, *_ = tomllib.loads(fitted)["revision"]
    speed = revision["reference"]["signals"]["speed_rpm"]
    assert speed["high"] == 2400.0
    used = [
        np.loadtxt(driven([*TESTS].index(n), *TESTS[n][1:]).splitlines()[1:], delimiter=",")[:, 3]
        for n in ("slow", "mid", "check")
    ]
    assert speed["level"] == pytest.approx(np.sqrt(np.mean(np.concatenate(used) ** 2)), rel=1e-8)


def test_every_later_revision_keeps_it(tmp_path, thermoscope, fitted):
    """Added, taken out, taken back, calibrated again beside another test: the level stays where it was."""
    case = written(tmp_path / "two", ("rest", *FITTED), fitted)
    for step in (["remove", case, "copper.ac@coil"], ["undo", case], ["undo", case, "--to", "0"], ["calibrate", case]):
        assert thermoscope("model", *step).code == 0, step
    revisions = tomllib.loads((case / "model.toml").read_text())["revision"]
    levels = [r["reference"]["signals"]["speed_rpm"]["level"] for r in revisions if "reference" in r]
    assert len(levels) >= 5
    assert len(set(levels)) == 1


def test_a_file_of_before_is_read_with_one_note(tmp_path, thermoscope, fitted):
    """It means what it meant when it was fitted: held-out tests have no say, and the note says the level."""
    document = _uncounted(fitted.split("[revision.reference]")[0])
    now = thermoscope("test", "compare", written(tmp_path / "now", FITTED, _uncounted(_first(fitted))), "--json", "-")
    old = thermoscope("test", "compare", written(tmp_path / "old", FITTED, document), "--json", "-")
    assert [t["rmse_K"] for t in old.document["tests"]] == [t["rmse_K"] for t in now.document["tests"]]
    assert old.err.count("does not say what its exponents") == 1
    assert "speed_rpm 1" in old.err
    assert "does not say" not in now.err


def test_a_test_that_was_fitted_is_no_held_out_one(tmp_path, thermoscope, fitted):
    case = written(tmp_path / "now", FITTED, fitted)
    (case / "case.toml").write_text((case / "case.toml").read_text().replace('role = "validate"', 'role = "hold-out"'))
    told = thermoscope("test", "compare", case, "--no-bands").err
    assert "check: held out, but the model was fitted to it" in " ".join(told.split())
    before = thermoscope("test", "compare", written(tmp_path / "before", FITTED, fitted), "--no-bands")
    assert "held out, but" not in before.err


def _first(model: str) -> str:
    return "\n[[revision]]\n".join(model.split("\n[[revision]]\n")[:2])


def test_a_right_fit_is_told_as_right_beside_a_hold_out(tmp_path, thermoscope):
    """Fitted to a tenth of a kelvin, whatever is held out; with sensors as fitted beside it."""
    alone = thermoscope("model", "calibrate", written(tmp_path / "alone", FITTED[:3]), "--json", "-").document
    beside = thermoscope("model", "calibrate", written(tmp_path / "beside", FITTED), "--json", "-").document
    assert beside["accepted"]
    for a, b in zip(alone["tests"], beside["tests"][:3], strict=True):
        assert a == b
    first = beside["tests"][0]
    assert first["rmse_K"]["after"] < 0.3 * first["rmse_K"]["before"]
    assert first["fitted_rmse_K"]["after"] != first["rmse_K"]["after"]


def test_an_unknown_exponent_is_still_refused(tmp_path, fitted):
    with pytest.raises(InputError, match=r"unknown parameter 'loss.windage\^wind'"):
        load_case(written(tmp_path / "two", FITTED, fitted.replace("windage^speed_rpm", "windage^wind")))


def test_errors_with_sensors_as_fitted_stand_beside_the_raw_ones(tmp_path):
    """A thermometer that reads half a kelvin high: the raw error has it, the fitted one has not."""
    model = """[[revision]]
number = 1
action = "calibrate"
effects = []
why = ""
[revision.values]
"bias of T_body" = 0.5
"""
    case = load_case(written(tmp_path / "two", ("slow",), model)).case
    raw = errors(case).tests[0].channels
    one = next(c for c in raw if c.channel == "T_body")
    assert one.fitted_rmse_K**2 == pytest.approx(one.rmse_K**2 - 2 * 0.5 * one.bias_K + 0.25)
    assert errors(replace(case, model=replace(case.model, values={}))).fitted_rmse_K is None


def _uncounted(document):
    """A model.toml without the number of its lines, as files of before are."""
    return "".join(line for line in document.splitlines(True) if not line.startswith("lines = "))
