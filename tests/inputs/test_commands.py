"""Options, drive cycles, loss maps and recordings of `new`: what makes no sense is refused before anything is done."""

import os
import tomllib

import pytest
from command_line import answered, refusal
from input_cases import ROOT, case_of

from lumped.declarations.network import read_network
from lumped.model.build import node_source
from lumped.sources.loss_laws import PowerLoss

CYCLE = "[cycle]\nstep_s = 10\n[boundaries]\nambient = 20\n"
DUTY = '[duty]\ntype = "S3"\nperiod_s = 600\nduty_percent = 40\ncycles = 3\nstep_s = 10\n[load]\ncurrent_A = 100\n'
COLUMN = '[columns.I]\nquantity = "current"\nunit = "A"\n'
ROWS = "t,I\n" + "".join(f"{10 * i},100\n" for i in range(30))
MAP = "torque_Nm,speed_rpm,copper_W\n"
POINTS = [(q, n) for q in (0, 50, 100) for n in (0, 1000, 2000)]
RATE = "use rate {case} --limit winding=155 --no-bands"
OPTIONS = {
    "test compare no-such-case": "hust-ipmsm",
    "compare {case} {case}": "extra argument",
    "test compare {case} --jsn -": "--jsn",
    "test compare {case} --json /": "is not a file to write to",
    "use simulate {case} --out {case}/tests/x": "a case keeps its inputs there",
    "use simulate {case} --out {case}/case.toml": "is not a folder",
    "use simulate {case} --cycle nosuch": "no such cycle",
    "model calibrate {case} --seed -1": "--seed",
    "model calibrate {case} --profile nosuch": "'nosuch' is not a free parameter",
    "model add {case} convektion@flange": "did you mean 'convection'?",
    "model add {case} convection@mars": "it can sit at",
    "model add {case} convection": "needs a place: convection@PLACE",
    "model add {case} event@0": "no event '0'",
    "model remove {case} convection@flange": "not in the model",
    "model undo {case}": "no step to undo",
    "model undo {case} --to 5": "no revision 5",
    "explain answer {case} maybe": "is not an answer",
    "explain answer {case} yes": "asked nothing",
    "explain answer {case} yes --about mars": "not a test, event or fault",
    "use export {case} --as pdf": "not a form to export",
    "use export {case} --as fmu --fmi 5": "2 or 3",
    "use export {case} --as c --limit winding": "is not a limit",
    "use export {case} --as c --limit winding=3 --limit winding=4": "given twice",
    "use rate {case}": "no limit is given",
    "use rate {case} --limit winding=nan": "is not a limit",
    "use rate {case} --limit winding=10 --no-bands": "without any load",
    f"{RATE} --load mars": "is not an input",
    f"{RATE} --at mars=3": "is not an input or boundary",
    f"{RATE} --at ambient=nan": "is not an operating point",
    f"{RATE} --overload inf": "--overload",
    f"{RATE} --voltage 100": "is of a loss map",
    f"{RATE} --losses nosuch.csv": "no such file",
    "bench curves {case} --against nosuch": "unknown test 'nosuch'",
    "bench curves {case} --against stand --test stand": "no other test than stand",
    "bench curves {case} --against stand --test road": "its load varies",
    "bench curves {case} --test stand": "is for two tests",
    "bench two-paths {case} --winding yoke --machine yoke": "'yoke' is both",
    "bench two-paths {case} --winding mars --machine yoke": "unknown place",
    "bench bases {case}": "no bases",
    "bench carry {case} nosuch": "no such case folder",
    "bench screen pmsm-m1 --design nosuch": "no design",
    "model build nosuch": "no such machine",
    "model build {case}/network.toml": "unknown section",
    "show viewer {case}": "no geometry",
    "show film {case} --out new/f.gif": "no geometry",
    "show viewer road-test --out v.png": "is not a name",
    "show film road-test --out f.avi": "is not a name",
    "show serve {case} --port 99999": "--port",
    "show serve tcalb": "did you mean 'tclab'?",
    "test doctor {case}/tests/stand.csv": "is a file",
}


@pytest.fixture(scope="module")
def shared(tmp_path_factory):
    return case_of(tmp_path_factory.mktemp("commands"))


@pytest.mark.parametrize("words", OPTIONS, ids=OPTIONS)
def test_an_option_without_sense_is_refused(shared, tmp_path, monkeypatch, words):
    monkeypatch.chdir(tmp_path)
    assert OPTIONS[words] in refusal(shared.parent, *(word.format(case=shared) for word in words.split()))


def test_a_port_of_another_computer(shared, monkeypatch):
    monkeypatch.setattr("extras.workbench.serve.prepare", lambda: None)
    message = refusal(shared.parent, "show", "serve", shared, "--host", "nosuch.invalid")
    assert "--host nosuch.invalid" in message


def duty(old="", new=""):
    return CYCLE + DUTY.replace(old, new), None


def columns(rows=ROWS, head="", more="", step="10"):
    return CYCLE.replace("step_s = 10", f'step_s = {step}\ntime = "t"\n{head}') + COLUMN + more, rows


CYCLES = {
    "no duty type": (duty("S3", "S9"), "type = 'S9'"),
    "without end": (duty("cycles = 3", "cycles = 100000"), "instants"),
    "no load": (duty("current_A = 100", ""), "no input follows"),
    "a load twice": ((CYCLE + "[inputs]\ncurrent_A = 5\n" + DUTY, None), "'current_A' is given twice"),
    "no surroundings": ((CYCLE.replace("ambient = 20", "") + DUTY, None), "nothing gives the boundary"),
    "a slip": ((CYCLE.replace("ambient = 20", "ambient = 20\nwater = 30") + DUTY, None), "is called 'water'"),
    "nothing": (("", None), "'time' is missing"),
    "a long hole": (columns("t,I\n" + "".join(f"{10 * i},{'' if 3 < i < 27 else 100}\n" for i in range(30))), "I"),
    "milliseconds": (columns(head='time_unit = "ms"'), "1.03 instants"),
    "a node as its surroundings": (
        columns(
            ROWS.replace("t,I", "t,I,T").replace(",100", ",100,20"),
            more=('[columns.T]\nquantity = "temperature"\nunit = "degC"\nplace = "yoke"\n'),
        ),
        "no boundary is called 'yoke'",
    ),
    "two currents": (
        columns(ROWS.replace("t,I", "t,I,J").replace(",100", ",100,20"), more=COLUMN.replace("I]", "J]")),
        "fed twice",
    ),
    "a duty and columns": ((columns()[0] + DUTY, ROWS), "unknown key 'time'"),
    "half a machine": (columns(more="[pm-machine]\npole_pairs = 4\n"), "pm-machine"),
}


@pytest.mark.parametrize(("files", "words"), CYCLES.values(), ids=CYCLES)
def test_a_cycle_that_cannot_be_run_is_refused(tmp_path, files, words):
    case = case_of(tmp_path)
    (case / "cycles").mkdir()
    text, rows = files
    (case / "cycles/x.toml").write_text(text)
    if rows is not None:
        (case / "cycles/x.csv").write_text(rows)
    message = refusal(tmp_path, "use", "simulate", case, "--cycle", "x")
    assert "cycles" + os.sep + "x." in message
    assert words in message


def test_what_a_cycle_says_and_nobody_reads_is_told(tmp_path):
    case = case_of(tmp_path)
    (case / "x.toml").write_text(CYCLE + DUTY.replace("current_A = 100", "current_A = 100\nfan_on = 1"))
    code, _, err = answered("use", "simulate", case, "--cycle", case / "x.toml", "--no-bands")
    assert code == 0
    assert [
        line for line in err.splitlines() if line.startswith("note: ") and "no law of the model reads 'fan_on'" in line
    ]


MAPS = {
    "nothing": ("", "is empty"),
    "a hole": (MAP + "".join(f"{q},{n},{q}\n" for q, n in POINTS[:-1]), "1 of 9 points are missing"),
    "a point twice": (MAP + "".join(f"{q},{n},{q}\n" for q, n in [*POINTS, POINTS[0]]), "given twice"),
    "cold": (MAP + "".join(f"{q},{n},{-q}\n" for q, n in POINTS), "negative"),
    "another loss": (MAP.replace("copper", "iron") + "".join(f"{q},{n},{q}\n" for q, n in POINTS), "is not a loss"),
    "no loss": ("torque_Nm,speed_rpm\n" + "".join(f"{q},{n}\n" for q, n in POINTS), "no losses"),
    "semicolons": (MAP.replace(",", ";") + "1;2;3\n", "separated by ';'"),
    "two voltages": (
        MAP.replace("copper_W", "voltage_V,copper_W")
        + "".join(f"{q},{n},{v},{q}\n" for v in (1, 2) for q, n in POINTS),
        "2 voltages",
    ),
}


@pytest.mark.parametrize(("text", "words"), MAPS.values(), ids=MAPS)
def test_a_loss_map_that_is_none_is_refused(tmp_path, text, words):
    case = case_of(tmp_path)
    (case / "map.csv").write_text(text, encoding="utf-8")
    message = refusal(tmp_path, "use", "rate", case, "--limit", "winding=155", "--losses", case / "map.csv")
    assert "map.csv" in message
    assert words in message


LOSSES = {
    "no kind": ("{ at = 'base', P_W = 3 }", "'kind' is missing"),
    "a kind unheard of": ("{ at = 'base', kind = 'magic', P_W = 3 }", "kind = 'magic'"),
    "more than a whole": ("{ at = { base = 0.7, foot = 0.7 }, kind = 'constant', P_W = 3 }", "sum to 1.4"),
}


@pytest.mark.parametrize(("declared", "words"), LOSSES.values(), ids=LOSSES)
def test_losses_of_a_machine_are_checked_before_it_is_meshed(tmp_path, monkeypatch, declared, words):
    monkeypatch.setattr("lumped.build.pipeline.build_mesh", lambda *given: pytest.fail("it was meshed"))
    text = (ROOT / "cases/pmsm-bases/machine.toml").read_text()
    (tmp_path / "mine.toml").write_text(text.replace("[losses.", f"[losses]\nx = {declared}\n[losses.", 1))
    for command in ("model build", "model crosscheck", "use rate --limit winding=155"):
        message = refusal(tmp_path, *command.split(), tmp_path / "mine.toml")
        assert str(tmp_path / "mine.toml") in message
        assert "losses.x" in message
        assert words in message


def test_a_machine_without_losses_is_held_against_nothing(tmp_path, monkeypatch):
    """A made-up loss would make measurements accuse the cooling; `rate` says what it assumes."""
    case = case_of(tmp_path)
    heat = ("assumed", "constant", {"winding": 1.0}, PowerLoss(((100.0, ()),)))
    network = read_network(tomllib.loads((case / "network.toml").read_text().partition("[losses")[0]))
    assumed = network.extended([], [node_source(network, "loss:assumed", heat[1], heat[2], heat[3], "winding")], [])
    monkeypatch.setattr("thermoscope.case_folder.folder.network_of", lambda *_: (assumed, None))
    assert "declares no losses" in refusal(tmp_path, "test", "compare", case)
    (case / "case.toml").write_text('[case]\nnetwork = "network.toml"\n')
    _, _, err = answered("use", "rate", case, "--limit", "winding=155", "--no-bands")
    assert [
        line for line in err.splitlines() if line.startswith("note: ") and "100 W in its windings are assumed" in line
    ]


def test_a_rating_without_end_is_said_in_words(tmp_path):
    case = case_of(tmp_path)
    (case / "map.csv").write_text(MAP + "".join(f"{q},{n},{q / 100}\n" for q, n in POINTS))
    code, out, _ = answered("use", "rate", case, "--limit", "winding=155", "--losses", case / "map.csv", "--no-bands")
    assert code == 0
    assert out.startswith("Continuous: no torque_Nm that this model knows reaches a limit.")


def record(make, head="time,T winding,I"):
    return head + "\n" + "".join(f"{make(i)}\n" for i in range(60))


RECORDS = {
    "nothing": ("", "not a record"),
    "words": ("t,T\n" + "x,y\n" * 50, "not a record"),
    "a clock that runs back": (record(lambda i: f"{i % 10},{20 + i},5"), "runs back"),
    "a century": (record(lambda i: f"{i * 1e9},{20 + i},5"), "at most a year"),
    "only air": (record(lambda i: f"{i},{20 + i},5", "time,T ambient,I"), "no column is a temperature"),
    "a reversed clamp": (record(lambda i: f"{i},{20 + i},-5", "time,T winding,Power"), "is a clamp reversed?"),
}


@pytest.mark.parametrize(("text", "words"), RECORDS.values(), ids=RECORDS)
def test_a_record_that_is_none_is_refused(tmp_path, text, words):
    (tmp_path / "mine.csv").write_text(text)
    message = refusal(tmp_path, "test", "new", tmp_path / "mine.csv", "--yes", "--out", tmp_path / "made")
    assert "mine.csv" in message
    assert words in message
    assert [p.name for p in tmp_path.iterdir()] == ["mine.csv"]


NEW = {
    "--set ambient=nan": "is not a NAME=VALUE",
    "--set mars=3": "the model reads no",
    "--set ambient=1e9": "ambient = 1000000000",
    "--from 5000": "never all run in the part asked for",
    "--from 100 --to 50": "100 is not before 50",
    "--to inf": "--to",
    "--period 0": "--period",
    "--machine pmsm-m1": "one of the two",
    "--json {case}/case.toml": "it stays",
}


@pytest.mark.parametrize("words", NEW, ids=NEW)
def test_a_wish_of_new_without_sense_is_refused(shared, words):
    given = [word.format(case=shared) for word in words.split()]
    files = [shared / "tests/stand.csv", "--yes", "--network", shared / "network.toml", "--out", shared.parent / "made"]
    assert NEW[words] in refusal(shared.parent, "test", "new", *files, *given)


@pytest.mark.parametrize("where", ["tests/x", "../" + "m" * 300])
def test_a_new_case_goes_nowhere_else(shared, where):
    files = [shared / "tests/stand.csv", "--yes", "--network", shared / "network.toml"]
    assert "; " in refusal(shared.parent, "test", "new", *files, "--out", shared / where)
