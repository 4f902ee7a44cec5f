"""The network of a motor built from geometry: condensed conduction plus films, air streams, losses and priors.

films, contacts = nominal_coefficients(machine, faces, contact_names)     # what the condensation is centred on
network = motor_network(machine, condensed)
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from lumped.laws import InputPower, Law
from lumped.motor_films import Sizes, face_films, nominal
from lumped.motor_losses import dc_sources
from lumped.motor_settings import Fan, Films, Losses, contact_coefficients, read
from lumped.network import Link, Network, Parameter, Place, Row

FLUIDS = ("air.left", "airgap", "air.interpolar", "air.right")
AIR_HEAT = 1.205 * 1006.0  # rho cp of the air the fan takes in at 20 degC, J/m3/K


def operating_point(machine: Any) -> dict[str, np.ndarray]:
    """The rated point as inputs of the laws."""
    ratings = machine.sections["ratings"]
    fan = _settings(machine, "fans", Fan)
    values = {"current_A": ratings["current_A"], "speed_rpm": ratings["speed_rpm"], "fan_flow_m3h": fan.flow_m3_h}
    return {name: np.array([float(value)]) for name, value in values.items()}


def nominal_coefficients(
    machine: Any, faces: Mapping[str, tuple[str, str]], contacts: Iterable[str]
) -> tuple[dict[str, float], dict[str, float]]:
    """Film coefficient per face and contact coefficient per contact (W/m2/K), at the rated point.

    faces : face -> (part, fluid);  contacts : names "a|b"
    """
    films, sizes, inputs = _settings(machine, "films", Films), _sizes(machine), operating_point(machine)
    h = {face: nominal(face_films(*where, films, sizes), inputs) for face, where in faces.items()}
    g = contact_coefficients(machine.sections.get("contacts", {}), sorted(contacts), f"{machine.name} [contacts]")
    return h, g


def motor_network(machine: Any, condensed: Network) -> Network:
    """The condensed network of a series-wound DC motor, completed to a model that can run a test."""
    films, sizes = _settings(machine, "films", Films), _sizes(machine)
    fan, losses = _settings(machine, "fans", Fan), _settings(machine, "losses", Losses)
    ratings = machine.sections["ratings"]
    faces = [place for place in condensed.places.values() if place.kind == "surface" and place.fluid]
    links = [link for face in faces for link in _film_links(condensed, face, films, sizes)]
    streams = _streams(condensed, fan)
    sources = dc_sources(condensed, losses, ratings)
    parameters = _parameters(condensed, faces, links, streams, sources)
    return condensed.extended([*links, *streams], sources, parameters)


def _settings(machine: Any, section: str, kind: type) -> Any:
    table = machine.sections.get(section, {})
    return read(kind, table, f"{machine.name} [{section}]")


def _sizes(machine: Any) -> Sizes:
    g = machine.geometry
    shell = g.stator.yoke_inner_diameter / 2 + g.stator.yoke_thickness + g.housing.thickness
    bore = g.rotor.outer_diameter / 2 + g.stator.air_gap
    poles, body = g.stator.poles, g.stator.body_width
    fins = 2 * g.housing.fins * g.housing.fin_height / (2 * np.pi * shell)
    depth = g.stator.yoke_inner_diameter / 2 - bore
    coils = 2 * poles * g.field.coil_width * g.field.coil_height
    area = np.pi * (bore + depth) ** 2 - np.pi * bore**2 - poles * body * depth - coils
    perimeter = 2 * np.pi * (2 * bore + depth) + 2 * poles * (depth - body)
    length = g.rotor.stack_length
    return Sizes(2 * shell, 1.0 + fins, g.rotor.outer_diameter / 2, g.stator.air_gap, area, perimeter, length)


def _film_links(network: Network, face: Place, films: Films, sizes: Sizes) -> list[Link]:
    laws = face_films(face.part, str(face.fluid), films, sizes)
    name = {mechanism: f"film:{face.name}" + (f":{mechanism}" if mechanism else "") for mechanism in laws}
    return [network.surface_link(name[m], "film", face.name, str(face.fluid), law) for m, law in laws.items()]


def _streams(network: Network, fan: Fan) -> list[Link]:
    """The fan's air: ambient -> left end -> gap and interpolar space in parallel -> right end -> out."""
    gap = fan.gap_share
    feeds = {
        "air.left": {"ambient": 1.0},
        "airgap": {"air.left": gap},
        "air.interpolar": {"air.left": 1.0 - gap},
        "air.right": {"airgap": gap, "air.interpolar": 1.0 - gap},
    }
    law = InputPower(AIR_HEAT / 3600.0, (("fan_flow_m3h", 1.0, 1.0),))
    return [_cell(network, cell, upstream, law) for cell, upstream in feeds.items()]


def _cell(network: Network, cell: str, upstream: Mapping[str, float], law: Law) -> Link:
    """An upwind cell: it takes up flow x heat capacity x (own temperature - what flows in)."""
    own = network.column(cell)
    cols = np.array([own, *(network.column(name) for name in upstream)])
    vals = np.array([sum(upstream.values()), *(-share for share in upstream.values())])
    inflow = -vals[1:] / vals[0]
    rows, first = np.full(len(cols), own), next(iter(upstream))
    hot, cold = Row(np.array([own]), np.array([1.0])), Row(cols[1:], inflow)
    return Link(f"stream:fan:{cell}", "stream", (first, cell), rows, cols, vals, law, hot, cold)


def _parameters(
    network: Network, faces: list[Place], films: list[Link], streams: list[Link], sources: list[Any]
) -> list[Parameter]:
    """What calibration may move, with priors: films 0.3, contacts 0.3, losses by kind, capacity 0.05 (log-sd)."""
    out = []
    for group, members in _film_groups(faces, films).items():
        targets = tuple((link.name, 1.0) for link in members)
        out.append(
            Parameter(f"h.{group}", targets, prior_sd=0.3, low=0.1, high=10.0, source="spread of film correlations")
        )
    for link in network.links:
        if link.kind == "contact":
            out.append(Parameter(link.name.replace(":", ".", 1), ((link.name, 1.0),), prior_sd=0.3, low=0.02, high=50.0,
                                 source="spread of published contact gaps"))  # fmt: skip
    spread = {"copper": 0.05, "iron": 0.25, "friction": 0.25, "brush": 0.15, "windage": 0.3}
    for source in sources:
        out.append(Parameter(source.name.replace(":", ".", 1), ((source.name, 1.0),), prior_sd=spread[source.kind],
                             low=0.1, high=10.0, source="spread of published loss formulas"))  # fmt: skip
    capacity = tuple((f"capacity:{group}", 1.0) for group in dict.fromkeys(network.capacity_group) if group)
    out.append(
        Parameter("capacity.machine", capacity, prior_sd=0.05, low=0.5, high=2.0, source="alloys and fill factors")
    )
    flow = tuple((link.name, 1.0) for link in streams)
    channel = tuple((link.name, 0.8) for link in films if link.places[1] == "air.interpolar")
    out.append(Parameter("fan.flow", (*flow, *channel), prior_sd=0.04, low=0.2, high=5.0, source="flow meter, +-3 %"))
    return out


def _film_groups(faces: list[Place], films: list[Link]) -> dict[str, list[Link]]:
    """Outer faces part by part, inner faces by the air that washes them."""
    groups: dict[str, list[Link]] = {}
    for face in faces:
        group = face.part if face.fluid == "ambient" else str(face.fluid)
        members = [link for link in films if link.places[0] == face.name]
        groups.setdefault(group, []).extend(members)
    return {group: members for group, members in groups.items() if members}
