"""A machine that was built, in a script: mesh, network, and steady temperature fields."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from geom.arrays import Array
from geom.errors import InputError, NoSolution
from geom.table import Table, TableResult
from geom.text import counted, table
from thermoscope.case_folder.folder import load_machine_file
from thermoscope.interface.notebook import Progress, hearing, silent
from thermoscope.parts import explained

if TYPE_CHECKING:
    import pyvista

    from geom import NamedMesh
    from lumped.build.crosscheck import CrossCheck, PartCheck
    from lumped.build.pipeline import Built
    from lumped.model.network import Network


@dataclass(frozen=True)
class Field(TableResult):
    """A steady temperature field and what the network says of the same operating point."""

    built: Built
    check: CrossCheck

    def __repr__(self) -> str:
        (content,) = self.tables()
        return (
            f"Steady field of '{self.built.machine.name}': {self.heat_W:.0f} W of loss, "
            f"energy balance {self.energy_balance:.1e}\n{table(content.columns, content.rows)}"
        )

    def tables(self) -> tuple[Table, ...]:
        """Temperatures (degC) of every part, the hottest first: of the field, and of the network."""
        every = sorted(self.parts.values(), key=lambda part: -part.fem_max_C)
        columns = "part=place | mean (degC)=fem_mean_C | hottest=fem_max_C | network: mean=network_mean_C"
        return (Table.of("", every, f"{columns} | network: hottest=network_max_C"),)

    @property
    def T(self) -> Array:
        """(n,) temperature of the field's unknowns (degC)."""
        return self.check.field

    @property
    def parts(self) -> Mapping[str, PartCheck]:
        """Mean and hottest temperature (degC) by part, of field and network."""
        return {part.place: part for part in self.check.parts}

    @property
    def heat_W(self) -> float:
        """All losses (W)."""
        return self.check.heat

    @property
    def energy_balance(self) -> float:
        """|heat in - heat out| / heat in."""
        return self.check.energy_balance

    @explained()
    def plot(self, png: str | Path | None = None) -> pyvista.Plotter:
        """The machine cut open, coloured by temperature (degC). Raises MissingDependency without OpenGL."""
        from viz import cutaway, require_gl, split

        require_gl()
        nodes = split(self.built.mesh)
        x = self.check.state[: len(self.built.network.states)]
        return cutaway(nodes, self.built.network.on_parts(nodes.parts, x), png=png)


@dataclass(frozen=True)
class Machine(TableResult):
    """A machine at every stage: geometry, mesh, field and network."""

    built: Built

    def __repr__(self) -> str:
        parts, tets = counted(len(self.built.machine.parts), "part"), len(self.mesh.tets)
        rated = ", ".join(f"{name} = {value:g}" for name, value in self.rated.items())
        return f"<Machine '{self.name}': {parts}, {tets} tetrahedra, {len(self.network.states)} states; rated {rated}>"

    def tables(self) -> tuple[Table, ...]:
        """Its parts with their materials."""
        return (Table.of("", self.built.machine.parts, "part=name | material"),)

    @property
    def name(self) -> str:
        return self.built.machine.name

    @property
    def mesh(self) -> NamedMesh:
        """Tetrahedra (m), the part of each, named faces and contacts."""
        return self.built.mesh

    @property
    def network(self) -> Network:
        """Condensed from the field: states, links, sources, places, parameters."""
        return self.built.network

    @cached_property
    def rated(self) -> Mapping[str, float]:
        """The rated operating point: input -> value, the unit in its name."""
        from lumped.machine.motor import rated_inputs

        return rated_inputs(self.built.machine)

    def field(self, ambient_C: float = 20.0, **inputs: float) -> Field:
        """The steady field at an operating point, with the coefficients at which the network settles there.

        inputs : those of `rated`, for example current_A=20, speed_rpm=1450; those that are not given are rated
        Raises InputError for an unknown input, and where the machine does not settle: at a rating for an hour, say.
        """
        from lumped.build.crosscheck import crosscheck
        from lumped.machine.loss_sources import loss_shares

        unknown = sorted(set(inputs) - set(self.rated))
        if unknown:
            raise InputError(f"unknown input '{unknown[0]}'", self.name, f"one of {', '.join(self.rated)}")
        point, b = {**self.rated, **inputs}, self.built
        try:
            check = crosscheck(b.field, b.network, point, ambient_C, shares=loss_shares(b.machine, b.network))
        except NoSolution as fault:
            there = ", ".join(f"{name} = {value:g}" for name, value in point.items())
            what = f"does not settle at {there}: its losses grow faster than its cooling"
            raise InputError(what, self.name, "a smaller load: field(current_A=...)") from fault
        return Field(b, check)


@explained()
def build(
    machine: str | Path, accuracy: float | None = None, size_m: float = 0.06, progress: Progress = silent
) -> Machine:
    """Mesh, field and network of a machine file, or of a machine that comes along by its name.

    accuracy : percent of a part's own rise that the network may be wrong by; None: the size that a case runs
    size_m : of the mesh's triangles (m)
    progress : is told what is going on; in a notebook that names none, a bar shows it
    Raises InputError: the key of the file, what is wrong with it, and what would be right.
    """
    from thermoscope.commands.model.build import built_from

    with hearing(progress, "model build", str(machine)) as tell:
        return Machine(built_from(load_machine_file(Path(machine)), accuracy, tell, size_m)[0])


def machines() -> tuple[str, ...]:
    """Names of the machines that come along."""
    from geom import library

    return tuple(library())
