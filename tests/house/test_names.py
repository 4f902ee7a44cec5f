"""No code decides what something is by a piece of its name: roles and quantities say it."""

import ast

import pytest

WHOLE = {"startswith", "endswith"}
PIECES = {"split", "partition", "rpartition", "rsplit"}
ALLOWED = {  # file -> what its strings are, none of them a user's name for a part, an input or a test
    "geom/description/parameters.py": "keys of geometry, GROUP.NAME",
    "geom/families/fit.py": "keys of geometry, GROUP.NAME",
    "geom/drawings/gallery.py": "a choice of the family",
    "geom/description/reading.py": "keys of geometry, NAME_mm and NAME_ratio",
    "lumped/schemas/schema.py": "keywords of JSON Schema",
    "lumped/schemas/bounds.py": "keys of files by their unit, NAME_mm",
    "measured/recordings/consistency.py": "names of inputs by the unit in them, NAME_W: for a warning only",
    "measured/recordings/units.py": "names of inputs by the unit that they say they hold, NAME_percent",
    "thermoscope/case_folder/doctor.py": "shapes that the network names itself, PART#1",
    "measured/recordings/csv_file.py": "endings of files",
    "thermoscope/cli.py": "options on the command line",
    "thermoscope/console/progress_bar.py": "options on the command line",
    "extras/workbench/dropped.py": "columns that the page names itself, FILE:COLUMN",
    "thermoscope/commands/open_case.py": "hidden files",
    "thermoscope/rooms.py": "names of modules",
    "geom/table.py": "columns as a table declares them, NAME=KEY",
    "geom/solids/step_prisms.py": "labels of a STEP assembly",
    "validation/effects/time_window.py": "events that the tool names itself, TEST:BEGIN-END",
    "fem/solvers/streams.py": "cells that fem.solvers.streams names itself, FLUID@3",
    "lumped/machine/path.py": "cells that fem.solvers.streams names itself, FLUID@3",
    "lumped/machine/shapes.py": "a choice of the family",
    "lumped/machine/bases.py": "faces and shapes that the network names itself",
    "lumped/machine/parameters.py": "streams that air.py and jackets.py name themselves",
    "lumped/condensation/basis_cache.py": "keys of a file of shapes",
    "lumped/schemas/reader.py": "a heading in brackets, a hint at a key",
    "lumped/declarations/network.py": "targets of parameters, link:NAME",
    "lumped/declarations/parameters.py": "targets of parameters, link:NAME",
    "measured/sensors/operators.py": "targets of parameters, gain:CHANNEL",
    "validation/comparison/predict.py": "targets of parameters, gain:CHANNEL",
    "validation/calibration/staged_fit.py": "parameters that forms and shares name themselves, NAME^INPUT",
    "validation/revision/revise.py": "parameters that forms and shares name themselves, NAME^INPUT",
    "validation/effects/registry.py": "modules, and KIND@PLACE",
    "validation/effects/films/inner_air.py": "places of this effect, A|B",
    "validation/effects/build.py": "links and losses by their own name, contact:A|B",
    "validation/effects/streams/flow.py": "links by their own name, stream:NAME; places FLOW:TEST:50",
    "validation/effects/losses/copper_feedback.py": "sources by their own name, loss:NAME",
    "extras/rating/loss_grid.py": "columns of a loss map, NAME_W; sources by their own name, loss:NAME",
    "extras/bench/commands/law.py": "COLUMN=UNIT of an option",
    "extras/bench/reduction/pm_network.py": "nodes that this file names itself",
    "extras/bench/reduction/two_paths.py": "parameters of losses, as the networks of machines name them",
    "viz/figures/flows.py": "streams that a machine's network names itself, fan:CELL",
    "geom/description/bases.py": "contacts, A|B",
    "geom/meshing/meshio_io.py": "keys of a file of meshes",
    "lumped/machine/part_identities.py": "contacts, A|B",
    "validation/inference/columns.py": "places of an effect, A|B",
    "viz/pages/report.py": "effects by their own name, KIND@PLACE",
    "thermoscope/commands/model/crosscheck.py": "shapes that the network names itself, PART#1",
    "thermoscope/commands/model/revise.py": "effects by their own name, KIND@PLACE",
    "thermoscope/commands/use/simulate.py": "inputs that lumped.drives.coupled names itself",
    "lumped/build/crosscheck.py": "links by their own name, contact:A|B",
    "measured/importing/target.py": "inputs by the unit that their name says, NAME_W: a guess that is shown",
    "measured/importing/draft.py": "files by their own name, NAME.csv",
    "thermoscope/commands/test/new.py": "options, NAME=VALUE",
    "thermoscope/case_folder/history.py": "effects by their own name, KIND@PLACE",
    "extras/export/model.py": "inputs that mark a test, by RUNNING",
    "validation/parameters/unknowns.py": "nuisances that it names itself, KIND of NAME",
    "measured/recordings/formats.py": "endings of files",
    "lumped/build/analytical_checks.py": "contacts, A|B",
    "thermoscope/case_folder/cycle.py": "sources by their own name, loss:NAME",
    "thermoscope/case_folder/runs.py": "effects by their own name, KIND@PLACE",
    "extras/rating/design/machine_keys.py": "keys of a machine file, geometry.GROUP.NAME",
    "extras/workbench/access_control.py": "hosts of requests",
    "geom/importing/motor_cad.py": "keys and words of a .mot file",
    "thermoscope/commands/model/import_losses.py": "loss zones of a machine file, PART.ZONE",
    "geom/importing/pyleecan.py": "classes of pyleecan's files",
}


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


NAMES = """
name n place part fluid boundary key channel node link face word target body state parameter sensor column which
kind k p
"""


def _named(node):
    """Is it something's name: `name`, `place`, `p.name`, `link.places[0]`, `name.lower()`?"""
    if isinstance(node, ast.Attribute):
        return node.attr in {"name", "place", "places", "part", "fluid", "key"}
    if isinstance(node, ast.Subscript):
        return _named(node.value)
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
        return node.func.attr in {"lower", "upper", "strip"} and _named(node.func.value)
    return isinstance(node, ast.Name) and node.id in NAMES.split()


@pytest.fixture(scope="module")
def lines(root, trees):
    """File -> its lines that look for a literal in a name."""
    return {str(f.relative_to(root)): sorted(set(guesses(tree))) for f, tree in trees.items()}


def test_no_name_is_taken_apart_but_where_the_tool_made_it(lines):
    assert {f: at for f, at in lines.items() if at and f not in ALLOWED} == {}


def test_every_exception_is_needed(lines):
    assert [f for f in ALLOWED if not lines[f]] == []


FAMILY = """
series-dc pmsm tefc poles airgap yoke rotor.core rotor.cage stator.core air.left air.right air.interpolar air.ducts
air.fan winding.field winding.armature slot.liner field.insulation
"""
PUBLISHED = {  # a thermal test of one kind of machine, by its parts' names
    "extras/bench/factors/screening.py",
    "extras/bench/reduction/pm_network.py",
    "validation/bases/base_heat.py",
}


def words_of_families(tree):
    return {n.value for n in ast.walk(tree) if isinstance(n, ast.Constant) and n.value in FAMILY.split()}


def test_what_a_family_calls_its_parts_stays_in_its_room(root, trees):
    """The other rooms read roles and `Machine.features`."""
    others = [f for f in trees if f.relative_to(root).parts[0] != "geom"]
    named = {str(f.relative_to(root)): words_of_families(trees[f]) for f in others}
    assert {f: names for f, names in named.items() if names and f not in PUBLISHED} == {}
    assert all(named[f] for f in PUBLISHED)


@pytest.mark.parametrize(
    "text",
    [
        '"gap" in p.name',
        'name.endswith("flow")',
        '"shaft" in n.lower()',
        'link.places[0].split(".")[0] == "foot"',
        '"oil" not in fluid',
        'part.startswith("bearing")',
    ],
)
def test_the_check_sees_what_it_is_for(text):
    assert list(guesses(ast.parse(text)))
