"""Documents that are right, as dictionaries, and the ways to every number in them."""

import copy
import re
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
Way = tuple[str | int, ...]


def shipped(name: str) -> dict[str, Any]:
    return tomllib.loads((ROOT / name).read_text(encoding="utf-8"))


def documented() -> dict[str, Any]:
    """The network of the page on network.toml."""
    text = (ROOT / "docs/network-toml.md").read_text(encoding="utf-8")
    return tomllib.loads(re.search(r"```toml\n(.*?)```", text, re.S).group(1))


def numbers(document: Any, way: Way = ()) -> Iterator[Way]:
    """Where numbers stand."""
    items = document.items() if isinstance(document, dict) else enumerate(document)
    for key, value in items:
        if isinstance(value, dict | list):
            yield from numbers(value, (*way, key))
        elif isinstance(value, int | float) and not isinstance(value, bool):
            yield (*way, key)


def put(document: dict[str, Any], way: Way, value: Any) -> dict[str, Any]:
    """A copy with another value there."""
    out = copy.deepcopy(document)
    place: Any = out
    for key in way[:-1]:
        place = place[key]
    place[way[-1]] = value
    return out


def key_of(way: Way) -> str:
    """The last name on the way."""
    return str([key for key in way if isinstance(key, str)][-1])
