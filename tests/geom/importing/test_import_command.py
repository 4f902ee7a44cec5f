"""`model import`: the file, the table, the JSON document; nothing half-written."""

import json

import pytest
from foreign_machines import pyleecan, saved

from geom import load_machine
from geom.errors import InputError
from thermoscope.commands.model.import_file import import_


def test_the_machine_file_builds_and_the_table_tells_its_values(tmp_path, capsys):
    source = saved(tmp_path, pyleecan())
    assert import_(source, tmp_path / "out", target=str(tmp_path / "doc.json")) == 0
    written, shown = tmp_path / "out/small.toml", capsys.readouterr().out
    assert load_machine(written).parts == load_machine(source).parts
    assert "Next: thermoscope model build" in shown
    assert "small.toml" in shown
    document = json.loads((tmp_path / "doc.json").read_text())
    assert {row["kind"] for row in document["values"]} == {"taken", "assumed", "not understood"}
    assert {"key": "geometry.stator.slots", "value": 12, "kind": "taken", "source": "stator.slot.Zs"} in document[
        "values"
    ]


def test_nothing_is_written_of_what_cannot_be_built(tmp_path):
    out = tmp_path / "out"
    with pytest.raises(InputError, match="cuts its neighbour"):
        import_(saved(tmp_path, pyleecan(stator__slot__W2=0.6)), out)
    with pytest.raises(InputError, match="not a template"):
        import_(saved(tmp_path, pyleecan()), out, "barrel")
    with pytest.raises(InputError, match="one of: "):
        import_(saved(tmp_path, "x", "machine.dwg"), out)
    assert not out.exists()


def test_a_file_that_lies_there_stays(tmp_path):
    source = saved(tmp_path, pyleecan())
    (tmp_path / "small.toml").write_text("mine")
    with pytest.raises(InputError, match="it stays"):
        import_(source, tmp_path)
    assert (tmp_path / "small.toml").read_text() == "mine"
