"""The paper on thermal analysis of series-wound DC motors in electric vehicles."""

import numpy as np
from matplotlib.figure import Figure

from extras.bench.measuring.curves import assembly
from extras.bench.measuring.warming import eq8, equilibrium, fit_eq8
from lumped.drives.drive import SeriesMachine
from lumped.transfer.properties import ethylene_glycol
from scripts.papers.page import Row, Section, page

TITLE = "Evaluation for thermal analysis of DC motors in electric vehicles"
RATED = {"power": 100e3, "speed_rpm": 1000.0, "voltage": 220.0, "current": 511.0}
PUBLISHED = (85.0, -0.652, -0.08)
MINUTES = np.arange(0.0, 60.5, 0.5)


def motor() -> SeriesMachine:
    return SeriesMachine.from_ratings(RATED["power"], RATED["speed_rpm"], RATED["voltage"], RATED["current"])


def ratings() -> Section:
    m, omega = motor(), RATED["speed_rpm"] * np.pi / 30
    loss = RATED["voltage"] * RATED["current"] - RATED["power"]
    rows = (
        Row("torque at 100 kW, 1000 rpm", "955 N m", f"{RATED['power'] / omega:.0f} N m"),
        Row("L_af from T = L_af I^2", "-", f"{1e3 * m.L_af:.3f} mH"),
        Row("back-EMF at the rated point", "-", f"{omega * m.L_af * RATED['current']:.1f} V"),
        Row("R_a + R_f from eq. 1 in steady state", "-", f"{1e3 * m.R:.1f} mOhm"),
        Row(
            "loss at the rated point",
            "-",
            f"{loss / 1e3:.2f} kW",
            "all of it counts as (R_a + R_f) I^2 (eq. 7); friction and iron loss are not published",
        ),
        Row("efficiency", "-", f"{RATED['power'] / (RATED['power'] + loss):.3f}"),
    )
    return Section("Table 1 and eq. 1 to 7: ratings", "The ratings fix the series machine of eq. 1 to 6.", rows)


def torque() -> Section:
    m = motor()
    amps = np.array([50.0, 100.0, 200.0, 300.0, 400.0, 511.0])
    table = (("current (A)", *(f"{i:.0f}" for i in amps)), ("torque (N m)", *(f"{t:.0f}" for t in m.torque(amps))))
    words = "A parabola, since eq. 5 knows no saturation; the printed curve carries no numbers to compare with."
    return Section("Figure 3: torque against current", words, table=table, picture="torque-current.png")


def warming() -> Section:
    curve = eq8(MINUTES, *PUBLISHED)
    fit = fit_eq8(MINUTES, curve, start_C=20.0)
    noisy = fit_eq8(MINUTES, curve + 0.5 * np.random.default_rng(1).standard_normal(MINUTES.size))
    rise = f"95 % of the rise {fit.rise_min():.1f} min"
    rows = (
        *(
            Row(name, f"{p:g}", f"{v:.4g}", "with 0.5 K of scatter {:.4g} to {:.4g} (95 %)".format(*noisy.ci95[name]))
            for name, p, v in zip("abc", PUBLISHED, (fit.a, fit.b, fit.c))
        ),
        Row("T(0)", "ambient, 20 degC", f"{fit.start:.1f} degC", fit.warnings[0]),
        Row("tau_95, time to 95 % of T_e", "-", f"{fit.time_to_share_min():.1f} min", rise),
    )
    words = "T = a exp(b exp(c t)), t in minutes, fitted to the published curve every half minute."
    return Section("Figure 9 and eq. 8: the left flange in forced air", words, rows, picture="eq8.png")


def settled() -> Section:
    long = np.arange(0.0, 120.5, 0.5)
    found = equilibrium(long, eq8(long, *PUBLISHED), 0.5)
    short = equilibrium(MINUTES, eq8(MINUTES, *PUBLISHED), 0.5)
    meaning = "zero means: within the thermocouples' 0.5 K"
    rows = (
        Row("difference of late readings", "0", "0.5 K or less, 10 min apart", meaning),
        Row("equilibrium since", "-", f"{found.from_min:.0f} min" if found.from_min else "not reached"),
        Row("T_e", f"{PUBLISHED[0]:g} degC", f"{found.T_e:.1f} degC"),
        Row("drift at the end of the hour", "-", f"{short.drift_K_h:.1f} K/h"),
    )
    return Section("Eq. 9: equilibrium", "The detector on the published curve, continued to two hours.", rows)


def acceptance() -> Section:
    verdicts = [assembly("", (85.0, True), 85.0 * (1 + e / 100), 20.0) for e in (2.0, 3.5, 5.0, 8.0)]
    table = (
        ("error (% of T_e = 85 degC)", "2", "3.5", "5", "8"),
        ("verdict", *(v.verdict for v in verdicts)),
        ("the same in % of the rise from 20 degC", *(f"{v.percent_of_rise:.1f}" for v in verdicts)),
    )
    words = (
        "The rule is in percent of a temperature in degC, so it is milder than it looks. The measurements behind "
        "table 2 and figures 7, 8 and 10 to 12 are not published; the same story on simulated measurements, with the "
        "error per assembly, is `thermoscope demo`."
    )
    return Section("Table 2: within 3 to 4 %, never above 7 %", words, table=table)


def coolants() -> Section:
    glycol, air = ethylene_glycol(50.0, 0.5), 1.205 * 1006.0
    rate = 8e-3 / 60 * glycol.rho * glycol.cp
    loss = RATED["voltage"] * RATED["current"] - RATED["power"]
    heat_words = f"{rate:.0f} W/K: 12.4 kW heats it {loss / rate:.1f} K in one pass"
    air_words = "turning up the air flow hid convection on the right flange"
    loop_words = "20 to 80 degC is the loop warming up, not the rise through the jacket"
    rows = (
        Row("138 m3/h of air", "start value", f"{138 / 3600 * air:.0f} W/K in air of 1.2 kg/m3 and 20 degC"),
        Row("240 m3/h of air", "after correction", f"{240 / 3600 * air:.0f} W/K", air_words),
        Row("8 l/min of 50/50 glycol", "20 to 80 degC", heat_words, loop_words),
    )
    return Section("Section 3: what the coolants can carry", "Heat capacity rates of the stated flows.", rows)


def text() -> str:
    words = f"Recomputed from *{TITLE}*. Figures 1, 2 and 4 to 6 are drawings and photographs."
    return page(TITLE, words, [ratings(), torque(), warming(), settled(), acceptance(), coolants()])


def pictures() -> dict[str, object]:
    """File name -> matplotlib figure."""
    one, two = Figure((6, 3.4), layout="constrained"), Figure((6, 3.4), layout="constrained")
    amps = np.linspace(0, 511, 100)
    axes = one.subplots()
    axes.plot(amps, motor().torque(amps))
    axes.set(xlabel="current (A)", ylabel="torque (N m)", title="T = L_af I²")
    axes = two.subplots()
    axes.plot(MINUTES, eq8(MINUTES, *PUBLISHED), label="eq. 8 as published")
    axes.plot(0, 20, "o", label="stated start, 20 °C")
    axes.axvline(fit_eq8(MINUTES, eq8(MINUTES, *PUBLISHED)).time_to_share_min(), ls=":", color="grey", label="tau_95")
    axes.set(xlabel="time (min)", ylabel="left flange (°C)", ylim=(0, 90))
    axes.legend()
    return {"torque-current.png": one, "eq8.png": two}
