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


MOT = """[Header]
Program_Name=Motor-CAD
Program_Version=2024.1
Title=small
[Calc_Options]
Motor_Type=BPM
[Design_Options]
Housing_Type=Water_Jacket
BPM_Rotor=Surface_Radial
[Winding_Design]
Slot_Type=Parallel_Tooth
ConductorsPerSlot=40
Copper_Diameter=1
Liner_Thickness=0.25
Imp_Goodness_[Active]=0.8
MagThrow=3
[Dimensions]
Housing_Dia=150
Stator_Lam_Dia=110
Stator_Bore=60
Stator_Lam_Length=40
Rotor_Lam_Length=40
Slot_Number=12
Tooth_Width=8
Slot_Depth=14
Tooth_Tip_Depth=1
Slot_Opening=3
Tooth_Tip_Angle=20
Slot_Corner_Radius=1
Airgap=1
Pole_Number=4
Magnet_Thickness=4
Magnet_Arc_[ED]=150
Shaft_Dia=20
Bearing_Dia_[F]=40
Motor_Length=140
Endcap_Thickness_[F]=8
Wdg_Extension_[F]=4
EWdg_Overhang_[F]=20
WJ_Channel-Lam=6
WJ_Channel_Height=6
WJ_Channel_Width=12
WJ_Channel_Spacing=5
[Water_Jacket_Data]
Housing_Water_Jacket_Fluid_Name=EGW 50/50
WJ_Fluid_Volume_Flow_Rate=5E-5
HousingWJ_Inlet_Temperature=30
[Interface_Gaps]
Stator_Lam_-_Housing=0.02
[Losses_At_RPM_Ref]
Stator_Copper_Loss_@Ref_Speed=100
Magnet_Iron_Loss_@Ref_Speed=10
[Loss_RPM_Ref]
Ref_Speed_-_Magnet_Iron_Loss=2000
[Loss_RPM_Coeff]
Speed_Coeff_-_Magnet_Iron_Loss=2
[Mat_Conductivity]
Thermal_Conductivity_Slot_Liner=0.2
[Miscellaneous]
Shaft_Speed=1500
[Temperature Validation]
Temperature_Validation_Legend[3]=Winding (Avg)
Temperature_Validation_Temperature[3]=71.5
"""
V_SHAPE = """PoleVAngle_Array[0]=120
PoleArc_Array[0]=130
BridgeThickness_Array[0]=2
MagnetThickness_Array[0]=3
MagnetBarWidth_Array[0]=14
"""


def motor_cad(more="", **changes):
    """A small surface-magnet machine with a jacket.  changes : key -> value, None to leave a key out;  more : lines"""
    lines = []
    for line in MOT.splitlines():
        key = line.partition("=")[0]
        if key not in changes:
            lines.append(line)
        elif changes[key] is not None:
            lines.append(f"{key}={changes[key]}")
    return "\n".join(lines).replace("[Water_Jacket_Data]", f"{more}[Water_Jacket_Data]") + "\n"
