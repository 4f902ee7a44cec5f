"""thermoscope model build MACHINE"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from geom.errors import InputError, MissingDependency
from geom.plugins import plugins
from geom.table import Table
from thermoscope.case_folder.folder import load_machine_file
from thermoscope.commands.model import crosscheck
from thermoscope.console.options import ACCURACY, Accuracy, Json, Machine, Out
from thermoscope.console.summary import Summary
from thermoscope.console.terminal import give, notes, progress

if TYPE_CHECKING:
    from geom import Machine as MachineDescription
    from geom.solids.surfaces import CadCheck
    from lumped.build.network_size import NetworkSize
    from lumped.build.pipeline import Built
    from thermoscope.console.terminal import Progress


NETWORKS = {0: "means only", None: "learned", "mesh": "the mesh"}  # rows of the table that no number of states names


def build(machine: Machine, out: Out = None, target: Json = None, accuracy: Accuracy = ACCURACY) -> int:
    """Solids (STEP, STL, GLB), mesh and the smallest network that is accurate enough. Exit code 1 if none is."""
    return build_machine(machine, out, target, accuracy)


def build_machine(machine: str, out: Path | None, target: str | None, accuracy: float | None) -> int:
    """The same.  accuracy : percent of a part's own rise, mesh included; None: mesh and size that a case runs"""
    from geom import check_cad, export_cad, write_vtu

    source = load_machine_file(Path(machine))
    folder = out or Path("out") / source.name
    if Path(machine).is_file() and folder.resolve() == Path(machine).resolve().parent:
        raise InputError("the machine file lies there: a result could take its name", f"--out {folder}", "out/NAME")
    with progress() as tell:
        built, size = built_from(source, accuracy, tell)
        checked = crosscheck.checked(built, size, tell)
        tell("solids")  # in this process: a fork of one in which CAD threads ever ran never ends
        export_cad(source, folder)
        write_vtu(built.mesh, folder / f"{source.name}.vtu")
        solids = check_cad(source)
        document = {**described_as(built, solids), **checked, **({} if size is None else {"sizes": size.document()})}
        crosscheck.save(document, folder)
        document["pictures"] = [str(file) for file in pictures(built, folder, tell)]
    give(document, target, lambda: build_summary(document, folder))
    return 0 if size is None or size.met else 1


def pictures(built: Built, folder: Path, tell: Progress) -> list[Path]:
    """What was built: the machine cut open, and its mesh; none, and one note, where nothing can be drawn."""
    from viz import regions, require_gl, split

    try:
        require_gl()
    except MissingDependency as fault:
        notes([str(fault)])
        return []
    tell("drawing")
    name, files, portrait = built.machine.name, [folder / "mesh.png"], plugins("sections").get("portrait")
    if portrait is not None:
        files.insert(0, folder / "machine.png")
        portrait(built.machine, title=name, png=files[0]).close()
    regions(split(built.mesh), mesh=True, title=f"{name}: its mesh", png=files[-1]).close()
    return files


def built_from(
    source: MachineDescription, accuracy: float | None, tell: Progress, size_m: float = 0.06
) -> tuple[Built, NetworkSize | None]:
    """The network of an accuracy; of None, with the mesh and the size that a case runs.  size_m : of triangles (m)"""
    from lumped.build.network_size import accurate_network
    from lumped.build.pipeline import build as usual
    from lumped.machine.bases import on_all

    if accuracy is None:
        return usual(on_all(source), size_m, progress=tell), None
    size = accurate_network(source, accuracy, size_m, tell, lambda message: notes([message]))
    return size.built, size


def described_as(built: Built, solids: list[CadCheck]) -> dict[str, Any]:
    """The document of the command; surfaces, mesh and formula volumes in m3, areas in m2."""
    from geom.meshing.areas import part_table

    # Volume of every part in the mesh (m3): its tetrahedra summed
    mesh = built.mesh
    corners = mesh.points[mesh.tets]
    sizes = np.abs(np.linalg.det(corners[:, 1:] - corners[:, :1])) / 6.0
    meshed = dict(zip(mesh.parts, np.bincount(mesh.region, sizes, len(mesh.parts)).tolist(), strict=True))
    rows = {row.name: row for row in part_table(built.machine)}
    parts = [
        {
            "name": s.part,
            "material": built.machine.part(s.part).material,
            "volume_m3": s.volume,
            "mesh_volume_m3": meshed[s.part],
            "solid_volume_m3": s.solid_volume,
            "watertight": s.watertight,
            "mass_kg": rows[s.part].mass,
            "faces_m2": dict(rows[s.part].faces),
            "contacts_m2": dict(rows[s.part].contacts),
        }
        for s in solids
    ]
    return {
        "machine": built.machine.name,
        "parts": parts,
        "mesh": {"nodes": len(built.mesh.points), "tets": len(built.mesh.tets)},
        "network": {"nodes": len(built.network.states), "links": len(built.network.links)},
    }


def build_summary(document: Mapping[str, Any], folder: Path) -> Summary:
    """How well the network agrees with the field, part by part, and where the files are."""
    mesh, network = document["mesh"], document["network"]
    sentence = (
        f"{document['machine']}: a network of {network['nodes']} states from {mesh['tets']} tetrahedra; "
        f"of the rise it has {crosscheck.agreement(document)}."
    )
    parts = Table.of(
        "Parts",
        document["parts"],
        "part=name | material | volume (l)=litres | in the mesh (l)=mesh_litres | *mass (kg)=mass_kg | "
        "to fluids (m2)=faces | to parts (m2)=contacts | *watertight",
        ["NO"],
        litres=lambda part: 1e3 * part["volume_m3"],
        mesh_litres=lambda part: 1e3 * part["mesh_volume_m3"],
        faces=lambda part: sum(part["faces_m2"].values()),
        contacts=lambda part: sum(part["contacts_m2"].values()),
        watertight=lambda part: "yes" if part["watertight"] else "NO",
    )
    tables = [*(_sizes(document["sizes"]) if "sizes" in document else []), crosscheck.parts(document), parts]
    rest = [crosscheck.links(document), crosscheck.analytical_table(document)]
    return Summary(sentence, tables, f"solids, mesh, tables and pictures in {folder}; --json FILE", rest)


def _sizes(sizes: Mapping[str, Any]) -> list[Table | str]:
    """Error against number of states, what was seen at points nothing was fitted to, and the mesh's own: all that the
    exit code hangs on."""
    requested, trials, mesh = sizes["wish_percent"], sizes["guard"], sizes["mesh"]
    meshes = [] if mesh is None else [{"asked": "mesh", "nominal": {"hot": mesh["worst"]}, "met": mesh["met"]}]
    limits = f"means {requested['mean']:.3g}, hot spots and points {requested['hot']:.3g}"
    table = Table.of(
        f"Error in % of a part's rise (asked: {limits})",
        [*sizes["sizes"], *({**g, "asked": None} for g in trials), *meshes],
        "network | *states | mean=nominal.mean | hot spot=nominal.hot | point=nominal.point | "
        "*mean, random=random.mean | *hot, random=random.hot | point, random=random.point | *met",
        network=lambda s: NETWORKS.get(s["asked"], f"up to {s['asked']}"),
        met=lambda s: "yes" if s["met"] else "no",
    )
    notes: list[Table | str] = []
    if mesh:
        left = f"{mesh['worst']:.2g} % of the rise at the hot spot of {mesh['worst_part']}"
        more = "" if mesh["met"] else ": too much, but a finer one is beyond 4 GB or 3 min"
        notes.append(f"The mesh of {mesh['unknowns']} unknowns leaves {left}{more}.")
    if trials and not trials[-1]["met"]:
        bad = trials[-1]["random"]
        where = f"mean {bad['mean_part']}, hot spot {bad['hot_part']}, point {bad['point_part']}"
        notes.append(f"The accuracy is missed: {where}.")
    return [table, *notes]
