"""Every word over a column that a command prints, and every verdict, stands in docs/glossary.md."""

import ast
import re
from itertools import pairwise
from typing import get_args

import pytest

from validation.diagnosis.result import Decided, Verdict

# Words of everyday English, units alone, and letters of a formula whose title says them.
PLAIN = {
    "", "%", "k", "degc", "w/k", "body w/k", "a", "b", "c", "t", "all", "at", "after", "end", "start", "name", "what",
    "how", "when", "way", "from", "to", "unit", "file", "rows", "seconds", "hours", "found", "missing", "needs", "note",
    "kind", "value", "material", "mass", "volume", "machine", "cooling", "difference", "mean", "sum", "met",
    "l x w x h", "winding", "measured", "measure",
}  # fmt: skip


def glossary(root):
    """The words of every entry, and pairs of them for words with a comma inside."""
    rows = [line.split(" | ")[0].removeprefix("| ").lower() for line in table(root)]
    lists = [row.split(", ") for row in rows]
    return {word for words in lists for word in (*words, *map(", ".join, pairwise(words)))}


def table(root):
    return [
        line for line in (root / "docs/glossary.md").read_text().splitlines() if re.match(r"\| [^|]+ \| .+ \|$", line)
    ]


def headers(root):
    """The second argument of every Grid, and every list called headers, in the commands and the demo."""
    for file in [*(root / "thermoscope/commands").rglob("*.py"), root / "thermoscope/demo.py"]:
        for node in ast.walk(ast.parse(file.read_text())):
            if isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "").lower() == "headers":
                yield from words_in(node.value)
            elif isinstance(node, ast.Call) and getattr(node.func, "id", "") == "Grid":
                yield from words_in(node.args[1])


def words_in(node):
    if isinstance(node, ast.List):
        for item in node.elts:
            if isinstance(item, ast.Constant) and isinstance(item.value, str):
                yield re.sub(r"\s*\([^)]*\)", "", item.value).strip().lower()


def explained(word, known):
    """Itself, or its singular."""
    return word in known | PLAIN or word.removesuffix("s") in known | PLAIN


def test_every_column_is_explained(root):
    known = glossary(root)
    assert sorted({w for w in headers(root) if not explained(w, known)}) == []


@pytest.mark.parametrize("word", sorted({*get_args(Verdict), *get_args(Decided)} - {"no"}))
def test_every_verdict_is_explained(root, word):
    assert word in glossary(root)


def test_the_check_reads_what_commands_print(root):
    assert {"rms", "limit", "decision", "goes to"} <= set(headers(root))
