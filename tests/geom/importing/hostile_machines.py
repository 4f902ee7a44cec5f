"""Machine files as an attacker, or a broken disk, would leave them: the name of the file, and its content."""

import json
import os

import cadquery as cq
from foreign_machines import motor_cad, pyleecan

from geom.machine_file import library

PMSM = library()["pmsm-m1"].read_text(encoding="utf-8")
LIKE = '[machine]\nname = "x"\nlike = "pmsm-m1"\n'
ESCAPE = "\x1b[2J"
NAMES = {
    "comment of C": "x */ int y; /*",
    "formula": '=HYPERLINK("http://x.test")',
    "zero": "x\0y",
    "right to left": "x\u202ey",
    "300 letters": "x" * 300,
    "folder above": "../../PWNED",
    "number": 7,
}


def changed(old, new):
    """The file of a machine that comes along, with one place changed."""
    assert old in PMSM
    return PMSM.replace(old, new, 1)


def length(value):
    return changed("stack_length_mm = 150.0", f"stack_length_mm = {value}")


def slots(value):
    return changed("slots = 18", f"slots = {value}")


TOML = {
    **{f"name: {kind}": changed('"pmsm-m1"', json.dumps(name)) for kind, name in NAMES.items()},
    "description with control characters": changed('"PM machine', '"\\u001b]0;x\\u0007PM machine'),
    "no UTF-8": PMSM.encode().replace(b"pmsm-m1", b"pmsm-\xff\xfe", 1),
    "UTF-16": PMSM.encode("utf-16"),
    "key twice": slots("18\nslots = 19"),
    **{f"length of {v}": length(v) for v in ("nan", "1e-300", "-150.0", '"150"')},
    **{f"{v[:9]} slots": slots(v) for v in ("1000000000", "9" * 5000, "17.5")},
    **{f"rated speed of {v}": changed("speed_rpm = 383.0", f"speed_rpm = {v}") for v in ('"fast"', "[1]")},
    "watts that are no number": changed("hysteresis_W = 45", "hysteresis_W = nan"),
    "loss with the name of a formula": f'{PMSM}\n[losses."=1+1"]\nkind = "constant"\nat = "winding.copper"\nP_W = 1\n',
    "group with the name of a formula": changed("{ impregnation = [", '{ "=1+1" = ['),
    "material with control characters": changed('base = "steel"', 'base = "\\u001b[2J"'),
    "lists in each other": "a = " + "[" * 100_000 + "]" * 100_000,
    "nothing": "",
    "17 MB of a remark": "#" + "x" * 17_000_000,
    "like a path": LIKE.replace("pmsm-m1", "../../etc/passwd"),
    "without its geometry": f'{LIKE}without = ["geometry"]\n',
    "base of itself": f'{LIKE}[bases]\nplate = "./m.toml"\n',
    "section of words": '[machine]\nname = "x"\nfamily = "pmsm"\n[geometry]\nframe = "x"\n',
    "cut in a key": PMSM[: len(PMSM) // 2],
}
SLOT = {"__class__": "__import__('os').system('touch PWNED')"}
JSON = {
    **{f"name: {kind}": pyleecan(name=NAMES[kind]) for kind in ("zero", "300 letters", "formula")},
    **{f"length of {v}": pyleecan(stator__L1=v) for v in (float("nan"), 1e-300, "1 m")},
    **{f"{v} slots": pyleecan(stator__slot__Zs=v) for v in (10**9, "12; rm", 0)},
    "class that runs": pyleecan(stator__slot=SLOT),
    "lists in each other": "[" * 100_000 + "]" * 100_000,
    "6000 digits": '{"__class__": "MachineIPMSM", "name": ' + "9" * 6000 + "}",
    "key twice": json.dumps(pyleecan()).replace('"Zs": 12', '"Zs": 12, "Zs": 13'),
    "UTF-16": json.dumps(pyleecan()).encode("utf-16"),
    "5000 holes": pyleecan(rotor__hole=pyleecan()["rotor"]["hole"] * 5000),
}
MOTOR_CAD = {
    "zero in the title": motor_cad(Title="\0"),
    "bytes": motor_cad().encode().replace(b"small", b"\xff\xfe\0"),
    **{f"air gap of {v}": motor_cad(Airgap=v) for v in ("nan", "-1")},
    **{f"{v} slots": motor_cad(Slot_Number=v) for v in ("1000000000", "twelve")},
    "nothing": "",
}
TEXTS = {
    **{f"m.toml, {kind}": ("m.toml", content) for kind, content in TOML.items()},
    **{f"m.json, {kind}": ("m.json", content) for kind, content in JSON.items()},
    **{f"m.mot, {kind}": ("m.mot", content) for kind, content in MOTOR_CAD.items()},
    "m.step, bytes": ("m.step", b"\xff\0" * 5000),
    "a name that is not text": (os.fsdecode(b"\xff\xfe.toml"), ""),
}


def box(side):
    return cq.Workplane().box(side, 10, 10)


def step(folder, beside="", **solids):
    """An assembly of named solids, and the file beside it."""
    assembly = cq.Assembly()
    for name, solid in solids.items():
        assembly.add(solid, name=name)
    assembly.export(str(folder / "m.step"))
    (folder / "m.step.toml").write_text(beside)


BESIDE = {
    "axis from a path": '[import]\naxis = "../x"\n',
    "origin nowhere": "[import]\norigin_mm = [nan, 1e300, 0]\n",
    "solids without a list": "[import]\nleave_out = 7\n",
    "nothing left": '[import]\nleave_out = ["*"]\n',
    "pattern of 2000 stars": f'[import]\nleave_out = ["{"*a" * 2000}"]\n',
    "name of a folder above": '[machine]\nname = "../PWNED"\n[materials]\nwinding = "winding"\n',
}
SOLIDS = {
    "a wire of 1000 km": {"winding": cq.Workplane().circle(1).extrude(1e9)},
    "a wire of nothing": {"winding": cq.Workplane().circle(1e-6).extrude(1e-6)},
    "a formula": {"=1+1": box(10)},
    "control characters": {ESCAPE: box(10)},
    "one in the other": {"winding": box(10), "shaft": box(10)},
    "a sphere": {"shaft": cq.Workplane().sphere(10)},
}
