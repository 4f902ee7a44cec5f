"""Which base a machine stood on: forgotten, invented and exchanged ones, by a small machine."""

from dataclasses import replace

import numpy as np
import pytest

from geom.description.roles import Role, identity
from geom.errors import InputError
from lumped.integration.simulate import Record, simulate
from lumped.machine.bases import Switched
from lumped.model.build import bare_network, node_link, node_row, node_source
from lumped.model.network import Parameter
from lumped.transfer.laws import Fixed, Radiation
from measured.case import Case, Channel, Model, Test
from validation import diagnose
from validation.bases.base_heat import base_heat
from validation.bases.which_base import base_hypotheses, on_base, which_base, wrong_bases

NODES = {"winding": 2.4e3, "stator.core": 2.5e4, "foot": 900.0, "base": 1.2e4, "foot.plate": 900.0, "base.plate": 2e4}
BASES = {"bench": "on_bench", "plate": "on_plate"}
SHINES = Fixed(0.1, Radiation())
AREA = {"base": 0.6, "base.plate": 1.2}  # m2


def machine():
    """Winding, laminations and two bases, W/K each; the plate's path is twice the bench's."""
    feet, plates = dict.fromkeys(("foot", "foot.plate"), Role.FOOT), dict.fromkeys(AREA, Role.BASE)
    said = {name: identity(role) for name, role in (feet | plates).items()}
    net = replace(bare_network("small", NODES, ["ambient"]), declared=said)
    links = [
        node_link(net, "slot", "link", "winding", "stator.core", Fixed(9.0)),
        node_link(net, "film:stator.core", "film", "stator.core", "ambient", Fixed(2.2)),
    ]
    for name, (foot, base, h) in {"bench": ("foot", "base", 1.0), "plate": ("foot.plate", "base.plate", 2.5)}.items():
        law = Switched(Fixed(5.0), f"on_{name}", True)
        links += [
            node_link(net, f"joint:{name}", "contact", "stator.core", foot, law),
            node_link(net, f"seat:{name}", "contact", foot, base, Fixed(8.0)),
            node_link(net, f"film:{base}:natural", "film", base, "ambient", Fixed(h)),
            node_link(net, f"film:{base}:radiation", "film", base, "ambient", SHINES, AREA[base]),
        ]
    heat = node_source(net, "loss:copper", "copper", {"winding": 1.0}, Fixed(220.0))
    names = ("slot", "film:stator.core", "joint:bench", "joint:plate", "film:base:natural", "film:base.plate:natural")
    own = [Parameter(f"h.{n}", ((n, 1.0),), prior_sd=0.2, low=0.05, high=20.0) for n in names]
    return net.extended(links, [heat], own)


NETWORK = machine()
KINDS = ("convection", "conduction.bench", "sensor.drift", "sensor.gain")
HIDDEN = {"h.film:stator.core": 1.12, "h.joint:bench": 0.85, "h.film:base:natural": 1.1, "h.slot": 0.93}


def measured(name, base, role="calibrate", seed=0):
    """10 h under load; readings with 0.8 K that all readings of a sensor share."""
    time = np.arange(0.0, 36001.0, 600.0)
    inputs = {switch: np.full(time.size, float(base == one)) for one, switch in BASES.items()}
    air = {"ambient": np.full(time.size, 20.0)}
    rows = [node_row(0), node_row(1)]
    y = simulate(NETWORK, Record(time, inputs, air, 20.0), HIDDEN, rows).y
    off = np.random.default_rng(seed).normal(0.0, 0.8, 2)
    channels = tuple(
        Channel(f"{place}@{name}", place, row, y[:, j] + off[j], 0.8)
        for j, (place, row) in enumerate(zip(("winding", "stator.core"), rows, strict=True))
    )
    return Test(name, role, time, inputs, air, channels, 20.0)


def case(**said):
    """Three tests on wood, bench and plate; `said` is what a sheet says of one instead."""
    tests = [measured(n, b, seed=k) for k, (n, b) in enumerate({"wood": "none", "b": "bench", "p": "plate"}.items())]
    tests = [on_base(t, said[t.name], BASES) if t.name in said else t for t in tests]
    return Case("small", Model(NETWORK), tuple(tests))


def test_right_sheets_are_believed():
    assert wrong_bases(base_hypotheses(case())) == []
    best = {h.test: h.base for h in which_base(case()) if h.deviance == 0.0}
    assert best["wood"] == "none"


@pytest.mark.parametrize(
    ("said", "right"), [({"wood": "bench"}, "none"), ({"b": "none"}, "bench"), ({"p": "none"}, "plate")]
)
def test_wrong_base_is_named_at_the_base(said, right):
    """A base forgotten or invented: excluded, the right one is not, and the words speak of the base's heat."""
    wrong = case(**said)
    (name, base), *_ = said.items()
    found = {h.base: h for h in which_base(wrong, [name])}
    assert found[base].declared
    assert found[base].excluded
    assert not found[right].excluded
    (sentence,) = [s for s in wrong_bases(base_hypotheses(wrong)) if s.startswith(name)]
    assert "At the base, not in the films" in sentence
    assert "conduction" in sentence
    assert "radiation" in sentence


def test_calibration_does_not_make_it_good_by_the_film():
    """Calibrated together, body and base both carry what they truly do."""
    found = {h.base: h for h in which_base(case(b="none"), ["b"])}
    true = base_heat(NETWORK, measured("b", "bench"), HIDDEN)
    assert found["bench"].heat.body_W_K == pytest.approx(true.body_W_K, rel=0.1)
    assert found["bench"].heat.path_W_K == pytest.approx(true.path_W_K, rel=0.15)


def test_heat_of_a_base_balances():
    """At rest what goes through the foot leaves by convection and radiation, and all that is made leaves."""
    test = measured("p", "plate")
    heat = base_heat(NETWORK, replace(test, time=10.0 * test.time), {})
    assert heat.conduction == pytest.approx(heat.convection + heat.radiation, rel=0.01)
    assert heat.conduction + heat.body == pytest.approx(220.0, rel=0.01)
    assert base_heat(NETWORK, measured("wood", "none"), {}).conduction == 0.0


def test_held_out_tests_are_not_used():
    held = case()
    tests = (*held.tests[:2], replace(held.tests[2], role="hold-out"))
    assert {h.test for h in which_base(replace(held, tests=tests))} == {"wood", "b"}


def test_what_cannot_be_asked():
    with pytest.raises(InputError, match="no test 'grass'"):
        which_base(case(), ["grass"])
    bare = replace(case(), model=Model(replace(NETWORK, links=NETWORK.links[:2], parameters=NETWORK.parameters[:2])))
    with pytest.raises(InputError, match="knows no bases"):
        which_base(bare)
    assert wrong_bases(base_hypotheses(bare)) == []


@pytest.mark.heavy
def test_diagnosis_says_it_first():
    """The verdict is the base, by mechanism; no sensor and no film is accused of what the base does."""
    found = diagnose(case(b="none"), KINDS, plan=False)
    assert found.verdict == "data"
    assert "b did not stand on the base its sheet says (none" in found.words
    assert "At the base, not in the films of the machine: conduction 0 instead of" in found.words
    assert found.named == ()
    assert {c.decision for c in found.candidates} <= {"no", "cannot-tell"}
    rows = {(h["test"], h["base"]): h["excluded"] for h in found.document()["bases"]}
    assert rows["b", "none"]
    assert not rows["b", "bench"]
