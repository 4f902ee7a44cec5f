"""Which bodies turn, from how they hang together: what a bearing or an air gap holds apart from what stands."""

from collections.abc import Collection, Mapping

import numpy as np

from lumped.model.topology import Topology, conductance, fixed, reached

ONLY_TURNING = {"brush": "carries the heat of brushes", "magnet": "carries a loss of magnets"}
LOOSE = 0.2  # of the strongest joint: what hangs on the rest by less may turn in it
FINEST = 1e6  # the strongest conductance in units of the smallest that the cut tells apart


def turning(top: Topology, statements: Mapping[str, bool]) -> dict[str, tuple[bool, str]]:
    """Body -> whether it turns, and what shows it; bodies of which nothing is known are left out.

    statements : body -> whether it is said to turn
    """
    stand = {b: "declared" for b, turns in statements.items() if not turns}
    stand |= {b: why for b, why in standing(top).items() if not statements.get(b)}
    turn = {b: "declared" for b, turns in statements.items() if turns}
    turn |= {b: why for b, why in seeds(top, stand).items() if statements.get(b) is not False}
    turn = turn or {b: why for b, why in loose(top).items() if b not in statements}
    stand = {b: why for b, why in stand.items() if b not in turn}
    out = {b: (False, why) for b, why in stand.items()} | {b: (True, why) for b, why in turn.items()}
    if turn and stand:
        bearings = [b for b in top.bearings if b not in turn]
        side = in_one_piece(top, cut(top, turn, stand, bearings), {*stand, *bearings})
        words = {True: "hangs on what turns", False: "hangs on what stands"}
        out = {b: (b in side, words[b in side]) for b in top.bodies} | out
    return out


def standing(top: Topology) -> dict[str, str]:
    """Bodies that free convection, radiation or wind cools, or else the one that the outside cools most."""
    out: dict[str, str] = {}
    most: tuple[float, str] = (0.0, "")
    total: dict[str, float] = {}
    for boundary in top.network.boundaries:
        for body, link in top.outer(boundary):
            if body in top.bodies and not fixed(link) and not link.law.reads:
                out[body] = "still air cools it"
            total[body] = total.get(body, 0.0) + conductance(top.network, link)
    most = max(((G, body) for body, G in total.items() if body in top.bodies), default=most)
    return out or ({most[1]: "the outside cools it most"} if most[0] > 0.0 else {})


def seeds(top: Topology, stand: Collection[str]) -> dict[str, str]:
    """Bodies that turn for sure: with the heat of brushes or magnets, or beyond a bearing as seen from what stands."""
    out = {b: why for b, kinds in top.heat.items() for kind, why in ONLY_TURNING.items() if kind in kinds}
    out |= dict.fromkeys(top.journals, "runs between two bearings")
    bearings = top.bearings
    far = reached([b for b in stand if b not in bearings], lambda a: [b for b in top.joined(a) if b not in bearings])
    for bearing in bearings:
        near = [b for b in top.joined(bearing) if b not in bearings]
        away = {b: far.get(b, len(top.bodies)) for b in near}
        if away and max(away.values()) > min(away.values()):
            out |= {b: "beyond a bearing" for b in near if away[b] == max(away.values())}
    return {b: why for b, why in out.items() if b in top.bodies}


def loose(top: Topology) -> dict[str, str]:
    """What one weak joint alone holds, with losses of its own that follow the drive and none of a winding."""
    strongest, anchor = max(top.joints.values(), default=0.0), standing(top)
    best: tuple[float, dict[str, str]] = (LOOSE * strongest, {})
    for (a, b), G in top.joints.items():
        side = _far_side(top, a, b)
        kinds = frozenset().union(*(top.heat.get(x, frozenset()) for x in side))
        follows = any(top.reads.get((x, kind)) for x in side for kind in kinds)
        if a not in side and not side & set(anchor) and follows and "copper" not in kinds and best[0] > G:
            best = (G, dict.fromkeys(side, f"hangs on the rest by {G:.3g} W/K alone and has a loss of its own"))
    return best[1]


def _far_side(top: Topology, a: str, b: str) -> set[str]:
    """All that is reached from b without the joint to a."""
    return set(reached([b], lambda x: [y for y in top.joined(x) if {x, y} != {a, b}]))


def in_one_piece(top: Topology, side: Collection[str], others: Collection[str]) -> set[str]:
    """The turning bodies with those that join them where a weak joint had cut them apart: a shaft is one piece."""
    left, first = set(side), next(iter(side))
    while True:
        whole = set(reached([first], lambda a: left.intersection(top.joined(a))))
        way = _way(top, whole, left - whole, others)
        if not way:
            return left
        left.update(way)


def _way(top: Topology, start: Collection[str], end: Collection[str], without: Collection[str]) -> list[str]:
    """The bodies on a shortest way between two sets; none where there is no way."""
    ways: dict[str, list[str]] = {a: [] for a in start}
    edge = list(start)
    for a in edge:  # grows while it is walked, so that nearer bodies come first
        near = top.joined(a)
        if any(b in end for b in near):
            return ways[a]
        for b in near:
            if b not in ways and b not in without:
                ways[b] = [*ways[a], b]
                edge.append(b)
    return []


def cut(top: Topology, turn: Collection[str], stand: Collection[str], bearings: Collection[str]) -> set[str]:
    """The turning side of the weakest cut (W/K) between what turns and what stands; bearings stand."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import breadth_first_order, maximum_flow

    bodies = [b for b in top.bodies if b not in bearings]
    at, n = {b: i for i, b in enumerate(bodies)}, len(bodies)
    ties = [(at[a], at[b], G) for (a, b), G in top.joints.items() if a in at and b in at and G > 0.0]
    scale = FINEST / max((G for *_, G in ties), default=1.0)
    whole = int(2 * FINEST * (len(ties) + 1))
    edges = [(i, j, max(round(scale * G), 1)) for i, j, G in ties]
    edges += [(n, at[b], whole) for b in turn if b in at] + [(at[b], n + 1, whole) for b in stand if b in at]
    if not edges:
        return set(turn)
    rows, cols, capacity = np.array(edges, np.int64).T
    graph = coo_array((np.minimum(capacity, 2**31 - 1).astype(np.int32), (rows, cols)), shape=(n + 2, n + 2)).tocsr()
    left = graph - maximum_flow(graph, n, n + 1).flow
    left.data = np.where(left.data > 0, left.data, 0)
    left.eliminate_zeros()
    indices = breadth_first_order(left, n, return_predecessors=False)
    return {bodies[i] for i in indices if i < n}
