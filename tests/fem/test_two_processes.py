"""Solutions in two processes are those of one, to the bit, and come whatever becomes of the second."""

import os
import signal

import numpy as np
import pytest

from fem.solvers import two_processes
from fem.solvers.solve import Solver
from fem.solvers.two_processes import in_two_processes
from geom import build_mesh, load_machine
from lumped.build.pipeline import coefficients_on, field_of

MANY = two_processes.LEAST
forks = pytest.mark.skipif(not two_processes._room(0), reason="one core, or no fork")


@forks
def test_a_field_is_the_same_to_the_bit():
    machine = load_machine("pmsm-m1-no-base")
    mesh = build_mesh(machine, 0.2, 24, 0.25, 0.24)
    field = field_of(machine, mesh)
    films, contacts = coefficients_on(machine, mesh)
    solver, load = Solver(field), np.column_stack([field.load("winding"), field.load("magnets")])
    assert field.n > 1000

    def solved(factor):
        return solver.factor(field.stiffness(films, {name: factor * g for name, g in contacts.items()}))(load)

    factors = [0.2, 1.0, 2.2, 5.0, 7.0]
    for one, two in zip(map(solved, factors), in_two_processes(solved, factors, MANY), strict=True):
        assert np.array_equal(one, two)


@forks
def test_both_processes_take_a_share():
    def slowly(k):
        sum(range(200_000))
        return k, os.getpid()

    found = in_two_processes(slowly, range(100, 140), MANY)
    assert [k for k, _ in found] == list(range(100, 140))
    assert len({pid for _, pid in found}) == 2


@forks
def test_what_a_killed_process_had_taken_is_done_by_the_other():
    parent = os.getpid()

    def killed(k):
        if os.getpid() != parent:
            os.kill(os.getpid(), signal.SIGKILL)
        return k * k

    assert in_two_processes(killed, range(50), MANY) == [k * k for k in range(50)]


@pytest.mark.parametrize("why", ["memory", "core", "small"])
def test_one_process_where_two_are_no_use(monkeypatch, why):
    if why == "memory":
        monkeypatch.setattr(two_processes, "BYTES", 10**12)
    if why == "core":
        monkeypatch.setattr(two_processes.os, "sched_getaffinity", lambda pid: {0}, raising=False)
    monkeypatch.setattr(two_processes.os, "fork", lambda: pytest.fail("forked"), raising=False)
    assert in_two_processes(lambda k: k + 1, range(5), MANY if why != "small" else MANY - 1) == [1, 2, 3, 4, 5]
