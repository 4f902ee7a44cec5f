"""Draws designs.png from the designs of `make designs`: python docs/images/designs.py"""

import csv
from pathlib import Path

from extras.rating.designs import WORDS, parallel_coordinates
from viz.live.curves import save

HERE = Path(__file__).parent
DESIGNS = HERE.parents[1] / "out/designs/jacket-one/pareto.csv"

if __name__ == "__main__":
    rows = list(csv.DictReader(DESIGNS.open()))
    variables = {name: name.rpartition(".")[2] for name in rows[0] if "." in name}
    figure = parallel_coordinates(rows, [o for o in WORDS if o in rows[0]], variables)
    figure.update_layout(width=1100, height=480)
    save(figure, HERE / "designs.png")
