"""What an input measures, and the input that a column of each quantity feeds where its sheet names none."""

from collections.abc import Mapping

INPUTS: Mapping[str, str] = {
    "current": "current_A",
    "speed": "speed_rpm",
    "vehicle_speed": "vehicle_speed_mps",
    "air_flow": "fan_flow_m3h",
    "water_flow": "flow_l_min",
    "torque": "torque_Nm",
    "power": "power_W",
    "voltage": "voltage_V",
    "frequency": "switching_Hz",
    "share": "share_percent",
    "flow_share": "flow_percent",
}
AIR, LIQUID = "air_flow", "water_flow"
FLOWS = ("vehicle_speed", AIR, LIQUID, "flow_share")  # that cool, and heat nothing
USUAL: Mapping[str, str] = {name: quantity for quantity, name in INPUTS.items()}
