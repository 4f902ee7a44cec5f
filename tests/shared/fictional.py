"""A small fictional case for the pictures' tests: two tests, three sensors, one wrong at the right flange."""

import numpy as np

from lumped.model.network import Row
from measured.case import Channel, Test
from viz.data import Comparison

LIMIT_K = 1.0  # of every sensor: two deviations of its reading
TIME = np.arange(0.0, 3601.0, 30.0)
PLACES = ("flange.left", "flange.right", "winding.field", "yoke", "housing")
POSITIONS = {
    "flange.left": (-0.12, 0.05, 0.10),
    "flange.right": (-0.08, -0.12, 0.65),
    "winding.field": (-0.14, 0.0, 0.30),
    "yoke": (0.0, 0.17, 0.30),
    "housing": (0.0, 0.20, 0.40),
}


def step(number, action, effect, words, stand, road):
    """A revision and what it did to the error of two tests (K), before and after."""
    tests = [("stand-1", "calibrate", stand), ("road-2", "hold-out", road)]
    fell = [{"name": n, "role": r, "rmse_K": dict(zip(("before", "after"), K))} for n, r, K in tests]
    return {"number": number, "action": action, "effect": effect, "words": words, "tests": fell}


WIND = "convection@flange.right", "forced convection by vehicle wind at flange.right"
HISTORY = [
    step(1, "calibrate", None, "calibrate", (3.1, 0.71), (6.4, 4.85)),
    step(2, "add", *WIND, (0.71, 0.68), (4.85, 0.93)),
]


def curve(end: float, tau: float) -> np.ndarray:
    return 20.0 + (end - 20.0) * (1.0 - np.exp(-TIME / tau))


def comparison(wrong_K: float = 6.2, before: bool = False) -> Comparison:
    """Five sensors; the machine's right flange is `wrong_K` colder than the model at the end."""
    rng = np.random.default_rng(0)
    model = {p: curve(60 + 12 * i, 700 + 150 * i) for i, p in enumerate(PLACES)}
    truth = {**model, "flange.right": curve(72 - wrong_K, 850)}
    row = Row(np.array([0]), np.array([1.0]))
    channels = tuple(Channel(p, p, row, truth[p] + rng.normal(0, 0.3, len(TIME))) for p in PLACES)
    inputs, air = {"current_A": np.full(len(TIME), 250.0)}, {"ambient": np.full(len(TIME), 20.0)}
    test = Test("road-2", "hold-out", TIME, inputs, air, channels)
    return Comparison(
        test, model, dict.fromkeys(PLACES, LIMIT_K), {p: y + 4.0 for p, y in model.items()} if before else None
    )


def candidate(effect: str, score: float, decision: str) -> dict:
    return {
        "effect": effect,
        "score": score,
        "threshold": 7.9,
        "decision": decision,
        "explained": 0.91,
        "amplitude": {"value": 12.34, "unit": "W/m2/K", "ci95": [10.1, 14.6]},
        "rmse_K": {"before": 4.85, "after": 0.93},
        "holdout_rmse_K": {"before": 4.85, "after": 0.93},
        "confused_with": [],
    }


def candidates() -> list[dict]:
    rng = np.random.default_rng(1)
    noise = [candidate(f"effect{i}@yoke", float(s), "no") for i, s in enumerate(2.2 * rng.normal(size=17))]
    group = candidate("radiation@flange.right", 14.0, "group")
    return [candidate("convection@flange.right", 31.4, "named"), group, *noise]


def documents() -> tuple[dict, dict]:
    """(compare, diagnose) documents."""
    common = {"n": 121, "seconds": 7_200.0, "bias_K": -4.21, "max_abs_K": 7.13, "sigma_K": 0.5, "percent_of_rise": 9.14}
    wrong = {"rmse_K": 5.07, "verdict": "over"}
    right = {"rmse_K": 0.31, "verdict": "within"}
    channels = [{"channel": p, "place": p, **common, **(wrong if p == "flange.right" else right)} for p in PLACES]
    test = {"name": "road-2", "role": "hold-out", "rmse_K": 4.85, "channels": channels}
    compare = {"case": "road-test", "model": {"revision": 2, "effects": []}, "tests": [test], "rmse_K": 4.85}
    compare |= {"floor_K": 0.62}
    blind = {"effect": "contact@yoke", "words": "worse contact at yoke", "smallest_detectable": 123.0, "unit": "W/m2/K"}
    diagnose = {
        "verdict": "named",
        "candidates": candidates(),
        "where": [{"place": "flange.right", "evidence_nats": 41.0}],
        "cannot_see": [blind],
        "next_tests": [{"test": "blower on", "separates": ["radiation@flange.right"], "predicted_gain": 44.0}],
    }
    return compare, diagnose
