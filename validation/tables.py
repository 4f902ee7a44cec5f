"""The tables of results, from their documents: a comparison, a diagnosis, a revision, an error budget.

A document that was read back from disk has the same tables as the result itself; every medium shows these.
"""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from geom.table import Table, cell, percent, with_interval
from validation.parameters.unknowns import value_words

Document = Mapping[str, Any]
LEAST_PROBABILITY = 0.005  # probabilities below half a per cent are in the document alone
MOST_DIFFERENCES = 12  # between tests: further ones are less certain
MOST_PARTNERS = 3  # of a cause, as a cell shows them
MOST_OFFERS = 3  # tests, and as many sensors, that a table proposes
SENSORS = (
    "sensor=channel | *test | place | n | *rms (K)=rmse_K | fitted (K)=fitted_rmse_K | *bias (K)=bias_K | "
    "largest (K)=max_abs_K | *limit (K)=limit_K | 1 sigma (K)=sigma_K | % of rise=percent_of_rise | *verdict"
)


def comparison_tables(document: Document) -> tuple[Table, ...]:
    """The tests, the sensors of each test, and the roles that nobody declares."""
    sensors = (sensors_table(f"{t['name']} ({t['role']})", [t]) for t in document["tests"])
    return tests_table(document["tests"]), *sensors, roles_table(document["roles"])


def tests_table(tests: Iterable[Document]) -> Table:
    """A row per test, those with most sensors over first."""
    rows = [{**t, "n": len(t["channels"]), "over": sum(c["verdict"] == "over" for c in t["channels"])} for t in tests]
    rows.sort(key=lambda row: -int(row["over"]))
    columns = "test=name | role | sensors=n | *over | *rms (K)=rmse_K | *sensors as fitted (K)=fitted_rmse_K"
    return Table.of("", rows, columns)


def sensors_table(title: str, tests: Iterable[Document], verdict: str = "") -> Table:
    """A row per sensor and test, of one verdict those that are furthest beyond their limit first."""
    records = [{"test": t["name"], **c} for t in tests for c in t["channels"] if verdict in ("", c["verdict"])]
    if verdict:
        records.sort(key=lambda r: -r["rmse_K"] / r["limit_K"])
    return Table.of(title, records, SENSORS, ["over"])


def roles_table(roles: Iterable[Document]) -> Table:
    """What was guessed of parts, with the evidence."""
    return Table.of(
        "Roles that nobody declares",
        [r for r in roles if r["known"] == "guessed"],
        "name | role | turns | evidence",
        role=lambda r: r["role"] or "?",
        turns=lambda r: {True: "yes", False: "no", None: ""}[r["turns"]],
    )


def diagnosis_tables(document: Document) -> tuple[Table, ...]:
    """Bases, explanations, candidates, events, contradictions, what would decide, and what cannot be seen."""
    candidates = candidates_table(weighty_candidates(document["candidates"]))
    events = events_table(document.get("events", []))
    every = (
        bases_table(document.get("bases", [])),
        explanations_table(document.get("explanations", [])),
        candidates,
        events,
        contradiction_table(document.get("contradiction") or {}),
        doubts_table(document.get("doubts", [])),
        offers_table(offers(document)),
        limits_table(document["cannot_see"]),
    )
    return tuple(table for table in every if table.rows)


def explanations_table(explanations: Iterable[Document], partners: bool = True) -> Table:
    """Each leading cause with its probability, and what may be there beside it.  partners : as a column of their own"""
    likely = [x for x in explanations if x["probability"] > LEAST_PROBABILITY]
    columns = f"*odds=probability | *explanation=words{' | beside it=partners' * partners}"
    return Table.of("What the readings say", likely, columns, probability=_percent, partners=partner_words)


def partner_words(explanation: Document) -> str:
    """The likeliest partners of a cause."""
    likely = [p for p in explanation["partners"] if p["probability"] > LEAST_PROBABILITY][:MOST_PARTNERS]
    return "; ".join(f"{p['words']} ({_percent(p)})" for p in likely)


def weighty_candidates(candidates: Sequence[Document]) -> Sequence[Document]:
    """Those that carry weight; the leader at least."""
    return [c for c in candidates if c["probability"] > LEAST_PROBABILITY or c["decision"] != "no"] or candidates[:1]


def candidates_table(candidates: Iterable[Document]) -> Table:
    """Size with interval and detection limit."""
    columns = (
        "effect | *odds=probability | *size (95 %)=size | *detectable=smallest_detectable | *unit | "
        "log odds=score | threshold | decision"
    )
    return Table.of(
        "Candidates (odds of each, alone or with others)",
        candidates,
        columns,
        ["named", "group"],
        size=lambda c: with_interval(c["amplitude"]["value"], *c["amplitude"]["ci95"]),
        probability=_percent,
        unit=lambda c: unit_of(c["amplitude"]),
        decision=lambda c: c["decision"].replace("-", " "),
    )


def unit_of(record: Document) -> str:
    """A unit as it is written behind a number."""
    return "" if record["unit"] == "1" else str(record["unit"])


def _percent(record: Document) -> str:
    return percent(record["probability"]) if "probability" in record else ""


def events_table(events: Iterable[Document], likely: bool = True) -> Table:
    """When something may have been different, or the improbable stretches that were tried as well."""
    numbered = [{**e, "add": f"event@{i}"} for i, e in enumerate(events, 1)]
    return Table.of(
        "What may have differed for a while" if likely else "Stretches in which hardly anything differed",
        [e for e in numbered if likely == (e["probability"] > LEAST_PROBABILITY)],
        "to add=add | when=words | odds=probability | most likely=effect | size=value | unit",
        effect=lambda e: value_words(e["effect"].partition(" in ")[0]),
        unit=unit_of,
        probability=_percent,
    )


def contradiction_table(contradiction: Document) -> Table:
    """What would have to differ between tests."""
    return Table.of(
        "What would have to differ between tests (by tangents)",
        contradiction.get("differences", [])[:MOST_DIFFERENCES],
        "test | *parameter | other tests=others | *this test=here | unit | *deviations=sd | *can it differ?=possible",
        ["no"],
        parameter=lambda d: value_words(d["parameter"]),
        unit=unit_of,
        sd=lambda d: abs(d["sd"]),
    )


def doubts_table(doubts: Iterable[Document]) -> Table:
    """What the table of doubt adds up to at each record."""
    columns = "sensor=channel | test=record | *sum (K)=sum_K | *counted (K)=counted_K | largest"
    return Table.of("Doubts of the model in sum (one sigma)", doubts, columns)


def bases_table(hypotheses: Iterable[Document]) -> Table:
    """Each base with its deviance over the best, all tests calibrated together for each."""
    return Table.of(
        "Which base: misfit over the best of each test (twice the log odds)",
        hypotheses,
        "test | *base | *said | *misfit=deviance | *verdict | conduction (W)=heat_W.conduction | "
        "convection (W)=heat_W.convection | radiation (W)=heat_W.radiation | W/K=heat_W.path_W_K | "
        "body W/K=heat_W.body_W_K",
        ["excluded"],
        said=lambda h: "sheet" if h["declared"] else "",
        verdict=lambda h: "excluded" if h["excluded"] else "possible",
    )


def limits_table(cannot_see: Iterable[Document]) -> Table:
    """Effects that these tests cannot show, and from which size they would."""
    return Table.of(
        "Effects that could be there unseen",
        cannot_see,
        "effect | *detectable=smallest | *unit",
        smallest=lambda h: h["smallest_detectable"] or "none that physics allows",
        unit=unit_of,
    )


def offers(diagnosis: Document) -> list[dict[str, Any]]:
    """Tests, then sensors, each best first, that are expected to tell at least one pair of candidates apart.

    kind : "test" or "sensor";  what, hours;  separates : pairs of effects;  gain : predicted deviance, 20 decides
    how : a test's currents, a sensor's way in
    """
    rows = [
        (kind, o, o[name])
        for kind, key, name in (("test", "next_tests", "test"), ("sensor", "next_sensors", "place"))
        for o in diagnosis.get(key, [])
        if o["separates"]
    ]
    return [
        {
            **{"kind": kind, "what": what, "gain": o["predicted_gain"]},
            "separates": [*map(_pair_words, o["separates"])],
            **{"hours": o.get("hours"), "how": o.get("why") or currents(o.get("currents", []))},
        }
        for kind, o, what in rows
    ]


def _pair_words(pair: str) -> str:
    """Two explanations that a test would tell apart, in words."""
    return " from ".join(map(value_words, pair.split(" / ")))


def offers_table(rows: Iterable[Document]) -> Table:
    """What would decide between the candidates of a group."""
    columns = "what | *kind | hours | *separates | *predicted gain=gain | how"
    return Table.of("What would decide", rows, columns, separates=lambda o: "; ".join(o["separates"]))


def currents(levels: Iterable[Document]) -> str:
    """The currents of a planned test, as its document lists them."""
    return "; ".join(f"{c['input']} at {c['level_A']:.4g} A, {c['share_of_rms']:.2f} of its rms" for c in levels)


def undecided(diagnosis: Document) -> str:
    """That no candidate test is expected to decide, and which comes nearest; empty where no test was looked at."""
    tests = diagnosis.get("next_tests", [])
    if not tests:
        return ""
    best = max(tests, key=lambda t: t["predicted_gain"])
    gain = f"with a predicted gain of {best['predicted_gain']:.2g} where 20 decides"
    return f"No candidate test would tell them apart: '{best['test']}' comes nearest, {gain}."


def next_tests(diagnosis: Document) -> list[Table | str]:
    """Three tests and three sensors at most, and the currents of those tests; or that no test would decide."""
    every = offers(diagnosis)
    best = [o for kind in ("test", "sensor") for o in [x for x in every if x["kind"] == kind][:MOST_OFFERS]]
    if not best:
        return [undecided(diagnosis)]
    how = [f"{o['what'][0].upper()}{o['what'][1:]}: {o['how']}." for o in best if o["kind"] == "test" and o["how"]]
    return [offers_table([{**o, "how": ""} for o in best]), *how]


def revision_tables(document: Document) -> tuple[Table, ...]:
    """The error of every test before and after, those that were not fitted first, and the parameters."""
    tests = sorted(document["tests"], key=lambda t: (t["role"] != "hold-out", t["role"] == "calibrate"))
    columns = (
        "test=name | role | *error before (K)=rmse_K.before | *after (K)=rmse_K.after | "
        "*sensors as fitted (K)=fitted_rmse_K.after"
    )
    return Table.of("", tests, columns, ["hold-out"]), parameters_table("Values", document["parameters"])


def parameters_table(title: str, parameters: Iterable[Document]) -> Table:
    """Values with their intervals, and the intervals that were expected before."""
    return Table.of(
        title,
        parameters,
        "parameter=name | *value | *unit | *from=low | *to=high | by profile=profile | prior from=expected_from | "
        "prior to=expected_to | note",
        low=lambda p: p["ci95"][0],
        high=lambda p: p["ci95"][1],
        profile=_profile_words,
        unit=unit_of,
        expected_from=lambda p: p["prior"] and p["prior"][1],
        expected_to=lambda p: p["prior"] and p["prior"][2],
        note=_parameter_note,
    )


def _profile_words(p: Document) -> str:
    """The profile's interval; an end in brackets is only the bound."""
    if p.get("profile") is None:
        return ""
    ends = zip(p["profile"]["ci95"], p["profile"]["open"], strict=True)
    return " ... ".join(f"({cell(x)})" if is_open else cell(x) for x, is_open in ends)


def _parameter_note(p: Document) -> str:
    if p.get("at_bound"):
        return "at its bound"
    return f"trades with {p['partner']}" if p.get("partner") else ""


def budget_table(rows: Iterable[Document]) -> Table:
    """What mesh, condensation and time steps leave at each place (K)."""
    return Table.of(
        "Error budget: what the model's own numbers may be wrong by",
        rows,
        "place | mesh (K)=mesh_K | condensation (K)=condensation_K | time steps (K)=time_K | *sum (K)=total_K",
    )
