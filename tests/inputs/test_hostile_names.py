"""Names are data: no name of a file runs, leaves its folder, or is more than text in what is written."""

import csv
import io
import json
import re
import tomllib
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import openpyxl
import pytest
import tomlkit
from hostile import Tags, hostile_names
from scipy.io import loadmat

from extras.export.compilers import Compiled
from extras.export.document import document, mat
from extras.export.fmu import description, identifier
from extras.export.model import Output, Signal, packed
from geom.description.names import DEVICES, FORBIDDEN, LETTERS, file_stem, is_plain, plain_header
from geom.errors import InputError
from geom.escapes import c_comment, csv_lines, toml_key, toml_value, xml_text
from geom.importing.draft import Draft
from geom.table import Table
from lumped.declarations.network import load_network
from lumped.model.build import bare_network, node_link
from lumped.model.network import Row
from lumped.transfer.laws import Fixed
from measured.case import Reference
from thermoscope.case_folder.workbook import write_csvs, write_xlsx
from thermoscope.console.summary import Summary, limited_lines, printed
from thermoscope.console.terminal import give, notes
from viz.pages import html
from viz.pages.report import Report
from viz.viewer.page import render

NAMES = hostile_names()
PLAIN = [name for name in NAMES if is_plain(name)]


def test_some_pass_the_door_and_some_do_not():
    assert len(NAMES) == len(set(NAMES)) == 300
    assert 60 < len(PLAIN) < 240


NETWORK = {
    "network": {"name": "n", "boundaries": ["room"]},
    "nodes": {"part": {"C_J_K": 100.0}},
    "links": {"loss": {"between": ["part", "room"], "G_W_K": 1.0}},
    "losses": {"heat": {"kind": "constant", "at": "part", "P_W": 1.0, "of": [{"input": "drive"}]}},
    "parameters": {"factor": {"acts_on": ["link:loss"]}},
}
PLACES = ("n", "room", "part", "loss", "heat", "drive", "factor")


def renamed(node, old, new):
    if isinstance(node, dict):
        return {renamed(key, old, new): renamed(value, old, new) for key, value in node.items()}
    if isinstance(node, list):
        return [renamed(value, old, new) for value in node]
    return new if node == old else f"link:{new}" if node == f"link:{old}" else node


@pytest.mark.parametrize("place", PLACES)
def test_every_name_of_a_network_passes_the_one_rule(tmp_path, place):
    file, passed = tmp_path / "network.toml", []
    for name in NAMES:
        file.write_bytes(tomlkit.dumps(renamed(NETWORK, place, name)).encode(errors="surrogatepass"))
        with suppress(InputError):
            load_network(file)
            passed.append(name)
    refused = [name for name in NAMES if name not in passed]
    assert all(is_plain(name) for name in passed)
    assert [n for n in refused if is_plain(n) and not set(n) & set("@#") and n.strip() == n] == []


def test_a_header_of_a_recorder_becomes_a_plain_name():
    assert plain_header("=T wickl\n[degC] ") == "T wickl [degC]"
    assert plain_header("\x1b[31mT winding") == "[31mT winding"
    assert all(is_plain(plain_header(name)) for name in NAMES)


@pytest.fixture(scope="module")
def model():
    """A network whose every name is hostile, as no file could declare it."""
    net = bare_network("x", {"a": 100.0}, ("room",))
    net = net.extended([node_link(net, "link:x", "link", "a", "room", Fixed(1.0))])
    one = packed(net, {}, Reference(), [])
    state = Output("", Row(np.array([0]), np.ones(1)))
    return replace(
        one,
        name=NAMES[0],
        effects=tuple(NAMES),
        inputs=tuple(Signal(n, n, 0.0, 1.0) for n in NAMES),
        outputs=tuple(replace(state, name=n, role=n) for n in NAMES),
    )


def test_exported_code_compiles_and_runs_nothing_of_a_name(model, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    y = Compiled(model).run(np.array([0.0, 60.0]), np.zeros((2, len(model.signals))), np.array([50.0]))
    assert y[1] == pytest.approx(50.0 * np.exp(-0.6), abs=0.1)  # C dT/dt = -G T, nothing else
    assert not list(tmp_path.iterdir())


def test_a_comment_of_c_ends_where_it_should():
    for name in NAMES:
        comment = c_comment([name, name])
        assert (comment.count("*/"), comment.count("/*"), comment.endswith("*/")) == (1, 1, True)
        assert not re.search(r"\\|\?\?", comment)


@pytest.mark.parametrize("version", [2, 3])
def test_the_description_of_an_fmu_is_xml_with_every_name(model, version):
    root = ElementTree.fromstring(description(model, version))
    names = [v.get("name") for v in root.find("ModelVariables").iter() if v.get("name")]
    assert set(map(xml_text, NAMES)) <= {n.replace("\r", "\n") for n in names} | set(names)
    assert re.fullmatch(r"\w+", identifier(model), re.ASCII)


def test_worksheets_hold_texts_as_texts(tmp_path):
    sheets = [Table(name, [name, "t"], [[name, NAMES[0]], ["x", NAMES[1]]]) for name in NAMES]
    book = openpyxl.load_workbook(write_xlsx(tmp_path / "x.xlsx", sheets))
    cells = [cell for sheet in book.worksheets for row in sheet for cell in row if cell.value is not None]
    assert {cell.data_type for cell in cells} == {"s"}
    assert not any(cell.hyperlink for cell in cells)
    assert "=1+1" in {cell.value for cell in cells}


def test_csv_has_no_formula_and_lies_in_its_folder(tmp_path):
    inside = tmp_path / "a" / "b"
    write_csvs(inside, [Table(name[:LETTERS], [name], [[name]]) for name in NAMES])
    assert {p.parent for p in tmp_path.rglob("*") if p.is_file()} == {inside}
    rows = list(csv.reader(io.StringIO(csv_lines([[name, -1.5, "-1.5"] for name in NAMES]), newline="")))
    assert len(rows) == len(NAMES)
    assert {tuple(row[1:]) for row in rows} == {("-1.5", "-1.5")}
    parts = [part.strip() for row in rows for part in (row[0], *row[0].split(";"))]
    assert not [part for part in parts if part.startswith(tuple("=+-@\uff1d"))]


def test_a_name_of_a_file_leads_nowhere():
    for name in map(file_stem, NAMES):
        assert name.isprintable()
        assert not set(name) & FORBIDDEN
        assert name.strip(".")
        assert name.partition(".")[0].strip().upper() not in DEVICES


def test_toml_reads_back_what_was_written():
    for name in NAMES:
        text = f"{toml_key(name)} = {toml_value(name)}\nlist = {toml_value([name])}"
        assert tomllib.loads(text) == {name: name, "list": [name]}


def test_a_draft_of_a_machine_reads_back():
    draft = Draft("x", Path("x.json"), "other")
    for name in NAMES:
        draft.take("names", name, **{name: name})
        draft.assume("maps", name, **{name: {name: [name, 1.5, True]}})
        draft.leave(name, name, name)
    assert tomllib.loads(draft.toml()) == draft.sections()


def tags(name):
    parser, inner = Tags(), html.inner_page(html.page(name, [html.text(name)]), name)
    parser.feed(html.page(name, [html.section(name, html.text(name), html.table(Table("", [name], [[name]]))), inner]))
    return parser.tags


def test_a_page_has_the_same_tags_whatever_the_names_are():
    usual = tags("name")
    assert [name for name in NAMES if tags(name) != usual] == []


def test_a_notebook_shows_the_same_tags_whatever_the_names_are():
    def tags_of(name):
        parser, framed = Tags(), Report(name)._repr_html_()
        parser.feed(Table(name, [name, "n"], [[name, 1.0]]).html() + framed)
        return parser.tags

    usual = tags_of("name")
    assert [name for name in NAMES if tags_of(name) != usual] == []


def test_the_viewer_keeps_names_in_its_data():
    page = render({"title": "@DATA@@SCRIPT@</title><script>", "parts": NAMES})
    data = re.findall(r'<script[^>]*type="application/json"[^>]*>(.*?)</script>', page, re.S)
    assert json.loads(data[-1])["parts"] == NAMES
    assert page.count("<script") == render({"title": "x", "parts": ["x"]}).count("<script")


def test_a_terminal_is_sent_no_control_characters(capsys):
    with limited_lines(None):
        for name in NAMES:
            printed(Summary(name, [name, Table(name, [name, "n"], [[name, 1.0]])], name))
            notes([name])
    shown = capsys.readouterr()
    assert shown.out.replace("\n", "").isprintable()
    assert shown.err.replace("\n", "").isprintable()
    assert len(shown.err.splitlines()) == len(NAMES)


def test_json_and_mat_read_back(model, capsys):
    give({"names": NAMES}, "-", lambda: None)
    assert json.loads(capsys.readouterr().out)["names"] == NAMES
    saved = loadmat(io.BytesIO(mat(model)), simplify_cells=True)["model"]
    assert len(saved["outputs"]) == len(document(model)["outputs"]) == len(NAMES)


def test_letters_of_a_name_are_counted():
    assert is_plain("x" * LETTERS)
    assert not is_plain("x" * (LETTERS + 1))
