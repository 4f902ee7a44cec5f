"""Recordings dropped on the workbench: guessed, dragged to parts, made a case that compare runs."""

import asyncio
import gzip
import zipfile
from pathlib import Path

import numpy as np
import openpyxl
import pytest
from aiohttp import ClientSession, CookieJar, FormData
from foreign_machines import motor_cad
from small_case import small_case
from test_serve_access_control import TOKEN, running
from trame.app import get_server

from extras.workbench.access_control import AccessControl
from extras.workbench.dropped import read, write
from extras.workbench.machines import Bench
from extras.workbench.session import Session
from extras.workbench.steps import machine
from geom.errors import InputError
from geom.machine_file import is_foreign_machine, load_machine
from measured.importing.source import read_sources
from thermoscope.case_folder.folder import load_case

HEAD = "Zeit;I [A];Wind [km/h];Raum;T Wicklung;Kanal 7;Bemerkung"


@pytest.fixture
def case(tmp_path):
    return small_case(tmp_path / "home")


def recording(folder: Path, name: str = "bench.csv") -> Path:
    """As a recorder writes it: semicolons, decimal commas, a channel without a name that says anything."""
    rows = [f"{10 * k},0;80,0;12,0;20,5;{20 + 0.2 * k:.1f};{20 + 0.1 * k:.1f};ok".replace(".", ",") for k in range(120)]
    file = folder / name
    file.write_text("\n".join([HEAD, *rows]), encoding="utf-8")
    return file


@pytest.fixture
def dropped(case, tmp_path):
    return read([recording(tmp_path)], load_case(case).case.model.network, lambda message: None)


def goes(dropped):
    return {row["name"]: row["goes"] for row in dropped.rows}


def test_columns_are_guessed_against_the_open_model(dropped):
    found = goes(dropped)
    assert found["T Wicklung"] == "winding"
    assert found["I [A]"] == "current_A"
    assert found["Kanal 7"] == ""
    assert [p["name"] for p in dropped.document["parts"]][:3] == ["winding", "yoke", "flange"]


def test_a_channel_goes_where_it_is_dragged(dropped):
    moved = dropped.moved("0:Kanal 7", "flange")
    assert goes(moved)["Kanal 7"] == "flange"
    assert next(r for r in moved.rows if r["name"] == "Kanal 7")["unit"] == "degC"
    assert goes(moved.moved("0:Kanal 7", ""))["Kanal 7"] == ""
    assert goes(moved.moved("0:Kanal 7", "ambient"))["Raum"] == "", "one column gives a boundary"


@pytest.mark.parametrize(
    ("key", "to", "words"),
    [
        ("0:I [A]", "winding", "is a current"),
        ("0:T Wicklung", "current_A", "is a temperature"),
        ("0:Bemerkung", "flange", "words, not numbers"),
        ("0:I [A]", "nowhere", "no 'nowhere'"),
        ("7:I [A]", "winding", "no column"),
        ("x", "winding", "no column"),
    ],
)
def test_a_channel_cannot_go_where_it_makes_no_sense(dropped, key, to, words):
    with pytest.raises(InputError, match=words):
        dropped.moved(key, to)


def test_what_was_not_recorded_is_asked_for(dropped):
    without = dropped.moved("0:I [A]", "")
    assert without.missing == ["current_A"]
    with pytest.raises(InputError, match="not a number"):
        without.constant("current_A", "many")
    assert without.constant("current_A", "80,5").document["constants"] == {"current_A": "80.5"}


def test_a_case_beside_the_open_one(case, dropped):
    folder = load_case(case)
    made = write(dropped.moved("0:Kanal 7", "flange"), folder.settings, folder.case.model.network, lambda m: None)
    assert made == case.parent / "bench"
    found = load_case(made)
    assert {c.place for c in found.case.tests[0].channels} == {"winding", "flange"}
    assert np.isfinite(found.compared.rmse_K)
    again = write(dropped, folder.settings, folder.case.model.network, lambda m: None)
    assert again == case.parent / "bench-2"


def visited(case, ask, **options):
    """(what `ask(address, session, path of a tab)` gives on the served case, name and content of what was taken in)."""
    seen = []

    async def take_in(self, files):
        seen.extend((f.name, f.read_bytes()) for f in files)

    async def main():
        async with (
            running(load_case(case), AccessControl("127.0.0.1", TOKEN), **options) as address,
            ClientSession(cookie_jar=CookieJar(unsafe=True)) as session,
        ):
            await session.get(f"{address}?token={TOKEN}", allow_redirects=False)
            first = await session.get(address, allow_redirects=False)
            return await ask(address, session, first.headers["Location"].removesuffix("index.html"))

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Session, "take_in", take_in)
        return asyncio.run(main()), seen


def upload(case, files, token=TOKEN, **options):
    """(status, what arrived) of a drop on a tab of the served case."""

    async def ask(address, session, tab):
        body = FormData(quote_fields=False)
        for name, content in files:
            body.add_field("recording", content, filename=name)
        if not token:
            session.cookie_jar.clear()
        return (await session.post(f"{address}{tab}recordings", data=body)).status

    return visited(case, ask, **options)


def test_files_arrive_under_their_names_and_nowhere_else(case):
    status, seen = upload(case, [("a.csv", b"1"), ("../../b.csv", b"2"), ("a.csv", b"3")])
    assert status == 204
    assert seen == [("a.csv", b"1"), ("b.csv", b"2"), ("a.csv", b"3")]


def test_a_name_that_no_file_may_have_is_made_one(case):
    """300 letters, an ending without end, dots and devices: stored all the same, under a short name."""
    names = ["a%00b.csv", "x" * 300 + ".csv", "ä" * 300 + ".csv", "a." + "y" * 300, "..", "=1+1.csv", "a:b|c.csv"]
    status, seen = upload(case, [(name, b"1") for name in names])
    assert status == 204
    assert [content for _, content in seen] == [b"1"] * len(seen)
    assert len(seen) == len(names)
    for name, _ in seen:
        assert len(name.encode()) <= 200
        assert name.isprintable()
        assert not set(name) & set('/\\:*?"<>|')
    assert [name[-4:] for name, _ in seen[:3]] == [".csv"] * 3


def test_a_zero_byte_in_a_name_stores_nothing(case):
    """No client's library sends one: the server answers 4xx, stores nothing, and serves on."""

    async def ask(address, session, tab):
        cookies = "; ".join(f"{c.key}={c.value}" for c in session.cookie_jar)
        body = b'--X\r\nContent-Disposition: form-data; name="recording"; filename="a\0b.csv"\r\n\r\n1\r\n--X--\r\n'
        head = (
            f"POST {tab}recordings HTTP/1.1\r\nHost: {address.removeprefix('http://')}\r\nCookie: {cookies}\r\n"
            f"Content-Type: multipart/form-data; boundary=X\r\nContent-Length: {len(body)}\r\n"
            "Connection: close\r\n\r\n"
        )
        reader, writer = await asyncio.open_connection("127.0.0.1", int(address.rpartition(":")[2]))
        writer.write(head.encode() + body)
        answer = await reader.read()
        writer.close()
        return answer, (await session.get(f"{address}{tab}index.html")).status

    (answer, after), taken = visited(case, ask)
    assert answer.startswith(b"HTTP/1.1 400")
    assert answer.endswith(b"not readable as an upload of files")
    assert after == 200
    assert taken == []


@pytest.mark.parametrize(("options", "status"), [({"token": ""}, 401), ({"largest_drop": 10}, 413)])
def test_strangers_cannot_drop_and_nobody_too_much(case, options, status):
    assert upload(case, [("a.csv", b"x" * 100)], **options) == (status, [])


def test_what_no_reader_likes_is_one_message_with_its_name(case, tmp_path):
    """A workbook of charts alone, one packed and one unpacked beyond all measure, zero bytes."""
    book = openpyxl.Workbook()
    book.create_chartsheet("chart")
    book.remove(book["Sheet"])
    book.save(tmp_path / "charts.xlsx")
    (tmp_path / "packed.csv.gz").write_bytes(gzip.compress(b"1,2\n" * 10**7, 1))
    (tmp_path / "zero.csv").write_bytes(b"t,T\n0,\0\n" * 9)
    with zipfile.ZipFile(tmp_path / "bomb.xlsx", "w", zipfile.ZIP_DEFLATED) as bomb:
        bomb.writestr("xl/worksheets/sheet1.xml", bytes(6 * 10**8))
    network = load_case(case).case.model.network
    for name in ("charts.xlsx", "packed.csv.gz", "zero.csv", "bomb.xlsx"):
        with pytest.raises(InputError, match=name):
            read([tmp_path / name], network, lambda message: None)


def test_a_machine_file_of_another_program_becomes_one_of_ours(tmp_path):
    """A motor as Motor-CAD writes it, from text of our own; the page has each value with its source."""
    file = tmp_path / "small.mot"
    file.write_text(motor_cad())
    document = machine(file, tmp_path, lambda message: None)
    assert load_machine(tmp_path / "small.toml").name == "small"
    assert "thermoscope model build" in document["words"]
    kinds = {row[document["columns"].index("kind")] for row in document["rows"]}
    assert {"taken", "assumed"} <= kinds
    with pytest.raises(InputError, match="is there already"):
        machine(file, tmp_path, lambda message: None)


def test_json_is_a_machine_where_it_names_a_class(tmp_path):
    for text, so in (('{"__class__": "MachineIPMSM"}', True), ('[{"time_s": 0, "T": 20}]', False)):
        (tmp_path / "a.json").write_text(text)
        assert is_foreign_machine(tmp_path / "a.json") is so
    assert not is_foreign_machine(tmp_path / "a.csv")


@pytest.mark.parametrize("name", ["model.toml", "part.STEP", "small.mot", "drawn.dxf"])
def test_what_describes_a_machine_is_no_recording(tmp_path, name):
    (tmp_path / name).write_text("1,2\n" * 9)
    with pytest.raises(InputError, match="describes a machine or a model"):
        read_sources(tmp_path / name)


def test_a_drop_beside_a_calculation_is_refused_aloud(case):
    """Not lost without a word."""
    session = Session(Bench(load_case(case)), get_server("a tab"))
    session.state.busy = True
    asyncio.run(session.take_in([case / "own.csv"]))
    assert "drop the files again" in session.state.error
