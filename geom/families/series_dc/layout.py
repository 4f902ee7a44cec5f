"""Where things are: positions along the axis and radii that several parts share."""

from geom.description.geometry import Geometry


class Axial:
    """Axial positions (m), left to right."""

    def __init__(self, g: Geometry) -> None:
        self.end = g.shaft.length
        self.fan0 = g.flange.shaft_end
        self.flange0 = self.fan0 + g.fan.depth
        self.inner0 = self.flange0 + g.flange.thickness
        self.flange1 = self.end - g.flange.shaft_end
        self.inner1 = self.flange1 - g.flange.thickness
        self.core0 = self.inner0 + g.flange.rotor_offset
        self.core1 = self.core0 + g.rotor.stack_length
        self.coil0, self.coil1 = self.core0 - g.rotor.straight, self.core1 + g.rotor.straight
        self.ring0, self.ring1 = self.coil0 - g.rotor.end_winding, self.coil1 + g.rotor.end_winding
        self.riser1 = self.ring1 + g.commutator.riser
        self.bars1 = self.riser1 + g.commutator.length
        self.yoke0, self.yoke1 = self.core0 - g.stator.yoke_overhang, self.core1 + g.stator.yoke_overhang
        self.field0 = self.core0 - g.field.insulation - g.field.coil_width
        self.field1 = self.core1 + g.field.insulation + g.field.coil_width
        # Each jacket's axial range: the housing between the feet, halved
        first = self.inner0 + g.feet.inset + g.feet.length
        last = self.inner1 - g.feet.inset - g.feet.length
        middle = (first + last) / 2
        self.jackets = dict([("jacket.left", (first, middle)), ("jacket.right", (middle, last))][: g.jacket.sides])


class Radii:
    """Radii and half widths (m) that several parts share."""

    def __init__(self, g: Geometry) -> None:
        self.rotor = g.rotor.outer_diameter / 2
        self.slot_bottom = self.rotor - g.rotor.slot_depth
        self.wire_bottom = self.slot_bottom + g.rotor.liner
        self.wire_top = self.rotor - g.rotor.wedge
        self.bore = self.rotor + g.stator.air_gap
        self.shoe_back = self.bore + g.stator.shoe
        self.coil0 = self.shoe_back + g.field.clearance
        self.coil1 = self.coil0 + g.field.coil_height
        self.body = g.stator.body_width / 2
        self.insulated = self.body + g.field.insulation
        self.coil_side = self.insulated + g.field.coil_width
        self.yoke0 = g.stator.yoke_inner_diameter / 2
        self.yoke1 = self.yoke0 + g.stator.yoke_thickness
        self.shell = self.yoke1 + g.housing.thickness
        self.channel = self.shell + g.jacket.height
        self.jacket = self.channel + g.jacket.wall
        self.fins = self.shell + (g.housing.fin_height if g.housing.fins else 0.0)
