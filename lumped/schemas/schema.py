"""JSON Schemas of all TOML files: for editors, and for what error messages say a key means.

Their text is in KIND.json beside this file, without what goes without saying: see `_spelt_out`. bounds.py has the
bounds of all numbers, and the families of machines have the keys of theirs.

python -m lumped.schemas.schema FOLDER    writes the schemas, out/schemas where no folder is named
"""

import json
import sys
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import Any

from geom.description.parameters import Parameter
from lumped.schemas.bounds import bounds

FOLDER = Path(__file__).parent
FILES = ("network", "case", "sheet", "model", "cycle", "bench", "machine")
Schema = dict[str, Any]


@cache
def schema(name: str) -> Schema:
    """The schema of one kind of file, one of FILES, with the bounds of every number."""
    if name == "machine":
        return machine_schema()
    text = json.loads((FOLDER / f"{name}.json").read_text(encoding="utf-8"))
    out: Schema = bounded(_spelt_out(text, text.pop("$defs", {})))
    return out


def _spelt_out(node: Any, parts: Mapping[str, Schema]) -> Any:
    """A schema with its repeated parts in full; a table has no keys but its own unless it says so."""
    if isinstance(node, list):
        return [_spelt_out(inner, parts) for inner in node]
    if not isinstance(node, Mapping):
        return node
    if "$ref" in node:
        return _spelt_out(parts[node["$ref"].rpartition("/")[2]], parts)
    out = {key: _spelt_out(inner, parts) for key, inner in node.items() if key != "properties"}
    if "properties" in node:
        inside = {key: _spelt_out(inner, parts) for key, inner in node["properties"].items()}
        return {"type": "object", "properties": inside, "additionalProperties": False} | out
    return {"type": "object"} | out if isinstance(out.get("additionalProperties"), Mapping) else out


@cache
def meanings() -> dict[str, str]:
    """Key -> what it is, for keys that mean the same wherever they stand."""
    words: dict[str, set[str]] = {}
    for name in FILES:
        for key, text in _described(schema(name)):
            words.setdefault(key, set()).add(text)
    return {key: next(iter(texts)) for key, texts in words.items() if len(texts) == 1}


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
    from geom.description.machine import SECTIONS
    from geom.machine_file import families, library

    groups: dict[str, dict[str, Schema]] = {}
    for family in families().values():
        for p in family.parameters:
            group = groups.setdefault(p.group, {})
            for name, key_schema in _keys(p).items():
                group[name] = _widest(group[name], key_schema) if name in group else key_schema
    geometry = {g: {"type": "object", "properties": keys, "additionalProperties": False} for g, keys in groups.items()}
    tables: dict[str, Schema] = {s: {"type": "object"} for s in SECTIONS}
    header = {
        "family": {"description": "family of machines", "enum": list(families())},
        "like": {"description": "the machine that comes along from which this one differs", "enum": list(library())},
        "without": {"description": "keys of that machine's file that are left out", "type": "array"},
    }
    either = [{"required": ["family"]}, {"required": ["like"]}]
    tables["machine"] = {"type": "object", "properties": header, "anyOf": either}
    tables["geometry"] = {"type": "object", "properties": geometry, "additionalProperties": False}
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "machine.toml: a machine by its dimensions",
        "type": "object",
        "properties": tables,
        "required": ["machine"],
        "additionalProperties": False,
    }


def _parameter(p: Parameter) -> Schema:
    unit = f" ({p.unit})" if p.unit else ""
    if p.choices:
        return {"description": p.doc, "enum": list(p.choices)}
    kind = "integer" if isinstance(p.default, int) else "number"
    return {"description": f"{p.doc}{unit}", "type": kind, "minimum": 0 if p.off else p.low, "maximum": p.high}


def _keys(p: Parameter) -> dict[str, Schema]:
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


def bounded(node: Any, key: str = "", table: str = "") -> Any:
    """A schema with the bounds of bounds.py on every number; `key` is the property it describes, in `table`."""
    if isinstance(node, list):
        return [bounded(inner, key, table) for inner in node]
    if not isinstance(node, Mapping):
        return node
    if node.get("type") in ("number", "integer"):
        limits = bounds(key, table)
        kind = "integer" if limits.whole else "number"
        return {**node, "type": kind, "minimum": limits.low, "maximum": limits.high}
    out = {name: bounded(inner, key, table) for name, inner in node.items() if name not in INNER}
    if "properties" in node:
        out["properties"] = {name: bounded(inner, name, key) for name, inner in node["properties"].items()}
    if "additionalProperties" in node:  # under names of the user's own: shares, constants, values
        out["additionalProperties"] = bounded(node["additionalProperties"], "shares" if key in COMMON else key, table)
    return {name: out[name] for name in node}


INNER = ("properties", "additionalProperties")
COMMON = ("at", "of", "wall", "winding", "magnet", "cage")  # tables of name -> share of one whole


def write_schemas(folder: Path | str) -> list[Path]:
    """KIND.json for every kind of file; returns what was written."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    paths = [folder / f"{name}.json" for name in FILES]
    for path in paths:
        path.write_text(json.dumps(schema(path.stem), indent=1) + "\n", encoding="utf-8")
    return paths


if __name__ == "__main__":
    write_schemas(*(sys.argv[1:] or ["out/schemas"]))
