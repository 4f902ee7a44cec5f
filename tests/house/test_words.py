"""Public names are terms of the field: docs/glossary.md lists words of our own that they have replaced."""

import ast
import re

import pytest

# How often a word is still in use; none may be added.
REMAINING: dict[str, int] = {}
# Participles that stand for a noun: what it is says more.
PARTICIPLES = "found own known seen given held made written drawn tried settled saved"
# More of them, in parameters and variables: a function may be named like sorted(), after what it returns.
LOCAL_PARTICIPLES = """
allowed begun built chosen cored declared described done driven fed grown joined looked moved named occupied ordered
placed ranked reached shared timed turned used wanted washed watched
"""
# What is left: pipeline.Built, fields (some of a JSON document), and adjectives such as DRIVEN_MACHINE. A boolean, such
# as `moved: bool`, is an adjective too and may be added, with its number here.
REMAINING_PARTICIPLES = {"built": 22, "declared": 7, "driven": 3, "joined": 1, "named": 1, "reached": 1, "watched": 1}
# In parameters and variables.
REMAINING_LOCALLY: dict[str, int] = {}
EVERYDAY = """apart hand asked behind beyond borrowed bridges failing gates kept lowered mixes said shown stood taken
told tuned undisturbed wish"""  # in sentences


def own_words(root):
    section = (root / "docs/glossary.md").read_text().partition("## Names in the code")[2]
    rows = re.findall(r"^\| ([^|]+) \| [^|]+ \|$", section, re.MULTILINE)[1:]
    return {word for row in rows for word in row.split(", ")}


@pytest.fixture(scope="module")
def public(trees):
    """Every module, and every function, method and class without an underscore before its name."""
    nodes = (n for tree in trees.values() for n in ast.walk(tree) if isinstance(n, ast.FunctionDef | ast.ClassDef))
    return [*(file.stem for file in trees), *(n.name for n in nodes if not n.name.startswith("_"))]


@pytest.fixture(scope="module")
def local(trees):
    """Every parameter and variable, and what begins with an underscore."""
    nodes = (n for tree in trees.values() for n in ast.walk(tree) if isinstance(n, ast.FunctionDef | ast.ClassDef))
    return [*variable_names(trees), *(n.name for n in nodes if n.name.startswith("_"))]


def variable_names(trees):
    """Every parameter and variable, and every field of a class."""
    names = []
    for n in (n for tree in trees.values() for n in ast.walk(tree)):
        if isinstance(n, ast.arg):
            names.append(n.arg)
        elif isinstance(n, ast.Name) and isinstance(n.ctx, ast.Store):
            names.append(n.id)
    return names


def words(name):
    """with_hats -> with, hats; BasisCache -> basis, cache."""
    return {word.lower() for word in re.findall(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])", name)}


def counted(names, known):
    found = [word for name in names for word in words(name) & set(known)]
    return {word: found.count(word) for word in sorted(set(found))}


def test_no_private_words_in_public_names(root, public):
    found = counted(public, own_words(root))
    assert {word: n for word, n in found.items() if n > REMAINING.get(word, 0)} == {}


def test_no_private_words_in_parameters_and_variables(root, local):
    found = counted(local, own_words(root))
    assert {word: n for word, n in found.items() if n > REMAINING_LOCALLY.get(word, 0)} == {}


@pytest.mark.parametrize("names", ["public", "local"])
def test_no_participle_is_added_as_a_noun(request, names):
    assert counted(request.getfixturevalue(names), PARTICIPLES.split()) == {}


def test_no_participle_is_added_as_a_variable(trees):
    found = counted(variable_names(trees), LOCAL_PARTICIPLES.split())
    assert {word: n for word, n in found.items() if n > REMAINING_PARTICIPLES.get(word, 0)} == {}


def test_no_private_words_on_pages(root):
    """What is left are words that everybody uses in their everyday sense."""
    pages = [root / "README.md", *root.glob("docs/**/*.md"), *root.glob("cases/*/README.md")]
    everyday = set(EVERYDAY.split())
    private = own_words(root) - everyday
    for page in pages:
        text = page.read_text(encoding="utf-8").partition("## Names in the code")[0]
        plain = re.sub(r"```.*?```|`[^`]*`", "", text, flags=re.DOTALL).lower()
        assert private & {*re.findall(r"[a-z]+", plain)} == set(), page


@pytest.mark.parametrize("name", ["Shelf", "foretold", "latent_heat", "HandShelf", "is_kept"])
def test_the_check_sees_what_it_is_for(root, name):
    assert counted([name], own_words(root))
