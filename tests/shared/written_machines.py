"""Machines as other programs write them, small ones of our own."""

import json

COPPER = {"__class__": "Material", "name": "Copper1"}
STEEL = {"__class__": "Material", "name": "M400-50A"}


def pyleecan(**changes):
    """An interior-magnet machine: 12 slots, 4 poles, one flat magnet in its hole for each.  changes : by dotted path"""
    machine = {
        "__class__": "MachineIPMSM",
        "__version__": "pyleecan_1.5.0",
        "name": "small",
        "stator": {
            "__class__": "LamSlotWind",
            "Rint": 0.03,
            "Rext": 0.055,
            "L1": 0.04,
            "Kf1": 0.95,
            "is_internal": False,
            "slot": {"__class__": "SlotW22", "Zs": 12, "H0": 0.001, "H2": 0.012, "W0": 0.1, "W2": 0.3},
            "winding": {
                "__class__": "Winding",
                "p": 2,
                "qs": 3,
                "Nlayer": 2,
                "Ntcoil": 20,
                "Npcp": 1,
                "coil_pitch": 3,
                "Lewout": 0.003,
                "conductor": {"__class__": "CondType12", "Wwire": 0.001, "Nwppc": 1, "cond_mat": COPPER},
            },
            "mat_type": STEEL,
        },
        "rotor": {
            "__class__": "LamHole",
            "Rint": 0.01,
            "Rext": 0.0295,
            "L1": 0.04,
            "is_internal": True,
            "hole": [
                {
                    "__class__": "HoleM63",
                    "Zh": 4,
                    "H0": 0.003,
                    "H1": 0.002,
                    "W0": 0.02,
                    "top_flat": True,
                    "magnet_0": {"__class__": "Magnet", "Lmag": 0.04},
                }
            ],
            "mat_type": STEEL,
        },
        "shaft": {"__class__": "Shaft", "Drsh": 0.02},
    }
    for path, value in changes.items():
        put(machine, path.split("__"), value)
    return machine


def put(machine, words, value):
    *way, last = (int(word) if word.isdigit() else word for word in words)
    for word in way:
        machine = machine[word]
    machine[last] = value


def saved(folder, machine, name="small.json"):
    path = folder / name
    path.write_text(machine if isinstance(machine, str) else json.dumps(machine))
    return path
