"""What condensing a large motor costs: CPU, memory, matrices factorised; `condensation.py --offline` writes it down."""

import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import Any

from field import MOTOR
from peers.field import peak_gib

from fem.solvers.solve import Solver
from geom import build_mesh, load_machine
from lumped.build.network_size import FINE
from lumped.build.pipeline import Meshing, Prepared, field_of, reduced
from lumped.machine.motor import nominal_coefficients
from lumped.machine.zones import motor_zones
from scripts.published import measured_row as row

Row = dict[str, Any]


def offline_rows() -> Iterator[Row]:
    """CPU and memory from a field on 150,000 nodes to a network, and what a changed film and contact cost then."""
    machine = load_machine("series-dc-100kw")
    mesh = build_mesh(machine, **MOTOR)
    faces = {name: (p.part, p.fluid) for name, p in mesh.patches.items()}
    films, contacts = nominal_coefficients(machine, faces, mesh.contacts)
    how = Meshing(**MOTOR, axial_m=1.5 * MOTOR["size_m"])
    ready = Prepared(machine, mesh, field_of(machine, mesh), films, contacts, how)
    case = f"motor, {len(mesh.points)} nodes, {ready.field.n} unknowns"
    changed = replace(
        ready,
        films={**films, "housing.fins": 2 * films["housing.fins"]},
        contacts={**contacts, "housing|yoke": 0.5 * contacts["housing|yoke"]},
    )
    for what, one in (("condensed", ready), ("a film and a contact changed", changed)):
        with counted() as solves:
            start = time.process_time()
            reduced(one, FINE, motor_zones(machine)).network(max_states=400)
            yield row(case, what, "s CPU", time.process_time() - start)
        yield row(case, f"{what}: factorisations", "1", len(solves))
    yield row(case, "peak memory of the process", "GiB", peak_gib(), 4.0, "wanted")


@contextmanager
def counted() -> Iterator[list[int]]:
    """Collects one entry for every matrix that is factorised."""
    own, solves = Solver.factor, []

    def factor(self: Solver, *args: Any) -> Any:
        solves.append(1)
        return own(self, *args)

    Solver.factor = factor  # type: ignore[assignment, method-assign]
    try:
        yield solves
    finally:
        Solver.factor = own  # type: ignore[method-assign]
