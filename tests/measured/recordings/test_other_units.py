"""The same recordings in other units are the same recordings: errors, odds and sizes stay."""

import numpy as np
import pytest
from small_case import HEADER, measured, small_case

import thermoscope as ts

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


def written(folder, other):
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
    here, there = (written(tmp_path / word, word == "other") for word in ("same", "other"))
    assert there.compare().rmse_K == pytest.approx(here.compare().rmse_K, rel=1e-6)
    one, two = here.diagnose().document()["odds"], there.diagnose().document()["odds"]
    assert [o["hypothesis"] for o in two] == [o["hypothesis"] for o in one]
    assert [o["probability"] for o in two] == pytest.approx([o["probability"] for o in one], abs=1e-3)
