"""The table of `model build`: what its exit code hangs on stands in it."""

import pytest

from thermoscope.commands.model.build import _sizes

ERRORS = {"mean": 0.1, "hot": 0.4, "point": 0.5, "mean_part": "a", "hot_part": "b", "point_part": "c"}


@pytest.mark.parametrize(("mesh", "network", "code"), [(1.2, 0.4, 0), (12.8, 0.4, 1), (1.2, 9.0, 1)])
def test_the_last_rows_say_yes_where_it_exits_0(mesh, network, code):
    """The network that was kept, and the mesh: the part and the error that are too much, in words."""
    first = {"asked": 0, "states": 5, "met": False, "nominal": ERRORS, "random": ERRORS}
    guard = {"states": 90, "points": ["p"], "met": network < 2.0, "random": {**ERRORS, "hot": network}}
    chosen = {"worst": mesh, "worst_part": "poles", "met": mesh < 1.5, "unknowns": 154161}
    wish = {"mean": 1.0, "hot": 2.0, "point": 2.0}
    table, *notes = _sizes({"wish_percent": wish, "sizes": [first], "guard": [guard], "mesh": chosen})
    rows = {row["network"]: row for row in table.documents()}
    assert list(rows) == ["means only", "learned", "the mesh"]
    assert rows["the mesh"]["hot spot"] == mesh
    assert (rows["learned"]["met"], rows["the mesh"]["met"]) == (
        "yes" if network < 2 else "no",
        "yes" if mesh < 1.5 else "no",
    )
    assert (rows["learned"]["met"] == rows["the mesh"]["met"] == "yes") is (code == 0)
    said = " ".join(map(str, notes))
    assert f"{mesh:.2g} % of the rise at the hot spot of poles" in said
    assert ("beyond 4 GB or 3 min" in said) is (mesh > 1.5)
