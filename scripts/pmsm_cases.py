"""Write the machine files of cases/pmsm-bases and cases/pmsm-machines: the library's, with the cold resistance.

python -m scripts.pmsm_cases
"""

import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
BASES, MACHINES = ROOT / "cases" / "pmsm-bases", ROOT / "cases" / "pmsm-machines"
BETA = 0.3925e-2
PHASES_IN_METER = {"pmsm-m1": 3, "pmsm-m2": 2, "pmsm-m3": 2}  # in series between the ohmmeter's leads
TESTS = {"pmsm-m1": ("wood", "plate", "bench", "bench-2", "bench-3"), "pmsm-m2": ("m2",), "pmsm-m3": ("m3",)}
WORDS = "Written by scripts/pmsm_cases.py: the library's machine with the winding's resistance as measured cold"


def folder_of(machine: str) -> Path:
    return BASES if machine == "pmsm-m1" else MACHINES / machine.removeprefix("pmsm-")


def phase_ohm(machine: str) -> float:
    """Resistance of a phase at 20 degC: mean of the cold readings in the tests' sheets."""
    found = []
    for name in TESTS[machine]:
        sheet = tomllib.loads((folder_of(machine) / "tests" / f"{name}.toml").read_text(encoding="utf-8"))
        cold = sheet["columns"][f"R_{name}"]["cold"]
        found.append(cold["reading"] / (1 + BETA * (cold["at_degC"] - 20.0)))
    return float(sum(found) / len(found) / PHASES_IN_METER[machine])


def text(machine: str) -> str:
    """The machine file of a case."""
    first = machine == "pmsm-m1"
    more = ", and both bases it was tested on" if first else ""
    bases = '\n[bases]\nbench = "own"\nplate = "pmsm-m1-plate"\n' if first else ""
    return f"""# {WORDS}{more}.

[machine]
name = "{machine}"
like = "{machine}"

[losses.copper]
R20_ohm = {phase_ohm(machine):.4g}
{bases}"""


def main() -> None:
    for machine in TESTS:
        (folder_of(machine) / "machine.toml").write_text(text(machine), encoding="utf-8")


if __name__ == "__main__":
    main()
