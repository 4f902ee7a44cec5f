"""Runs the commands of a page and writes under each what it printed: python scripts/tutorial.py [PAGE] [--keep DIR]

Commands stand in ```sh blocks; what they print follows in a ```text block. Those that wait for a browser are not run.
"""

import argparse
import os
import re
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "tutorial.md"
BLOCK = re.compile(r"```sh\n(.*?)```\n(?:\n```text\n.*?```\n)?", re.DOTALL)
TOOK = re.compile(r"(<!-- took:begin -->\n).*?(<!-- took:end -->)", re.DOTALL)
FEW = 12  # lines of an output on any other page: enough to know it by
WAITING = ("thermoscope show serve",)


def commands(page: str) -> list[str]:
    """The commands of the page, one a line, without remarks."""
    return [line for block in BLOCK.findall(page) for line in _lines(block)]


def _lines(block: str) -> list[str]:
    return [line.partition("  #")[0].strip() for line in block.splitlines() if line.strip()]


def with_outputs(page: str, printed: dict[str, list[str]], most: int = 10**6) -> str:
    """The page with what the commands printed.  printed : command -> an output for every time it stands there

    most : lines of a block, the others are left out
    """

    def block(match: re.Match[str]) -> str:
        out = "\n".join(text for line in _lines(match[1]) if line in printed and (text := printed[line].pop(0)))
        lines = out.splitlines()
        out = "\n".join([*lines[:most], *(["..."] if len(lines) > most else [])])
        return f"```sh\n{match[1]}```\n" + (f"\n```text\n{out}\n```\n" if out else "")

    return BLOCK.sub(block, page)


def run(lines: list[str], folder: Path) -> dict[str, list[str]]:
    """Every command in the folder, at 80 columns, as a reader would; stdout without trailing blanks."""
    (folder / "cases").symlink_to(ROOT / "cases")
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    variables = {**os.environ, "PATH": path, "COLUMNS": "80"}
    printed: dict[str, list[str]] = {}
    for line in lines:
        if line.startswith(WAITING):
            continue
        begun = time.monotonic()
        done = subprocess.run(line, shell=True, cwd=folder, env=variables, text=True, stdout=subprocess.PIPE)
        print(f"{time.monotonic() - begun:6.0f} s  exit {done.returncode}  {line}", file=sys.stderr)
        if done.returncode > 1:
            raise SystemExit(f"{line} ended with {done.returncode}")
        printed.setdefault(line, []).append(done.stdout.rstrip())
    return printed


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("page", type=Path, nargs="?", default=PAGE, help="else the tutorial, its outputs whole")
    parser.add_argument("--keep", type=Path, help="folder to run in; else one that is thrown away")
    chosen = parser.parse_args()
    folder, file = chosen.keep or Path(tempfile.mkdtemp()), chosen.page.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    page = file.read_text(encoding="utf-8")
    page = with_outputs(page, run(commands(page), folder), 10**6 if file == PAGE else FEW)
    used = resource.getrusage(resource.RUSAGE_CHILDREN)  # other programs may run beside
    minutes = (used.ru_utime + used.ru_stime) / 60
    words = f"All commands of this page together need {minutes:.0f} min of one core ({time.strftime('%Y-%m-%d')}).\n"
    file.write_text(TOOK.sub(lambda m: m[1] + words + m[2], page), encoding="utf-8")


if __name__ == "__main__":
    main()
