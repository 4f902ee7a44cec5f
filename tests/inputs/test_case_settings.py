"""case.toml, sheets, network.toml and model.toml that contradict themselves or the data: refused, or said."""

import os

import pytest
from command_line import answered, refusal
from input_cases import STAND, case_of, named, network, settings, sheet

from thermoscope.commands.open_case import fingerprint

TIME = 'time = "time_s"'
COPPER = 'kind = "copper"\nR20_ohm = 0.02\ncurrents = ["current_A"]'
STEP = '[[revision]]\nnumber = 1\naction = "calibrate"\neffects = []\n'


def more(file, text):
    return lambda case: (case / file).write_text((case / file).read_text() + text)


def before_losses(text):
    return network("[losses.copper]", f"{text}\n[losses.copper]")


def loss(text):
    return network(COPPER, text)


def model(text):
    return lambda case: (case / "model.toml").write_text(text)


def mapped(at_speed, at_torque, P_W):
    return loss(f'kind = "map"\nat_speed = {at_speed}\nat_torque = {at_torque}\nP_W = {P_W}')


def events(rows):
    def write(case):
        more(STAND, '[events.fan_on]\nfile = "ev.csv"\n')(case)
        (case / "tests/ev.csv").write_text(rows)

    return write


def sensor(line):
    return sheet("sigma_K = 0.4", line)


def node(name):
    link = f'[links.more]\nbetween = ["{name}", "yoke"]\nG_W_K = 1'
    return before_losses(f'[nodes."{name}"]\nC_J_K = 3\n{link}')


NODES = {f"a node called {name!r}": node(name) for name in ("", "a@b", " x")}
CASES = {
    "a case named over two lines": (settings('"three"', '"a\\nb"'), "case.toml | one line"),
    "frees nothing": (more("case.toml", "[calibration]\nfree = []\n"), "case.toml | free = [] names nothing"),
    "frees the same twice": (more("case.toml", '[calibration]\nfree = ["link.*", "link.*"]\n'), "'link.*' twice"),
    "a test frees what is not there": (
        settings("[tests.stand]", '[tests.stand]\nfrees = ["x.*"]'),
        "'x.*' frees nothing | stand",
    ),
    "no such kind": (more("case.toml", '[diagnosis]\ncatalogue = ["zzz*"]\n'), "case.toml | 'zzz*'"),
    "no such line of doubt": (more("case.toml", "[doubt]\nxyz = 3\n"), "case.toml | xyz"),
    "a mesh of a network": (settings("sample_s = 20", "axial_mm = 40"), "axial_mm | network"),
    "a test named as a device": (named("CON"), "case.toml | 'CON' | devices"),
    "a test with a name of many bytes": (named("\u00e9" * 60), "case.toml | up to 100"),
    "a file name without end": (
        settings("[tests.stand]", f'[tests.stand]\nfile = "tests/{"x" * 5000}.csv"'),
        "tests | a shorter name",
    ),
    "a sample longer than the test": (settings("sample_s = 20", "sample_s = 5000"), "sample_s"),
    "no table of tests": (settings("[tests.stand]", "[tests]\nx = 3\n[tests.stand]"), "tests.x"),
}
SHEETS = {
    "a time that does not rise": (sheet(TIME, 'time = "T_winding"'), "T_winding | line | sort"),
    "no clock": (sheet(TIME, ""), f"{STAND} | 'time' is missing"),
    "two clocks": (sheet(TIME, f"{TIME}\nperiod_s = 10"), f"{STAND} | unknown key 'time'"),
    "a part that runs backwards": (sheet(TIME, f"{TIME}\nfrom_s = 50\nto_s = 20"), f"{STAND} | from_s = 50"),
    "a part of two rows": (sheet(TIME, f"{TIME}\nto_s = 10"), f"{STAND} | 2 rows"),
    "a start of a place that is not there": (sheet(TIME, f"{TIME}\ninitial = {{ mars = 20 }}"), "'mars'"),
    "a start in words": (sheet(TIME, f'{TIME}\ninitial = "cold"'), f"{STAND} | 'cold' | first-readings"),
    "columns of no sheet": (sheet(TIME, f'{TIME}\ncolumns_of = "no.toml"'), "no.toml | no such file"),
    "an input that is the clock": (more(STAND, "[inputs]\ntime_s = 3\n"), f"{STAND} | 'time_s' is the clock"),
    "a mean at the air": (more(STAND, '[means.M]\nof = ["T_yoke"]\nplace = "ambient"\n'), "'ambient' is a boundary"),
    "a root of a temperature": (more(STAND, '[root_sum_square]\nI_A = ["T_yoke"]\n'), f"{STAND} | 'T_yoke'"),
    "a recorder that is the test": (more(STAND, '[recorders.x]\nfile = "stand.csv"\n'), f"{STAND} | recorded twice"),
    "a position in a plane": (sensor("position_mm = [1, 2]"), f"{STAND} | position_mm = [x, y, z]"),
    "a unit of another country": (sheet('unit = "degC"', 'unit = "Celsius"'), f"{STAND} | 'Celsius' | degC"),
    "kelvin for degrees": (
        sheet('unit = "degC"\nplace = "ambient"', 'unit = "K"\nplace = "ambient"'),
        "stand.csv | line 2 | unit",
    ),
    "kiloamperes": (sheet('unit = "A"', 'unit = "kA"'), "network.toml | runaway | units of their inputs"),
    "no cold resistance": (
        sheet(
            'quantity = "temperature"\nunit = "degC"\nplace = "winding"',
            'quantity = "resistance"\nunit = "ohm"\nplace = "winding"',
        ),
        f"{STAND} | cold",
    ),
    "ohms beyond the meter": (
        sheet(
            'quantity = "temperature"\nunit = "degC"\nplace = "winding"',
            'quantity = "resistance"\nunit = "ohm"\nplace = "winding"\ncold = { reading = 20, at_degC = 20 }',
        ),
        "stand.csv | T_winding | ohm",
    ),
    **{
        f"an event of {value}": (
            more(STAND, f"[events.fan_on]\nat_s = [0, 100]\nvalue = [0, {value}]\n"),
            f"{STAND} | events.fan_on | not a state",
        )
        for value in ('"maybe"', "[1]", "nan", "9" * 400)
    },
    "events that begin late": (more(STAND, '[events.x]\nat_s = [5]\nvalue = ["on"]\n'), f"{STAND} | at the start"),
    "events that go back": (more(STAND, "[events.x]\nat_s = [0, 9, 3]\nvalue = [0, 1, 0]\n"), f"{STAND} | rises"),
    **{
        f"an events file with {kind}": (events(rows), f"ev.csv | {words}")
        for kind, rows, words in (
            ("no column", "time_s,x\n0,off\n", "'fan_on' is not in the file"),
            ("a word for a time", "time_s,fan_on\nnow,off\n", "line 2"),
            ("nothing", "", "is empty"),
            ("a time before", "time_s,fan_on\n-5,off\n0,on\n", "at the start"),
        )
    },
    "events of a column's input": (more(STAND, "[events.current_A]\nat_s = [0]\nvalue = [1]\n"), "fed twice"),
}
NETWORKS = {
    **{kind: (spoil, "network.toml | [nodes] | cannot be a name") for kind, spoil in NODES.items()},
    "a link with an at sign": (before_losses('[links."a@b"]\nbetween = ["yoke", "ambient"]\nG_W_K = 1'), "'a@b'"),
    "a boundary twice": (network('["ambient"]', '["ambient", "ambient"]'), "'ambient' twice"),
    "a boundary that is a node": (network('["ambient"]', '["ambient", "yoke"]'), "'yoke' is a node"),
    "a node joined to itself": (network('["winding", "yoke"]', '["yoke", "yoke"]'), "two different"),
    "a loss at a boundary": (network('at = "winding"', 'at = "ambient"'), "loss:copper | boundary"),
    "a loss at nothing": (network('at = "winding"', "at = {}"), "losses.copper | sum to 0"),
    "a division by rest": (
        loss('kind = "constant"\nP_W = 10\nof = { input = "vehicle_speed_mps", exponent = -1 }'),
        "loss:copper | vehicle_speed_mps | no negative exponent of 0",
    ),
    "a gigawatt": (loss('kind = "constant"\nP_W = 1e9'), "network.toml | passes 3000 degC | check the units"),
    "a map turned over": (mapped([0, 1000, 2000], [0, 10], [[1, 2, 3], [4, 5, 6]]), "losses.copper | no | grid"),
    "a map that falls": (mapped([1000, 0], [0, 10], [[1, 2], [3, 4]]), "losses.copper | rising"),
    "a map that cools": (mapped([0, 1000], [0, 10], [[1, 2], [3, -4]]), "losses.copper | P_W[1][1] = -4"),
    "a parameter of nothing": (before_losses("[parameters.x]\nacts_on = []"), "parameters.x | names nothing"),
    "a parameter twice": (
        before_losses('[parameters."link.yoke-air"]\nacts_on = ["link:yoke-air"]'),
        "two parameters | 'link.yoke-air'",
    ),
    "a parameter of what is not there": (before_losses('[parameters.x]\nacts_on = ["link:x"]'), "'link:x' | known"),
    "a mean of no node": (before_losses("[means.m]\nof = {}"), "means.m | averages nothing"),
    "a stream past nothing": (before_losses('[streams.x]\npath = ["ambient", "mars"]\nmcp_W_K = 5'), "mars"),
}
MODELS = {
    "an effect twice": (model(STEP.replace("[]", '["convection@flange", "convection@flange"]')), "twice"),
    "an effect that is not there": (model(STEP.replace("[]", '["warp@yoke"]')), "unknown effect 'warp'"),
    "an interval turned over": (model(f'{STEP}intervals = {{ "link.yoke-air" = [2.0, 1.0] }}\n'), "not an interval"),
    "an interval of no value": (model(f'{STEP}intervals = {{ "link.yoke-air" = [1.0, 2.0] }}\n'), "has no value"),
    "no number": (model(STEP.replace("number = 1", "number = 1.5")), "number = 1.5"),
    "a number left out": (model(STEP + STEP.replace("number = 1", "number = 3")), "not numbered"),
    "answers in words": (model(f'{STEP}answers = {{ x = "yes" }}\n'), "x = 'yes' | true or false"),
    "a folder": (lambda case: (case / "model.toml").mkdir(), "is not a file"),
    "a link to nowhere": (lambda case: (case / "model.toml").symlink_to("/nowhere/model.toml"), "no such file"),
}
REFUSED = {
    **{f"case: {kind}": spoilt for kind, spoilt in CASES.items()},
    **{f"sheet: {kind}": spoilt for kind, spoilt in SHEETS.items()},
    **{f"network: {kind}": spoilt for kind, spoilt in NETWORKS.items()},
    **{f"model: {kind}": (spoil, f"model.toml | {words}") for kind, (spoil, words) in MODELS.items()},
}


@pytest.mark.parametrize(("spoil", "words"), REFUSED.values(), ids=REFUSED)
def test_refused_in_one_line_with_its_place(tmp_path, spoil, words):
    case = case_of(tmp_path)
    spoil(case)
    message = refusal(tmp_path, "test", "compare", case)
    assert [word for word in words.split(" | ") if word not in message] == []


SAID = {
    "a start far from the readings": (sheet(TIME, f"{TIME}\ninitial = 500"), "the sheet says initial = 500"),
    "a sensor that knows nothing": (sensor("sigma_K = 60"), "its sigma_K = 60 is more than it moves"),
    "a lag longer than the test": (sensor("lag_s = 3600"), "its lag of 3600 s is longer than the test (2990 s)"),
    "an event after the end": (more(STAND, '[events.fan_on]\nat_s = [0, 1e6]\nvalue = ["off", "on"]\n'), "has ended"),
    "an event nobody reads": (more(STAND, "[events.fan_on]\nat_s = [0]\nvalue = [1]\n"), "fan_on: no law"),
    "no loss": (
        lambda case: (case / "network.toml").write_text((case / "network.toml").read_text().partition("[losses")[0]),
        "the network has no loss: nothing heats it",
    ),
    "a loss of nothing": (network(COPPER, 'kind = "constant"\nP_W = 0'), "no loss of the network gives"),
    "an input nobody reads": (more(STAND, "[inputs]\nyoke = 20\n"), "no law of the model reads 'yoke'"),
}


@pytest.mark.parametrize(("change", "note"), SAID.values(), ids=SAID)
def test_accepted_with_a_note(tmp_path, change, note):
    case = case_of(tmp_path)
    change(case)
    done = answered("test", "compare", case, "--no-bands")
    assert done.code == 1
    assert "three, revision 0" in done.out
    assert [line for line in done.notes if note in line]


def test_what_else_lies_in_a_case_does_not_matter(tmp_path):
    """A name that is not text, a pipe, a link to the folder itself, a film of 2 GB (with holes)."""
    case = case_of(tmp_path)
    with open(os.fsencode(case) + b"/\xff\xfe.txt", "wb"):
        pass
    os.mkfifo(case / "pipe")
    (case / "loop").symlink_to(case)
    with (case / "film.bin").open("wb") as film:
        film.truncate(2 * 10**9)
    assert len(fingerprint(case)) == 64
