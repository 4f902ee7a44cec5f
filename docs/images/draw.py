"""Draws the pictures of the documentation from the shipped motor: python docs/images/draw.py

One hour at 130 A and 1000 rpm with the fan at 138 m3/h, uncalibrated nominal values.
"""

from pathlib import Path

import numpy as np
from PIL import Image

import viz
from fem.matrices.material import Conductivity
from geom import load_machine
from lumped import Record, balance
from lumped.build.pipeline import Built, build
from viz.machine.parts import exploded, regions

HERE = Path(__file__).parent
INPUTS = {"current_A": 130.0, "speed_rpm": 1000.0, "fan_flow_m3h": 138.0}
TIME = np.arange(0.0, 3601.0, 20.0)


def record() -> Record:
    inputs = {name: np.full(TIME.size, value) for name, value in INPUTS.items()}
    return Record(TIME, inputs, {"ambient": np.full(TIME.size, 20.0)}, 20.0)


def draw(built: Built) -> None:
    """All pictures, 1280 x 800 unless their content wants another shape."""
    network, nodes = built.network, viz.split(built.mesh)
    flows = balance(network, record())
    assert network.recovery is not None
    z = flows.z[-1]
    x = z[: len(network.states)]
    T = network.on_parts(nodes.parts, x)
    viz.cutaway(nodes, T, title="100 kW traction motor after an hour at 130 A", png=HERE / "field.png").close()
    exploded(nodes, title="The motor pulled apart", png=HERE / "exploded.png").close()
    regions(nodes, title="The parts and their names", png=HERE / "parts.png").close()
    regions(nodes, mesh=True, title="The mesh", png=HERE / "mesh.png").close()
    found = {part.name: built.machine.material_of(part.name) for part in built.machine.parts}
    k = {name: Conductivity(m.k_plane, m.k_plane, m.k_axial) for name, m in found.items()}
    viz.flux_arrows(nodes, T, k, title="Heat flux after an hour;", png=HERE / "flux.png").close()
    heat = viz.heat_flows(network, flows)
    viz.sankey_of_losses(heat, png=HERE / "losses.png")
    means = dict(zip([*network.states, *network.boundaries], z.tolist(), strict=True))
    viz.network_in_machine(built.mesh, means, heat, title="Heat flows after an hour;", png=HERE / "network.png").close()


if __name__ == "__main__":
    draw(build(load_machine("series-dc-100kw")))
    for png in sorted(HERE.glob("*.png")):
        if Image.open(png).mode != "P":  # what has a palette is small already
            Image.open(png).convert("RGB").save(png, optimize=True)
        print(f"{png.name}  {png.stat().st_size / 1000:.0f} kB")
