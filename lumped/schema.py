"""JSON Schemas of all TOML files: for editors, and for what error messages say a key means.

python -m lumped.schema    writes schemas/machine.json from the machine families' own parameters
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import Any

FOLDER = Path(__file__).parent / "schemas"
FILES = ("network", "case", "sheet", "model", "cycle", "machine")
Schema = dict[str, Any]


@cache
def schema(name: str) -> Schema:
    """The schema of one kind of file, one of FILES."""
    return json.loads((FOLDER / f"{name}.json").read_text(encoding="utf-8"))


@cache
def meanings() -> dict[str, str]:
    """Key -> what it is, for keys that mean the same wherever they stand."""
    found: dict[str, set[str]] = {}
    for name in FILES:
        for key, text in _described(schema(name)):
            found.setdefault(key, set()).add(text)
    return {key: next(iter(texts)) for key, texts in found.items() if len(texts) == 1}


def _described(node: Any) -> Iterator[tuple[str, str]]:
    if isinstance(node, Mapping):
        for key, inner in node.get("properties", {}).items():
            if isinstance(inner, Mapping) and "description" in inner:
                yield key, inner["description"]
        for inner in node.values():
            yield from _described(inner)
    elif isinstance(node, list):
        for inner in node:
            yield from _described(inner)


def meaning(key: str) -> str:
    """' (what the key is)' for an error message, or nothing."""
    text = meanings().get(key)
    return f" ({text})" if text else ""


def machine_schema() -> Schema:
    """The machine file: header and geometry from the families' parameters, the other sections as tables."""
    from geom.families import families
    from geom.machine import SECTIONS

    groups: dict[str, dict[str, Schema]] = {}
    for family in families().values():
        for p in family.parameters:
            known = groups.setdefault(p.group, {})
            for name, own in _keys(p).items():
                known[name] = _widest(known[name], own) if name in known else own
    geometry = {g: {"type": "object", "properties": keys, "additionalProperties": False} for g, keys in groups.items()}
    tables: dict[str, Schema] = {s: {"type": "object"} for s in SECTIONS}
    header = {"family": {"description": "family of machines", "enum": list(families())}}
    tables["machine"] = {"type": "object", "properties": header, "required": ["family"]}
    tables["geometry"] = {"type": "object", "properties": geometry, "additionalProperties": False}
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "machine.toml: a machine by its dimensions", "type": "object", "properties": tables,
        "required": ["machine"], "additionalProperties": False,
    }  # fmt: skip


def _parameter(p: Any) -> Schema:
    unit = f" ({p.unit})" if p.unit else ""
    if p.choices:
        return {"description": p.doc, "enum": list(p.choices)}
    kind = "integer" if isinstance(p.default, int) else "number"
    return {"description": f"{p.doc}{unit}", "type": kind, "minimum": 0 if p.off else p.low, "maximum": p.high}


def _keys(p: Any) -> dict[str, Schema]:
    """Of a length also its ratio."""
    if p.of is None:
        return {p.name: _parameter(p)}
    low = 0 if p.off else p.of.low
    ratio = {"description": f"{p.doc}, over {p.of.name}", "type": "number", "minimum": low, "maximum": p.of.high}
    return {p.name: _parameter(p), p.ratio_name: ratio}


def _widest(a: Schema, b: Schema) -> Schema:
    """One key that two families declare: what either allows."""
    if "enum" in a or "enum" in b:
        return {**a, "enum": sorted({*a.get("enum", ()), *b.get("enum", ())})}
    return {**a, "minimum": min(a["minimum"], b["minimum"]), "maximum": max(a["maximum"], b["maximum"])}


def write_machine_schema() -> Path:
    """Write schemas/machine.json."""
    path = FOLDER / "machine.json"
    path.write_text(json.dumps(machine_schema(), indent=1) + "\n", encoding="utf-8")
    return path


if __name__ == "__main__":
    write_machine_schema()
