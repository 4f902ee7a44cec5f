"""thermoscope rate: ratings of a small case, with bands; what is wrong is one message."""

import pytest
from small_case import small_case

HOLES = "torque_Nm,speed_rpm,copper_W\n0,0,0\n50,0,20\n0,1000,0\n"


def test_the_continuous_rating_is_the_rest_of_the_network(thermoscope, tmp_path):
    """G from winding to air: 8 in series with (3 + (6 in series with 1.5)); R grows with the winding's temperature."""
    said = thermoscope(
        "use", "rate", small_case(tmp_path), "--limit", "winding=120", "--at", "ambient=20", "--json", "-"
    )
    assert said.code == 0, said.err
    document = said.document
    air = 3.0 + 1.0 / (1.0 / 6.0 + 1.0 / 1.5)
    heat = 100.0 / (1.0 / 8.0 + 1.0 / air)
    amps = (heat / (0.02 * (1.0 + 0.00393 * 100.0))) ** 0.5
    rows = {r["form"]: r for r in document["ratings"]}
    assert rows["S1"]["value"] == pytest.approx(amps, rel=3e-3)
    low, high = rows["S1"]["ci95"]
    assert low < amps < high
    values = [rows[f]["value"] for f in ("S1", "S6 40 %", "S2 60 s", "S2 10 s")]
    assert values == sorted(values)
    assert 0.0 < document["overload"]["from_warm_s"] < document["overload"]["from_cold_s"]
    shares = {d["value"]: d["share"] for d in document["derating"] if d["of"] == "ambient"}
    assert shares[60.0] == pytest.approx(0.6**0.5, rel=5e-3)


def test_what_is_wrong_is_one_message(thermoscope, tmp_path):
    case, holes = small_case(tmp_path), tmp_path / "map.csv"
    holes.write_text(HOLES)
    for arguments, message in {
        ("--limit", "winding=10"): "the limit of 'winding', 10 degC, is exceeded without any load",
        ("--limit", "coil=120"): "no temperature 'coil' to limit",
        (): "no limit is given",
        ("--limit", "winding=120", "--losses", str(holes)): "1 of 4 points are missing, the first at 50 Nm, 1000 1/min",
    }.items():
        said = thermoscope("use", "rate", case, *arguments)
        assert said.code == 2
        assert message in said.err.splitlines()[-1]
