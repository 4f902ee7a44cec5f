"""A page of docs/papers against what its script writes now."""

import re

import numpy as np

from scripts.papers.__main__ import HERE, PAGES

NUMBER = re.compile(r"[-+]?\d+\.?\d*(?:e[-+]?\d+)?")


def differences(name: str) -> list[str]:
    """Words that differ, and numbers by more than half a percent or 0.2: processors differ in a fit's last digits."""
    written, now = (HERE / name).read_text(encoding="utf-8"), PAGES[name].text()
    if NUMBER.sub("#", written) != NUMBER.sub("#", now):
        lines = zip(written.splitlines(), now.splitlines(), strict=False)
        return [f"{a} | {b}" for a, b in lines if NUMBER.sub("#", a) != NUMBER.sub("#", b)] or ["another length"]
    pairs = [(float(a), float(b)) for a, b in zip(NUMBER.findall(written), NUMBER.findall(now), strict=True)]
    return [f"{a} | {b}" for a, b in pairs if not np.abs(a - b) <= 0.2 + 5e-3 * np.abs(b)]
