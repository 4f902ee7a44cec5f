"""docs/how-to/oil-cooling.md, done: its network at three flows, and what a diagnosis says of nozzles that are blocked.

The readings come from another network than the one that is diagnosed: two nodes at the rear, three cells, and faces of
which a share is dry while the pump holds the flow.
"""

import copy
import re
import tomllib
from pathlib import Path

import numpy as np
import pytest
from command_line import answered

from lumped.declarations.network import read_network
from lumped.integration.simulate import Record, simulate
from lumped.integration.steady import steady

PAGE = (Path(__file__).parents[3] / "docs" / "how-to" / "oil-cooling.md").read_text(encoding="utf-8")
TEXT = next(block for block in re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL) if block.startswith("[network]"))
REAR, FRONT = "end winding rear", "end winding front"
SEEN = (REAR, FRONT, "slot winding", "core", "rotor", "spray.outlet")
COLUMNS = {f"T_{k}": place for k, place in enumerate(SEEN)}


def rows(first):
    lines = PAGE[PAGE.index(f"| {first} |") :].split("\n\n")[0].splitlines()[2:]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]


def hidden(rear, front):
    """Nozzles of 8 that give oil at the rear and in front."""
    truth = copy.deepcopy(tomllib.loads(TEXT))
    truth["nodes"] |= {REAR: {"C_J_K": 450.0, "role": "winding"}, "crown": {"C_J_K": 450.0, "role": "winding"}}
    truth["links"]["crown"] = {"between": [REAR, "crown"], "G_W_K": 120.0}
    truth["losses"]["copper"]["at"] = {"slot winding": 0.5, REAR: 0.125, "crown": 0.125, FRONT: 0.25}
    spray = truth["circuits"]["spray"]
    spray["cells"] = 3
    for one, open_ in zip(spray["passes"], (rear, front), strict=True):
        one |= {"nozzles": open_, "area_m2": one["area_m2"] * open_ / 8}
    spray["passes"][0]["wall"] = {REAR: 0.5, "crown": 0.5}
    spray["passes"] = [one for one in spray["passes"] if one["nozzles"]]
    return read_network(truth)


def readings(net, seed, warm):
    """Of 90 minutes with current, speed, flow and oil in steps: (n, 12) rows, noise 0.2 K."""
    rng, time = np.random.default_rng(seed), np.arange(0.0, 5400.0, 10.0)

    def steps(low, high, n):
        return rng.uniform(low, high, n)[np.minimum((time * n / 5400).astype(int), n - 1)]

    given = {"current_A": steps(100, 220, 7), "speed_rpm": steps(1000, 4000, 6), "flow_l_min": steps(3, 7, 5)}
    air, oil = np.full_like(time, 25.0), warm + steps(-5, 5, 3)
    z = simulate(net, Record(time, given, {"ambient": air, "oil": oil}, 60.0), keep_states=True).z
    each = [z[:, net.column(place)] for place in SEEN]
    each[0] = 0.5 * (each[0] + z[:, net.column("crown")])
    noisy = [T + 0.2 * rng.standard_normal(time.size) for T in each]
    return np.column_stack([time, *given.values(), air, oil, *noisy])


def case(folder, rear, front):
    (folder / "tests").mkdir()
    net = hidden(rear, front)
    (folder / "network.toml").write_text(TEXT)
    roles = "".join(f'[tests.{name}]\nrole = "{role}"\n' for name, role in (("a", "calibrate"), ("b", "validate")))
    (folder / "case.toml").write_text(f'[case]\nname = "oil"\nnetwork = "network.toml"\nsample_s = 20\n{roles}')
    meters = (("current", "current", "A"), ("speed", "speed", "rpm"), ("flow", "water_flow", "l/min"))
    sheet = '[test]\ntime = "time_s"\ndescription = "simulated"\n' + "".join(
        f'[columns.{name}]\nquantity = "{quantity}"\nunit = "{unit}"\n' for name, quantity, unit in meters
    )
    places = {"air": "ambient", "oil_in": "oil", **COLUMNS}
    for name, place in places.items():
        sheet += f'[columns.{name}]\nquantity = "temperature"\nunit = "degC"\nplace = "{place}"\n'
    head = ",".join(["time_s", "current", "speed", "flow", *places])
    for name, seed, warm in (("a", 1, 70.0), ("b", 2, 60.0)):
        (folder / "tests" / f"{name}.toml").write_text(sheet)
        table = folder / "tests" / f"{name}.csv"
        np.savetxt(table, readings(net, seed, warm), delimiter=",", header=head, comments="", fmt="%.3f")
    return folder


def test_the_table_of_the_page():
    net = read_network(tomllib.loads(TEXT))
    for flow, *printed in rows("flow (l/min)"):
        given = {"flow_l_min": float(flow), "current_A": 200.0, "speed_rpm": 3000.0}
        rest = steady(net, given, {"ambient": 25.0, "oil": 70.0})
        found = [rest[place] for place in (REAR, "slot winding", "rotor", "spray.outlet")]
        assert [float(cell) for cell in printed] == pytest.approx(found, abs=0.06)
        assert rest[REAR] == pytest.approx(rest[FRONT], abs=1e-6)


HIDDEN = dict(zip((row[0] for row in rows("what is hidden")), ((4, 8), (8, 0), (4, 4), (8, 8)), strict=True))


@pytest.mark.heavy
@pytest.mark.parametrize("row", rows("what is hidden"), ids=lambda row: row[0])
def test_what_is_blocked_is_named(row, tmp_path):
    what, printed, size = row
    found = answered("diagnose", case(tmp_path, *HIDDEN[what]), "--json", "-").document
    if not size:
        assert (found["verdict"], found["named"]) == ("adequate", [])
        return
    first = found["candidates"][0]
    assert first["words"] == printed
    assert found["named"][0] == first["effect"]
    assert all("film:spray" in name for name in found["named"][1:])
    numbers = [float(x) for x in re.findall(r"-\d+\.\d+", size)]
    found_size = first["amplitude"]
    assert [found_size["value"], *found_size["ci95"]] == pytest.approx(numbers, abs=0.02)
