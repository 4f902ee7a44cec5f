"""What a file may not be or say: refused in one line with place and cure, exit 2, all files as before."""

import gzip
import io
import os
import tarfile

import pytest
from command_line import answered, contents
from input_cases import STAND, case_of, cell, changed, edited, named, network, settings, sheet


def whole(name, make):
    """A whole column of stand.csv."""
    return lambda case: changed(case, "stand", lambda table: table.__setitem__(name, make(table)))


def bytes_of(name, make):
    def write(case):
        file = case / name
        content = file.read_bytes()
        file.unlink()
        (case / make(content)[0]).write_bytes(make(content)[1])

    return write


def packed(content):
    return gzip.compress(content)


def damaged(content):
    out = bytearray(packed(content))
    out[50:60] = b"x" * 10
    return bytes(out)


def archive(content):
    memory = io.BytesIO()
    with tarfile.open(fileobj=memory, mode="w:gz") as tar:
        info = tarfile.TarInfo("stand.csv")
        info.size = len(content)
        tar.addfile(info, io.BytesIO(content))
    return memory.getvalue()


def beside(case):
    (case / "tests/stand.csv.gz").write_bytes(packed((case / "tests/stand.csv").read_bytes()))


def power(case, value):
    """The current column read as a power that a loss takes the amount of."""
    edited(
        case / "network.toml",
        'kind = "copper"\nR20_ohm = 0.02\ncurrents = ["current_A"]',
        'kind = "constant"\nP_W = 1.0\nof = { input = "power_W", at = 1.0 }',
    )
    for test in ("stand", "road", "town"):
        edited(case / f"tests/{test}.toml", 'quantity = "current"\nunit = "A"', 'quantity = "power"\nunit = "W"')
    changed(case, "stand", lambda table: table.__setitem__("current", value(table["current"])))


def pipe(name):
    def make(case):
        (case / name).unlink()
        os.mkfifo(case / name)

    return make


def model(values):
    text = f'[[revision]]\nnumber = 1\naction = "calibrate"\neffects = []\nvalues = {{ {values} }}\n'
    return lambda case: (case / "model.toml").write_text(text)


def parameter(keys):
    extra = f'[parameters.x]\nacts_on = ["link:yoke-air"]\n{keys}\n[losses.copper]'
    return network("[losses.copper]", extra)


AIR = "[columns.air]"
FLANGE = 'between = ["flange", "ambient"]'
CURRENT = '[columns.current]\nquantity = "current"\nunit = "A"\n'
REFUSED = {
    "unknown key": (settings("sample_s", "sample_sec"), "case.toml | unknown key 'sample_sec' | sample_s"),
    "unknown role": (settings('"validate"', '"training"'), "tests.road | training | validate"),
    "neither machine nor network": (settings('network = "network.toml"', ""), "machine | network"),
    "frees what is not there": (
        settings("[tests.stand]", '[calibration]\nfree = ["link.winding-yok"]\n[tests.stand]'),
        "case.toml | link.winding-yok | link.winding-yoke",
    ),
    "recording that is not there": (
        lambda case: (case / "tests/town.csv").unlink(),
        "town.csv | no such file | stand.csv",
    ),
    "network that is not there": (lambda case: (case / "network.toml").unlink(), "network.toml | no such file"),
    "misspelt quantity": (sheet('"current"', '"curent"'), "curent | did you mean 'current'"),
    "misspelt key of a column": (sheet("sigma_K", "sigma"), "unknown key 'sigma' | did you mean 'sigma_K'"),
    "misspelt place": (sheet('"flange"', '"flnge"'), "'flnge' | did you mean 'flange'"),
    "misspelt column": (sheet("[columns.T_yoke]", "[columns.T_joke]"), "'T_joke' is not in the file | 'T_yoke'"),
    "input without a column": (sheet(CURRENT, ""), "stand.toml | current_A"),
    "boundary without a column": (sheet("[columns.air]", "[columns.air]\nuse = false"), "stand.toml | ambient"),
    "a time given twice": (cell("time_s", 29, 280), "line 31 | twice"),
    "a long hole in an input": (
        whole("current", lambda table: table["current"].where((table.index < 50) | (table.index > 100))),
        "stand.csv | current",
    ),
    "misspelt key of the network": (network("G_W_K = 8", "G = 8"), "network.toml | winding-yoke"),
    "model of another network": (model('"link.wrong" = 1.0'), "model.toml | link.wrong"),
    "a case named with an escape code": (
        settings('name = "three"', 'name = "\\u001b[2J"'),
        "case.toml | \\x1b[2J | printed",
    ),
    "a link to a node with an escape code": (
        network('between = ["winding"', 'between = ["\\u001b[2J"'),
        "network.toml | printed",
    ),
    "a node with a name without end": (
        network('between = ["winding"', f'between = ["{"x" * 9999}"'),
        "network.toml | 80 letters",
    ),
    "name that leads outside": (named("/../../../ESCAPED"), "case.toml | ESCAPED | characters without"),
    "name with a backslash": (named("a\\\\b"), "case.toml | characters without"),
    "name with a line break": (named("a\\nb"), "case.toml | one line"),
    "name without end": (named("x" * 200), "case.toml | at most 80 letters"),
    "two recordings of one name": (beside, 'stand.csv and stand.csv.gz | file = "tests/stand.csv"'),
    "one recording in two roles": (
        settings('role = "hold-out"', f'role = "hold-out"\nfile = "tests/stand.csv"\nsheet = "{STAND}"'),
        "tests.stand | tests.town | one recording",
    ),
    "network of a wrong type": (settings('"network.toml"', "3"), "case.toml | network = 3"),
    "recording that is a pipe": (pipe("tests/stand.csv"), "stand.csv | is not a file"),
    "damaged gzip": (bytes_of("tests/stand.csv", lambda c: ("tests/stand.csv.gz", damaged(c))), "as gzip"),
    "archive": (bytes_of("tests/stand.csv", lambda c: ("tests/stand.csv.gz", archive(c))), "zero bytes"),
    "binary": (bytes_of("tests/stand.csv", lambda c: ("tests/stand.csv", bytes(range(256)) * 9)), "zero bytes"),
    "UTF-16": (bytes_of("tests/stand.csv", lambda c: ("tests/stand.csv", c.decode().encode("utf-16"))), "stand.csv"),
    "Latin-1": (bytes_of("tests/stand.csv", lambda c: ("tests/stand.csv", c.replace(b"air", b"\xb0C"))), "UTF-8"),
    "no workbook": (bytes_of("tests/stand.csv", lambda c: ("tests/stand.xlsx", c)), "stand.xlsx | Excel"),
    "decimal commas": (
        bytes_of("tests/stand.csv", lambda c: ("tests/stand.csv", c.replace(b".", b","))),
        "decimal commas",
    ),
    "row cut off": (bytes_of("tests/stand.csv", lambda c: ("tests/stand.csv", c[:-25])), "line 301 | cut off"),
    "semicolons": (bytes_of("tests/stand.csv", lambda c: ("tests/stand.csv", c.replace(b",", b";"))), "';'"),
    "a header twice": (
        lambda case: changed(case, "stand", lambda table: table.insert(7, " T_yoke", table["T_yoke"])),
        "'T_yoke' stands twice",
    ),
    "last time of 1e12": (cell("time_s", 299, 1e12), "1e+12 s | time_unit"),
    "time unit that leaves one sample": (
        sheet('time = "time_s"', 'time = "time_s"\ntime_unit = "ms"'),
        "2.99 s | time_unit",
    ),
    "time unit to a huge power": (
        sheet('time = "time_s"', 'time = "time_s"\ntime_unit = "s**999999999"'),
        "s**999999999 | known: h",
    ),
    "unit of powers of powers": (sheet('"km/h"', '"km/h**9**9**9**9"'), "km/h**9 | known"),
    "unit that is a list": (sheet('"km/h"', '["km/h"]'), "not a unit"),
    "m/s of a shaft": (sheet('"vehicle_speed"\nunit = "km/h"', '"speed"\nunit = "m/s"'), "vehicle_speed"),
    "input named in another unit": (
        sheet('"current"\nunit = "A"', '"current"\nunit = "A"\ninput = "current_mA"'),
        "held in A",
    ),
    "use in quotes": (sheet('"km/h"', '"km/h"\nuse = "false"'), "use = 'false' | without quotes"),
    "boundary by column and constant": (
        sheet(AIR, f"[boundaries]\nambient = 20\n{AIR}"),
        "ambient | [columns.air] | [boundaries]",
    ),
    "boundary by two columns": (sheet('place = "yoke"', 'place = "ambient"'), "[columns.air] | T_yoke"),
    "misspelt boundary": (sheet(AIR, f"[boundaries]\nambeint = 20\n{AIR}"), "did you mean 'ambient'"),
    "misspelt input": (
        sheet("[columns.current]", "[inputs]\ncurent_A = 20\n[columns.current]\nuse = false"),
        "curent_A | did you mean 'current_A'",
    ),
    "input by column and constant": (sheet(AIR, f"[inputs]\ncurrent_A = 20\n{AIR}"), "current_A | twice"),
    "one column as two sensors": (
        sheet("[columns.T_flange]", '[columns.T_flange]\ncolumn = "T_yoke"'),
        "T_flange | one column",
    ),
    "sensor without end": (sheet("sigma_K = 0.4", "sigma_K = inf"), "T_flange | sigma_K = inf"),
    "reading below all cold": (cell("T_flange", 10, -150), "line 12 | -150"),
    "reading above all metal": (cell("T_flange", 10, 5000), "line 12 | 5000"),
    "degC read as K": (sheet('unit = "degC"\nplace = "winding"', 'unit = "K"\nplace = "winding"'), "unit"),
    "reversed clamp": (lambda case: power(case, lambda amps: -amps), "negative | clamp | line"),
    "nodes alone": (
        lambda case: [
            edited(case / "network.toml", FLANGE, 'between = ["flange", "winding"]'),
            edited(case / "network.toml", 'between = ["yoke", "ambient"]', 'between = ["yoke", "winding"]'),
        ],
        "no heat can leave | 'winding', 'yoke', 'flange' | ambient",
    ),
    "a capacity of zero": (network("C_J_K = 2000", "C_J_K = 0"), "C_J_K = 0 | 1e-09 to 1e+10"),
    "a factor down to next to nothing": (parameter("low = 1e-300"), "low = 1e-300 | 1e-12"),
    "no capacity": (
        lambda case: [edited(case / "network.toml", f"C_J_K = {C}", "") for C in (2000, 6000, 3000)],
        "no node has a heat capacity",
    ),
    "stream in a loop": (
        network(
            "[losses.copper]", '[streams.x]\npath = ["ambient", "yoke", "flange", "yoke"]\nmcp_W_K = 5\n[losses.copper]'
        ),
        "streams.x | 'yoke' 2 times | circuits",
    ),
    "shares that make more than a whole": (
        network('at = "winding"', "at = { winding = 0.7, yoke = 0.7 }"),
        "sum to 1.4",
    ),
    "negative share": (network('at = "winding"', "at = { winding = 1.5, yoke = -0.5 }"), "= 1.5"),
    "capacity of 5000 digits": (network("C_J_K = 2000", f"C_J_K = {'9' * 5000}"), "network.toml"),
    "runaway": (network("R20_ohm = 0.02", "R20_ohm = 2"), "winding | thermal runaway | copper"),
    "bounds that cross": (parameter("low = 2\nhigh = 0.5"), "parameters.x | low = 2 | high = 0.5"),
    "value outside its bounds": (parameter("value = 9\nlow = 0.5\nhigh = 5"), "parameters.x | value = 9"),
    "model beyond its bounds": (model('"link.yoke-air" = 5000'), "revision 1 | link.yoke-air | 0.001 to 1000"),
}


@pytest.mark.parametrize(("spoil", "words"), REFUSED.values(), ids=REFUSED)
def test_one_line_exit_2_files_as_before(tmp_path, spoil, words):
    case = case_of(tmp_path)
    spoil(case)
    before = contents(tmp_path)
    done = answered("compare", case)
    assert (done.code, done.out, len(done.errors)) == (2, "", 1)
    assert [word for word in words.split(" | ") if word not in done.errors[0]] == []
    assert contents(tmp_path) == before


@pytest.mark.parametrize(
    ("option", "name", "words"),
    [
        *(("--json", "case.toml", "stays"), ("--json", "tests/stand.csv", "stays")),
        *(("--json", "tests", "not a file"), ("--json", "", "not a file"), ("--out", ".", "inputs")),
        *(("--out", "tests", "inputs"), ("--out", "case.toml", "not a folder")),
    ],
)
def test_results_never_go_over_inputs(tmp_path, option, name, words):
    case = case_of(tmp_path)
    before = contents(tmp_path)
    target = case / name if name else ""
    command = "compare" if option == "--json" else "simulate"
    done = answered(command, case, option, target)
    assert (done.code, done.out, len(done.errors)) == (2, "", 1)
    assert words in done.errors[0]
    assert contents(tmp_path) == before


def test_a_document_may_be_written_again(tmp_path):
    case = case_of(tmp_path)
    for _ in range(2):
        assert answered("compare", case, "--json", tmp_path / "result.json")[0] == 1
    assert (tmp_path / "result.json").read_text().startswith("{")
