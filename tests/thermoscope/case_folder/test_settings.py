"""What case.toml says of the commands is what they do."""

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
        ("[doubt]\nsloww = 0.1", "unknown line of doubt"),
        ("[doubt]\nslow = true", "slow"),
        ('[diagnosis]\ncatalogue = ["convektion"]', "no kind of effect"),
        ("[diagnosis]\ndraws = 3", "unknown key 'draws'"),
        ("[calibration]\nstarts = 0", "starts"),
        ("[calibration]\nseed = 1.5", "seed"),
    ],
)
def test_refused_by_file_and_key(case, lines, words):
    with pytest.raises(InputError, match=words) as fault:
        said(case, lines)
    assert "case.toml" in str(fault.value)
