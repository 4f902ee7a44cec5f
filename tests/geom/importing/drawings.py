"""Cross-sections drawn with ezdxf: 24 slots with parallel sides, four flat magnets in their pockets."""

import cmath
import math

import ezdxf

BORE, OUTER, SLOTS, POLES = 40.0, 70.0, 24, 4  # mm
OPENING, TIP, WIDE, DEEP = 3.0, 41.0, 6.0, 60.0  # width, to this radius; width, to this radius
SURFACE, SHAFT = 39.2, 12.0
MAGNET = (27.0, 31.0, 20.0)  # from x to x, width
LAYERS = {
    "stator": "stator",
    "winding": "winding",
    "rotor": "rotor",
    "magnet": "magnet",
    "shaft": "shaft",
    "housing": "housing",
    "slot": "slot",
}


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
