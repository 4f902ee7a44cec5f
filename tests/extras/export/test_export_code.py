"""The exported C runs as `simulate` does on stiff random networks, and compiles everywhere."""

import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from random_networks import built, machine

from extras.export.c_code import c_files
from extras.export.commands.export import export
from extras.export.compilers import AGREES_K, Compiled, difference
from extras.export.model import Output, packed
from lumped.correlations.ducts import duct_film
from lumped.correlations.streams import streamed
from lumped.integration.simulate import Record, simulate
from lumped.model.build import bare_network, node_link, node_source
from lumped.model.network import Row
from lumped.transfer.coolant import glycol
from lumped.transfer.laws import FILMS, FilmTable, Fixed, Linear, Table
from measured.case import Reference
from validation.parameters.reference import reference_of

CASES = Path(__file__).parents[3] / "cases"


def states(network):
    return [Output(n, Row(np.array([i]), np.ones(1))) for i, n in enumerate(network.states)]


@pytest.mark.parametrize("seed", range(1000, 1005))
def test_stiff_random_networks_agree(seed):
    """Capacities over six decades and none, cells of 0.1 J/K, flows that turn round, radiation and free convection.

    Both integrators allow 0.01 K and 1e-4 of the range a step: they may differ by a few of these.
    """
    network, given = built(machine(seed, 25))
    model = packed(network, {}, reference_of(network, [Recorded(given)]), states(network))
    reach = np.ptp(simulate(network, given, rows=[o.row for o in model.outputs]).y)
    assert difference(Compiled(model), network, given, {}) < AGREES_K + 5e-4 * reach


class Recorded:
    """A test, as far as ranges of inputs go."""

    def __init__(self, given):
        self.name, self.inputs, self.boundaries, self.initial = "recorded", given.inputs, given.boundaries, 20.0


def curved():
    """A node that every temperature law heats or cools, and one of a millionth of its capacity."""
    knots = (0.0, 1.0, 10.0, 100.0)
    films = tuple((np.array([1.0, 2.0, 4.0, 6.0]) * (1.0 + 0.05 * np.arange(FILMS)[:, None])).ravel().tolist())
    net = bare_network("curved", {"body": 500.0, "chip": 5e-4}, ("air",))
    links = [
        node_link(net, "t", "film", "body", "air", Fixed(0.2, Table(knots, (1.0, 2.0, 4.0, 6.0)))),
        node_link(net, "f", "film", "body", "air", Fixed(0.1, FilmTable(knots, films))),
        node_link(net, "g", "link", "chip", "body", Fixed(3.0)),
    ]
    heat = [node_source(net, "h", "copper", {"chip": 1.0}, Fixed(40.0, Linear(0.004, 20.0)))]
    time = np.array([0.0, 60.0, 60.0, 600.0, 3600.0])
    return net.extended(links, heat), Record(time, {}, {"air": np.array([20.0, 20.0, 5.0, 5.0, 45.0])}, 20.0)


@pytest.mark.parametrize("kind", ["plain", "onto the outlet of a cell", "beside still air"])
def test_films_by_reynolds_number(kind):
    """A flow that starts and stops through all regimes, over fluids of -30 to 90 degC."""
    net, given = curved()
    film, thin = (lambda v, fluid: duct_film(v, 0.01, 1.0, fluid)), 3e-4 if "cell" in kind else 0.0
    law = streamed("flow", 0.5, film, glycol("ethylene", 50), 40.0, True, 1e-4, thin)
    if "still" in kind:
        law = replace(law, table=replace(law.table, still=net.links[1].law.temperature, exponent=4.0))
    link = node_link(net, "s", "film", "body", "air", law)
    to_air = Row(np.array([2]), np.array([1.0]))  # a liquid's own temperature, where nothing is mixed
    if "still" not in kind:
        link = replace(link, hot=to_air, cold=Row(to_air.index[:0], np.empty(0)))
    network = net.extended([link], [])
    time = np.linspace(0.0, 3600.0, 61)
    air = 30.0 + 60.0 * np.sin(time / 700.0)
    given = Record(time, {"flow": 0.5 + 0.6 * np.cos(time / 300.0)}, {"air": air}, 20.0)
    reference = reference_of(network, [Recorded(given)])
    assert difference(Compiled(packed(network, {}, reference, states(network))), network, given, {}) < AGREES_K


def test_a_table_that_begins_below_zero_minds_the_sign():
    """A node colder than the air, then warmer."""
    net, given = curved()
    signed = Fixed(0.4, Table((-40.0, -10.0, 0.0, 40.0), (5.0, 3.0, 1.0, 0.2)))
    network = net.extended([node_link(net, "s", "film", "body", "air", signed)], [])
    given = Record(given.time, {}, {"air": np.array([60.0, 60.0, 5.0, 5.0, 25.0])}, 20.0)
    assert difference(Compiled(packed(network, {}, Reference(), states(network))), network, given, {}) < 0.02


@pytest.mark.parametrize(("flags", "within"), [((), 0.02), (("-DTHERMAL_REAL=float",), 0.05)], ids=["double", "float"])
def test_temperature_laws_jumps_and_single_precision(flags, within):
    network, given = curved()
    assert difference(Compiled(packed(network, {}, Reference(), states(network)), flags), network, given, {}) < within


@pytest.fixture
def written(tmp_path):
    """A folder with the code of the curved network."""
    network, _ = curved()
    for name, text in c_files(packed(network, {}, Reference(), states(network))).items():
        (tmp_path / name).write_text(text)
    return tmp_path


def test_the_code_is_clean_c99_without_allocation(written):
    warned = ["-std=c99", "-Wall", "-Wextra", "-pedantic", "-Werror", "-O2", "-c", "thermal_network.c"]
    done = subprocess.run(["gcc", *warned], cwd=written, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    used = subprocess.run(["nm", "-u", "thermal_network.o"], cwd=written, capture_output=True, text=True).stdout
    assert not {"malloc", "calloc", "realloc", "free"} & set(used.split())


@pytest.mark.parametrize(
    ("target", "magic"),
    [("x86_64-windows-gnu", b"\x64\x86"), ("aarch64-macos", b"\xcf\xfa\xed\xfe"), ("x86_64-linux-gnu", b"\x7fELF")],
)
def test_zig_compiles_it_for_other_platforms(written, target, magic):
    """Objects only: linking would first build each platform's C library, which takes minutes once."""
    pytest.importorskip("ziglang")
    zig = [sys.executable, "-m", "ziglang", "cc", "-target", target, "-std=c99", "-c", "thermal_network.c", "-o", "o"]
    done = subprocess.run(zig, cwd=written, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert (written / "o").read_bytes().startswith(magic)


def test_the_header_says_what_a_user_must_know(tmp_path):
    assert export(str(CASES / "hust-ipmsm"), tmp_path, "c", ["winding=155"], json=str(tmp_path / "said.json")) == 0
    text = (tmp_path / "thermal_network_sizes.h").read_text()
    for said in (
        "revision 0",
        "speed_rpm (rpm), 0 to",
        "coolant (degC)",
        "winding, limit 155 degC",
        "State: 88 bytes",
        "sensor rotor, against measurements 6.16 K rms (hold-out tests)",
    ):
        assert said in text
