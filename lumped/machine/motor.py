"""The network of a motor built from geometry: condensed conduction plus films, streams, losses and priors.

    films, contacts = nominal_coefficients(machine, faces, contact_names)  # what the condensation is centred on
    condensed = reduce(field, films, contacts, fluids(machine), boundaries(machine), ...).network()
    network = motor_network(machine, condensed)          # or lumped.build.pipeline.build(machine).network: all of it

What comes out, for every family and for imported machines alike (the machine file decides, no names do):

    states      every part's mean ("winding", "magnets", ...), its shapes "winding#1", ..., the fluids ("airgap", ...;
                "jacket@0", "jacket@1", ...: the coolant as it leaves each cell of a jacket)
    boundaries  "ambient", "coolant" where the machine has jackets (the temperature of the coolant's inlet), "oil" where
                it is sprayed (that of the nozzles)
    inputs      "current_A", "speed_rpm", "fan_flow_m3h" (open machines), "flow_l_min" (jackets), "oil_l_min" (sprays);
                `operating_point`
                gives their rated values. With three phases current_A is the rms of each phase, which direct current
                through the phases in series also is: DC heating is current_A = I, speed_rpm = 0.
    places      every part, every face ("housing.fins"), every fluid, "JACKET.outlet", and the means declared in
                [sensors], such as "winding.copper": the mean over all copper, what a resistance measurement sees
    parameters  "h.PART" outer faces, "h.FLUID" inner ones, "contact.A|B", "loss.NAME", "capacity.machine", "fan.flow",
                "coolant.flow", "oil.flow", "h.oil", and "k.GROUP" for conductivities declared in [calibration]
"""

from collections.abc import Iterable, Mapping
from dataclasses import replace

import numpy as np

from geom.description.machine import Machine
from lumped.machine.air import fan_streams
from lumped.machine.bases import switched
from lumped.machine.films import Surroundings, face_films, nominal, surroundings
from lumped.machine.hairpin import insulation
from lumped.machine.jackets import FLOW, INLET, coolant_streams, outlet_film, outlets
from lumped.machine.loss_sources import loss_inputs, sources
from lumped.machine.parameters import parameters
from lumped.machine.part_identities import declared
from lumped.machine.path import cells_of, stem
from lumped.machine.settings import contact_coefficients
from lumped.machine.sprays import OIL_FLOW, RAIL
from lumped.model.network import Link, Network, Place
from lumped.model.quantities import LIQUID
from lumped.schemas.reader import Table, suggestion

AIR_IN_SPACE = 60.0  # J/K, a few tens of litres of air with a part of its walls' skin


def means(machine: Machine, network: Network) -> dict[str, Place]:
    """Name -> place; its mean row is what the sensor sees."""
    section, where = machine.sections.get("sensors", {}), f"{machine.name} [sensors]"
    return {name: _mean(machine, network, name, Table(data, f"{where} {name}")) for name, data in section.items()}


def _mean(machine: Machine, network: Network, name: str, table: Table) -> Place:
    parts = table.words("mean_of")
    by = table.word("by", "mass", ("mass", "copper"))
    table.close()
    for part in parts:
        if part not in [p.name for p in machine.parts]:
            raise table.error(f"no part '{part}'", suggestion(part, [p.name for p in machine.parts]))
    weights = np.array([_amount(machine, part, by) for part in parts])
    if not weights.sum() > 0:
        raise table.error("no copper in these parts", 'by = "mass"')
    weights = weights / weights.sum()
    states = np.array([network.column(part) for part in parts])
    return Place(name, "node", parts[int(np.argmax(weights))], states, np.diag(weights), weights)


def _amount(machine: Machine, part: str, by: str) -> float:
    """kg, or m3 of conductor: the length of wire of one cross-section."""
    material, volume = machine.material_of(part), machine.part(part).volume
    if by == "mass":
        return material.rho * volume
    return volume if material.mixture is None else material.mixture.fill * volume


def fluids(machine: Machine) -> dict[str, float]:
    """Fluid nodes and their heat capacities (J/K)."""
    out: dict[str, float] = {}
    for part in machine.fluids:
        if part.material == "air":
            out[part.name] = AIR_IN_SPACE
        else:
            liquid = surroundings(machine, ()).cooling.liquid  # type: ignore[union-attr]
            names = cells_of(machine, part.name)
            out |= dict.fromkeys(names, liquid.rho * liquid.cp * part.volume / len(names))
    return out


def boundaries(machine: Machine) -> tuple[str, ...]:
    """Temperatures given from outside."""
    around = surroundings(machine, ())
    feeds = ((INLET, around.cooling), (RAIL, around.spray))
    return ("ambient", *(name for name, of in feeds if of is not None))


def operating_point(machine: Machine) -> dict[str, np.ndarray]:
    """The rated point as inputs of the laws: current and speed, 0 where not rated, and what losses read beside them."""
    around, ratings = surroundings(machine, ()), machine.sections.get("ratings", {})
    values = {name: ratings.get(name, 0.0) for name in ("current_A", "speed_rpm")}
    values |= {name: ratings[name] for name in loss_inputs(machine) & ratings.keys()}
    if around.fan is not None:
        values["fan_flow_m3h"] = around.fan.flow_m3_h
    if around.cooling is not None:
        values[FLOW] = around.cooling.flow_l_min
    if around.spray is not None:
        values[OIL_FLOW] = around.spray.flow_l_min
    return {name: np.array([float(value)]) for name, value in values.items()}


def rated_inputs(machine: Machine) -> dict[str, float]:
    """The same, a number each."""
    return {name: float(value[0]) for name, value in operating_point(machine).items()}


def nominal_coefficients(
    machine: Machine, faces: Mapping[str, tuple[str, str]], contacts: Iterable[str]
) -> tuple[dict[str, float], dict[str, float]]:
    """Film coefficient per face and contact coefficient per contact (W/m2/K), at the rated point.

    faces : face -> (part, fluid);  contacts : names "a|b"
    """
    names = sorted(contacts)
    around, inputs = surroundings(machine, names), operating_point(machine)
    h = {face: nominal(face_films(*where, around), inputs) for face, where in faces.items()}
    table = machine.sections.get("contacts", {})
    layers = {name: h for name, h in insulation(machine).items() if name in names and name not in table}
    g = contact_coefficients(table, names, f"{machine.name} [contacts]") | layers
    return h, g


def motor_network(machine: Machine, condensed: Network) -> Network:
    """The condensed network of a motor, completed to a model that can run a test."""
    contacts = (link.name.removeprefix("contact:") for link in condensed.links if link.kind == "contact")
    around = surroundings(machine, contacts)
    ports = {} if around.cooling is None else outlets(machine, condensed, around.cooling)
    network = replace(condensed, places={**condensed.places, **ports, **means(machine, condensed)})
    fluids_there = {n: p for n, p in network.places.items() if p.kind == "fluid" and stem(n) != n}
    cells = {n: replace(p, channel=stem(n)) for n, p in fluids_there.items()}  # each says which jacket it belongs to
    network = replace(network, places={**network.places, **cells})
    network = replace(network, declared=declared(machine, network, around.contacts))
    faces = [place for place in network.places.values() if place.kind == "surface" and place.fluid]
    films = [link for face in faces for link in _film_links(network, face, around)]
    streams = [] if around.ways is None else fan_streams(network, machine.features, around.ways)
    if around.cooling is not None:
        streams += coolant_streams(machine, network, around.cooling)
    if around.spray is not None:
        streams += around.spray.streams(network, faces)
        network = replace(network, quantities={OIL_FLOW: LIQUID})
    losses = sources(machine, network)
    multipliers = parameters(machine, network, faces, films, streams, losses)
    return switched(machine, network.extended([*films, *streams], losses, multipliers))


def _film_links(network: Network, face: Place, around: Surroundings) -> list[Link]:
    if around.cooling is not None and stem(str(face.fluid)) in around.cooling.feeds:
        return [outlet_film(around.machine, network, face.name, around.cooling)]
    if around.spray is not None and around.spray.wets(face.part, str(face.fluid)):
        return [around.spray.link(network, face)]
    laws = face_films(face.part, str(face.fluid), around)
    name = {mechanism: f"film:{face.name}" + (f":{mechanism}" if mechanism else "") for mechanism in laws}
    return [network.surface_link(name[m], "film", face.name, str(face.fluid), law) for m, law in laws.items()]
