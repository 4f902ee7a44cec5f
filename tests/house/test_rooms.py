"""Folders are short enough to be read at a glance, no modules import each other in a circle, and the pages say so."""

import ast
import importlib
import re
from graphlib import CycleError, TopologicalSorter

import pytest

from scripts import walk

ROOMS = ("geom", "fem", "lumped", "measured", "validation", "viz", "thermoscope", "extras")
BESIDE = ("simulated", "benchmarks", "scripts", "docs", "tests")  # examples/ is a gallery, side by side
MOST = 15  # files of a folder beside its __init__: more do not fit on a screen
# The longest chain of modules that import each other inside a room: what a reader passes from the top to the bottom.
DEEPEST = dict(geom=8, fem=10, lumped=15, measured=10, validation=10, viz=7, thermoscope=10, extras=8)
SENTENCES = 6  # of the page of the architecture, which has one picture


@pytest.fixture(scope="module")
def uses(root, trees):
    """Module -> the modules that it imports."""
    names = {f: ".".join(f.relative_to(root).with_suffix("").parts).removesuffix(".__init__") for f in trees}
    modules = set(names.values())
    return {names[file]: set(imports(tree, modules)) for file, tree in trees.items()}


def test_no_folder_is_long(root):
    folders = {f.parent for room in (*ROOMS, *BESIDE) for f in (root / room).rglob("*.py")}
    files = {str(d.relative_to(root)): len([f for f in d.glob("*.py") if f.stem != "__init__"]) for d in folders}
    assert {name: n for name, n in files.items() if n > MOST} == {}


def test_the_architecture_is_one_picture_six_sentences_two_walks_and_where_a_new_one_goes(root):
    page, *sections = re.split("^## ", (root / "docs/architecture.md").read_text(encoding="utf-8"), flags=re.MULTILINE)
    title, picture, text = re.split("```text|```\n", page)
    assert title.strip() == "# Architecture"
    assert [line for line in picture.splitlines() if line.strip().startswith(ROOMS)] != []
    assert not re.search(r"^[#|-]", text, re.MULTILINE), "no table, no list and no further heading"
    assert len(re.findall(r"\.(?:\s|$)", text)) == SENTENCES
    assert len(sections) == 3
    named = re.findall(r"`((?:\w+/)+(?:\w+\.py)?)`", "".join(sections))
    assert len(named) > 20, "two walks"
    assert [path for path in named if not (root / path).exists()] == []


def test_no_circle_by_types_either(uses):
    """What a module names for a type checker alone counts, too: a reader follows it all the same."""
    graph = walk.import_graph(types=True)
    assert len(graph) >= len([name for name in uses if name.partition(".")[0] in ROOMS])
    assert walk.circle(graph) == []


def rows_of(root):
    """Room -> its row on the page."""
    page = (root / "docs/rooms.md").read_text(encoding="utf-8").partition("## What passes")[0]
    return {name: row for name, row in re.findall(r"^\| `(\w+)` \| (.*) \|$", page, re.MULTILINE) if name in ROOMS}


def test_the_page_of_rooms_names_every_room(root):
    rows = rows_of(root)
    assert set(rows) == set(ROOMS)
    missing = {
        f"{room}/{d.name}"
        for room in ROOMS
        for d in (root / room).iterdir()
        if d.is_dir() and any(d.glob("*.py")) and f"`{d.name}`" not in rows[room]
    }
    assert missing == set()


def test_modules_import_each_other_one_way(uses):
    assert circle(uses) == []


def test_folders_import_each_other_one_way(uses):
    """At every depth: of all that stands in one folder, files and folders, each uses only what comes before it."""
    folders = {name.rpartition(".")[0] for name in uses if "." in name}
    assert {"validation", "lumped", "validation.effects"} <= folders
    assert {f: ring for f in sorted(folders) if (ring := circle(children(uses, f)))} == {}


@pytest.mark.parametrize("room", ROOMS)
def test_the_page_names_folders_after_those_they_use(root, uses, room):
    inside = children(uses, room)
    order = [name for name in re.findall(r"`(\w+)`", rows_of(root)[room]) if (root / room / name).is_dir()]
    late = {(name, used) for k, name in enumerate(order) for used in inside.get(name, set()) & set(order[k + 1 :])}
    assert late == set()


def children(graph, folder):
    """What the files and folders of one folder use of each other."""
    out = {}
    for name in (n for n in graph if n.startswith(f"{folder}.")):
        used = {_child(m, folder) for m in graph[name] if m.startswith(f"{folder}.")}
        out.setdefault(_child(name, folder), set()).update(used - {_child(name, folder)})
    return out


def _child(name, folder):
    return name.removeprefix(f"{folder}.").partition(".")[0]


def test_the_check_sees_folders_that_use_each_other():
    """Though no two of their modules do."""
    graph = {"r.a.one": {"r.b.one"}, "r.b.one": set(), "r.b.two": {"r.a.two"}, "r.a.two": set()}
    assert not circle(graph)
    assert circle(children(graph, "r"))


def test_no_room_is_deeper_than_it_was(uses):
    depths = {room: depth({n: m for n, m in uses.items() if n.partition(".")[0] == room}) for room in ROOMS}
    assert {room: n for room, n in depths.items() if n > DEEPEST[room]} == {}


def depth(graph):
    """Modules on the longest chain inside the graph."""
    levels = {}
    for name in TopologicalSorter({n: m & graph.keys() - {n} for n, m in graph.items()}).static_order():
        levels[name] = 1 + max((levels[m] for m in graph[name] & levels.keys()), default=0)
    return max(levels.values())


def test_a_chain_is_as_deep_as_its_modules():
    assert depth({"a": {"b", "x"}, "b": {"c"}, "c": set(), "d": {"c"}}) == 3


def imports(tree, known):
    """Modules that the code imports, inside functions too; what only types need does not count."""
    for node in run_time(tree):
        if isinstance(node, ast.Import):
            yield from (a.name for a in node.names if a.name in known)
        elif isinstance(node, ast.ImportFrom):
            wholes = [f"{node.module}.{a.name}" for a in node.names]
            yield from (w if w in known else node.module for w in wholes if w in known or node.module in known)


def run_time(node):
    for child in ast.iter_child_nodes(node):
        if not (isinstance(child, ast.If) and getattr(child.test, "id", "") == "TYPE_CHECKING"):
            yield child
            yield from run_time(child)


def circle(graph):
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        return error.args[1]
    return []


@pytest.mark.parametrize("text", ["import b", "from b import x", "def f():\n    from b import x"])
def test_the_check_sees_a_circle(text):
    assert circle({"a": set(imports(ast.parse(text), {"a", "b"})), "b": {"a"}})


@pytest.mark.parametrize("room", ["geom", "lumped", "measured", "validation", "viz"])
def test_every_public_name_is_where_its_room_says(room):
    """They are loaded by words that no type checker reads; thermoscope has a test of its own."""
    module = importlib.import_module(room)
    assert [name for name in module.__all__ if getattr(module, name) is None] == []
    with pytest.raises(AttributeError, match=module.__all__[0]):
        _ = module.nothing


def test_no_script_hides_a_room(root):
    """Python looks first beside the script it runs: `benchmarks/viz.py` would be the `viz` of all benchmarks."""
    beside = {path.stem: path for folder in ("benchmarks", "examples", "scripts") for path in (root / folder).iterdir()}
    assert {name: beside[name] for name in ROOMS if name in beside} == {}


def test_make_runs_benchmarks_that_are_there(root):
    named = re.search(r"for name in ([\w ]+); do", (root / "Makefile").read_text(encoding="utf-8"))
    assert [name for name in named[1].split() if not (root / "benchmarks" / f"{name}.py").is_file()] == []
