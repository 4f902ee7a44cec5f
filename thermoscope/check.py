"""What this computer lacks, each with the command that fixes it."""

import os
import shutil
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from typing import Annotated, Any

import typer

from geom.disk_cache import empty
from geom.storage import cache_folder
from thermoscope.console.options import Json
from thermoscope.console.summary import Summary
from thermoscope.console.terminal import give, progress
from thermoscope.parts import EXTRAS
from viz.pages.html import BROWSERS

VULKAN = "apt-get install -y libvulkan1 mesa-vulkan-drivers"
CHROMIUM = "apt-get install -y chromium"


@dataclass(frozen=True)
class Finding:
    """One thing the tool can use.

    needed_for : what does not work without it;  needed : False where everything else works without it
    fix : the command that installs it, "" when it is there
    """

    name: str
    present: bool
    needed_for: str
    needed: bool
    fix: str = ""

    @property
    def document(self) -> dict[str, Any]:
        return {"found" if key == "present" else key: value for key, value in vars(self).items()}


def findings(browsers: Sequence[str] = BROWSERS) -> list[Finding]:
    """Everything that is looked for, in the order of importance.  browsers : commands, any of which will do"""
    from viz.rendering.gl import COMMAND

    extras = {e: all(find_spec(package) is not None for package in e.packages) for e in EXTRAS.values()}
    rerun = (shutil.which("rerun") or shutil.which("rerun", path=os.path.dirname(sys.executable))) is not None
    browser = any(shutil.which(name) for name in browsers)
    return [
        *(_finding(f"[{e.name}]", present, e.needed_for, False, e.install) for e, present in extras.items()),
        _finding("off-screen OpenGL", _gl(), "pictures (render, report, demo)", True, COMMAND),
        _finding("rerun viewer", rerun, "opening .rrd recordings", False, "uv pip install rerun-sdk"),
        _finding("Vulkan driver", _vulkan(), "screenshots from the rerun viewer without a display", False, VULKAN),
        _finding("Chromium", browser, "screenshots of the HTML report", False, CHROMIUM),
    ]


def _finding(name: str, present: bool, needed_for: str, needed: bool, fix: str) -> Finding:
    return Finding(name, present, needed_for, needed, "" if present else as_root(fix))


def as_root(command: str) -> str:
    """The same command for someone who is not root."""
    return f"sudo {command}" if command.startswith("apt-get") and os.geteuid() != 0 else command


def _gl() -> bool:
    from viz.rendering.gl import off_screen_window

    return off_screen_window() is not None


def _vulkan() -> bool:
    """A loader and at least one driver; asked in a process of its own, since drivers may crash."""
    process = subprocess.run([sys.executable, "-P", "-c", _INSTANCE], capture_output=True, timeout=60, check=False)
    return process.returncode == 0


_INSTANCE = """
import ctypes
vk, instance, count = ctypes.CDLL("libvulkan.so.1"), ctypes.c_void_p(), ctypes.c_uint()
info = (ctypes.c_uint64 * 8)(1)  # VkInstanceCreateInfo: its type is 1, all else zero
assert vk.vkCreateInstance(info, None, ctypes.byref(instance)) == 0
assert vk.vkEnumeratePhysicalDevices(instance, ctypes.byref(count), None) == 0 and count.value
"""


def check(
    clean: Annotated[bool, typer.Option("--clean", help="Empty the cache instead, and say what was freed.")] = False,
    target: Json = None,
) -> int:
    """What this computer lacks (graphics), each with the command that fixes it."""
    if clean:
        return _cleaned(target)
    with progress() as tell:
        tell("looking for graphics")
        parts = findings()
    document = {"ready": all(f.present for f in parts if f.needed), "checks": [f.document for f in parts]}
    give(document, target, lambda: check_summary(parts))
    return 0 if document["ready"] else 1


def _cleaned(target: str | None) -> int:
    """Every command makes again what it needs of these: meshes, solids, shapes, comparisons, how long stages took."""
    folder = cache_folder()
    files, size = empty(folder)
    document = {"cleaned": {"folder": folder, "files": files, "bytes": size}}
    give(document, target, lambda: Summary(f"Freed {size / 1e6:.1f} MB: {files} files in {folder}."))
    return 0


def check_summary(parts: list[Finding]) -> Summary:
    """What is missing, and the command that fixes it."""
    missing = [f.name for f in parts if f.needed and not f.present]
    lines = [_line(f) for f in parts]
    sentence = f"This computer lacks {', '.join(missing)}." if missing else "This computer has all that is needed."
    return Summary(sentence, lines)


def _line(f: Finding) -> str:
    state = "there" if f.present else "MISSING" if f.needed else "not there (optional)"
    return f"{f.name}: {state}; for {f.needed_for}" + (f". Install it with: {f.fix}" if f.fix else "")
