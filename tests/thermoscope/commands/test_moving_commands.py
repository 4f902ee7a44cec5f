"""thermoscope show viewer, show film: one message for what they cannot do, and nothing written."""

from pathlib import Path

import pytest

from geom.errors import InputError
from thermoscope.commands.show.film import film
from thermoscope.commands.show.viewer import viewer


@pytest.mark.parametrize(("run", "name"), [(viewer, "v.html"), (film, "f.gif"), (film, "f.mp4")])
def test_a_case_without_geometry_is_refused(case, tmp_path, run, name):
    with pytest.raises(InputError, match="no geometry"):
        run(str(case), tmp_path / "new" / name, None)
    assert not (tmp_path / "new").exists()


@pytest.mark.parametrize(("run", "name"), [(viewer, "v.png"), (film, "f.avi")])
def test_a_name_that_fits_no_format_is_refused(run, name):
    with pytest.raises(InputError, match="is not a name"):
        run("road-test", Path(name), None)
