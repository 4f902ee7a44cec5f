"""The prisms of a STEP file, read in a process of its own: nothing else can interrupt OpenCASCADE.

python -m geom.solids.step_prisms    {"path", "import"} as JSON on stdin; the prisms, or the fault, as its last line
"""

import json
import os
import subprocess
import sys
from collections.abc import Mapping
from fnmatch import fnmatchcase
from pathlib import Path
from typing import TYPE_CHECKING, Any

from geom.description.machine import step_sidecar
from geom.description.names import plain_name
from geom.description.parameters import is_number
from geom.description.part import Prism
from geom.description.profile import Profile
from geom.errors import InputError
from geom.limits import SECONDS, STEP_BYTES, ReadingTime
from geom.solids.slicing import sliced

if TYPE_CHECKING:
    import cadquery as cq

RIGHT = "a STEP assembly of named solids"
LARGEST_MM = 1e6  # as all lengths of a machine file
_ROTATIONS = {"x": ((0, 1, 0), -90.0), "y": ((1, 0, 0), 90.0), "z": ((0, 0, 1), 0.0)}  # axis and angle (deg) onto z


def step_prisms(path: Path, options: Mapping[str, Any]) -> dict[str, tuple[Prism, ...]]:
    """Prisms (m) by the name of their solid.  options : [import] of the file beside it

    InputError where the file takes longer than the limit allows, ends its reader, or holds what cannot be sliced.
    """
    STEP_BYTES.check(path.stat().st_size, path, "holds")
    with path.open("rb") as file:
        if b"ISO-10303-21" not in file.read(200):
            raise InputError("not a STEP file", str(path), RIGHT)
    clock = ReadingTime(path)
    try:
        process = subprocess.run(
            [sys.executable, "-P", "-m", __name__],
            input=json.dumps({"path": str(path), "import": options}, default=str),
            env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))},
            capture_output=True,
            encoding="utf-8",
            errors="replace",
            timeout=SECONDS.most,
            check=False,
        )
    except subprocess.TimeoutExpired:
        clock.check()
        raise
    if process.returncode:
        last = (process.stderr.strip().splitlines() or [f"exit code {process.returncode}"])[-1]
        raise InputError(f"not readable: its reader ended ({last})", str(path), RIGHT)
    result = json.loads(process.stdout.splitlines()[-1])  # OpenCASCADE may have spoken before
    if isinstance(result, list):
        raise InputError(*result)
    return {name: tuple(_prism(*prism) for prism in prisms) for name, prisms in result.items()}


def _prism(loops: list[list[list[float]]], z0: float, z1: float) -> Prism:
    outer, *holes = (tuple((x, y, bulge) for x, y, bulge in loop) for loop in loops)
    return Profile(outer, tuple(holes)), z0, z1


def _solids(path: Path, options: Mapping[str, Any]) -> "dict[str, list[cq.Solid]]":
    """Solids (mm) by name, turned and moved so that the machine's axis is z."""
    import cadquery as cq

    axis, origin = options.get("axis", "z"), options.get("origin_mm", [0.0, 0.0, 0.0])
    where = f"{step_sidecar(path)} [import]"
    if not isinstance(axis, str) or axis not in _ROTATIONS:
        raise InputError(f"{axis!r} is not an axis", f"{where} axis", f"one of {', '.join(_ROTATIONS)}")
    within = isinstance(origin, list) and all(is_number(x) and abs(x) <= LARGEST_MM for x in origin)
    if not within or len(origin) != 3:
        raise InputError(
            f"{origin!r} is not a point", f"{where} origin_mm", f"[x, y, z], each within {LARGEST_MM:g} mm"
        )
    rotation = cq.Location(cq.Vector(), cq.Vector(*_ROTATIONS[axis][0]), _ROTATIONS[axis][1])
    translation = cq.Location(cq.Vector(*(-float(x) for x in origin)))
    by_name: dict[str, list[cq.Solid]] = {}
    for shape, name, place, _ in _assembly(path):
        body = shape.moved(rotation * translation * place)
        if body.Solids():
            by_name.setdefault(name.split("/")[-1].replace("|", "_"), []).extend(body.Solids())
    if not by_name:
        raise InputError("no solids", str(path), RIGHT)
    return by_name


def _assembly(path: Path) -> Any:
    import cadquery as cq

    try:
        return list(cq.Assembly.load(str(path)))
    except Exception as error:  # OpenCASCADE's readers raise whatever comes to hand
        raise InputError(f"not readable: {error}", str(path), RIGHT) from error


def _without_excluded(
    solids: "dict[str, list[cq.Solid]]", options: Mapping[str, Any], path: Path
) -> "dict[str, list[cq.Solid]]":
    patterns, where = options.get("leave_out", []), f"{step_sidecar(path)} [import] leave_out"
    if not (isinstance(patterns, list) and all(isinstance(p, str) for p in patterns)):
        raise InputError(f"{patterns!r} is not a list of names", where, 'such as ["bolt*"]')
    for pattern in patterns:
        if not any(fnmatchcase(name, pattern) for name in solids):
            raise no_solid(pattern, solids, where)
    rest = {name: pieces for name, pieces in solids.items() if not any(fnmatchcase(name, p) for p in patterns)}
    if not rest:
        raise InputError("no solid is left", where, f"fewer of {', '.join(solids)}")
    return rest


def _all_sliced(solids: "Mapping[str, list[cq.Solid]]", path: Path) -> dict[str, tuple[Prism, ...]]:
    """Prisms by name; one error that names every solid that cannot be sliced."""
    prisms, faults = {}, []
    for name, pieces in solids.items():
        try:
            prisms[plain_name(name, "a solid")] = tuple(prism for solid in pieces for prism in sliced(solid, name))
        except InputError as fault:
            faults.append(fault)
    if faults:
        what = "; ".join(f"{fault.where}: {fault.what}" for fault in faults)
        raise InputError(what, str(path), f"{faults[0].right} ([import] leave_out in {step_sidecar(path).name})")
    return prisms


def no_solid(pattern: str, names: Mapping[str, Any], where: str) -> InputError:
    return InputError(f"no solid is called {pattern[:60]!r}", where, f"the file has: {', '.join(names)}")


def main() -> None:
    """Read one file."""
    order = json.load(sys.stdin)
    path, options = Path(order["path"]), order["import"]
    try:
        solids = _without_excluded(_solids(path, options), options, path)
        prisms = {n: [(p.loops, *z) for p, *z in whole] for n, whole in _all_sliced(solids, path).items()}
        print("\n" + json.dumps(prisms))
    except InputError as fault:
        print("\n" + json.dumps([fault.what, fault.where, fault.right]))


if __name__ == "__main__":
    main()
