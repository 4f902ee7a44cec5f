"""Errors of mesh and condensation at a machine's rated point, looked at once and kept."""

import hashlib
import json
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from math import log
from types import MappingProxyType

import numpy as np

from fem.matrices.assembly import FieldModel
from geom.disk_cache import recalled, store
from geom.storage import cache_folder
from lumped.build.fixed_coefficients import FixedCoefficients, rated
from lumped.build.pipeline import Built, coefficients_on, meshed
from lumped.condensation.error_budget import MonitoredPlaces
from lumped.condensation.recovery import PartShape, Shapes, locate
from lumped.machine.bases import on_every_base
from lumped.model.network import Array, Network, Row

SPREAD = 2.0  # every film and contact is multiplied by up to this in one further look: what most calibrations do
STEP = 1.1  # factors are rounded to its powers: within them one look serves, errors change little
LEAST = 1e-3  # a film or contact that is switched off
HOT = "hot spot of "
NOMINAL: Mapping[str, float] = MappingProxyType({})


@dataclass(frozen=True)
class Rated:
    """At the rated point: place -> error of mesh and of condensation (K); the hottest rise (K); hot spots' nodes."""

    mesh_K: Mapping[str, float]
    condensation_K: Mapping[str, float]
    rise_K: float
    nodes: Mapping[str, int]


def hot_rows(network: Network, rated: Rated) -> dict[str, Row]:
    """The hot spots as rows over the network's z."""
    shapes = network.recovery
    assert isinstance(shapes, Shapes)
    nodes = ((name, shapes.parts[name.removeprefix(HOT)], node) for name, node in rated.nodes.items())
    return {name: Row(shape.states, shape.V[node]) for name, shape, node in nodes}


def cached_errors(built: Built, looks: MonitoredPlaces, multipliers: Mapping[str, float] = NOMINAL) -> Rated:
    """From the cache, where this network was looked at before in the same places.

    multipliers : link -> what the model's values multiply it by; where one goes beyond SPREAD, condensation is looked
    at there, too
    """
    file = cache_folder() / f"budget-{_key(built, looks)}.json"
    errors = recalled(file, lambda path: Rated(**json.loads(path.read_text(encoding="utf-8"))))
    if errors is None:
        errors = at_rated_point(built, looks)
        store(file, json.dumps(vars(errors)))
    factors = {x.name: multipliers.get(x.name, 1.0) for x in built.network.links if x.kind in ("film", "contact")}
    if all(1.0 / SPREAD <= m <= SPREAD for m in factors.values()):
        return errors
    powers = {name: round(log(max(m, LEAST)) / log(STEP)) for name, m in factors.items()}
    there = file.with_name(f"{file.stem}-{hashlib.sha256(repr(sorted(powers.items())).encode()).hexdigest()[:12]}.json")
    left = recalled(there, lambda path: dict[str, float](json.loads(path.read_text(encoding="utf-8"))))
    if left is None:
        left = at_multiplied_point(built, looks, errors.rise_K, {name: STEP**n for name, n in powers.items()})
        store(there, json.dumps(left))
    return replace(errors, condensation_K={n: max(off, left[n]) for n, off in errors.condensation_K.items()})


def _key(built: Built, looks: MonitoredPlaces) -> str:
    shapes = built.network.recovery
    assert isinstance(shapes, Shapes)
    content = hashlib.sha256(repr((built.meshing, built.machine.sections, looks.places)).encode())
    for block, shape in zip(built.field.blocks.values(), shapes.parts.values(), strict=True):
        content.update(np.ascontiguousarray(block.K.data).tobytes())
        content.update(np.ascontiguousarray(shape.V).tobytes())
    for name, xyz in sorted(looks.points.items()):
        content.update(repr((name, xyz.tolist())).encode())
    return content.hexdigest()[:20]


def at_rated_point(built: Built, looks: MonitoredPlaces) -> Rated:
    """Mesh: the difference to elements twice as large, which for two meshes is Roache's grid convergence index of
    order 2 with his factor of 3. Condensation: the largest difference from the field on the same mesh, steady and after
    a step of loss, at nominal coefficients and at other ones.

    Source: Roache 1994, J. Fluids Eng. 116, 405.
    """
    field, network = built.field, on_every_base(built.network)
    films, contacts = coefficients_on(built.machine, built.mesh)
    point = rated(built.machine, network, films, contacts)
    coarse = meshed(built.machine, built.meshing.coarser).field
    reader, rough = (Reader(f, network, point, looks) for f in (field, coarse))
    T, variant = point.of_field(field), point.moved(SPREAD)
    fine, other = reader.read(T), rough.read(point.of_field(coarse))
    beside = variant.of_field(field), variant.of_network(network, field)
    left = _largest(reader, [*_steady_and_step(point, T, field, network), beside])
    nodes = {f"{HOT}{p}": int(np.argmax(T[field.blocks[p].dofs])) for p in point.watts}
    return Rated({n: abs(fine[n] - other[n]) for n in fine}, left, max(map(abs, fine.values())), nodes)


def _steady_and_step(
    point: FixedCoefficients, T: Array, field: FieldModel, network: Network
) -> Iterator[tuple[Array, Array]]:
    """Field and network, steady and after a step of loss.  T : the field's steady answer"""
    yield T, point.of_network(network, field)
    yield from zip(point.steps_of_field(field), point.steps_of_network(network, field), strict=True)


def _largest(reader: "Reader", answers: Iterable[tuple[Array, Array]]) -> dict[str, float]:
    """Place -> the largest difference (K) between field and network."""
    each = [reader.differences(exact, approximation) for exact, approximation in answers]
    return {name: max(off[name] for off in each) for name in each[0]}


def at_multiplied_point(
    built: Built, looks: MonitoredPlaces, rise_K: float, multipliers: Mapping[str, float]
) -> dict[str, float]:
    """Place -> error of condensation (K) with films and contacts multiplied, steady and after a step, as of a rise of
    `rise_K`."""
    field, network = built.field, on_every_base(built.network)
    point = rated(built.machine, network, *coefficients_on(built.machine, built.mesh))

    links = [(x, multipliers[x.name]) for x in built.network.links if x.name in multipliers]
    films = {x.places[0]: m for x, m in links if x.kind == "film"}
    contacts = {x.name.removeprefix("contact:"): m for x, m in links if x.kind == "contact"}
    h = {face: films.get(face, 1.0) * h for face, h in point.films.items()}
    g = {pair: contacts.get(pair, 1.0) * g for pair, g in point.contacts.items()}
    there = replace(point, films=h, contacts=g)
    reader, T = Reader(field, network, there, looks), there.of_field(field)
    scale = rise_K / max(map(abs, reader.read(T).values()))
    return {name: scale * off for name, off in _largest(reader, _steady_and_step(there, T, field, network)).items()}


@dataclass(frozen=True)
class Reader:
    """Sensors and hot spots of heated parts in a field's answer (n + n_fluid,)."""

    field: FieldModel
    network: Network
    point: FixedCoefficients
    looks: MonitoredPlaces

    def read(self, T: Array) -> dict[str, float]:
        """name -> K"""
        sensors = {name: float(row @ T) for name, row in self.rows.items()}
        return sensors | {f"{HOT}{p}": float(T[self.field.blocks[p].dofs].max()) for p in self.point.watts}

    def differences(self, one: Array, other: Array) -> dict[str, float]:
        """name -> K between two answers on the same mesh"""
        a, b = self.read(one), self.read(other)
        return {name: abs(a[name] - b[name]) for name in a}

    @cached_property
    def rows(self) -> dict[str, Array]:
        return {name: self._row(name, place) for name, place in self.looks.places.items()}

    def _row(self, name: str, place: str) -> Array:
        out, p = np.zeros(self.field.n + len(self.point.fluids)), self.network.places[place]
        if name in self.looks.points and p.part in self.field.blocks:
            block = self.field.blocks[p.part]
            shape = PartShape(block.points, block.elements, np.zeros((block.n, 0)), block.w, np.zeros(0, np.int64))
            nodes, weights = locate(shape, self.looks.points[name], p.part)
            out[block.dofs.start + nodes] = weights
        elif p.kind == "surface":
            out[: self.field.n] = self.field.face_mean(self.field.film(place).trace)
        else:  # a sum of means of parts and of fluids; shapes of a zone are left out
            for i, weight in zip(p.mean.index, p.mean.weights, strict=True):
                state = self.network.states[i]
                if state in self.field.blocks:
                    out[: self.field.n] += weight * self.field.mean(state)
                elif state in self.point.fluids:
                    out[self.field.n + self.point.fluids.index(state)] += weight
        return out
