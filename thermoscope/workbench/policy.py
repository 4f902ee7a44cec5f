"""Content security policy: what the pages may load and run, and nothing from anywhere else."""

from __future__ import annotations

import base64
import hashlib
import re
from functools import cache
from pathlib import Path

INLINE = re.compile(rb"<script>(.*?)</script>", re.S)
REPORT = "; ".join([
    "default-src 'none'", "style-src 'unsafe-inline'", "img-src 'self' data:", "font-src data:", "base-uri 'none'",
    "form-action 'none'", "frame-ancestors 'none'",
])  # fmt: skip


@cache
def hashes(page: Path) -> str:
    """The scripts inside a page, as a policy names them."""
    found = INLINE.findall(page.read_bytes())
    return " ".join(f"'sha256-{base64.b64encode(hashlib.sha256(script).digest()).decode()}'" for script in found)


def policy(page: Path, host: str) -> str:
    """Of a page of trame: its own scripts and socket. 'unsafe-eval': Vue compiles its templates in the browser."""
    return "; ".join([
        "default-src 'none'", f"script-src 'self' 'unsafe-eval' {hashes(page)}", "style-src 'self' 'unsafe-inline'",
        "img-src 'self' data: blob:", "font-src 'self' data:", f"connect-src 'self' blob: ws://{host} wss://{host}",
        "worker-src 'self' blob:", "manifest-src 'self'", "base-uri 'self'", "form-action 'none'", "object-src 'none'",
        "frame-ancestors 'none'",
    ])  # fmt: skip
