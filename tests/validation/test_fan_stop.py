"""Several instants at which one fan may have stopped."""

from everything import machine, scene

from validation.effects import catalogue, extended
from validation.effects.flow import flows


def test_no_instant_copies_what_another_has_copied():
    """Links grow by as many as the fan acts on for every instant, not by what was added before."""
    net = machine()
    found = catalogue(scene(net), ["fan.stop"])
    links = sum(len({t for t, _ in p.targets} & {x.name for x in net.links}) for p in flows(net))
    assert len(found) > 2
    assert len(extended(net, found).links) - len(net.links) == len(found) * links / len(flows(net))
