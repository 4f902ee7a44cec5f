"""Where things are: positions along the axis and radii that several parts share."""

import math

from geom.description.geometry import Geometry


class SlotLayout:
    """A slot's radii (m); it asks for no length along the axis."""

    def __init__(self, g: Geometry) -> None:
        self.bore = g.stator.bore_diameter / 2
        self.slot0, self.slot1 = self.bore + g.stator.tip, self.bore + g.stator.slot_depth
        self.wire0 = self.slot0 + g.stator.liner_gap + g.stator.liner
        self.wire1 = self.slot1 - g.stator.liner_gap - g.stator.liner
        self.lining = g.stator.liner_gap + g.stator.liner
        self.slots, self.tooth = g.stator.slots, g.stator.tooth
        self.slot_width = g.stator.slot_width if g.stator.slot_shape == "parallel" else None

    def half_angle(self, radius: float, lining: float = 0.0) -> float:
        """Half the angle (rad) that a slot, narrower by the lining (m) on either side, takes at a radius (m)."""
        if self.slot_width is not None:
            return math.asin(max(self.slot_width / 2 - lining, 0.0) / radius)
        return math.pi / self.slots - math.asin(min((self.tooth / 2 + lining) / radius, 1.0))

    def width(self, radius: float, lining: float = 0.0) -> float:
        """Of a slot at a radius, inside a lining on either side (m)."""
        return 2 * radius * math.sin(max(self.half_angle(radius, lining), 0.0))


class Layout(SlotLayout):
    """Axial positions z... and radii r... (m)."""

    def __init__(self, g: Geometry) -> None:
        super().__init__(g)
        self.length = g.frame.length
        self.cowl0 = 0.0 - g.fan.depth  # no -0.0
        self.cap0, self.cap1 = g.frame.cap, g.frame.length - g.frame.cap
        self.core0 = (g.frame.length - g.stator.stack_length) / 2
        self.core1 = self.core0 + g.stator.stack_length
        self.coil0, self.coil1 = self.core0 - g.winding.straight, self.core1 + g.winding.straight
        self.ring0, self.ring1 = self.coil0 - g.winding.end, self.coil1 + g.winding.end
        self.middle = g.frame.length / 2
        self.foot0, self.foot1 = self.middle - g.foot.length / 2, self.middle + g.foot.length / 2
        self.rotor = self.bore - g.stator.air_gap
        self.core = g.stator.outer_diameter / 2
        self.wall = self.core + (0.0 if g.housing.kind == "none" else g.housing.thickness)
        self.channel = self.wall + g.housing.channel
        self.body = self.channel + g.housing.wall if g.housing.kind == "spiral" else self.wall
        self.fins = self.body + (g.housing.fin_height if g.housing.kind.endswith("fins") else 0.0)
        self.ground = -(self.fins + g.foot.height)
        self.cap_radius = self.body
