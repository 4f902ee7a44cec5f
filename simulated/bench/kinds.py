"""Five kinds of machines as their user would declare them: a network of four or five nodes, a bench, its limits."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

HIDDEN: tuple[str, ...] = ("nothing", "contact@fit", "coupling@winding|housing")
HIDDEN += ("convection.constant@housing", "blockage@housing", "windage@rotor")
HIDDEN += ("copper.ac@winding", "loss.rotor.load@rotor", "gap.convection@core|rotor")


@dataclass(frozen=True)
class Kind:
    """Nominal numbers: C J/K by node, G W/K by link, area m2 of the housing, R ohm at 20 degC, iron W at `rpm`.

    amperes, rpm : largest set points;  cooled : (quantity, G W/K at its largest set point, exponent) of an outer stream
    bed : G W/K to a plate, 0 without one;  sensors : nodes with a thermometer;  most_C : of the winding's hot spot
    """

    C: Mapping[str, float]
    liner: float
    fit: float
    gap: float
    area: float
    R: float
    iron: float
    amperes: float
    rpm: float
    cooled: tuple[str, float, float] = ("", 0.0, 0.0)
    bed: float = 0.0
    friction: float = 5.0
    sensors: tuple[str, ...] = ("winding", "core", "housing")
    most_C: float = 130.0
    seat: float = 0.0
    off: Mapping[str, float] = field(default_factory=dict)

    @property
    def hidden(self) -> tuple[str, ...]:
        """What can be hidden in it: air on a housing that liquid cools is too little to matter."""
        return tuple(h for h in HIDDEN if h != "convection.constant@housing" or self.cooled[0] != "pump_share")


def _C(winding: float, core: float, housing: float, rotor: float) -> dict[str, float]:
    return {"winding": winding, "core": core, "housing": housing, "rotor": rotor}


KINDS: Mapping[str, Kind] = {
    "servo": Kind(_C(120, 500, 800, 300), 4.0, 12.0, 0.8, 0.1, 1.2, 12.0, 8.0, 3000.0, bed=0.5),
    "blower": Kind(
        _C(900, 4000, 2500, 3500), 25.0, 60.0, 4.0, 0.35, 1.0, 120.0, 25.0, 1800.0, ("fan_share", 22.0, 0.8),
        sensors=("winding", "core", "housing", "rotor"),
    ),
    "jacket": Kind(
        _C(1500, 6000, 5000, 5000), 50.0, 150.0, 5.0, 0.4, 0.09, 400.0, 160.0, 6000.0, ("pump_share", 120.0, 0.7),
        sensors=("winding", "core", "housing", "rotor"),
    ),
    "shaft-fan": Kind(
        _C(1700, 7000, 4500, 6000), 35.0, 60.0, 4.5, 0.4, 1.3, 140.0, 20.0, 1800.0, ("speed_rpm", 16.0, 0.8),
    ),
    "spindle": Kind(
        _C(500, 2500, 3000, 2000), 18.0, 60.0, 3.0, 0.2, 0.35, 150.0, 45.0, 9000.0, ("pump_share", 45.0, 0.7),
        friction=60.0, seat=2.5, sensors=("winding", "core", "housing", "flange"),
    ),
}  # fmt: skip


def network(name: str) -> str:
    """The user's declared network."""
    k = KINDS[name]
    quantity, cooling, exponent = k.cooled
    liquid = quantity == "pump_share"
    baths = ["ambient", *(["coolant"] if liquid else []), *(["plate"] if k.bed else [])]
    out = [f'[network]\nname = "{name}"\nboundaries = {baths}'.replace("'", '"')]
    out += [f'[boundaries.{b}]\nrole = "{"test bed" if b == "plate" else b}"' for b in baths]
    if quantity in ("fan_share", "pump_share"):
        out.append(f'[inputs.{quantity}]\nquantity = "share"')
    roles = {"winding": "winding", "core": "iron", "housing": "housing", "rotor": "rotor", "flange": "end shield"}
    C = dict(k.C) | ({"flange": 0.3 * k.C["housing"]} if k.seat else {})
    out += [f'[nodes.{n}]\nrole = "{roles[n]}"\nC_J_K = {c:g}\nprior_sd = 0.1' for n, c in C.items()]

    def link(called: str, a: str, b: str, G: float, sd: float, more: str = "") -> None:
        out.append(f'[links.{called}]\nbetween = ["{a}", "{b}"]\nG_W_K = {G:g}\nprior_sd = {sd:g}{more}')

    link("liner", "winding", "core", k.liner, 0.15)
    link("fit", "core", "housing", k.fit, 0.15)
    link("gap", "core", "rotor", k.gap, 0.2)
    if k.seat:
        link("seat", "rotor", "flange", k.seat, 0.25)
        link("spigot", "flange", "housing", 8.0 * k.seat, 0.25)
    if k.bed:
        link("bed", "housing", "plate", k.bed, 0.25)
    if quantity:
        top = k.rpm if quantity == "speed_rpm" else 1.0
        to = "coolant" if liquid else "ambient"
        of = f'{{ input = "{quantity}", at = {top:g}, exponent = {exponent:g} }}'
        link("stream", "housing", to, cooling, 0.15, f"\nof = {of}")
    out.append(
        f'[links.still]\nbetween = ["housing", "ambient"]\narea_m2 = {k.area:g}\nprior_sd = 0.15\n'
        f'[links.still.natural]\nsurface = "horizontal cylinder"\nsize_m = 0.2\n'
        f"[links.still.radiation]\nemissivity = 0.8"
    )
    out.append(
        f'[losses.copper]\nkind = "copper"\nat = "winding"\ncurrents = ["current_A"]\nfactor = 1.5\nR20_ohm = {k.R:g}\n'
        f'alpha_1_K = 0.00393\nprior_sd = 0.05\n[losses.iron]\nkind = "iron"\nat = "core"\n'
        f"hysteresis_W = {0.55 * k.iron:g}\n"
        f'eddy_W = {0.45 * k.iron:g}\nspeed_at = {k.rpm:g}\nprior_sd = 0.15\n[losses.friction]\nkind = "friction"\n'
        f'at = "{"flange" if k.seat else "rotor"}"\nP_W = {k.friction:g}\n'
        f'of = {{ input = "speed_rpm", at = {k.rpm:g}, exponent = 1.2 }}\nprior_sd = 0.25'
    )
    return "\n".join(out) + "\n"


def columns(name: str) -> str:
    """The sheet of the rows."""
    k = KINDS[name]
    out = ['[test]\ntime = "time_s"\ninitial = "first-readings"\ndescription = "rows of a live bench"']
    inputs = [("current_A", "current", "A"), ("speed_rpm", "speed", "rpm")]
    inputs += [(k.cooled[0], "share", "1")] if k.cooled[0].endswith("share") else []
    out += [f'[columns.{n}]\nquantity = "{q}"\nunit = "{u}"\ninput = "{n}"' for n, q, u in inputs]
    baths = ["ambient", *(["coolant"] if k.cooled[0] == "pump_share" else []), *(["plate"] if k.bed else [])]
    sensed = tuple(f"[columns.T_{s}]" for s in k.sensors)
    out += [f'[columns.T_{b}]\nquantity = "temperature"\nunit = "degC"\nplace = "{b}"' for b in baths]
    out += [f'[columns.T_{b}]\nquantity = "temperature"\nunit = "degC"\nplace = "{b}"' for b in k.sensors]
    out = [f"{x}\nsigma_K = 0.5\nlag_s = 10" if x.startswith(sensed) else x for x in out]
    return "\n".join(out) + "\n"


def bench(name: str) -> str:
    """Set points and limits."""
    k = KINDS[name]

    def levels(top: float, shares: tuple[float, ...]) -> str:
        return "[" + ", ".join(f"{s * top:g}" for s in shares) + "]"

    out = ['sheet = "tests/columns.toml"']
    out.append(
        f"[set.current_A]\nlevels = {levels(k.amperes, (0.0, 0.4, 0.7, 1.0))}\nsafe = 0\nrate_per_s = {k.amperes / 5:g}"
    )
    out.append(f"[set.speed_rpm]\nlevels = {levels(k.rpm, (0.0, 0.5, 1.0))}\nsafe = 0\nrate_per_s = {k.rpm / 10:g}")
    if k.cooled[0].endswith("share"):
        out.append(f"[set.{k.cooled[0]}]\nlevels = [0.3, 1.0]\nsafe = 1.0\nrate_per_s = 0.2\ncooling = true")
    out.append(f'[limits.winding]\nplace = "winding"\nmost_C = {k.most_C:g}\nhot_spot = 1.15')
    out.append('[limits.rotor]\nplace = "rotor"\nmost_C = 120\nhot_spot = 1.05')
    out.append('[limits.housing]\nplace = "housing"\nmost_C = 100')
    return "\n".join(out) + "\n"


def write_case(name: str, folder: Path) -> Path:
    """The case of a kind as its user hands it in, without any test."""
    (folder / "tests").mkdir(parents=True, exist_ok=True)
    kinds = sorted({h.partition("@")[0] for h in HIDDEN[1:]})
    catalogue = str(kinds).replace("'", '"')
    (folder / "case.toml").write_text(
        f'[case]\nname = "{name}"\ndescription = "A bench that steers itself; simulated"\nnetwork = "network.toml"\n'
        f"[diagnosis]\ncatalogue = {catalogue}\n"
    )
    (folder / "network.toml").write_text(network(name))
    (folder / "bench.toml").write_text(bench(name))
    (folder / "tests" / "columns.toml").write_text(columns(name))
    return folder
