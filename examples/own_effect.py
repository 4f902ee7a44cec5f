"""An effect of your own, known to the tool by an entry point: sunshine on the housing.

The package here is a folder with two small files, as an installer would leave it. Its effect is found by name, can sit
where it says, and is added to a network; the housing warms by Q / G.

    python examples/own_effect.py
"""

# %%
import sys
import tempfile
from pathlib import Path

import thermoscope as ts
from thermoscope.validation.effects import Scene, extended

PACKAGE = """
from dataclasses import dataclass
from thermoscope.lumped.transfer.laws import Fixed
from thermoscope.validation.effects.base import Effect, with_parameter
from thermoscope.validation.effects.build import heat

@dataclass(frozen=True)
class Sun(Effect):
    "Sunshine on the housing (W)."
    kind, title, unit, source, isolating_test = "acme.sun", "sunshine", "W", "definition", "shade it"
    typical, prior_sd, high, confused_with = (5.0, 50.0), 20.0, 200.0, ("loss.constant",)

    @classmethod
    def candidate_places(cls, scene):
        return [p for p in scene.network.places if p == "housing"]

    def extend(self, network):
        source = heat(network, self.name, "constant", self.place, Fixed(1.0))
        return with_parameter(network.extended(sources=[source]), self.parameter(source.name))
"""
home = Path(tempfile.mkdtemp())
(home / "acme_sun.py").write_text(PACKAGE)
(about := home / "acme_sun-1.0.dist-info").mkdir()
(about / "METADATA").write_text("Metadata-Version: 2.1\nName: acme-sun\nVersion: 1.0\n")
(about / "entry_points.txt").write_text("[thermoscope.effects]\nsun = acme_sun:Sun\n")
sys.path.insert(0, str(home))

# %% A housing without losses that stands in the sun: 30 W over 1.5 W/K.
G, AIR, Q = 1.5, 20.0, 30.0
network = ts.read_network(
    {
        "network": {"name": "housing", "boundaries": ["air"]},
        "nodes": {"housing": {"C_J_K": 5000.0}},
        "links": {"film": {"between": ["housing", "air"], "G_W_K": G}},
    }
)
sun = ts.effects()["acme.sun"]("housing")
places = sun.candidate_places(Scene(network))
sunny = extended(network, [sun])
computed = ts.steady(sunny, {}, {"air": AIR}, {sun.name: Q})["housing"]
expected = AIR + Q / G
print(f"{sun.name}, which can sit at {', '.join(places)}: computed {computed:.4f} degC, exact {expected:.4f} degC")
sys.path.remove(str(home))
