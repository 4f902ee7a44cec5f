"""What case.toml says of the commands is what they do."""

import numpy as np
import pytest

from geom.errors import InputError
from measured.doubt import USUAL
from thermoscope.case_folder.folder import load_case
from thermoscope.commands.model.calibrate import calibrate
from validation.inference.evidence import candidates


def said(case, lines):
    file = case / "case.toml"
    file.write_text(f"{file.read_text()}\n{lines}\n")
    return load_case(case)


def test_a_wider_line_of_doubt_reaches_the_fits(case):
    folder = said(case, '[doubt]\n"gain of stream" = 0.2\nslow = 0.05')
    assert {k: v for k, v in folder.case.doubt.items() if v != USUAL[k]} == {"gain of stream": 0.2, "slow": 0.05}


def test_a_catalogue_of_globs(case):
    folder = said(case, '[diagnosis]\ncatalogue = ["convection*", "mass"]')
    assert {"convection", "convection.constant", "mass"} <= set(folder.settings.kinds)
    assert "radiation" not in folder.settings.kinds
    assert {e.kind for e in candidates(folder.case, folder.settings.kinds)} <= set(folder.settings.kinds)


def test_a_calibration_takes_starts_and_seed(case, monkeypatch, capsys):
    said(case, "[calibration]\nstarts = 3\nseed = 11")
    taken = []
    monkeypatch.setattr(
        "validation.revision.revise.calibrate", lambda *_, search, **__: taken.append(search) or _stop()
    )
    for options, wanted in (({}, (3, 11)), ({"starts": 1, "seed": 5}, (1, 5))):
        with pytest.raises(InputError):
            calibrate(str(case), False, None, **options)
        assert (taken[-1].starts, taken[-1].seed) == wanted


def _stop():
    raise InputError("seen")


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        ("[doubt]\nslow = 0.001", "no wider than usual"),
        ("[doubt]\nslow = true", "slow"),
        ("[diagnosis]\ndraws = 3", "unknown key 'draws'"),
        ("[calibration]\nseed = 1.5", "seed"),
    ],
)
def test_refused_by_file_and_key(case, lines, words):
    with pytest.raises(InputError, match=words) as fault:
        said(case, lines)
    assert "case.toml" in str(fault.value)


@pytest.mark.parametrize(("at", "told"), [(100.0, True), (1.0, False), (2.0, False)])
def test_a_law_of_a_share_that_refers_to_a_percentage(case, at, told):
    """Files of before were written for 0 to 100: a hundred times less loss in silence would look like a cause."""
    loss = f'\n[losses.fan]\nkind = "friction"\nat = "yoke"\nP_W = 50\nof = {{ input = "load", at = {at} }}\n'
    (case / "network.toml").write_text((case / "network.toml").read_text() + loss)
    for sheet in (case / "tests").glob("*.toml"):
        wind = 'quantity = "vehicle_speed"\nunit = "km/h"'
        assert wind in sheet.read_text()
        sheet.write_text(sheet.read_text().replace(wind, 'quantity = "share"\nunit = "%"\ninput = "load"'))
    folder = load_case(case)
    fan = next(s for s in folder.case.model.network.sources if s.name == "loss:fan")
    assert float(fan.law.factor({"load": np.ones(1)})[0]) == pytest.approx(50.0 if told else 50.0 / at)
    assert [n for n in folder.notes if "laws refer to load in percent" in n] == (
        ["laws refer to load in percent, recorded as 0 to 1: taken so"] if told else []
    )
