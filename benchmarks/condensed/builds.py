"""What `model build` needs, and what its mesh leaves: each machine in a process of its own, with nothing kept before.

    python benchmarks/condensed/builds.py [MACHINE ...] [--json FILE [--page]]

CPU time and memory are those of all its processes together; what they share counts once.
"""

import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from scripts.published import machine_arguments, publish, table, write_json

PAGE = Path("docs/condensation.md")
HEAD = ("machine", "unknowns", "mesh leaves (%)", "at", "states", "CPU (s)", "wall (s)", "memory (GB)", "exit code")
EVERY_S = 1.0  # a look at the memory: factors, which need most, stand for seconds


def row(machine: str) -> dict[str, Any]:
    """One build at the default accuracy."""
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "thermoscope", "model", "build", machine, "--out", folder]
        begun = time.monotonic()
        process = subprocess.Popen(command, env={**os.environ, "THERMOSCOPE_CACHE": f"{folder}/cache"})
        ended, most, status, used = 0, 0, 0, resource.getrusage(resource.RUSAGE_SELF)
        while not ended:
            most = max(most, memory(process.pid))
            time.sleep(EVERY_S)
            ended, status, used = os.wait4(process.pid, os.WNOHANG)
        process.returncode = os.waitstatus_to_exitcode(status)
        sizes = json.loads((Path(folder) / "crosscheck.json").read_text(encoding="utf-8"))["sizes"]
        stages = json.loads((Path(folder) / "cache" / "stages.json").read_text(encoding="utf-8"))["model build 0"]
    return {
        "machine": machine,
        "exit": process.returncode,
        "cpu_s": round(used.ru_utime + used.ru_stime, 1),
        "wall_s": round(time.monotonic() - begun, 1),
        "memory_GB": round(most / 1e9, 2),
        "states": sizes["states"],
        "stages": stages,
        **{key: sizes["mesh"][key] for key in ("unknowns", "worst", "worst_part")},
    }


def memory(pid: int) -> int:
    """Bytes of a process and its children; what several of them share is split between them."""
    try:
        children = Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
        rollup = Path(f"/proc/{pid}/smaps_rollup").read_text()
    except OSError:  # it has just ended
        return 0
    mine = sum(1024 * int(line.split()[1]) for line in rollup.splitlines() if line.startswith("Pss:"))
    return mine + sum(memory(int(child)) for child in children)


def builds_table(found: Sequence[Mapping[str, Any]]) -> str:
    rows = []
    for r in sorted(found, key=lambda r: r["machine"]):
        of_mesh = (f"{r['unknowns']:,}", f"{r['worst']:.1f}", r["worst_part"], f"{r['states']:,}")
        cost = (f"{r['cpu_s']:.0f}", f"{r['wall_s']:.0f}", f"{r['memory_GB']:.1f}", r["exit"])
        rows.append([r["machine"], *of_mesh, *cost])
    return table(HEAD, rows)


def main() -> None:
    given = machine_arguments(__doc__)
    found = json.loads(given.json.read_text()) if given.json and given.json.exists() else []
    for machine in given.machines:
        found = [*(r for r in found if r["machine"] != machine), row(machine)]
        print(found[-1], flush=True)
        write_json(given.json, found)
    if given.page:
        publish(PAGE, "builds", builds_table(found))


if __name__ == "__main__":
    main()
