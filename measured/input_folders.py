"""Where a case keeps its inputs."""

from pathlib import Path

CASE = "case.toml"
INPUTS = ("tests", "cycles")  # folders of a case


def within_inputs(path: Path) -> bool:
    """Does a path lie where a case keeps its inputs?"""
    whole = path.absolute()
    return any(p.name in INPUTS and (p.parent / CASE).exists() for p in (whole, *whole.parents))
