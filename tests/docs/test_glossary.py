"""Every term that commands print, over columns, as a verdict or in sentences, stands in docs/glossary.md."""

import ast
import re
from itertools import pairwise
from typing import get_args

import printed_words
import pytest

from validation.inference.result import Decided, Verdict

# Words of everyday English, units alone, and letters of a formula whose title says them.
PLAIN = """
%, now, k, degc, w/k, body w/k, a, b, c, t, all, at, after, end, start, name, what, how, when, way, from, to, unit,
file, rows, seconds, hours, found, missing, needs, note, kind, value, material, mass, volume, machine, cooling,
difference, mean, sum, met, l x w x h, winding, measured, measure
"""

# Words of everyday English that say something of their own here.
TERMS = """
assembly band base basis bearing boundary bound bridge brush cage candidate capacity case channel circuit clock coil
condition contact core coupling cycle design deviance drift drive duct effect envelope error event evidence factor
field film fin fit fleet friction gap input jacket joint lag lamination law leads limit link liner load locked loss
magnet mesh model motor network neutral node noise objective observer part parallel place plate pole potting prior
probability probe rating reading recorder repeat response rib role runaway sample scatter screening sensor series
sheet shunt slot source state stem step stream sweep test tip tolerance tooth trigger turns winding window yoke
"""


def glossary(root):
    """The words of every entry, and pairs of them for words with a comma inside."""
    rows = [line.split(" | ")[0].removeprefix("| ").lower() for line in table(root)]
    lists = [row.split(", ") for row in rows]
    return {word for words in lists for word in (*words, *map(", ".join, pairwise(words)))}


def table(root):
    lines = (root / "docs/glossary.md").read_text().partition("|---|---|\n")[2].partition("\n## ")[0].splitlines()
    return [line for line in lines if re.match(r"\| [^|]+ \| .+ \|$", line)]


def in_entries(root):
    """Single words of the entries, and what they are forms of."""
    return {s for entry in glossary(root) for w in re.findall("[a-z]{3,}", entry) for s in printed_words.stems(w)}


def in_need(found, known):
    return sorted(w for w in found if not printed_words.plain(w) and not {*printed_words.stems(w)} & known)


def headers(root):
    """The columns of every table, and every list called headers, in the commands, the demo and the results."""
    others = [root / "thermoscope/demo.py", root / "validation/tables.py"]
    for file in [*(root / "thermoscope/commands").rglob("*.py"), *others]:
        for node in ast.walk(ast.parse(file.read_text())):
            if isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "").lower() == "headers":
                yield from words_in(node.value)
            elif isinstance(node, ast.Call) and getattr(node.func, "id", "") == "Table":
                yield from words_in(node.args[1])
            elif isinstance(node, ast.Call) and ast.unparse(node.func) == "Table.of":
                yield from names_of(node.args[2])
            elif isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "").lower() in ("columns", "sensors"):
                yield from names_of(node.value)


def names_of(node):
    """Of the columns in "NAME=KEY | *NAME"."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        for column in node.value.split("|"):
            yield re.sub(r"\s*\([^)]*\)", "", column.partition("=")[0].strip(" *")).strip().lower()


def words_in(node):
    if isinstance(node, ast.List):
        for item in node.elts:
            if isinstance(item, ast.Constant) and isinstance(item.value, str):
                yield re.sub(r"\s*\([^)]*\)", "", item.value).strip().lower()


def test_every_column_is_explained(root):
    known = glossary(root) | {"", *re.split(r",\s+", PLAIN.strip())}
    assert sorted(w for w in set(headers(root)) if not {w, w.removesuffix("s")} & known) == []


@pytest.mark.parametrize("word", sorted({*get_args(Verdict), *get_args(Decided)} - {"no"}))
def test_every_verdict_is_explained(root, word):
    assert word in glossary(root)


def test_every_term_inside_a_sentence_is_explained(root):
    found = printed_words.printed(root)
    assert {word: found[word] for word in in_need(found, in_entries(root))} == {}


def test_everyday_words_with_a_meaning_here_are_explained(root):
    assert sorted(set(TERMS.split()) - in_entries(root)) == []


def test_the_glossary_explains_by_words_that_need_no_glossary(root):
    meanings = {word for line in table(root) for word in printed_words.words(line.split(" | ")[1])}
    assert in_need(meanings, in_entries(root)) == []


def test_entries_are_in_order(root):
    assert table(root) == sorted(table(root), key=str.lower)


def test_the_check_of_sentences_reads_them_and_sees_a_foreign_word(root):
    found = printed_words.printed(root)
    assert {"emissivity", "deviance", "thermocouple"} <= set(found)
    assert in_need({"enthalpy", "hotter", "drifted", "copies"}, in_entries(root)) == ["enthalpy"]
    assert printed_words.words("--limit PLACE of `yoke` is 3.5 W/K; Gnielinski, hotter") == {"hotter"}


def test_the_check_reads_what_commands_print(root):
    assert {"rms", "limit", "decision", "goes to"} <= set(headers(root))
