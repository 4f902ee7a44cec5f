"""What is published of measured error agrees: the front page and the page of the case, and both with their script."""

import re

import pytest

from scripts.published import FRONT, HUST, ROOT, between, demo_table

CONDENSATION = (ROOT / "docs" / "condensation.md").read_text(encoding="utf-8")


def rows(text: str, first: str) -> list[list[str]]:
    """The cells of the Markdown table whose first heading is `first`, without its head."""
    lines = text[text.index(f"| {first} |") :].split("\n\n")[0].splitlines()
    return [[c.strip(" *") for c in re.split(r"(?<!\\)\|", line)[1:-1]] for line in lines[2:] if line.startswith("|")]


@pytest.fixture(scope="module")
def published():
    """Front page: model -> cells.  Page: (model, role) -> cells, profile -> cells of its last row."""
    front = {r[0]: r[1:] for r in rows(FRONT.read_text().split("<!-- hust-rows:begin -->")[1], "model")}
    page = HUST.read_text()
    models = {(r[0], r[1]): r[2:] for r in rows(page, "model")}
    return front, models, {r[0]: r[2:] for r in rows(page, "held-out profile") if r[1] == "all"}


def test_both_pages_have_the_same_models(published):
    front, models, _ = published
    assert list(front) == list(dict.fromkeys(model for model, _ in models))
    assert len(front) >= 3


def test_sensors_and_sums_agree(published):
    front, models, _ = published
    for model, cells in front.items():
        assert cells[:5] == models[model, "hold-out"], model


def test_profiles_agree(published):
    front, _, profiles = published
    first, last = front[next(iter(front))], front[list(front)[-1]]
    assert first[5:] == [cells[0] for cells in profiles.values()]
    assert last[5:] == [cells[1] for cells in profiles.values()]


def test_words_say_what_the_table_says(published):
    """By how much each sensor's error fell, in the page's words."""
    front, *_ = published
    first, last = front[next(iter(front))], front[list(front)[-1]]
    share = [round(100 * float(b) / float(a)) for a, b in zip(first[:4], last[:4], strict=True)]
    said = re.search(r"winding to (\d+) %, stator to (\d+) %, rotor to\s+(\d+) %, all to (\d+) %", HUST.read_text())
    assert [int(x) for x in said.groups()] == pytest.approx(share, abs=1)


def test_a_table_goes_between_its_markers():
    assert between("a\n<!-- x:begin -->\nold\n<!-- x:end -->\nb", "x", "new\n") == (
        "a\n<!-- x:begin -->\nnew\n<!-- x:end -->\nb"
    )
    with pytest.raises(SystemExit, match="no pair of markers 'y'"):
        between("a", "y", "new")


def test_the_demo_table_is_bold_where_it_was_never_used():
    tests = [{"name": "a", "role": "calibrate", "rmse_K": 0.256}, {"name": "b", "role": "hold-out", "rmse_K": 1.0}]
    assert demo_table([{"stage": "start", "tests": tests}]).splitlines()[-1] == "| start | 0.26 | **1.00** |"


def cells(marker: str) -> dict[str, list[tuple[float, float]]]:
    """Point -> (heated, other) of each machine, from the table between a marker's begin and end."""
    table = CONDENSATION.partition(f"<!-- {marker}:begin -->\n")[2].partition(f"<!-- {marker}:end -->")[0]
    rows = [[c.strip() for c in line.strip("|").split("|")] for line in table.splitlines()[3:]]
    return {row[0]: [tuple(map(float, c.split(" / "))) for c in row[1:]] for row in rows}


def test_a_cases_network_is_within_what_is_wanted():
    """Hottest points that a loss heats within 2 %, any other within 5 %: steady, and after a step of loss."""
    found = cells("case-network")
    assert {
        "nominal",
        "films x0.3",
        "films x10",
        "contacts x0.2",
        "contacts x5",
        "step of loss, nominal",
    } <= found.keys()
    assert "Wanted are 2 / 5" in CONDENSATION
    for point, machines in found.items():
        assert max(heated for heated, _ in machines) <= 2.0, point
        assert max(other for _, other in machines) <= 5.0, point


def test_the_small_network_is_compared_at_the_same_points():
    small, large = cells("small-network"), cells("case-network")
    assert small.keys() == large.keys()
    assert all(len(small[point]) == len(large[point]) for point in small)


def test_no_table_of_it_is_empty():
    assert re.findall(r"<!-- (\S+):begin -->\n<!--", CONDENSATION) == []
