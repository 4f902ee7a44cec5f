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
    "control character": ESCAPE,
    "zero": "x\0y",
    "right to left": "x\u202ey",
    "300 letters": "x" * 300,
    "folder above": "../../PWNED",
    "folder of the system": "/tmp/PWNED",
    "number": 7,
    "list": ["a"],
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
    "zero byte": changed("[ratings]", "\0[ratings]"),
    "no UTF-8": PMSM.encode().replace(b"pmsm-m1", b"pmsm-\xff\xfe", 1),
    "UTF-16": PMSM.encode("utf-16"),
    "key twice": slots("18\nslots = 19"),
    "section twice": f"{PMSM}\n[geometry.stator]\nslots = 3\n",
    **{f"length of {v}": length(v) for v in ("nan", "inf", "1e-300", "1e300", "-150.0", '"150"', "2026-01-01")},
    **{f"{v[:9]} slots": slots(v) for v in ("1000000000", "9" * 5000, "true", "17.5", "0")},
    "a million poles": changed("poles = 16", "poles = 1000000"),
    **{f"rated speed of {v}": changed("speed_rpm = 383.0", f"speed_rpm = {v}") for v in ('"fast"', "nan", "[1]", "-1")},
    "rated power of a day": changed("power_W = 7e3", "power_W = 2026-01-01"),
    "turns without end": changed("per_slot = 328", "per_slot = 1e300"),
    "watts that are no number": changed("hysteresis_W = 45", "hysteresis_W = nan"),
    "resistance of nothing": changed("R20_ohm = 0.88", "R20_ohm = -1"),
    "loss with the name of a formula": f'{PMSM}\n[losses."=1+1"]\nkind = "constant"\nat = "winding.copper"\nP_W = 1\n',
    "group with the name of a formula": changed("{ impregnation = [", '{ "=1+1" = ['),
    "material with control characters": changed('base = "steel"', 'base = "\\u001b[2J"'),
    "lists in each other": "a = " + "[" * 100_000 + "]" * 100_000,
    "tables in each other": "[" + ".".join(["a"] * 5000) + "]\nx = 1\n",
    "nothing": "",
    "17 MB of a remark": "#" + "x" * 17_000_000,
    "like a path": LIKE.replace("pmsm-m1", "../../etc/passwd"),
    "like itself": LIKE.replace("pmsm-m1", "m"),
    "without its geometry": f'{LIKE}without = ["geometry"]\n',
    "without control characters": f'{LIKE}without = ["a\\u001b[2J"]\n',
    "base from a path": f'{LIKE}[bases]\nplate = "../../../etc/passwd"\n',
    "base of itself": f'{LIKE}[bases]\nplate = "./m.toml"\n',
    "list of sections": changed("[ratings]", "[[ratings]]"),
    "section of words": '[machine]\nname = "x"\nfamily = "pmsm"\n[geometry]\nframe = "x"\n',
    "cut in a key": PMSM[: len(PMSM) // 2],
    "cut in a string": PMSM[: PMSM.index("PM machine M1, 7") + 5],
}
SLOT = {"__class__": "__import__('os').system('touch PWNED')"}
JSON = {
    **{f"name: {kind}": pyleecan(name=NAMES[kind]) for kind in ("control character", "zero", "300 letters", "formula")},
    **{f"length of {v}": pyleecan(stator__L1=v) for v in (float("nan"), float("inf"), 1e-300, 1e300, "1 m")},
    **{f"{v} slots": pyleecan(stator__slot__Zs=v) for v in (10**9, "12; rm", -12, 0)},
    "no poles": pyleecan(rotor__hole__0__Zh=0),
    "turns without end": pyleecan(stator__winding__Ntcoil=1e300),
    "class that runs": pyleecan(stator__slot=SLOT),
    "no stator": pyleecan(stator=None),
    "list": [1, 2, 3],
    "lists in each other": "[" * 100_000 + "]" * 100_000,
    "6000 digits": '{"__class__": "MachineIPMSM", "name": ' + "9" * 6000 + "}",
    "key twice": json.dumps(pyleecan()).replace('"Zs": 12', '"Zs": 12, "Zs": 13'),
    "cut": json.dumps(pyleecan())[:700],
    "UTF-16": json.dumps(pyleecan()).encode("utf-16"),
    "17 MB of blanks": json.dumps(pyleecan()) + " " * 17_000_000,
    "5000 holes": pyleecan(rotor__hole=pyleecan()["rotor"]["hole"] * 5000),
}
MOTOR_CAD = {
    "zero in the title": motor_cad(Title="\0"),
    "bytes": motor_cad().encode().replace(b"small", b"\xff\xfe\0"),
    **{f"air gap of {v}": motor_cad(Airgap=v) for v in ("nan", "1e999", "1e-300", "-1")},
    **{f"{v} slots": motor_cad(Slot_Number=v) for v in ("1000000000", "0", "twelve")},
    "speed of nothing": motor_cad(**{"Ref_Speed_-_Magnet_Iron_Loss": 0}),
    "nothing": "",
}
TEXTS = {
    **{f"m.toml, {kind}": ("m.toml", content) for kind, content in TOML.items()},
    **{f"m.json, {kind}": ("m.json", content) for kind, content in JSON.items()},
    **{f"m.mot, {kind}": ("m.mot", content) for kind, content in MOTOR_CAD.items()},
    "m.step, nothing": ("m.step", ""),
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
    "axis in a list": '[import]\naxis = ["x"]\n',
    "origin nowhere": "[import]\norigin_mm = [nan, 1e300, 0]\n",
    "solids without a list": "[import]\nleave_out = 7\n",
    "nothing left": '[import]\nleave_out = ["*"]\n',
    "pattern of 2000 stars": f'[import]\nleave_out = ["{"*a" * 2000}"]\n',
    "name of a folder above": '[machine]\nname = "../PWNED"\n[materials]\nwinding = "winding"\n',
    "rated speed in words": '[ratings]\nspeed_rpm = "fast"\n',
    "materials in a list": '[materials]\nwinding = ["winding"]\n',
}
SOLIDS = {
    "a wire of 1000 km": {"winding": cq.Workplane().circle(1).extrude(1e9)},
    "a wire of nothing": {"winding": cq.Workplane().circle(1e-6).extrude(1e-6)},
    "a formula": {"=1+1": box(10)},
    "control characters": {ESCAPE: box(10)},
    "one in the other": {"winding": box(10), "shaft": box(10)},
    "a sphere": {"shaft": cq.Workplane().sphere(10)},
}
