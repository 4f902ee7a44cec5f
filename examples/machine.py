"""A machine from its file: parts, masses, and a picture.

Loads the 100 kW series-wound motor, lists what its parts weigh, and draws its sections. The mass of the shaft is
checked against the cylinders it is made of.

    python examples/machine.py [FOLDER]
"""

# %%
import math
import sys
from pathlib import Path

from thermoscope.geom import load_machine, part_table, thumbnail_of

out = Path(sys.argv[1] if len(sys.argv) > 1 else "out/examples")

# %% The machine and its parts.
machine = load_machine("series-dc-100kw")
rows = {row.name: row for row in part_table(machine)}
for row in rows.values():
    print(row)

# %% A picture: sections across and along the axis.
out.mkdir(parents=True, exist_ok=True)
(out / "machine.svg").write_text(thumbnail_of(machine), encoding="utf-8")

# %% Are the masses right? The shaft is a row of cylinders, and its profiles have their radii.
shaft = machine.part("shaft")
computed = rows["shaft"].volume
exact = sum(math.pi * profile.outer[0][0] ** 2 * (z1 - z0) for profile, z0, z1 in shaft.prisms)
error = abs(computed / exact - 1.0)
print(f"shaft: computed {computed * 1e6:.1f} cm3, cylinders {exact * 1e6:.1f} cm3")
