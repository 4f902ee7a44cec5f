"""The pictures of docs/how-to/watch.md and fleet.md: python docs/images/monitoring.py (some minutes)."""

import gzip
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
RUN = [sys.executable, "-m", "thermoscope"]


def watched(folder: Path) -> None:
    """A profile that was never fitted, with the winding's and the stator's sensors alone."""
    file = ROOT / "cases/hust-ipmsm/tests/id_5.csv.gz"
    given = ["--follow", file, "--sensor", "winding", "--sensor", "stator", "--out", folder]
    command = [*RUN, "use", "watch", ROOT / "cases/hust-ipmsm", *given]
    subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.DEVNULL)
    with gzip.open(file, "rt") as rows:
        rotor = np.genfromtxt(rows, delimiter=",", names=True)["rotor"]
    table = np.loadtxt(folder / "watch-id_5.csv", delimiter=",", skiprows=1)
    head = (folder / "watch-id_5.csv").read_text().partition("\n")[0].split(",")
    minutes = table[:, 0] / 60.0
    column = {name: table[:, i] for i, name in enumerate(head)}
    figure, (above, below) = plt.subplots(2, 1, figsize=(8, 6), sharex=True)
    for name, colour in (("winding", "tab:orange"), ("stator", "tab:green"), ("rotor", "tab:blue")):
        T, sd = column[f"T {name} (degC)"], column[f"sd T {name} (K)"]
        above.plot(minutes, T, color=colour, label=name)
        above.fill_between(minutes, T - 1.96 * sd, T + 1.96 * sd, color=colour, alpha=0.2)
    above.plot(np.arange(rotor.size) / 60.0, rotor, "k--", lw=1, label="rotor, measured, not given")
    for name, colour in (("winding", "tab:orange"), ("stator", "tab:green"), ("rotor", "tab:blue")):
        below.plot(minutes, column[f"missing heat {name} (W)"], color=colour, label=name)
    above.set_ylabel("temperature (degC)")
    below.set_ylabel("missing heat (W)")
    below.set_xlabel("time (min)")
    above.legend(fontsize=8)
    below.legend(fontsize=8)
    figure.tight_layout()
    figure.savefig(HERE / "watch.png", dpi=110)


def fleet(folder: Path) -> None:
    """Two hundred simulated motors, jacket against joint."""
    subprocess.run([sys.executable, "-m", "simulated.fleet", "--out", folder], cwd=ROOT, check=True)
    subprocess.run(
        [*RUN, "use", "fleet", folder / "case", folder / "fleet", "--json", folder / "fleet.json"],
        cwd=ROOT,
        check=True,
        stdout=subprocess.DEVNULL,
    )
    drawn(json.loads((folder / "fleet.json").read_text()))


def drawn(document: dict) -> None:
    units, odd = document["units"], {o["unit"]: o for o in document["outliers"]}
    words = {"link.jacket": "jacket's film", "link.joint": "joint of stator and housing"}
    a, b = words
    figure, axes = plt.subplots(figsize=(7, 5))
    for u in units:
        x, y = u["parameters"][a], u["parameters"][b]
        low, high = u["ci95"][a], u["ci95"][b]
        colour = "tab:red" if u["unit"] in odd else "tab:blue"
        axes.errorbar(
            x,
            y,
            xerr=[[x - low[0]], [low[1] - x]],
            yerr=[[y - high[0]], [high[1] - y]],
            fmt="o",
            ms=3,
            lw=0.5,
            color=colour,
        )
        if u["unit"] in odd:
            label = f"{u['unit']}: {words[odd[u['unit']]['parameter']]}"
            axes.annotate(label, (x, y), textcoords="offset points", xytext=(8, 4))
    axes.set_xlabel(f"{words[a]}, times the declared")
    axes.set_ylabel(f"{words[b]}, times the declared")
    figure.tight_layout()
    figure.savefig(HERE / "fleet.png", dpi=110)


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as here:
        watched(Path(here) / "watch")
        fleet(Path(here) / "motors")
