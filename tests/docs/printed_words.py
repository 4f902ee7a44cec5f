"""Words of the sentences that commands print, and which of them everybody knows."""

import ast
import re
from functools import cache
from itertools import islice

from spellchecker import SpellChecker

ROOMS = ("geom", "fem", "lumped", "measured", "validation", "viz", "thermoscope", "extras")
FILES_ONLY = ("export", "browser", "observer_code.py")  # whose text goes into programs, not to a reader
COMMON = 8000  # the most frequent words of English, about what an upper-intermediate learner reads
# Everyday or computer words that are rarer in films' subtitles, which the list of words was counted in.
PLAIN = """
alloy aluminium anew anneal arc arch arithmetic attribute auxiliary axis axle bracket browser byte cache
calculation centimetre centred ceramic clamp comma compile compute csv cylinder decimal default demo detection
diagnose diameter disagreement disc divider duration enclose encoder exceed exclude export finite fmu foil
folder format furthest geometry graphics halo halve halves hinder horizontal hypotheses import inlet insulate
integer inverse json kelvin latter likelihood logger magnitude matlab matrix matt measurement midway module
neighbour ohm optional outlet overlap pip plunge pmsm pymoo quotation refit rerun revise rotate
screenshot semi simplify simultaneous slope span spiral spreadsheet stainless stderr stdout sudo tab
thermoscope thumbnail tilt triangle uncertain undo undone uneven validate vary vermilion vertical visibility
watt widen width workbench workbook worksheet xlsx
"""
SENTENCE = r"[a-z,;:]\s|\s[a-z]"  # a blank between words, or before or after what is filled in
PROGRAM = r"[<>{}=]|https?:|::|-src |ctypes|apt-get"  # HTML, styles, shell
ENDINGS = ("s", "es", "d", "ed", "ing", "r", "er", "st", "est", "ly", "ness", "able", "n", "ation")


@cache
def printed(root):
    """Word -> a sentence it stands in: every text of the rooms with a blank in it, and the help of every command."""
    found = {}
    for file in sorted(f for room in ROOMS for f in (root / room).rglob("*.py")):
        if not {*FILES_ONLY} & {*file.parts}:
            for text in sentences(ast.parse(file.read_text(encoding="utf-8"))):
                for word in words(text):
                    found.setdefault(word, f"{file.relative_to(root)}: {text.strip()}")
    return found


def takes_json(function):
    """Is it a command? Each has that option, but `serve`."""
    return any(getattr(a.annotation, "id", "") == "Json" for a in function.args.args)


def sentences(tree):
    """Constants with a blank between letters; docstrings only where they are the help of a command."""
    commands = [f for f in ast.walk(tree) if isinstance(f, ast.FunctionDef) and takes_json(f)]
    helps = {id(f.body[0]) for f in commands}
    held = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr) and id(node) not in helps}
    texts = [
        n for n in ast.walk(tree) if isinstance(n, ast.Constant) and isinstance(n.value, str) and id(n) not in held
    ]
    yield from (n.value for n in texts if re.search(SENTENCE, n.value) and not re.search(PROGRAM, n.value))


def words(text):
    """Code, options, file names, units and what begins with a capital (proper names) are none."""
    plain = re.sub(r"`[^`]*`|'[^']*'|\"[^\"]*\"|--?[a-z][\w-]*|\S*[_/@=.\[\]|^]\S+", " ", text)
    return set(re.findall(r"(?<![\w@.])[a-z]{3,}(?![\w@(])", plain))


@cache
def common():
    table = SpellChecker(language="en").word_frequency
    ranked = sorted(table.items(), key=lambda pair: -pair[1])
    return {word for word, _ in islice(ranked, COMMON)} | {*PLAIN.split()}


def stems(word):
    """The word, and what it is a form of: drifts, drifted -> drift; hotter -> hot; halved -> halve; copies -> copy."""
    yield word
    for ending in ENDINGS:
        stem = word.removesuffix(ending)
        if stem != word and len(stem) > 1:
            yield from (stem, stem + "e", stem[:-1] if stem[-1:] == stem[-2:-1] else stem, re.sub("i$", "y", stem))


def plain(word):
    """Everybody knows it, or the word it is made of."""
    return not common().isdisjoint(stems(word))
