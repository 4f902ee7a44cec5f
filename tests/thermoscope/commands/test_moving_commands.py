"""thermoscope show viewer, show film: one message for what they cannot do, and nothing written."""

from pathlib import Path
from types import SimpleNamespace

import pytest

from geom.errors import InputError
from thermoscope.commands.show.film import film, largest, title
from thermoscope.commands.show.viewer import viewer
from viz import Sensor


@pytest.mark.parametrize(("run", "name"), [(viewer, "v.html"), (film, "f.gif"), (film, "f.mp4")])
def test_a_case_without_geometry_is_refused(case, tmp_path, run, name):
    with pytest.raises(InputError, match="no geometry"):
        run(str(case), tmp_path / "new" / name, None)
    assert not (tmp_path / "new").exists()


@pytest.mark.parametrize(("run", "name"), [(viewer, "v.png"), (film, "f.avi")])
def test_a_name_that_fits_no_format_is_refused(run, name):
    with pytest.raises(InputError, match="is not a name"):
        run("road-test", Path(name), None)


def test_a_title_names_the_sensor_that_is_missed_most():
    place = (0.0, 0.0, 0.0)
    row = [
        Sensor("T_shaft_degC", place, 2.0, 1.0),
        Sensor("T_yoke_degC", place, -4.0, 4.5),
        Sensor("T_air", place, None),
    ]
    assert largest(row) == ": shaft +2.0 K"
    assert largest(row[1:]) == ""
    assert title(SimpleNamespace(name="road-2"), 3120.0, "the model now", row) == (
        "road-2 at 52 min, the model now: shaft +2.0 K"
    )
