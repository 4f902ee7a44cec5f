"""Recordings that are hardly of equal motors: said first, with what speaks against it."""

from extras.monitor.commands.fleet import fleet_summary, unequal_words


def document(spread: float, rmse: float = 0.4) -> dict:
    rows = [
        {"name": n, "mean": 1.0, "spread_percent": s, "differs": True}
        for n, s in (("film", 20.0), ("capacity.a", spread))
    ]
    units = [{"unit": f"motor-{i}", "rmse_K": 0.4} for i in range(4)] + [{"unit": "motor-9", "rmse_K": rmse}]
    return {"units": units, "parameters": rows, "outliers": []}


def test_what_differs_by_more_than_half_is_another_motor():
    assert unequal_words(document(5.0)) == ""
    says = fleet_summary(document(70.0)).sentence
    asks = "Are these equal motors? heat capacity of a differs by 70 %. Give each type a folder of its own."
    assert says.startswith(asks)


def test_a_recording_that_no_parameter_explains_is_named():
    assert "of motor-9 as of the usual one" in unequal_words(document(5.0, rmse=4.0))
