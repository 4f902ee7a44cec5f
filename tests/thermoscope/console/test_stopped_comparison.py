"""A comparison or a fit that the user stops gives what is known, and says what was kept."""

import signal
from contextlib import suppress

import pytest

from tests.shared.command_line import answered
from tests.shared.small_case import small_case
from thermoscope import cli
from thermoscope.commands.model import calibrate
from thermoscope.files import STOPPED
from validation.comparison import compare as comparison
from validation.parameters.unknowns import value_words


@pytest.fixture(scope="module")
def case(tmp_path_factory):
    return small_case(tmp_path_factory.mktemp("stopped"))


def stop_in(monkeypatch, number):
    """As Ctrl-C does, while the test of that number is compared."""
    usual, so_far = comparison.judged_error, []

    def judged(*given):
        so_far.append(given)
        if len(so_far) == number:
            raise KeyboardInterrupt
        return usual(*given)

    monkeypatch.setattr(comparison, "judged_error", judged)


def test_what_was_compared_is_shown(case, monkeypatch, tmp_path):
    whole = answered("test", "compare", case, "--json", "-").document
    stop_in(monkeypatch, 3)
    done = answered("test", "compare", case, "--json", tmp_path / "a.json")
    assert done.code == 130
    assert "2 of 3 tests were compared" in done.err
    assert "kept in" in done.err
    assert f"of {sum(len(t['channels']) for t in whole['tests'][:2])} sensor records" in done.out
    assert not (tmp_path / "a.json").exists(), "a part would be taken for the whole"
    monkeypatch.undo()
    assert answered("test", "compare", case, "--json", "-").document == whole


def test_nothing_known_is_said_too(case, monkeypatch):
    stop_in(monkeypatch, 1)
    done = answered("test", "compare", case)
    assert done.code == 130
    assert "stopped: inputs are as they were" in done.err
    assert "Traceback" not in done.err


def test_a_stopped_fit_shows_the_values_it_reached_and_goes_on_from_them(tmp_path, monkeypatch):
    case = small_case(tmp_path)
    before = (case / "model.toml").read_bytes() if (case / "model.toml").exists() else None
    usual, kept = calibrate.Unfinished.keep, []

    def keep(self, values):
        usual(self, values)
        kept.append(dict(values))
        if len(kept) == 2:
            raise KeyboardInterrupt

    monkeypatch.setattr(calibrate.Unfinished, "keep", keep)
    done = answered("model", "calibrate", case, "--json", tmp_path / "a.json")
    assert done.code == 130
    assert "As far as the fit came" in done.out
    assert any(value_words(name) in done.out for name in kept[-1])
    assert f"kept in {case / 'out' / calibrate.NAME}" in " ".join(done.err.split())
    assert not (tmp_path / "a.json").exists()
    assert ((case / "model.toml").read_bytes() if (case / "model.toml").exists() else None) == before
    monkeypatch.undo()
    assert "going on with the calibration" in answered("model", "calibrate", case).err


def interrupted(*_, **__):
    raise KeyboardInterrupt


def test_a_stopped_diagnosis_shows_the_comparison_and_keeps_the_one_before(tmp_path, monkeypatch):
    case = small_case(tmp_path)
    answered("test", "compare", case)
    monkeypatch.setattr("validation.diagnose", interrupted)
    done = answered("explain", "diagnose", case, "--json", tmp_path / "a.json")
    assert done.code == 130
    assert "sensor records" in done.out
    assert "stopped: a verdict weighs all hypotheses" in " ".join(done.err.split())
    assert not (tmp_path / "a.json").exists()


def test_a_stopped_improvement_shows_the_steps_that_stay(tmp_path, monkeypatch):
    case = small_case(tmp_path)
    monkeypatch.setattr("validation.revision.improvement.diagnose", interrupted)
    done = answered("explain", "improve", case, "--yes", "--json", tmp_path / "a.json")
    assert done.code == 130
    assert "Stopped after 1 step;" in done.out
    assert "1 revision written to" in " ".join(done.err.split())
    assert (case / "model.toml").exists()
    assert not (tmp_path / "a.json").exists()


def test_a_stop_that_a_package_makes_an_error_of_is_a_stop(monkeypatch, capsys):
    """C code that is loaded when Ctrl-C comes says that it could not be."""

    def loading(*_, **__):
        with suppress(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
        raise ImportError("initialization failed")

    monkeypatch.setattr(signal, "default_int_handler", signal.getsignal(signal.SIGINT))
    monkeypatch.setattr("sys.argv", ["thermoscope", "test", "compare", "x"])
    monkeypatch.setattr(cli, "narrowed_app", lambda arguments: loading)
    before = signal.getsignal(signal.SIGINT)
    with pytest.raises(SystemExit) as end:
        cli.main()
    signal.signal(signal.SIGINT, before)
    assert end.value.code == STOPPED
    assert "inputs are as they were" in capsys.readouterr().err
