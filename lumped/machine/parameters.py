"""What calibration may move in a motor's network, each with its prior."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

from geom.description.machine import Machine
from geom.errors import InputError
from lumped.machine.path import stem
from lumped.machine.sprays import OIL_STREAM, SPRAY
from lumped.model.network import Link, Network, Parameter, Place, Source
from lumped.schemas.reader import suggestion
from lumped.sources.loss_laws import declared_name

SPREADS = (  # log-sd, kinds of losses
    (0.05, "copper"),
    (0.1, "map measured"),
    (0.15, "brush inverter"),
    (0.25, "iron friction bearing"),
    (0.3, "windage switching constant ripple"),
    (0.5, "magnet stray pwm"),
)
LOSS_SPREAD = {kind: sd for sd, kinds in SPREADS for kind in kinds.split()}
FLOW_EXPONENT = 0.8  # of films in turbulent flow
OIL_EXPONENT = 0.3  # of films under nozzles


def parameters(
    machine: Machine,
    network: Network,
    faces: Sequence[Place],
    films: Sequence[Link],
    streams: Sequence[Link],
    losses: Sequence[Source],
) -> list[Parameter]:
    """Films 0.3, contacts 0.3, losses by kind, capacity 0.05, flows 0.04 (log-sd), conductivities as declared."""
    beside = {name for name, duct in machine.features.ducts.items() if not duct.turns}
    out = []
    begins = {"fan.flow": "stream:fan:", "oil.flow": OIL_STREAM, "coolant.flow": "stream:"}
    left = list(streams)
    for name, begin in begins.items():
        flow_links = [s for s in left if s.name.startswith(begin)]
        left = [s for s in left if s not in flow_links]
        cells = beside if name == "fan.flow" else {s.places[1] for s in flow_links}
        oiled = name == "oil.flow"
        of = OIL_EXPONENT if oiled else FLOW_EXPONENT
        films_there = [(f.name, of) for f in films if f.places[1] in cells and f.name.endswith(SPRAY) == oiled]
        acts = (*((s.name, 1.0) for s in flow_links), *films_there)
        if flow_links:
            out.append(Parameter(name, acts, prior_sd=0.04, low=0.2, high=5.0, source="flow meter, +-3 %", flow=True))
    groups: dict[str, list[tuple[str, float]]] = {}
    for face in faces:
        group = face.part if face.fluid == "ambient" else stem(str(face.fluid))
        for link in (x for x in films if x.places[0] == face.name):
            groups.setdefault("oil" if link.name.endswith(SPRAY) else group, []).append((link.name, 1.0))
    film = Parameter("", (), prior_sd=0.3, low=0.1, high=10.0, source="spread of film correlations")
    heat = [replace(film, name=f"h.{group}", targets=tuple(acts)) for group, acts in groups.items() if acts]
    joint = Parameter("", (), prior_sd=0.3, low=0.02, high=50.0, source="spread of published contact gaps")
    contacts = [x.name for x in network.links if x.kind == "contact"]
    heat += [replace(joint, name=name.replace(":", ".", 1), targets=((name, 1.0),)) for name in contacts]
    whole = tuple((f"capacity:{group}", 1.0) for group in dict.fromkeys(network.capacity_group) if group)
    of_machine = Parameter(
        "capacity.machine", whole, prior_sd=0.05, low=0.5, high=2.0, source="alloys and fill factors"
    )
    return [*heat, *_losses(losses), of_machine, *out, *_conductivities(machine, network)]


def _losses(losses: Sequence[Source]) -> list[Parameter]:
    out = []
    for whole, kind in {declared_name(s.name): s.kind for s in losses}.items():
        name, spread = whole.replace(":", ".", 1), LOSS_SPREAD[kind]
        acts = tuple((s.name, 1.0) for s in losses if declared_name(s.name) == whole)
        words = "spread of published loss formulas"
        out.append(Parameter(name, acts, prior_sd=spread, low=0.1, high=10.0, source=words))
    return out


def _conductivities(machine: Machine, network: Network) -> list[Parameter]:
    """[calibration] conductivity = { GROUP = [parts] }: impregnation, liners; prior from the materials' spread."""
    section = machine.sections.get("calibration", {})
    groups = section.get("conductivity", {})
    inner = {link.places[0]: link.name for link in network.links if link.kind == "conduction"}
    where = f"{machine.name} [calibration]"
    if unknown := [key for key in section if key != "conductivity"] or not isinstance(groups, Mapping):
        raise InputError(f"{unknown} is not possible", where, "conductivity = { GROUP = [parts] }")
    out = []
    for group, parts in groups.items():
        for part in parts:
            if part not in network.places:
                raise InputError(f"no part '{part}'", where, suggestion(part, [p.name for p in machine.parts]))
        spread = max(machine.material_of(part).spread for part in parts)
        acts = tuple((inner[part], 1.0) for part in parts if part in inner)
        if acts:
            words = "spread of materials"
            out.append(Parameter(f"k.{group}", acts, prior_sd=spread, low=0.05, high=20.0, source=words))
    return out
