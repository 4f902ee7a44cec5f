"""Several instants at which one fan may have stopped."""

from everything import machine, scene

from validation.effects import catalogue, effect, extended
from validation.effects.streams.flow import flows


def test_no_instant_copies_what_another_has_copied():
    """Links grow by as many as the fan acts on for every instant, not by what was added before."""
    net = machine()
    found = catalogue(scene(net), ["fan.stop"])
    links = sum(len({t for t, _ in p.targets} & {x.name for x in net.links}) for p in flows(net))
    assert len(found) > 2
    assert len(extended(net, found).links) - len(net.links) == len(found) * links / len(flows(net))


def test_a_test_may_have_a_colon_in_its_name():
    net = machine()
    flow = flows(net)[0].name
    named, plain = (extended(net, [effect(f"fan.stop@{flow}:{t}:50")]) for t in ("asked: half the flow", "road"))
    assert len(named.links) == len(plain.links) > len(net.links)
