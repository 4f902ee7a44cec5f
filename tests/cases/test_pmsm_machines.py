"""Two machines that nobody calibrated, predicted by M1's model; test_pmsm has M1 itself.

A file of its own: another process meshes them while that one calibrates.
"""

import pytest
from paper_pages import as_written, different

from extras.bench.reduction.two_paths import end_errors
from scripts.papers import machines
from scripts.pmsm_cases import TESTS, folder_of, text
from thermoscope.case_folder.folder import load_case

pytestmark = pytest.mark.nightly


@pytest.mark.parametrize("machine", list(TESTS))
def test_machine_files_are_the_library_s(machine):
    """One description with only the constructive differences: the library's file with the cold resistance."""
    assert (folder_of(machine) / "machine.toml").read_text(encoding="utf-8") == text(machine)


@pytest.mark.parametrize("name", ["m2", "m3"])
def test_machines_that_were_not_used_are_predicted(name):
    """Every difference within the measurement's worst case with M1's values, and closer than without them.

    Of four, one may lie outside the 95 %: that of m3's winding is just there.
    """
    plain = end_errors(load_case(machines.CASES / "pmsm-machines" / name).case)
    found = machines.others()[name]
    assert "h.stator.core" in found.parameters
    assert not any(name.startswith("loss.") for name in found.parameters)
    assert found.agrees
    assert sum(abs(r.difference_K) > r.U95_K for r in found.rows) <= 1, [r.document() for r in found.rows]
    assert sum(abs(r.difference_K) for r in found.rows) < sum(abs(r.difference_K) for r in plain)


@pytest.mark.parametrize("section", [machines.circuits, machines.machines, machines.constructive])
def test_sections_of_the_paper_are_current(section):
    now = section()
    assert different(as_written("thermal-test-procedure.md", now.title).text(), now.text()) == []
