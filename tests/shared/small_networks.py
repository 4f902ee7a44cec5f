"""Small networks that several tests share."""

import numpy as np

from lumped.model.build import bare_network, node_link, node_source
from lumped.model.network import Parameter
from lumped.transfer.laws import FILMS, FilmTable, Fixed, InputPower, Linear, Power, Radiation, Table

G12, G2A, C1, C2 = 10.0, 25.0, 2500.0, 25000.0


def two_masses(loss=None, core=None, middle=False):
    """Winding and core to ambient; `middle` puts a node without capacity half-way between them."""
    masses = {"winding": C1, "core": C2, **({"middle": 0.0} if middle else {})}
    net = bare_network("two masses", masses, ("ambient",))
    if middle:
        links = [
            node_link(net, "a", "link", "winding", "middle", Fixed(2 * G12)),
            node_link(net, "b", "link", "middle", "core", Fixed(2 * G12)),
        ]
    else:
        links = [node_link(net, "a", "link", "winding", "core", Fixed(G12))]
    links.append(node_link(net, "out", "link", "core", "ambient", Fixed(G2A)))
    sources = [node_source(net, "loss:winding", "copper", {"winding": 1.0}, loss or Fixed(100.0))]
    if core is not None:
        sources.append(node_source(net, "loss:core", "iron", {"core": 1.0}, core))
    return net.extended(links, sources)


def every_law(table=Table((0.0, 2.0, 10.0, 60.0), (1.0, 1.5, 2.0, 2.6))):  # noqa: B008
    """Four nodes, one of them without capacity, with every temperature law, time-varying inputs and every mapping."""
    net = bare_network("every law", {"a": 300.0, "b": 500.0, "c": 800.0, "skin": 0.0}, ("ambient", "bench"))
    film = FilmTable((0.0, 5.0, 80.0), tuple(v - 0.05 * k for k in range(FILMS) for v in (1.0, 1.6, 2.4)))
    links = [
        node_link(net, "film", "film", "c", "ambient", Fixed(0.3, film)),
        node_link(net, "constant", "link", "a", "b", Fixed(4.0)),
        node_link(net, "linear", "link", "b", "c", Fixed(3.0, Linear(0.002, 20.0))),
        node_link(net, "skin", "link", "c", "skin", Fixed(6.0)),
        node_link(net, "power", "film", "skin", "ambient", Fixed(0.8, Power(0.25))),
        node_link(net, "radiation", "film", "skin", "ambient", Fixed(0.05, Radiation())),
        node_link(net, "table", "film", "a", "bench", Fixed(0.4, table)),
        node_link(net, "forced", "film", "b", "ambient", InputPower(1.5, (("speed_rpm", 1000.0, 0.8),))),
        node_link(net, "both", "film", "c", "bench", InputPower(0.3, (("speed_rpm", 1000.0, 0.8),), Power(0.33))),
    ]
    sources = [
        node_source(
            net, "copper", "copper", {"a": 1.0}, InputPower(60.0, (("current_A", 10.0, 2.0),), Linear(0.0039, 20.0))
        ),
        node_source(net, "iron", "iron", {"b": 0.7, "c": 0.3}, InputPower(30.0, (("speed_rpm", 1000.0, 1.5),))),
    ]
    return net.extended(links, sources, (*MULTIPLIERS, *SPECIAL))


NAMES = "constant linear skin power radiation table film forced both copper iron capacity:a"
MULTIPLIERS = tuple(Parameter(f"log {n}", ((n, 1.0),)) for n in NAMES.split())
SPECIAL = (
    Parameter("relative", (("power", 1.0), ("iron", 0.5)), 0.2, mapping="relative", neutral=0.0),
    Parameter("amplitude", (("forced", 1.0),), 0.7, mapping="amplitude", neutral=0.0),
    Parameter("square", (("constant", 2.0), ("capacity:b", 1.0), ("capacity:c", 1.0)), 1.1),
)


def inputs(time):
    """Varying current and speed, with a stop."""
    speed = np.clip(1000 + 900 * np.sin(time / 250.0), 0.0, None) * (time < 900)
    return {"current_A": 10 + 4 * np.sin(time / 130.0), "speed_rpm": speed}


def boundaries(time):
    return {"ambient": 20 + 4 * np.sin(time / 300.0), "bench": np.asarray(25.0)}


# In which every kind of site is: roles, bench, air gap, joints, an end space.
MOTOR = """
[network]
name = "motor"
boundaries = ["ambient", "bench"]
[boundaries.ambient]
role = "ambient"
[boundaries.bench]
role = "test bed"
[nodes.winding]
role = "winding"
C_J_K = 500
[nodes.stator]
role = "iron"
C_J_K = 4000
[nodes.rotor]
role = "rotor"
C_J_K = 3000
[nodes.shield]
role = "end shield"
C_J_K = 1000
[nodes.housing]
role = "housing"
C_J_K = 2000
[nodes.air]
kind = "fluid"
C_J_K = 10
[links.liner]
between = ["winding", "stator"]
G_W_K = 20
[links.fit]
between = ["stator", "housing"]
G_W_K = 60
[links.spigot]
between = ["shield", "housing"]
G_W_K = 10
[links.shaft]
between = ["rotor", "shield"]
G_W_K = 1
[links.gap]
between = ["rotor", "stator"]
G_W_K = 4
[links.stirred]
between = ["winding", "shield"]
G_W_K = 1
of = { input = "speed_rpm", at = 1000, exponent = 0.8 }
[links.inside]
between = ["air", "winding"]
G_W_K = 2
[links.outside]
between = ["housing", "ambient"]
G_W_K = 8
[links.face]
between = ["shield", "ambient"]
G_W_K = 2
[links.foot]
between = ["housing", "bench"]
G_W_K = 3
"""
