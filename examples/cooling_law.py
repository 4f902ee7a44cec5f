"""From a table of steady tests to the law of their cooling, and to tests with more flow and more speed.

Oil from nozzles cools six layers of a winding. Its conductance is drawn as 90 (flow/4)^0.8 + 160 (speed/10000)^1.6 W/K,
6 % more for each 10 K of warmer oil; 3 W/K go to a room of 25 degC. The law is found from 30 tests up to 4 l/min and
10,000 rpm; 26 others have 6 l/min, 12,500 or 15,000 rpm. Sensors read to 0.1 K.

    python examples/cooling_law.py [FOLDER]

With FOLDER both tables are written there, and the command line reads them and draws the picture.
"""

# %%
import sys
from itertools import product
from pathlib import Path

import numpy as np

from thermoscope.extras.bench.steady_law.law import find_law
from thermoscope.extras.bench.steady_law.steady_tests import Columns, steady_tests

ROOM, LAYERS = 25.0, np.array([-0.07, -0.03, 0.0, 0.01, 0.03, 0.06])  # degC; a layer's rise above the mean, as a share
rng = np.random.default_rng(504)


COLUMNS = Columns("loss", "oil", (("flow", "l/min"), ("speed", "rpm")), "T_*", ROOM)
NAMES = [f"T_{layer}" for layer in "abcdef"]


def table(flows, speeds):
    """Flow (l/min), speed (rpm), inlet (degC), loss (W), layers (degC) of all combinations; the mean without error"""
    flow, speed, inlet = np.array(list(product(flows, speeds, (40.0, 75.0)))).T
    G = (90.0 * (flow / 4.0) ** 0.8 + 160.0 * (speed / 1e4) ** 1.6) * 1.06 ** ((inlet - 57.5) / 10.0)
    loss = np.round(G * (18.0 - speed / 1500.0), -1)
    mean = (loss + G * inlet + 3.0 * ROOM) / (G + 3.0)
    layers = mean[:, None] + np.outer(mean - inlet, LAYERS) + 0.1 * rng.standard_normal((mean.size, LAYERS.size))
    return np.column_stack([flow, speed, inlet, loss, np.round(layers, 1)]), mean


def readings(rows, scales=None):
    """The rows of a table, checked."""
    room = np.full(len(rows), ROOM)
    return steady_tests(COLUMNS, NAMES, rows[:, :2], rows[:, 3], rows[:, 2], room, rows[:, 4:], scales)


# %% Two tables: what the law is made from, and what it is to predict.
speeds = [0.0, 2500.0, 5000.0, 7500.0, 10000.0, 12500.0, 15000.0]
tests, _ = table((2.0, 3.0, 4.0), speeds[:5])
faster, faster_means = table((2.0, 3.0, 4.0), speeds[5:])
more, more_means = table((6.0,), speeds)
further, expected = np.vstack([faster, more]), np.append(faster_means, more_means)

# %% The law, and what it says of the others.
law = find_law(readings(tests))
others = readings(further, law.tests.scales)
prediction = law.predict(others)
computed, agreement = prediction.mean, prediction.agreement(others)
print(law.sentence)
print(law.formula)
share = 100.0 * agreement["inside"]
print(f"{agreement['tests']} further tests: {agreement['rms_K']:.2f} K rms, {share:.0f} % in the 95 % band")

# %% The same at the command line.
if __name__ == "__main__" and len(sys.argv) > 1:
    from thermoscope.cli import main

    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for name, rows in (("tests", tests), ("further", further)):
        header = ",".join(["flow", "speed", "oil", "loss", *NAMES])
        np.savetxt(folder / f"{name}.csv", rows, "%.6g", ",", header=header, comments="")
    words = f"bench law {folder}/tests.csv --heat loss --coolant oil --follows flow=l/min --follows speed=rpm"
    words += f" --temperatures T_* --ambient 25 --predict {folder}/further.csv --out {folder}"
    sys.argv[1:] = words.split()
    main()
