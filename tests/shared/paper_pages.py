"""A page of docs/papers against what its script writes now, whole or section by section."""

import re
from types import SimpleNamespace

import numpy as np

from scripts.papers.__main__ import HERE, PAGES

NUMBER = re.compile(r"[-+]?\d+\.?\d*(?:e[-+]?\d+)?")


def page(name: str) -> str:
    return (HERE / name).read_text(encoding="utf-8")


def as_written(name: str, title: str) -> SimpleNamespace:
    """A section that is as it stands on the page."""
    found = re.search(rf"^## {re.escape(title)}$.*?(?=\s+^## |\s*\Z)", page(name), re.MULTILINE | re.DOTALL)
    assert found, title
    return SimpleNamespace(text=lambda: found[0])


def differences(name: str) -> list[str]:
    """Of a whole page."""
    return different(page(name), PAGES[name].text())


def different(written: str, now: str) -> list[str]:
    """Words that differ, and numbers by more than half a percent or 0.2: processors differ in a fit's last digits."""
    if NUMBER.sub("#", written) != NUMBER.sub("#", now):
        lines = zip(written.splitlines(), now.splitlines(), strict=False)
        return [f"{a} | {b}" for a, b in lines if NUMBER.sub("#", a) != NUMBER.sub("#", b)] or ["another length"]
    pairs = [(float(a), float(b)) for a, b in zip(NUMBER.findall(written), NUMBER.findall(now), strict=True)]
    return [f"{a} | {b}" for a, b in pairs if not np.abs(a - b) <= 0.2 + 5e-3 * np.abs(b)]
