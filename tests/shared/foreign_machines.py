"""Machines as other programs write them, small ones of our own; drawings of 24 slots with four magnets in pockets."""

import cmath
import json
import math

import ezdxf

COPPER = {"__class__": "Material", "name": "Copper1"}
STEEL = {"__class__": "Material", "name": "M400-50A"}


def pyleecan(**changes):
    """An interior-magnet machine: 12 slots, 4 poles, one flat magnet in its hole for each.  changes : by dotted path"""
    conductor = {"__class__": "CondType12", "Wwire": 0.001, "Nwppc": 1, "cond_mat": COPPER}
    winding = {"__class__": "Winding", "p": 2, "qs": 3, "Nlayer": 2, "Ntcoil": 20, "Npcp": 1, "coil_pitch": 3}
    winding |= {"Lewout": 0.003, "conductor": conductor}
    slot = {"__class__": "SlotW22", "Zs": 12, "H0": 0.001, "H2": 0.012, "W0": 0.1, "W2": 0.3}
    stator = {"__class__": "LamSlotWind", "Rint": 0.03, "Rext": 0.055, "L1": 0.04, "Kf1": 0.95, "is_internal": False}
    hole = {"__class__": "HoleM63", "Zh": 4, "H0": 0.003, "H1": 0.002, "W0": 0.02, "top_flat": True}
    hole |= {"magnet_0": {"__class__": "Magnet", "Lmag": 0.04}}
    rotor = {"__class__": "LamHole", "Rint": 0.01, "Rext": 0.0295, "L1": 0.04, "is_internal": True, "hole": [hole]}
    machine = {
        "__class__": "MachineIPMSM",
        "__version__": "pyleecan_1.5.0",
        "name": "small",
        "stator": {**stator, "slot": slot, "winding": winding, "mat_type": STEEL},
        "rotor": {**rotor, "mat_type": STEEL},
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
Thermal_Conductivity_Housing_[A]=168
Thermal_Conductivity_Stator_Lam_[Back_Iron]=30
Thermal_Conductivity_Copper_-_Active=401
[Mat_Cp]
Specific_Heat_Housing_[A]=833
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


BORE, OUTER, SLOTS, POLES = 40.0, 70.0, 24, 4  # mm
OPENING, TIP, WIDE, DEEP = 3.0, 41.0, 6.0, 60.0  # width, to this radius; width, to this radius
SURFACE, SHAFT = 39.2, 12.0
MAGNET = (27.0, 31.0, 20.0)  # from x to x, width
LAYERS = {name: name for name in ("stator", "winding", "rotor", "magnet", "shaft", "housing", "slot")}


def on_circle(radius, y):
    return complex(math.sqrt(radius**2 - y**2), y)


def slot_points():
    """From the bore below the middle to the bore above it."""
    half, wide = OPENING / 2, WIDE / 2
    upper = [on_circle(BORE, half), TIP + 1j * half, TIP + 1j * wide, DEEP + 1j * wide]
    return [*(z.conjugate() for z in upper), *reversed(upper)]


def box(x0, x1, width):
    return [x0 - 0.5j * width, x1 - 0.5j * width, x1 + 0.5j * width, x0 + 0.5j * width]


class Sheet:
    """A drawing in the making.  unit : mm per unit;  axis : where the machine's is;  names : layers of the parts"""

    def __init__(self, insunits=4, unit=1.0, axis=0j, names=None):
        self.document = ezdxf.new()
        self.document.header["$INSUNITS"] = insunits
        self.space, self.unit, self.axis = self.document.modelspace(), unit, axis
        self.names = LAYERS | (names or {})

    def at(self, z):
        z = z / self.unit + self.axis
        return (z.real, z.imag)

    def line(self, layer, a, b):
        self.space.add_line(self.at(a), self.at(b), dxfattribs={"layer": self.names.get(layer, layer)})

    def lines(self, layer, points, turn=1.0, close=True):
        points = [z * turn for z in points]
        for a, b in zip(points, points[1:] + points[:1] if close else points[1:]):
            self.line(layer, a, b)

    def polyline(self, layer, points, turn=1.0, bulges=None):
        points = [(*self.at(z * turn), b) for z, b in zip(points, bulges or [0.0] * len(points))]
        attributes = {"layer": self.names.get(layer, layer)}
        self.space.add_lwpolyline(points, format="xyb", close=True, dxfattribs=attributes)

    def arc(self, layer, radius, a, b):
        """Around the axis, from one angle (rad) to another."""
        ends = (math.degrees(a), math.degrees(b))
        self.space.add_arc(self.at(0j), radius / self.unit, *ends, dxfattribs={"layer": self.names.get(layer, layer)})

    def circle(self, layer, radius):
        self.space.add_circle(self.at(0j), radius / self.unit, dxfattribs={"layer": self.names.get(layer, layer)})

    def saved(self, folder, name="drawn.dxf"):
        self.document.saveas(folder / name)
        return folder / name


def stator(sheet, count=SLOTS, first=0.0, sides=True, winding=None):
    """Pitches with their slot in the middle, from `first` of a pitch on.  winding : corners, as in a slot around +x"""
    pitch = 2 * math.pi / SLOTS
    for k in range(count):
        middle = (first + k) * pitch
        turn, half = cmath.exp(1j * middle), cmath.phase(slot_points()[-1])
        sheet.lines("stator", slot_points(), turn, close=False)
        sheet.arc("stator", BORE, middle - pitch / 2, middle - half)
        sheet.arc("stator", BORE, middle + half, middle + pitch / 2)
        sheet.polyline("winding", winding or box(TIP + 1, DEEP - 0.25, WIDE - 0.5), turn)
    if count == SLOTS:
        sheet.circle("stator", OUTER)
        return
    ends = [(first - 0.5) * pitch, (first + count - 0.5) * pitch]
    sheet.arc("stator", OUTER, *ends)
    for angle in ends if sides else ():
        sheet.line("stator", BORE * cmath.exp(1j * angle), OUTER * cmath.exp(1j * angle))


def rotor(sheet, count=POLES):
    """Poles with their magnet in the middle, pockets as holes in the iron."""
    pitch = 2 * math.pi / POLES
    for k in range(count):
        turn = cmath.exp(1j * k * pitch)
        sheet.lines("rotor", box(*MAGNET), turn)
        sheet.polyline("magnet", box(*MAGNET), turn)
    if count == POLES:
        sheet.circle("rotor", SURFACE)
        sheet.circle("rotor", SHAFT)
        return
    ends = [-pitch / 2, (count - 0.5) * pitch]
    for radius in (SURFACE, SHAFT):
        sheet.arc("rotor", radius, *ends)
    for angle in ends:
        sheet.line("rotor", SHAFT * cmath.exp(1j * angle), SURFACE * cmath.exp(1j * angle))


def whole(**options):
    sheet = Sheet(**options)
    stator(sheet)
    rotor(sheet)
    return sheet
