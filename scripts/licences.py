"""Writes docs/reference/licences.md: every package that an installation brings, by part, with its licence.

python scripts/licences.py
"""

import tomllib
from importlib.metadata import PackageNotFoundError, metadata, requires
from pathlib import Path

from packaging.requirements import Requirement

from scripts.published import table

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "reference" / "licences.md"
PARTS = ("cad", "view", "bench", "oil")
# What a package's own record leaves out, from the licence file that it brings.
UNSAID = {"CoolProp": "MIT"}
SHORT = {  # classifiers and long names -> SPDX
    "MIT License": "MIT",
    "Apache Software License": "Apache-2.0",
    "Apache 2.0": "Apache-2.0",
    "BSD License": "BSD",
    "BSD 3-Clause License": "BSD-3-Clause",
    "new BSD": "BSD-3-Clause",
    "Mozilla Public License 2.0 (MPL 2.0)": "MPL-2.0",
    "Python Software Foundation License": "PSF-2.0",
    "GNU Lesser General Public License v3 (LGPLv3)": "LGPL-3.0",
    "GNU Lesser General Public License v3 or later (LGPLv3+)": "LGPL-3.0-or-later",
    "ISC License (ISCL)": "ISC",
    "GNU Library or Lesser General Public License (LGPL)": "LGPL",
    "The Unlicense (Unlicense)": "Unlicense",
}


def needed(part: str | None) -> list[str]:
    """Packages that a part asks for by itself; None is the core."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    return project["dependencies"] if part is None else project["optional-dependencies"][part]


def closure(lines: list[str]) -> set[str]:
    """All packages that these bring on this computer, themselves too, by the names they call themselves."""
    found: dict[str, str] = {}
    todo = [(Requirement(line), frozenset[str]()) for line in lines]
    while todo:
        asked, extras = todo.pop()
        if asked.marker and not any(asked.marker.evaluate({"extra": e}) for e in extras or {""}):
            continue
        try:
            name = metadata(asked.name)["Name"]
        except PackageNotFoundError:  # of another platform
            continue
        key = f"{name}{sorted(asked.extras)}"
        if key not in found:
            found[key] = name
            todo += [(Requirement(r), frozenset(asked.extras)) for r in requires(name) or []]
    return set(found.values())


def licence(name: str) -> str:
    """As its record says it: the SPDX expression, else the classifiers, else the first line of its licence field."""
    about = metadata(name)
    said = about.get("License-Expression")
    classified = [c.rpartition(" :: ")[2] for c in about.get_all("Classifier") or [] if c.startswith("License ::")]
    named = [SHORT.get(c, c) for c in classified if c != "OSI Approved"]
    field = (about.get("License") or "").strip().partition("\n")[0]
    plain = SHORT.get(field, field) if len(field) < 70 else ""
    return said or UNSAID.get(name) or ", ".join(named) or plain or "see its licence file"


def parts_of() -> dict[str, str]:
    """Package -> the first part that brings it."""
    out: dict[str, str] = {}
    for part in (None, *PARTS):
        for name in sorted(closure(needed(part)), key=str.lower):
            out.setdefault(name, "core" if part is None else f"[{part}]")
    return out


def page() -> str:
    """The page as Markdown."""
    found = parts_of()
    rows = ((name, part, licence(name)) for name, part in found.items())
    count = {part: sum(p == part for p in found.values()) for part in dict.fromkeys(found.values())}
    return "\n".join(
        [
            "# Licences of what comes along",
            "",
            "Written by `scripts/licences.py`. thermoscope itself is under the MIT licence.",
            f"`pip install thermoscope` brings the core, {count['core']} packages; "
            f"{', '.join(f'`[{part}]`' for part in PARTS)} bring the others.",
            "Nothing in the core is under the GPL or the LGPL.",
            "What makes films (`[video]`) has an encoder under the GPL, so it is in no other part.",
            "",
            table(["package", "part", "licence"], rows),
            "",
        ]
    )


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
