"""JSON Schemas against every TOML file that comes along, and against the readers."""

import json
import re
import tomllib
from fnmatch import fnmatch
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator

from geom.errors import InputError
from lumped.declarations.network import read_network
from lumped.schemas.bounds import COLDEST, HOTTEST
from lumped.schemas.schema import FILES, meanings, schema, write_schemas
from scripts.keys_page import PAGE, page

ROOT = Path(__file__).resolve().parents[3]
PATTERNS = {
    "network": ["cases/**/network.toml", "examples/**/network.toml", "benchmarks/hidden/machines/*.toml"],
    "case": ["cases/**/case.toml"],
    "sheet": ["cases/**/tests/*.toml"],
    "cycle": ["cases/**/cycles/*.toml"],
    "model": ["cases/**/model.toml"],
    "machine": ["geom/machines/*.toml", "cases/**/machine.toml"],
}
SHIPPED = [
    (kind, path) for kind, patterns in PATTERNS.items() for pattern in patterns for path in sorted(ROOT.glob(pattern))
]


def faults(kind, data):
    checker = Draft202012Validator(schema(kind))
    return [f"{'.'.join(map(str, e.path))}: {e.message}" for e in checker.iter_errors(data)]


@pytest.mark.parametrize("kind", FILES)
def test_schemas_are_schemas(kind):
    Draft202012Validator.check_schema(schema(kind))


@pytest.mark.parametrize(("kind", "path"), SHIPPED, ids=[str(p.relative_to(ROOT)) for _, p in SHIPPED])
def test_shipped_files_fit(kind, path):
    assert faults(kind, tomllib.loads(path.read_text())) == []


@pytest.mark.parametrize(("kind", "path"), SHIPPED, ids=[str(p.relative_to(ROOT)) for _, p in SHIPPED])
def test_editors_are_told_which_schema_is_whose(kind, path):
    """By .taplo.toml; Taplo refuses a schema with a relative $id (tried with 0.9.3), so there is none."""
    rules = tomllib.loads((ROOT / ".taplo.toml").read_text())["rule"]
    name = str(path.relative_to(ROOT))
    fits = {
        r["schema"]["path"]
        for r in rules
        for glob in r["include"]
        if fnmatch(f"/{name}", f"*/{glob.removeprefix('**/')}")
        if not any(fnmatch(f"/{name}", f"*/{no.removeprefix('**/')}") for no in r.get("exclude", ()))
    }
    assert fits == {f"out/schemas/{kind}.json"}
    assert "$id" not in schema(kind)


@pytest.fixture
def example():
    text = (ROOT / "docs/network-toml.md").read_text()
    return tomllib.loads(re.search(r"```toml\n(.*?)```", text, re.S).group(1))


def test_the_documented_network_fits(example):
    assert faults("network", example) == []


SLIPS = {
    "unknown key": lambda d: d["links"]["winding-stator"].update(colour=1),
    "negative": lambda d: d["nodes"]["stator"].update(C_J_K=-5.0),
    "text for a number": lambda d: d["nodes"]["stator"].update(C_J_K="5616"),
    "loss class": lambda d: d["losses"]["copper"].update(kind="coper"),
    "one end": lambda d: d["links"]["winding-stator"].update(between=["winding"]),
}


@pytest.mark.parametrize("slip", SLIPS.values(), ids=SLIPS)
def test_what_the_schema_refuses_the_reader_refuses(example, slip):
    slip(example)
    assert faults("network", example)
    with pytest.raises(InputError):
        read_network(example)


def test_messages_say_what_a_key_means(example):
    del example["losses"]["copper"]["currents"]
    with pytest.raises(InputError, match=re.escape(f"currents = [words] ({meanings()['currents']})")):
        read_network(example)


def test_every_key_is_described():
    for kind in FILES:
        for name, part in walked(schema(kind)):
            assert "description" in part or "properties" in part or "additionalProperties" in part, (kind, name)


def walked(node):
    """Every property with a type of its own, below the document's sections."""
    for name, inner in node.get("properties", {}).items():
        if inner.get("type") not in (None, "object", "array"):
            yield name, inner
        yield from walked(inner)
    extra = node.get("additionalProperties")
    if isinstance(extra, dict):
        yield from walked(extra)


def test_schemas_for_editors_are_written_when_asked_with_bounds_and_the_families_keys(tmp_path):
    written = {path.stem: json.loads(path.read_text(encoding="utf-8")) for path in write_schemas(tmp_path / "schemas")}
    assert written == {kind: schema(kind) for kind in FILES}
    settles = written["network"]["properties"]["network"]["properties"]["settles_s"]
    assert (settles["minimum"], settles["maximum"]) == (1.0, 1e9)
    reference = written["network"]["properties"]["losses"]["additionalProperties"]["properties"]["reference_degC"]
    assert (reference["minimum"], reference["maximum"]) == (COLDEST, HOTTEST)
    shaft = written["machine"]["properties"]["geometry"]["properties"]["shaft"]["properties"]
    assert shaft["diameter_mm"] == {"description": "shaft (mm)", "type": "number", "minimum": 1.0, "maximum": 500.0}


def test_the_page_of_keys_is_the_schemas():
    """After a change of keys or bounds: python -m scripts.keys_page"""
    assert PAGE.read_text(encoding="utf-8") == page()
