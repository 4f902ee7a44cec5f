"""A motor by hand in which every kind of site is: roles, bench, air gap, joints, an end space."""

MOTOR = """
[network]
name = "motor"
boundaries = ["ambient", "bench"]
[boundaries.ambient]
role = "ambient"
[boundaries.bench]
role = "test bed"
[nodes.winding]
role = "winding"
C_J_K = 500
[nodes.stator]
role = "iron"
C_J_K = 4000
[nodes.rotor]
role = "rotor"
C_J_K = 3000
[nodes.shield]
role = "end shield"
C_J_K = 1000
[nodes.housing]
role = "housing"
C_J_K = 2000
[nodes.air]
kind = "fluid"
C_J_K = 10
[links.liner]
between = ["winding", "stator"]
G_W_K = 20
[links.fit]
between = ["stator", "housing"]
G_W_K = 60
[links.spigot]
between = ["shield", "housing"]
G_W_K = 10
[links.shaft]
between = ["rotor", "shield"]
G_W_K = 1
[links.gap]
between = ["rotor", "stator"]
G_W_K = 4
[links.stirred]
between = ["winding", "shield"]
G_W_K = 1
of = { input = "speed_rpm", at = 1000, exponent = 0.8 }
[links.inside]
between = ["air", "winding"]
G_W_K = 2
[links.outside]
between = ["housing", "ambient"]
G_W_K = 8
[links.face]
between = ["shield", "ambient"]
G_W_K = 2
[links.foot]
between = ["housing", "bench"]
G_W_K = 3
"""
