"""The page on condensation: what its tables say is what is wanted, and they stand between markers of their script."""

import re
from pathlib import Path

PAGE = (Path(__file__).parents[2] / "docs" / "condensation.md").read_text(encoding="utf-8")


def cells(marker: str) -> dict[str, list[tuple[float, float]]]:
    """Point -> (heated, other) of each machine, from the table between a marker's begin and end."""
    table = PAGE.partition(f"<!-- {marker}:begin -->\n")[2].partition(f"<!-- {marker}:end -->")[0]
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
    assert "Wanted are 2 / 5" in PAGE
    for point, machines in found.items():
        assert max(heated for heated, _ in machines) <= 2.0, point
        assert max(other for _, other in machines) <= 5.0, point


def test_the_small_network_is_compared_at_the_same_points():
    small, large = cells("small-network"), cells("case-network")
    assert small.keys() == large.keys()
    assert all(len(small[point]) == len(large[point]) for point in small)


def test_no_table_of_it_is_empty():
    assert re.findall(r"<!-- (\S+):begin -->\n<!--", PAGE) == []
