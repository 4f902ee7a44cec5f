"""The small case, made once and copied, and ways to change its files."""

import shutil
import tempfile
from collections.abc import Callable
from functools import cache
from pathlib import Path

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
