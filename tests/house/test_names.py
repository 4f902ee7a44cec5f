"""No code decides what something is by a piece of its name: roles and quantities say it."""

import ast
from pathlib import Path

import pytest

ROOMS = ("geom", "fem", "lumped", "validation", "viz", "thermoscope")
WHOLE = {"startswith", "endswith"}
PIECES = {"split", "partition", "rpartition", "rsplit"}
ALLOWED = {  # file -> what its strings are, none of them a user's name for a part, an input or a test
    "geom/parameters.py": "keys of geometry, GROUP.NAME",
    "geom/gallery.py": "a choice of the family",
    "geom/reading.py": "keys of geometry, NAME_mm and NAME_ratio",
    "lumped/keys_page.py": "keywords of JSON Schema",
    "lumped/schema.py": "keywords of JSON Schema",
    "lumped/bounds.py": "keys of files by their unit, NAME_mm",
    "thermoscope/consistency.py": "names of inputs by the unit that they say they hold, NAME_W: for a warning only",
    "thermoscope/units.py": "names of inputs by the unit that they say they hold, NAME_percent",
    "thermoscope/doctor.py": "shapes that the network names itself, PART#1",
    "thermoscope/csv_file.py": "endings of files",
    "thermoscope/groups.py": "options on the command line",
    "thermoscope/commands/saved.py": "hidden files",
    "geom/step.py": "labels of a STEP assembly",
    "validation/effects/gate.py": "events that the tool names itself, TEST:BEGIN-END",
    "fem/streams.py": "cells that fem.streams names itself, FLUID@3",
    "lumped/motor_path.py": "cells that fem.streams names itself, FLUID@3",
    "lumped/motor_shapes.py": "a choice of the family",
    "lumped/motor_bases.py": "faces and shapes that the network names itself",
    "lumped/motor_parameters.py": "streams that motor_air and motor_coolant name themselves",
    "lumped/shelf.py": "keys of a file of shapes",
    "lumped/reader.py": "a heading in brackets, a hint at a key",
    "lumped/declared.py": "targets of parameters, link:NAME",
    "lumped/declared_parameters.py": "targets of parameters, link:NAME",
    "validation/operators.py": "targets of parameters, gain:CHANNEL",
    "validation/predict.py": "targets of parameters, gain:CHANNEL",
    "validation/staged.py": "parameters that forms and shares name themselves, NAME^INPUT",
    "validation/revise.py": "parameters that forms and shares name themselves, NAME^INPUT",
    "validation/effects/registry.py": "modules, and KIND@PLACE",
    "validation/effects/coupling.py": "places of this effect, A|B",
    "validation/effects/gap_convection.py": "places of this effect, A|B",
    "validation/effects/contact.py": "links by their own name, contact:A|B",
    "validation/effects/air_leak.py": "links by their own name, stream:NAME",
    "validation/effects/copper_feedback.py": "sources by their own name, loss:NAME",
    "validation/effects/fan_stop.py": "places of this effect, FLOW:TEST:50",
    "validation/rating/loss_grid.py": "columns of a loss map, NAME_W; sources by their own name, loss:NAME",
    "validation/procedure/pm_network.py": "nodes that this file names itself",
    "validation/procedure/carry.py": "parameters of losses, as the networks of machines name them",
    "viz/sankey.py": "streams that a machine's network names itself, fan:CELL",
    "geom/bases.py": "contacts, A|B",
    "geom/meshio_io.py": "keys of a file of meshes",
    "lumped/motor_roles.py": "contacts, A|B",
    "validation/inference/evidence.py": "places of an effect, A|B",
    "viz/report.py": "effects by their own name, KIND@PLACE",
    "thermoscope/commands/crosscheck.py": "shapes that the network names itself, PART#1",
    "thermoscope/commands/revise.py": "effects by their own name, KIND@PLACE",
    "thermoscope/commands/simulate.py": "shapes that the network names itself, PART#1",
    "thermoscope/commands/simulate_readings.py": "inputs that lumped.coupled names itself",
    "thermoscope/crosscheck.py": "links by their own name, contact:A|B",
    "thermoscope/importing/target.py": "inputs by the unit that their name says, NAME_W: a guess that is shown",
    "thermoscope/importing/words.py": "words of headers in other people's files: a guess that is shown",
    "thermoscope/importing/draft.py": "files by their own name, NAME.csv",
    "thermoscope/importing/text.py": "endings of files",
    "thermoscope/commands/new.py": "options, NAME=VALUE",
    "thermoscope/folder.py": "effects by their own name, KIND@PLACE",
    "thermoscope/formats.py": "endings of files",
    "thermoscope/hand.py": "contacts, A|B",
    "thermoscope/runs.py": "effects by their own name, KIND@PLACE",
    "thermoscope/workbench/gate.py": "hosts of requests",
}  # fmt: skip


def guesses(tree):
    """Lines that look for a literal in a name: "x" in name, name.startswith("x"), name.split(".")[0] == "x"."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Compare) and isinstance(node.ops[0], ast.In | ast.NotIn):
            if _literal(node.left) and _named(node.comparators[0]):
                yield node.lineno
        elif isinstance(node, ast.Call) and _takes_apart(node):
            yield node.lineno


def _takes_apart(node):
    method = node.func.attr if isinstance(node.func, ast.Attribute) else ""
    return method in WHOLE | PIECES and bool(node.args) and _named(node.func.value)


def _literal(node):
    return isinstance(node, ast.Constant) and isinstance(node.value, str)


NAMES = {"name", "n", "place", "part", "fluid", "boundary", "key", "channel", "node", "link", "face", "word",
         "target", "body", "state", "parameter", "sensor", "column", "which", "kind", "k", "p"}  # fmt: skip


def _named(node):
    """Is it something's name: `name`, `place`, `p.name`, `link.places[0]`, `name.lower()`?"""
    if isinstance(node, ast.Attribute):
        return node.attr in {"name", "place", "places", "part", "fluid", "key"}
    if isinstance(node, ast.Subscript):
        return _named(node.value)
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
        return node.func.attr in {"lower", "upper", "strip"} and _named(node.func.value)
    return isinstance(node, ast.Name) and node.id in NAMES


def files(root):
    return [f for room in ROOMS for f in sorted((root / room).rglob("*.py"))]


def test_no_name_is_taken_apart_but_where_the_tool_made_it(root):
    found = {str(f.relative_to(root)): sorted(set(guesses(ast.parse(f.read_text())))) for f in files(root)}
    assert {f: lines for f, lines in found.items() if lines and f not in ALLOWED} == {}


def test_every_exception_is_needed(root):
    unused = [f for f in ALLOWED if not list(guesses(ast.parse(Path(root, f).read_text())))]
    assert unused == []


@pytest.mark.parametrize(
    "text",
    ['"gap" in p.name', 'name.endswith("flow")', '"shaft" in n.lower()', 'link.places[0].split(".")[0] == "foot"',
     '"oil" not in fluid', 'part.startswith("bearing")'],
)  # fmt: skip
def test_the_check_sees_what_it_is_for(text):
    assert list(guesses(ast.parse(text)))
