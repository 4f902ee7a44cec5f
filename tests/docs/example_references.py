"""What the examples are held against, in the checkout and in the wheel."""

# What `computed` may differ from `expected` by, and why.
REFERENCE = {
    "slab": 1.0,  # s of 610: zeta is tabulated to four digits (0.1 s), forty cells err by 1/12/40^2 (0.1 s); air 0.5 s
    "hollow_cylinder": 1e-6,  # K: the circuit is exact for the mean
    "jacket": 0.15,  # K: half of a cell's transfer units, 0.005, of what is left of 50 K times 0.6
    "shaft_fan": 0.01,  # K of 50: Radau is exact to 1e-6, the tool's steps keep to a few mK
    "copper_feedback": 1e-6,  # K: Newton's method to rounding
    "duty_cycle": 0.01,  # K of 70: steps of the integrator
    "radiation": 3.6,  # s of 3600: a thousandth, the tool's time steps
    "two_bodies": 0.01,  # K of 80: steps of the integrator
    "own_effect": 1e-6,  # K: linear
    "fin": 2e-4,  # of 0.79: the mean of forty cells errs by (mL)^2 / (4 N^2) = 1.3e-4 at most
    "composite_wall": 1e-6,  # K: resistances in series are exact
    "generation": 1e-6,  # K: the sum over the layers is exact
    "semi_infinite": 0.08,  # K of 80: cells of 2.5 mm in a front of 65 mm err by (1/26)^2 of it at most
    "periodic": 0.01,  # K of 20: steps of the integrator
    "two_blocks": 0.01,  # K of 130: steps of the integrator; the wire takes 1e-6 of the joint's heat
    "free_convection": 0.01,  # K of 100: steps of the integrator
    "short_time_duty": 0.05,  # s of 518: the curve is nearly straight within a sample of 1 s
    "delta_star": 1e-6,  # K: both are exact
    "iron_loss": 1e-6,  # W: linear
    "reciprocity": 1e-12,  # K/W of 0.1: rounding
    "locked_rotor": 1e-3,  # s of 23: the curve is nearly straight within a sample of 0.1 s
    "ramp": 0.01,  # K of 30: what a step of the integrator may be wrong by
    "switched_fan": 0.016,  # K: an input is straight between samples, so the fan starts 0.5 s early; it takes 0.03 K/s
    "thermal_wave": 0.1,  # K of 30: what is left of the start, and the first cell, a tenth of d, by (1/10)^2 / 12 of 30
    "fan_for_a_while": 10.0,  # s: two samples
    "superposition": 0.01,  # K of 57: steps of the integrator
    "field_of_a_ring": 0.1,  # K of 110: 144 chords for a circle and twelve linear cells across
    "gap_laws": 1e-9,  # W/m2/K: conduction, exactly
    "rotor_friction": 1e-6,  # K: linear
    "pressed_and_grey": 1e-6,  # K, W/m2, 1: closed forms
    "cooling_law": 0.5,  # K of 9 to 20: two standard deviations of its numbers, half as far again as the tests go
    "duct_shapes": 5e-3,  # of Nu: the polynomial of the table, printed to four digits
}
NEED_EXTRAS = {"field_of_a_ring"}  # the others run with the core alone
