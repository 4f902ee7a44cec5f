"""Write the networks of cases/pmsm-bases and cases/pmsm-machines from the machines' descriptions and the cold readings.

python scripts/pmsm_cases.py
"""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import tomlkit

from geom import load_machine
from validation.procedure.pm_network import Base, PmSettings, pm_document

ROOT = Path(__file__).resolve().parents[1]
BASES, MACHINES = ROOT / "cases" / "pmsm-bases", ROOT / "cases" / "pmsm-machines"
MAGNETIC_W = {"m2": 77.0, "m3": 76.0}  # table II of the paper
BETA = 0.3925e-2
WORDS = "Written by scripts/pmsm_cases.py from the machine's description; see validation/procedure/pm_network.py."


def cold_ohm(folder: Path, name: str) -> float:
    """Resistance at 20 degC from the cold reading in a test's sheet."""
    cold = tomllib.loads((folder / f"{name}.toml").read_text(encoding="utf-8"))["columns"][f"R_{name}"]["cold"]
    return float(cold["reading"] / (1 + BETA * (cold["at_degC"] - 20.0)))


def documents() -> dict[Path, dict[str, Any]]:
    """File -> the network's tables."""
    bench, plate = load_machine("pmsm-m1"), load_machine("pmsm-m1-plate")
    names = ("wood", "plate", "bench", "bench-2", "bench-3")
    R1 = sum(cold_ohm(BASES / "tests", n) for n in names) / len(names)
    bases = (Base("plate", plate, 0.03, "on_plate"), Base("bench", bench, 0.10, "on_bench"))
    out = {BASES / "network.toml": pm_document(bench, PmSettings(resistance_ohm=R1), bases=bases)}
    for name, magnetic in MAGNETIC_W.items():
        machine, folder = load_machine(f"pmsm-{name}"), MACHINES / name
        R = cold_ohm(folder / "tests", name)
        settings = PmSettings(resistance_ohm=R, phases=1.5, magnetic_W=magnetic)
        own = (Base("bench", machine, 0.10, "on_bench"),)
        out[folder / "network.toml"] = pm_document(machine, settings, bases=own)
    return out


def text(document: dict[str, Any]) -> str:
    """TOML with numbers to six digits."""
    return f"# {WORDS}\n" + tomlkit.dumps(rounded(document))


def rounded(value: Any) -> Any:
    if isinstance(value, dict):
        return {k: rounded(v) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [rounded(v) for v in value]
    return float(f"{value:.6g}") if isinstance(value, float) else value


def close(a: Any, b: Any) -> bool:
    """Equal but for a thousandth in numbers."""
    if isinstance(a, dict) and isinstance(b, dict):
        return a.keys() == b.keys() and all(close(a[k], b[k]) for k in a)
    if isinstance(a, list) and isinstance(b, list):
        return len(a) == len(b) and all(close(x, y) for x, y in zip(a, b))
    if isinstance(a, float | int) and isinstance(b, float | int):
        return abs(a - b) <= 1e-3 * abs(a)
    return bool(a == b)


def main() -> None:
    for path, document in documents().items():
        path.write_text(text(document), encoding="utf-8")


if __name__ == "__main__":
    main()
