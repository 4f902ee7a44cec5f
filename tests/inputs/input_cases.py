"""The small case and ways to change its files; documents that are right, and the ways to every number in them."""

import copy
import re
import shutil
import tempfile
import tomllib
from collections.abc import Callable, Iterator
from functools import cache, partial
from pathlib import Path
from typing import Any

import pandas as pd
from small_case import small_case


@cache
def original() -> Path:
    return small_case(Path(tempfile.mkdtemp(prefix="thermoscope-")))


def case_of(folder: Path) -> Path:
    """A copy of the small case in a folder."""
    return Path(shutil.copytree(original(), folder / "three"))


def changed(case: Path, test: str, change: Callable[[pd.DataFrame], object]) -> None:
    """Change a recording as a table."""
    file = case / "tests" / f"{test}.csv"
    table = pd.read_csv(file)
    change(table)
    table.to_csv(file, index=False)


def edited(file: Path, old: str, new: str) -> None:
    """Change a text file at one place."""
    text = file.read_text()
    assert old in text
    file.write_text(text.replace(old, new, 1))


STAND = "tests/stand.toml"


def swap(file: str, old: str, new: str) -> Callable[[Path], None]:
    return lambda case: edited(case / file, old, new)


sheet, network, settings = (partial(swap, file) for file in (STAND, "network.toml", "case.toml"))


def cell(name: str, row: int, value: object) -> Callable[[Path], None]:
    """One cell of stand.csv."""

    def change(table: pd.DataFrame) -> None:
        table[name] = table[name].astype(object)
        table.loc[row, name] = value

    return lambda case: changed(case, "stand", change)


def named(name: str) -> Callable[[Path], None]:
    """Another name of the first test."""
    return swap("case.toml", "[tests.stand]", f'[tests."{name}"]\nfile = "tests/stand.csv"\nsheet = "{STAND}"')


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
