"""Heat flows of a hand-made network, and their pictures."""

import numpy as np
import pytest
from PIL import Image, ImageSequence
from small_motor import LEVELS, RADII, motor

from geom.errors import InputError
from lumped import Balance, bare_network, node_link, node_source
from lumped.transfer.laws import Fixed
from viz.figures import paper
from viz.figures.flows import Flow, Heat, heat_flows, last_running_step, sankey_of_losses
from viz.machine.animation import WRITERS, animate
from viz.machine.network import LABEL, NODE, clear_place, network_in_machine, places, spread_out
from viz.rendering.nodes import split

MESH = motor(24)
NODES = split(MESH)


@pytest.fixture(scope="module")
def heat():
    """100 W into the yoke, through a contact to the housing and out to the air; 25 W of it still warm the yoke."""
    net = bare_network("two", {"yoke": 10.0, "housing": 10.0}, ("ambient",))
    links = [
        node_link(net, "contact:housing|yoke", "contact", "housing", "yoke", Fixed(2.0)),
        node_link(net, "film:housing.outer", "film", "housing", "ambient", Fixed(5.0)),
    ]
    losses = {"loss:iron": 90.0, "loss:iron^speed_rpm": 10.0}  # the second is what an exponent off its value changes
    net = net.extended(links, [node_source(net, n, "iron", {"yoke": 1.0}, Fixed(w)) for n, w in losses.items()])
    seconds = np.array([0.0, 10.0])
    z = np.array([72.5, 35.0, 20.0])  # 75 W through 2 W/K and 5 W/K, air at 20 degC
    through = {"contact:housing|yoke": -75.0 * seconds, "film:housing.outer": 75.0 * seconds}
    made = {name: watts * seconds for name, watts in losses.items()}
    return heat_flows(net, Balance(seconds, through, made, 75.0 * seconds, 25.0 * seconds, np.stack([z, z])))


def test_what_is_lost_leaves_or_is_stored_and_flows_keep_sign_and_conductance_of_their_link(heat):
    assert heat.losses == pytest.approx({"iron": 100.0})
    assert heat.out == pytest.approx({"housing": 75.0})
    assert heat.stored == pytest.approx(25.0)
    flow = next(f for f in heat.flows if f.kind == "contact")
    assert (flow.start, flow.end, flow.watts) == ("housing", "yoke", pytest.approx(-75.0))
    assert {f.kind: f.conductance for f in heat.flows} == pytest.approx({"contact": 2.0, "film": 5.0})


@pytest.mark.parametrize(("joules", "step"), [([0, 900, 1800, 1800], 1), ([0, 0, 900, 1000], 1), ([0, 0, 0, 0], 2)])
def test_a_test_that_ends_at_standstill_is_drawn_where_it_last_ran(joules, step):
    net = bare_network("one", {"yoke": 10.0}, ("ambient",))
    net = net.extended([], [node_source(net, "loss:iron", "iron", {"yoke": 1.0}, Fixed(1.0))])
    seconds, heat = 10.0 * np.arange(4), np.array(joules, float)
    z = np.full((4, 2), 20.0)
    assert last_running_step(net, Balance(seconds, {}, {"loss:iron": heat}, 0 * heat, heat, z)) == step


def test_width_is_conductance_and_colour_is_heat():
    """Twice the root of the conductance is twice as wide; equal heat has one colour."""
    flows = tuple(Flow("yoke", end, "link", w, g) for end, w, g in (("housing", 75.0, 8.0), ("shaft", 75.0, 2.0)))
    p = network_in_machine(
        MESH, {"yoke": 90.0, "housing": 40.0, "shaft": 30.0}, Heat({}, flows, {}), limits=(0.0, 200.0)
    )
    assert p.actors["nodes"].mapper.scalar_range == (0.0, 200.0)
    wide, narrow = (p.actors[f"link {i}"] for i in (0, 1))
    assert wide.prop.line_width == pytest.approx(2 * narrow.prop.line_width)
    assert wide.mapper.dataset["W"].tolist() == narrow.mapper.dataset["W"].tolist()
    assert "8 W/K" in p.actors["headline"].GetInput()
    p.close()


def test_where_nothing_conducts_no_line_is_drawn_and_colours_span_the_nodes():
    """A state without a place of its own does not stretch the range."""
    still = Heat({}, (Flow("yoke", "housing", "link", 0.0, 0.0),), {})
    p = network_in_machine(MESH, {"yoke": 90.0, "housing": 40.0, "shape.1": -150.0}, still)
    assert "link 0" not in p.actors
    assert p.actors["nodes"].mapper.scalar_range == (40.0, 90.0)
    p.close()


OUT = {"fan:a": 150.0, "fan:b": 50.0, "housing": 120.0, "shaft": 1.0}
RIBBONS = {
    "warms": ({"copper": 300.0, "iron": 100.0}, OUT, ("iron  100 W", "400 W", "fan  200 W", "warms the machine  79 W")),
    "cools": ({"copper": 300.0}, {"housing": 390.0}, ("the machine cools  90 W", "390 W", "housing  390 W")),
}


@pytest.mark.parametrize("kind", RIBBONS)
def test_ribbons_carry_their_watts(kind):
    """What a cooling machine gives up comes in with its losses; what is small has no name of its own."""
    losses, out, shown = RIBBONS[kind]
    text = paper.svg(sankey_of_losses(Heat(losses, (), out)), "s").replace("\u00a0", " ")
    assert [word for word in ("copper  300 W", *shown) if word not in text] == []
    assert "shaft" not in text


@pytest.mark.parametrize(("count", "out"), [(1, 1.0), (14, 1.0), (3, 900.0)])
def test_ribbons_stay_inside_the_drawing(count, out):
    (ax,) = sankey_of_losses(Heat({f"loss {i}": 100.0 for i in range(count)}, (), {"housing": out})).axes
    low, high = ax.get_ylim()
    for ribbon in ax.patches:
        y = ribbon.get_path().vertices[:, 1]
        assert low - 1e-9 <= y.min()
        assert y.max() <= high + 1e-9


def test_no_losses_no_ribbons():
    with pytest.raises(InputError, match="no losses"):
        sankey_of_losses(Heat({}, (), {}))


def test_nodes_stand_where_their_parts_are():
    """A ring of inner and outer radius a, b has mean radius 2/3 (b3 - a3) / (b2 - a2); polygons are a little inside."""
    at = places(MESH, NODES)
    a, b = RADII[5], RADII[6]
    assert at["yoke"][1] == pytest.approx(2 / 3 * (b**3 - a**3) / (b**2 - a**2), rel=0.02)
    assert at["yoke"][2] == pytest.approx((LEVELS[2] + LEVELS[8]) / 2)


def test_nodes_on_one_spot_are_pushed_apart():
    moved = spread_out({"a": np.zeros(3), "b": np.zeros(3), "c": np.array([0, 0, 1.0])}, 0.1)
    assert np.linalg.norm(moved["a"] - moved["b"]) >= 0.1
    assert moved["c"].tolist() == [0, 0, 1.0]


def frames_of(file):
    with Image.open(file) as gif:
        return [np.asarray(one.convert("RGB")).astype(int) for one in ImageSequence.Iterator(gif)]


def test_animation_has_a_frame_per_time_and_warms_up(tmp_path):
    fields = np.linspace(20.0, 90.0, 4)[:, None] * np.ones(NODES.size)
    first, *_, last = frames = frames_of(animate(NODES, [0.0, 600.0, 1200.0, 1800.0], fields, tmp_path / "a.gif"))
    assert len(frames) == 4
    assert last[200:500, 200:700, 1].mean() > first[200:500, 200:700, 1].mean() + 20


def test_small_hot_parts_keep_their_colour_in_a_gif(tmp_path):
    """Beside a shell of all shades from blue to red: a thousandth of the picture stays orange, within eight of 255."""
    high, wide, spot = 200, 320, (slice(90, 98), slice(150, 158))
    x, light = np.linspace(0, 1, wide)[None, :, None], np.linspace(0.4, 1.0, high)[:, None, None]
    shell = (np.array([70.0, 60.0, 200.0]) * (1 - x) + np.array([235.0, 90.0, 110.0]) * x) * light
    pictures = []
    for k in range(6):
        one = np.clip(shell + 2 * k, 0, 255).astype(np.uint8)
        one[spot] = (230 + k, 140, 60)
        pictures.append(one)
    for one, seen in zip(pictures, frames_of(WRITERS[".gif"](tmp_path / "a.gif", pictures, 12.0)), strict=True):
        assert np.abs(seen[spot] - one[spot]).max() <= 8


def test_a_label_on_a_line_covers_no_node_and_no_other_label():
    """A node in the middle of the line: the label moves along it; a line between close neighbours gets none."""
    a, b = np.array([0.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])
    nodes = [a, b, np.array([0.0, 0.0, 0.5])]
    first = clear_place(a, b, nodes, [], PIXEL)
    second = clear_place(a, b, nodes, [first], PIXEL)
    least = PIXEL * (LABEL[1] + NODE)
    assert all(abs(first[2] - n[2]) >= least for n in nodes)
    assert abs(second[2] - first[2]) >= 2 * PIXEL * LABEL[1]
    assert clear_place(a, np.array([0.0, 0.0, least]), nodes, [], PIXEL) is None


PIXEL = 0.0015  # m: a line of a metre is 670 of them long
