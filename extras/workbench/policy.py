"""Content security policy: what the pages may load and run, and nothing from anywhere else."""

from __future__ import annotations

import base64
import hashlib
import re
from functools import cache
from pathlib import Path

INLINE = re.compile(rb"<script>(.*?)</script>", re.S)


def _named(script: bytes) -> str:
    """A script as a policy names it."""
    return f"'sha256-{base64.b64encode(hashlib.sha256(script).digest()).decode()}'"


@cache
def hashes(page: Path) -> str:
    """The scripts inside a page."""
    return " ".join(_named(script) for script in INLINE.findall(page.read_bytes()))


@cache
def _page_policy(*further: str) -> str:
    """Of a page that runs no script but the viewer's."""
    from thermoscope.plugin import script

    first = ["default-src 'none'", f"script-src {_named(script().encode())}", "style-src 'unsafe-inline'"]
    return "; ".join([*first, "base-uri 'none'", "form-action 'none'", *further])


def report_policy() -> str:
    """Of the report, which runs the viewer in a frame of its own."""
    return _page_policy("img-src 'self' data:", "font-src data:", "frame-ancestors 'none'")


def viewer_policy() -> str:
    """Of the viewer, inside a page of ours."""
    return _page_policy("frame-ancestors 'self'")


def policy(page: Path, host: str) -> str:
    """Of a page of trame: its own scripts and socket. 'unsafe-eval': Vue compiles its templates in the browser."""
    return "; ".join(
        [
            "default-src 'none'",
            f"script-src 'self' 'unsafe-eval' {hashes(page)}",
            "style-src 'self' 'unsafe-inline'",
            "img-src 'self' data: blob:",
            "font-src 'self' data:",
            f"connect-src 'self' blob: ws://{host} wss://{host}",
            "worker-src 'self' blob:",
            "manifest-src 'self'",
            "base-uri 'self'",
            "form-action 'none'",
            "object-src 'none'",
            "frame-src 'self'",
            "frame-ancestors 'none'",
        ]
    )
