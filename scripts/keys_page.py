"""docs/reference/keys.md: every key of every file with its bounds and what it is, from the schemas.

python -m scripts.keys_page    writes the page
"""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from lumped.schemas.bounds import COLDEST, HOTTEST
from lumped.schemas.schema import FILES, schema
from scripts.published import table

PAGE = Path(__file__).parents[1] / "docs" / "reference" / "keys.md"
HEAD = f"""# Keys of all files

Every key that a file may have, what it is, and what it may be. This page, the schemas, the readers and their messages
have the bounds from one table, `lumped/schemas/bounds.csv`. The bounds are far beyond any machine. What they refuse is
a slip: a sign, a decimal point, a unit. Temperatures lie between {COLDEST:g} and {HOTTEST:g} degC.
A number has to be finite, and true is not a number. Names that are yours are written as NAME.

"""


def page() -> str:
    """The page as Markdown."""
    return HEAD + "\n".join(_section(name) for name in FILES)


def _section(name: str) -> str:
    document = schema(name)
    escaped = ([cell.replace("|", "\\|") for cell in row] for row in _rows(document, ""))
    rows = dict.fromkeys((f"`{way}`", words, text) for way, words, text in escaped)
    return f"## {document['title']}\n\n{table(['key', 'may be', 'what it is'], rows)}\n"


def _rows(node: Any, way: str) -> Iterator[tuple[str, str, str]]:
    """(key with the tables around it, what it may be, what it is)"""
    for key, inner in node.get("properties", {}).items():
        yield from _row(inner, f"{way}.{key}" if way else key)
    extra = node.get("additionalProperties")
    if isinstance(extra, Mapping):
        yield from _row(extra, f"{way}.NAME")


def _row(node: Mapping[str, Any], way: str) -> Iterator[tuple[str, str, str]]:
    inner = list(_rows(node, way))
    if "description" in node or not inner:
        yield way, _words(node), node.get("description", "")
    yield from inner
    for form in (*node.get("anyOf", ()), node.get("items", {})):
        yield from _rows(form, way)
        yield from _rows(form.get("items", {}), way)


def _words(node: Mapping[str, Any]) -> str:
    """What a value may be, in words."""
    if "enum" in node:
        return ", ".join(str(word) for word in node["enum"])
    if "anyOf" in node:
        return " or ".join(dict.fromkeys(_words(form) for form in node["anyOf"]))
    kind = node.get("type", "anything")
    if kind in ("number", "integer"):
        whole = "whole number " if kind == "integer" else ""
        return f"{whole}{node['minimum']:g} to {node['maximum']:g}"
    if kind == "array":
        return f"list: {_words(node['items'])}" if "items" in node else "list"
    return {"string": "word", "boolean": "true or false", "object": "table"}.get(kind, str(kind))


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
