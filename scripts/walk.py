"""Walks one machine file to its network and one case to its verdict, and prints the files whose code ran, in order.

python scripts/walk.py                     # the imports alone: longest chain of every room, circles
python scripts/walk.py --machine pmsm-m1   # and the files from a machine file to its network
python scripts/walk.py --case tclab        # and the files from a case to its verdict
python scripts/walk.py --page              # both walks, as docs/architecture.md shows them
"""

import argparse
import ast
import os
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from functools import cache
from graphlib import CycleError, TopologicalSorter
from itertools import pairwise
from pathlib import Path
from types import FrameType
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
ROOMS = ("geom", "fem", "lumped", "measured", "validation", "viz", "thermoscope", "extras")  # from the ground up
Graph = dict[str, set[str]]
PAGE, MACHINE, CASE = ROOT / "docs" / "architecture.md", "pmsm-m1-no-base", "tclab"
LEAST_SHARE = 0.02  # of the time, from which a file is a station on the page


def import_graph(types: bool) -> Graph:
    """Module -> the modules of the rooms that it imports.  types : what only a type checker reads counts, too"""
    files = {name_of(f): f for room in ROOMS for f in (ROOT / room).rglob("*.py")}
    return {name: set(imported(file, files, types)) - {name} for name, file in files.items()}


def name_of(file: Path) -> str:
    return ".".join(file.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")


def imported(file: Path, known: dict[str, Path], types: bool) -> Iterator[str]:
    """Modules of the rooms that a file imports, inside functions as well."""
    todo: list[ast.AST] = [ast.parse(file.read_text(encoding="utf-8"))]
    while todo:
        node = todo.pop()
        if not types and isinstance(node, ast.If) and getattr(node.test, "id", "") == "TYPE_CHECKING":
            continue
        todo += ast.iter_child_nodes(node)
        if isinstance(node, ast.ImportFrom):
            wholes = [f"{node.module}.{alias.name}" for alias in node.names]
            yield from (w if w in known else str(node.module) for w in wholes if w in known or node.module in known)
        elif isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names if alias.name in known)


def longest_chain(graph: Graph) -> list[str]:
    """The longest chain of modules of a graph without circles that import each other, the upper one first."""
    below: dict[str, list[str]] = {}
    for name in TopologicalSorter(graph).static_order():
        below[name] = [name, *max((below[m] for m in graph[name]), key=_by_length, default=[])]
    return max(below.values(), key=_by_length, default=[])


def _by_length(chain: list[str]) -> tuple[int, list[str]]:
    """Of two that are as long, the same one every time."""
    return len(chain), chain


def circle(graph: Graph) -> list[str]:
    """Modules that import each other in a circle; [] where none do."""
    try:
        TopologicalSorter({name: sorted(graph[name]) for name in sorted(graph)}).prepare()
    except CycleError as fault:
        return list(fault.args[1])
    return []


def of_room(graph: Graph, room: str) -> Graph:
    inside = {name for name in graph if name.partition(".")[0] == room}
    return {name: graph[name] & inside for name in inside}


@cache
def room_module(file: str) -> str:
    """The module of a file of the rooms, "" of any other."""
    path = Path(file)
    ours = path.is_relative_to(ROOT) and path.relative_to(ROOT).parts[0] in ROOMS
    return name_of(path) if ours else ""


def visits(work: Callable[[], Any]) -> list[str]:
    """Modules whose functions run, one entry for every change from one to another."""
    out: list[str] = []

    def look(frame: FrameType, event: str, argument: Any) -> None:
        if event != "call":
            return
        name = room_module(frame.f_code.co_filename)
        if name and frame.f_code.co_name != "<module>" and (not out or out[-1] != name):
            out.append(name)

    sys.setprofile(look)
    try:
        work()
    finally:
        sys.setprofile(None)
    return out


def stations(work: Callable[[], Any]) -> list[tuple[str, float]]:
    """Modules in order of the first visit, with the share of the time between a visit and its return."""
    inside: dict[str, float] = {}  # module -> seconds, all that it calls included
    depth: dict[str, int] = {}  # module -> how often it waits for a call of its own
    since: dict[str, float] = {}

    def look(frame: FrameType, event: str, argument: Any) -> None:
        file = frame.f_code.co_filename
        name = "" if file.endswith("__init__.py") else room_module(file)
        if not name or event not in ("call", "return") or frame.f_code.co_name == "<module>":
            return
        if event == "call":
            depth[name] = depth.get(name, 0) + 1
            if depth[name] == 1:
                since[name] = time.perf_counter()
                inside.setdefault(name, 0.0)
        elif depth.get(name):
            depth[name] -= 1
            if not depth[name]:
                inside[name] += time.perf_counter() - since[name]

    begin = time.perf_counter()
    sys.setprofile(look)
    try:
        work()
    finally:
        sys.setprofile(None)
    whole = time.perf_counter() - begin
    return [(name, t / whole) for name, t in inside.items()]


def walk_table(work: Callable[[], Any]) -> str:
    """The files in which a fiftieth of the time and more passes, in order of the first visit, in Markdown."""
    path = stations(work)
    rows = [f"| `{file_of(n)}` | {purpose(n)} | {100 * p:.0f} % |" for n, p in path if p >= LEAST_SHARE]
    others = f"{len(path) - len(rows)} further files on the way are left for less than a fiftieth of the time."
    return "\n".join(["| file | what it holds | time |", "|---|---|---|", *rows, "", others])


def file_of(name: str) -> str:
    return f"{name.replace('.', '/')}.py"


def purpose(name: str) -> str:
    """The first sentence of a module's docstring."""
    text = ast.get_docstring(ast.parse((ROOT / file_of(name)).read_text(encoding="utf-8"))) or ""
    return " ".join(text.split("\n\n")[0].split()).replace("|", "\\|")


def write_page() -> None:
    """Both walks between their marks on the page of the architecture, on a computer that has kept nothing."""
    import thermoscope as ts

    with tempfile.TemporaryDirectory() as empty:
        os.environ["THERMOSCOPE_CACHE"] = empty
        works = {"machine": lambda: ts.build(MACHINE), "case": lambda: ts.open(CASE).diagnose()}
        page = PAGE.read_text(encoding="utf-8")
        for name, work in works.items():
            begin, end = f"<!-- {name}:begin -->", f"<!-- {name}:end -->"
            before, rest = page.split(begin)
            page = f"{before}{begin}\n{walk_table(work)}\n{end}{rest.split(end)[1]}"
    PAGE.write_text(page, encoding="utf-8")


def print_walk(title: str, path: list[str]) -> None:
    """Every file once, in order of the first visit, and how often the walk goes from one to another and upwards."""
    rooms = [ROOMS.index(name.partition(".")[0]) for name in path]
    climbs = sum(b > a for a, b in pairwise(rooms))
    files = list(dict.fromkeys(path))
    print(f"{title}: {len(files)} files, {len(path)} visits, {climbs} of them climb to an upper room")
    print(*(f"  {name}" for name in files), sep="\n")


def print_chains() -> None:
    """The longest chain of every room and what goes in a circle."""
    graph, typed = import_graph(types=False), import_graph(types=True)
    for room in ROOMS:
        chain = longest_chain(of_room(graph, room))
        print(f"{room}: {len(of_room(graph, room))} files, longest chain {len(chain)}: {' > '.join(chain)}")
        if ring := circle(of_room(typed, room)):
            print(f"  in a circle by types: {' > '.join(ring)}")
    whole = longest_chain(graph)
    print(f"all rooms: {len(graph)} files, longest chain {len(whole)}")


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--machine", help="a machine file, or a name that comes along")
    options.add_argument("--case", help="a case folder, or the name of a case that comes along")
    options.add_argument("--page", action="store_true", help="write both walks to docs/architecture.md")
    wish = options.parse_args()
    if wish.page:
        return write_page()
    print_chains()
    import thermoscope as ts

    if wish.machine:
        print_walk(f"{wish.machine} to its network", visits(lambda: ts.build(wish.machine)))
    if wish.case:
        print_walk(f"{wish.case} loaded", visits(lambda: ts.open(wish.case)))
        print_walk(f"{wish.case} to its verdict", visits(lambda: ts.open(wish.case).diagnose()))


if __name__ == "__main__":
    sys.path.insert(0, str(ROOT))
    main()
