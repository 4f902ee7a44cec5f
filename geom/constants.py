"""Constants of nature, units, and what this house counts as sure: each stands here once."""

import math

SIGMA = 5.670374419e-8  # W/m2/K4, Stefan and Boltzmann, CODATA 2018
ZERO_C = 273.15  # K
GRAVITY = 9.80665  # m/s2, the standard one (CGPM 1901)
ALPHA_CU = 0.00393  # 1/K at 20 degC, annealed copper, IEC 60028
RPM = math.pi / 30.0  # rad/s
L_MIN, M3_H = 1.0 / 60000.0, 1.0 / 3600.0  # m3/s
NORMAL_95 = 1.96  # standard deviations on either side that hold 95 % of a normal distribution
