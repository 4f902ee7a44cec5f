"""Cases of another generator: folders as the product reads them, beside a truth.json that is only read to judge.

    NAME/case.toml ...    truth.json: {NAME: {"kind", "effects": [{"effect": "kind@place", "size", "group"}], "rival",
                                                  "test", "span_s": [begin, end]}}

Only "kind" and "effects" must be there; a condition may say in which test it held and from when to when (s).

Its words are translated by WORDS; another generator brings a table of its own (`--words FILE`, TOML, the same form).
"""

import json
import time
import tomllib
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from hidden.answer import answer
from hidden.cases import Label
from lumped.model.network import Network
from thermoscope.case_folder.folder import load_case
from validation.effects.conduction.contact import joints, label

CLASSES = {"confounded": "pair", "data": "fault", "outside": "foreign"}
SIZES = {"small": 1.0, "medium": 2.0, "large": 4.0}
JOINT = "joint at the place"
WORDS: Mapping[str, tuple[str, ...]] = {
    "bench_conduction": ("conduction.bench",),
    "road_wind": ("convection",),
    "shaft_fan": ("convection.fan", "convection.rotation"),
    "convection": ("convection.constant", "convection.buoyant"),
    "radiation": ("radiation",),
    "coupling_heat": ("conduction.shaft", "loss.constant"),
    "windage": ("windage",),
    "bearing_friction": ("bearing.friction",),
    "friction": ("bearing.friction",),
    "ac_copper": ("copper.ac",),
    "copper_tempco": ("copper.feedback",),
    "impregnation_void": (JOINT,),
    "pwm_iron": ("iron.pwm",),
    "sensor_gain": ("sensor.gain",),
    "sensor_bias": ("sensor.bias",),
    "sensor_lag": ("sensor.lag",),
    "sensor_drift": ("sensor.drift",),
    "sensor_swap": ("sensor.swap",),
    "sensor_frozen": ("frozen",),
    "clock": ("time.offset",),
    "cable_heat": ("unknown heat",),
}


def words_of(file: Path | None) -> Mapping[str, tuple[str, ...]]:
    return {k: tuple(v) for k, v in tomllib.loads(file.read_text()).items()} if file else WORDS


def names(effect: str, words: Mapping[str, tuple[str, ...]], network: Network) -> tuple[str, ...]:
    """The catalogue's names of 'kind@place': a joint is any that ends there, a copper loss any of the network's."""
    kind, _, place = effect.partition("@")
    out: list[str] = []
    for word in words.get(kind, (kind,)):
        if word == JOINT:
            out += [f"contact@{label(j)}" for j in joints(network) if place in j.places]
        else:
            out.append(f"{word}@{place}")
        if word == "copper.feedback":
            out += [
                f"{word}@{s.name.split(':', 1)[-1]}"
                for s in network.sources
                if s.kind == "copper" and not s.name.endswith(":eddy")
            ]
    return tuple(out)


def label_of(
    name: str, machine: str, truth: Mapping[str, Any], words: Mapping[str, tuple[str, ...]], network: Network
) -> Label:
    """The label of one folder."""

    def all_names(effects: Iterable[str]) -> tuple[str, ...]:
        return tuple(dict.fromkeys(n for e in effects for n in names(e, words, network)))

    hidden, group = truth["effects"], CLASSES.get(truth["kind"], truth["kind"])
    near = [[*e.get("group", ()), *truth.get("rival", ())] for e in hidden]
    place = hidden[0]["effect"].partition("@")[2] if hidden and group == "foreign" else ""
    return Label(
        f"{machine}-{group}-{name}",
        machine,
        group,
        0,
        tuple(e["effect"] for e in hidden),
        tuple(all_names([e["effect"]]) for e in hidden),
        tuple(all_names(n) for n in near),
        max((SIZES.get(e.get("size", ""), 0.0) for e in hidden), default=0.0),
        place=place,  # its amplitudes are in units of its own
        test=truth.get("test", ""),
        span=tuple(truth.get("span_s", ())),
    )


def found_in(root: Path, only: Sequence[str], count: int) -> dict[str, Mapping[str, Any]]:
    """Folders under `root` and what truth.json says of them: the first `count` of every class wanted."""
    told, seen, out = json.loads((root / "truth.json").read_text()), {}, {}  # type: ignore[var-annotated]
    for name, truth in told.items():
        group = CLASSES.get(truth["kind"], truth["kind"])
        seen[group] = seen.get(group, 0) + 1
        if (root / name / "case.toml").is_file() and group in only and seen[group] <= count:
            out[name] = truth
    return out


def diagnosed(
    folder: Path, truth: Mapping[str, Any], words: Mapping[str, tuple[str, ...]]
) -> tuple[Label, dict[str, Any]]:
    """Only the folder goes to the diagnosis; its truth makes the label."""
    start = time.process_time()
    case = load_case(folder).case
    made = time.process_time() - start
    label = label_of(folder.name, folder.resolve().parent.name, truth, words, case.model.network)
    return label, {**answer(case, plan=False), "case": label.case, "made_s": made}
