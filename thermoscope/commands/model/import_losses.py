"""A loss map of an electromagnetic tool in a machine's file: its losses as tables over two inputs."""

import tomllib
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from geom.constants import ALPHA_CU
from geom.description.machine import Machine
from geom.description.names import file_stem
from geom.description.part import Part
from geom.description.roles import Role
from geom.errors import InputError
from geom.escapes import toml_key
from geom.importing.assumptions import USUAL_RPM
from geom.importing.draft import ASSUMED, Draft, new_draft
from measured.importing.loss_map import BY_OPTION, IN_FILE, Column, LossMap, read_loss_map
from thermoscope.case_folder.folder import load_machine_file

SPEED_EXPONENTS = {"copper-ac": 2.0, "magnet": 2.0, "cage": 2.0, "mechanical": 1.0, "windage": 3.0}
IRON_EXPONENT = 1.5  # between hysteresis, 1, and eddy currents, 2
COLD = 20.0  # degC: if the map was made hotter, copper heats less than declared, so that a doubt lies on the hot side
DIGITS = 5  # of watts: maps are computed to three
HEATED = {  # kind of a loss -> role of the parts it heats
    "copper": Role.WINDING,
    "copper-ac": Role.WINDING,
    "iron": Role.IRON,
    "rotor-iron": Role.ROTOR,
    "magnet": Role.MAGNET,
    "cage": Role.CAGE,
    "mechanical": Role.BEARING,
    "windage": Role.AIR_GAP,
}
COVERED = {"iron": (Role.IRON, Role.ROTOR), "mechanical": (Role.BEARING, Role.AIR_GAP)}  # else its own alone


def losses_draft(file: Path, machine_file: Path, units: str, copper_degC: float | None) -> tuple[Draft, str]:
    """What was taken and assumed, and the text of the machine's file with the losses of the map.

    units : "speed=rad/s,power=kW", where the file has none;  copper_degC : of the winding in the map, None: not said
    Raises InputError where a file is not a map, or no machine file with tables of losses.
    """
    machine = load_machine_file(machine_file)
    ratings = machine.sections.get("ratings", {})
    pairs = {quantity: unit for pair in filter(None, units.split(",")) for quantity, _, unit in [pair.partition("=")]}
    loss_map = read_loss_map(file, pairs, float(ratings.get("speed_rpm", USUAL_RPM)))
    draft = new_draft(file_stem(f"{machine.name}-{file.stem}"), file, "a loss map")
    for name, why in loss_map.notes.items():
        draft.leave(name, "not used", why)
    heated = _places(machine)
    for kind in loss_map.losses:
        if kind in heated:
            _enter(draft, loss_map, kind, heated[kind], copper_degC)
        else:
            columns = ", ".join(column.name for column in loss_map.losses[kind][0])
            draft.leave(columns, kind, f"the machine has no {HEATED[kind]} to heat")
    for name, column in loss_map.axes.items():
        if name not in ratings:
            half = float(f"{column.values[-1] / 2:.4g}")
            draft.assume("ratings", f"half of the largest {column.name}: change it", **{name: half})
    if loss_map.speed_rpm is not None and "speed_rpm" not in ratings:
        draft.take("ratings", "the map's speed", speed_rpm=loss_map.speed_rpm)
    return draft, _spliced(draft, machine, machine_file, {kind for kind in loss_map.losses if kind in heated})


def _enter(draft: Draft, loss_map: LossMap, kind: str, at: Any, copper_degC: float | None) -> None:
    section, (columns, watts) = f"losses.{kind}", loss_map.losses[kind]
    (first, down), (second, along) = loss_map.axes.items()
    _say(draft, section, columns, kind="map")
    draft.assume(section, "the parts of this kind, by their copper or volume", at=at)
    for key, column in (("at_speed", down), ("at_torque", along)):
        _say(draft, section, (column,), **{key: [float(f"{x:.7g}") for x in column.values]})
    if first != "speed_rpm":
        draft.take(section, "a map over currents", speed=first, torque=second)
    words = f"{' + '.join(column.name for column in columns)}"
    draft.take(section, words, P_W=[[float(f"{x:.{DIGITS}g}") for x in row] for row in watts])
    if first != "speed_rpm" and kind != "copper":
        if loss_map.speed_rpm is None:
            right = "a column of the speed at which they hold, one for all points"
            raise InputError(f"{words} over id and iq says no speed", str(draft.path), right)
        exponent = SPEED_EXPONENTS.get(kind, IRON_EXPONENT)
        of = {"input": "speed_rpm", "at": loss_map.speed_rpm, "exponent": exponent}
        draft.assume(section, f"the map holds at {loss_map.speed_rpm:g} rpm; the exponent is the usual one", of=of)
    if kind != "copper":
        return
    draft.take(section, "copper", alpha_1_K=ALPHA_CU)
    if copper_degC is not None or loss_map.winding_degC is not None:
        source = "--copper-degc" if copper_degC is not None else "the file's temperature of the winding"
        draft.take(section, source, reference_degC=loss_map.winding_degC if copper_degC is None else copper_degC)
    else:
        draft.assume(section, "winding in the map: say it by --copper-degc", reference_degC=COLD)


def _say(draft: Draft, section: str, columns: tuple[Column, ...], **values: Any) -> None:
    """Taken where the file or an option says the units, else assumed, with what tells them."""
    guesses = [column.why for column in columns if column.why not in (IN_FILE, BY_OPTION)]
    words = ", ".join(f"{column.name} in {column.unit}" for column in columns)
    if guesses:
        draft.assume(section, f"{words}; {guesses[0]}", **values)
    else:
        draft.take(section, f"{words}, {columns[0].why}", **values)


def _places(machine: Machine) -> dict[str, Any]:
    """Kind of a loss -> where it heats, as `at` of a loss: copper by copper, all else by volume."""
    wound = [part for part in machine.parts if part.role is Role.WINDING and not part.turns]
    mean = next((name for name, how in machine.sections.get("sensors", {}).items() if _is_mean(how, wound)), None)
    slots = [part for part in wound if part.material != "end-winding"]
    out: dict[str, Any] = {"copper": mean or _shares(wound), "copper-ac": _shares(slots)}
    for kind, role in HEATED.items():
        parts = [part for part in (*machine.parts, *machine.fluids) if part.role is role]
        if kind == "cage":
            parts += [part for part in machine.parts if part.role is Role.WINDING and part.turns]
        if kind not in out and parts:
            out[kind] = _shares(parts)
    return {kind: at for kind, at in out.items() if at}


def _is_mean(how: Any, wound: list[Part]) -> bool:
    return (
        isinstance(how, Mapping) and how.get("by") == "copper" and {*how.get("mean_of", ())} == {p.name for p in wound}
    )


def _shares(parts: list[Part]) -> Any:
    """By copper, or by volume; one part alone by its name."""
    sizes = np.array([part.volume * (part.filling or (1.0,))[0] for part in parts])
    if len(parts) < 2:
        return parts[0].name if parts else {}
    shares = np.round(sizes / sizes.sum(), 4)
    shares[-1] = 1.0 - shares[:-1].sum()
    return {part.name: float(f"{share:.4f}") for part, share in zip(parts, shares)}


def _spliced(draft: Draft, machine: Machine, file: Path, kinds: set[str]) -> str:
    """The machine's file with what the map says; losses of other parts stay, and are said to."""
    import tomlkit

    from geom import library

    path = file if file.is_file() else library()[file.name.removesuffix(".toml")]
    if path.suffix.lower() != ".toml":
        raise InputError(
            "is not a machine file", str(file), "a .toml file: `model import` makes one of other programs' files"
        )
    text = path.read_text(encoding="utf-8")
    tables, losses = tomllib.loads(text).get("losses", {}), machine.sections.get("losses", {})
    if not all(isinstance(table, Mapping) for table in losses.values()):
        raise InputError("its losses are plain numbers", f"{file} [losses]", "tables: [losses.copper], [losses.iron]")
    covered = {role for kind in kinds for role in COVERED.get(kind, (HEATED[kind],))}
    document: Any = tomlkit.parse(text)
    document["machine"]["name"] = draft.name
    for name, table in losses.items():
        if name not in kinds and _role(machine, table.get("at")) not in covered:
            draft.leave(f"losses.{toml_key(name)}", table.get("kind", ""), "stays as it was: no column is of its part")
        elif name in tables:
            del document["losses"][name]
        else:
            document["machine"].setdefault("without", []).append(f"losses.{toml_key(name)}")
    if "losses" in document and not document["losses"]:
        del document["losses"]
    for entry in draft.entries:
        if entry.section == "ratings":
            words = f"assumed: {entry.source}" if entry.kind == ASSUMED else entry.source
            document.setdefault("ratings", tomlkit.table())[entry.key] = tomlkit.item(entry.value).comment(words)
    added = replace(draft, entries=[entry for entry in draft.entries if entry.section != "ratings"])
    return f"{tomlkit.dumps(document).rstrip()}\n\n{added.toml()}"


def _role(machine: Machine, at: Any) -> Role | None:
    """Of the part that a loss heats first; that of a zone is its part's, that of a mean the first part's."""
    name = next(iter(at)) if isinstance(at, Mapping) else str(at)
    mean = machine.sections.get("sensors", {}).get(name)
    name = mean["mean_of"][0] if isinstance(mean, Mapping) and mean.get("mean_of") else name
    roles = {part.name: part.role for part in (*machine.parts, *machine.fluids)}
    while name not in roles and "." in name:
        name = name.rpartition(".")[0]
    return roles.get(name)
