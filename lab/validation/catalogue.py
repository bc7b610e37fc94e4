# SPDX-License-Identifier: BSD-3-Clause
"""The gear maker's catalogue, size 25, ratio 101: stiffness, friction, efficiency, accuracy."""
import math

import numpy as np

from bounds import Within
from evidence import SELF_CONSISTENT, fitted, measured
from page import BLUE, GREEN, GREY, ORANGE, RED, number

ARCMIN = math.radians(1.0 / 60.0)
RATIO = 101
RPM_2000 = 2000.0 * math.pi / 30.0  # rad/s
RATED_TORQUE = 67.0  # N.m, HFUS-25-2SH
EFFICIENCY_TORQUE = 87.0  # N.m, where the catalogue states the efficiency

# Whole gear: K1, K2, K3 [N.m/rad], T1, T2 [N.m].
STIFFNESSES, BREAKPOINTS = (31e3, 50e3, 57e3), (14.0, 48.0)
TORQUES = (14.0, 48.0, 67.0, 108.0, 150.0)
EFFICIENCY = 0.77
# Efficiency at part load over that at rated load, by load over rated load.
PART_LOADS = {0.1: 0.30, 0.4: 0.72, 0.7: 0.90}
NO_LOAD, STARTING, BACK_DRIVING = 0.195, 0.069, 7.26  # N.m; the last at the output
OIL = {40.0: 37.0, 100.0: 5.9}  # mm^2/s by degC, as quoted for the grease's base oil
LOOP_TORQUES = (2.0, 5.0, 14.0, 67.0)  # N.m
CREEPING = 1.0  # rad/s at the motor: friction by load, hardly any by speed
AT_20_DEGREES = ("--set", "input.temperature=20.0")

FRICTION_SHARES = "bearing.viscosity and race_preload are fitted to two other figures of the same catalogue"

# Worst errors of zhulu248/harmonic-drive-twin over its four sizes, with its three global dials.
OTHER_TWIN = {"efficiency": "2.2 points", "no_load": "25 %", "starting": "19 %", "back_driving": "19 %",
              "stiffness": "37 … 93 %"}


def catalogue_angle(torque, stiffnesses=STIFFNESSES, breakpoints=BREAKPOINTS):
    """Torsion of a whole gear [rad] under a load >= 0 [N.m]."""
    angle, start = 0.0, 0.0
    for slope, end in zip(stiffnesses, (*breakpoints, math.inf)):
        if torque > start:
            angle += (min(torque, end) - start) / slope
        start = end
    return angle


def build(page):
    stiffness(page)
    hysteresis(page)
    loops(page)
    friction(page)
    efficiency(page)
    temperature(page)
    dials(page)


def stiffness(page):
    page.heading("Torsion of the whole gear")
    page.text("""
Wave generator locked, load on the circular spline. The catalogue's three slopes are those of the whole gear. Rim and
teeth take their share of the twist, so the cup's own law is stiffer by as much: its three slopes are fitted, the
assembly's angles judged.
""")
    rows = page.tool("stiffness", "--torques", ",".join(map(str, TORQUES)))["rows"]
    for row in rows:
        torque = row["torque"]
        page.check(f"catalogue.torsion.{torque:g}", f"torsion at {torque:g} N·m",
                   "catalogue: 31/50/57e3 N·m/rad, 14/48 N·m",
                   Within(catalogue_angle(torque) / ARCMIN, relative=0.02), -row["output_angle"] / ARCMIN, "arcmin",
                   "asked of the twin; three straight lines stand for a curve",
                   evidence=fitted("cup.torsion_* to the catalogue's slopes"))
    if page.fast:
        return
    sweep = np.linspace(-150.0, 150.0, 61)
    curve = page.tool("stiffness", "--torques", ",".join(f"{torque:g}" for torque in sweep))["rows"]
    bare = page.tool("stiffness", "--torques", ",".join(f"{torque:g}" for torque in sweep), "--set",
                     "cup.torsion_stiffness=[31.0e+3, 50.0e+3, 57.0e+3]")["rows"]

    def draw(figure):
        left, right = figure.subplots(1, 2)
        left.set_title("Torsion [arcmin] against load [N·m]")
        expected = [math.copysign(catalogue_angle(abs(torque)), torque) / ARCMIN for torque in sweep]
        left.plot(sweep, expected, color=ORANGE, lw=4, alpha=0.5, label="catalogue")
        left.plot(sweep, [-row["output_angle"] / ARCMIN for row in curve], color=BLUE, label="twin")
        left.legend()
        right.set_title("Twist beyond the catalogue's [%]")
        loads = [torque for torque in sweep if torque > 1.0]
        for rows_drawn, colour, label in ((bare, GREY, "cup as stiff as the whole gear"), (curve, BLUE, "cup fitted")):
            right.plot(loads, [100.0 * (-row["output_angle"] / catalogue_angle(row["torque"]) - 1.0)
                               for row in rows_drawn if row["torque"] > 1.0], color=colour, label=label)
        right.axhspan(-2.0, 2.0, color=GREEN, alpha=0.12, label="tolerance")
        right.set_xlabel("load [N·m]")
        left.set_xlabel("load [N·m]")
        right.legend()

    most = max(-row["output_angle"] / catalogue_angle(row["torque"]) - 1.0 for row in bare if row["torque"] > 1.0)
    page.figure("catalogue_torsion",
                f"Torsion of the locked gear. Without the fit, rim and teeth add up to {100.0 * most:.0f} % to "
                "the catalogue's twist; with it, the rounding of the curve between the catalogue's straight lines is "
                "left.", draw)


def hysteresis(page):
    page.heading("Hysteresis and lost motion")
    sweep = ("hysteresis", "--amplitude", RATED_TORQUE, "--lost-motion-torque", 0.04 * RATED_TORQUE)
    loop = page.tool(*sweep)
    flanks = page.tool(*sweep, "--set", "cup.friction_torque=0.0")
    page.text(f"""
Wave generator locked, load cycled slowly over the rated torque. The width comes from dry friction: of the
tooth flanks ({flanks["hysteresis"] / ARCMIN:.2g} arcmin) and in parallel with the cup's spring (the rest). The latter
is set by a real drive, see *Real drives*; the catalogue gives a limit.
""")
    page.value("catalogue.hysteresis", loop["hysteresis"] / ARCMIN, "arcmin")
    page.value("catalogue.lost_motion", loop["lost_motion"] / ARCMIN, "arcmin")


def loops(page):
    page.heading("Torsion loops by amplitude")
    cup = page.tool("parameters")["cup"]
    widths = [0.5 * cup["friction_angle"] * 3.0 ** -j for j in range(6)]
    spring = cup["friction_torque"] / sum(widths)
    page.text("""
The friction beside the cup's spring is six springs with sliders (Masing's model): small loops are narrower than large
ones, and all branches are one curve. The expected area is the closed form 4 k Σ w (A − w) over the elements that
slip, A the cup's own rotation under what the housing holds at the largest load; the area of the loop of the whole
gear is integrated. Its height grows by the friction: the load at the ends is the given one plus that. No loops of a
real drive of this size at several amplitudes are public, so the growth itself is not compared.
""")
    rows = []
    for torque in LOOP_TORQUES:
        loop = page.tool("hysteresis", "--amplitude", torque, "--lost-motion-torque", 0.5 * torque, "--set",
                         "mesh.friction_static=0.0", "--set", "mesh.friction_kinetic=0.0")
        load = np.array([point["torque"] for point in loop["points"]])
        angle = np.array([point["output_angle"] for point in loop["points"]])
        area = float(np.sum(0.5 * (load[1:] + load[:-1]) * np.diff(angle)))
        turned = catalogue_angle(torque * (RATIO - 1.0) / RATIO, cup["torsion_stiffness"], cup["torsion_breakpoints"])
        expected = sum(4.0 * spring * width * max(turned - width, 0.0) for width in widths)
        page.check(f"catalogue.loop.{torque:g}", f"energy of a torsion loop of ± {torque:g} N·m", "closed form",
                   Within(1e6 * expected, relative=0.01), 1e6 * area, "µJ", "integration over 400 points",
                   evidence=SELF_CONSISTENT)
        page.value(f"catalogue.loop_width.{torque:g}", 1e6 * loop["hysteresis"], "µrad")
        page.value(f"catalogue.loop_loss.{torque:g}", area / (math.pi * load.max() * angle.max()), "")
        rows.append([f"{torque:g} N·m", number(1e6 * loop["hysteresis"]) + " µrad", number(1e6 * area) + " µJ",
                     number(area / (math.pi * load.max() * angle.max()))])
    page.table(["amplitude", "width at no load", "energy of a loop", "loss factor"], rows)


def losses(page, speeds, loads, *arguments):
    """Rows of `joint_twin losses`, at 20 degC unless other arguments are given."""
    return page.tool("losses", "--speeds", ",".join(f"{speed:.6g}" for speed in speeds), "--loads",
                     ",".join(f"{load:.6g}" for load in loads), *(arguments or AT_20_DEGREES))["rows"]


def friction(page):
    page.heading("Friction")
    page.text("""
The gear alone, without the motor's friction. Running: mean over a tooth pitch; starting: the largest over a tooth
pitch, at rest; back-driving: the load at the output whose own pull overcomes the friction at the wave generator.
""")
    running = losses(page, [RPM_2000], [0.0])[0]
    starts = page.tool("breakaway", *AT_20_DEGREES)
    page.check("catalogue.no_load", "no-load running torque, 2000 rpm, 20 °C", "catalogue (RT1-H-CS-25)",
               Within(NO_LOAD, relative=0.10), running["gear_loss"], "N·m", "asked of the twin; drives scatter more",
               evidence=fitted("bearing.viscosity to it (lab/run calibrate 25)"))
    page.check("catalogue.starting", "starting torque, 20 °C", "same", Within(STARTING, relative=0.10),
               starts["starting_torque"], "N·m", "asked of the twin",
               evidence=fitted("bearing.race_preload to it (lab/run calibrate 25)"))
    page.check("catalogue.back_driving", "back-driving torque, 20 °C", "catalogue (RT1-H-CS-25)",
               Within(BACK_DRIVING, relative=0.15),
               starts["back_driving_torque"], "N·m", "asked of the twin; nothing is fitted to it",
               evidence=measured(FRICTION_SHARES))
    # What slips between race and rim, from the shape alone: the tilt of a ring bent to w0 cos 2 psi turns at
    # (3 w0 / r0) |cos 2 psi| per motor turn, under a contact force that is nearly the same all around.
    insertion = page.tool("insert")
    contact, gear = (page.tool("parameters")[section] for section in ("contact", "gear"))
    slip = contact["slip_lever"] * 3.0 * gear["wave_amplitude"] / gear["flexspline_inner_radius"]
    page.check("catalogue.interface_slip", "torque of the race slipping in the rim, no mesh load",
               "μ = 0.07 (thesis, Table 3.2) "
               "× ΣF × lever × 3 w0/r0 × 2/π",
               Within(0.07 * insertion["wave_generator_force_sum"] * slip * 2.0 / math.pi,
                      relative=0.30), running["interface"], "N·m",
               "the closed form leaves out that teeth at the lobes press the rim on, where it tilts fastest",
               evidence=SELF_CONSISTENT)


def efficiency(page):
    page.heading("Efficiency")
    page.text("""
At 2000 rpm and 20 °C. No friction is fitted to it: the load raises the contact forces, and with them the bearing's
and the flanks' friction.
""")
    rated = losses(page, [RPM_2000], [EFFICIENCY_TORQUE])[0]
    page.check("catalogue.efficiency", f"efficiency at {EFFICIENCY_TORQUE:g} N·m", "catalogue: 77 ± 3 %; thesis 75 %",
               Within(EFFICIENCY, absolute=0.022), rated["gear_efficiency"], "",
               "the worst error of the best public twin; the catalogue's own is ± 3 points",
               evidence=measured(FRICTION_SHARES))
    still, loaded = losses(page, [CREEPING], [0.0, RATED_TORQUE])
    by_load = 100.0 * (loaded["gear_loss"] - still["gear_loss"]) * RATIO / RATED_TORQUE
    page.text(f"""
A load of {RATED_TORQUE:g} N·m adds {by_load:.1f} % of it as loss at low speed; drives of other makers (xMate, eRob)
5 to 13 %, two joints of a UR10e 6 % (*Real drives*).
""")
    page.value("catalogue.load_dependent_loss", by_load, "%")
    # What slides on the flanks, from the shape alone: at an angle a from the lobe a tooth moves in and out of its space
    # by 2 w0 sin 2a per motor turn.
    gear, mesh = (page.tool("parameters")[section] for section in ("gear", "mesh"))
    page.tool("stiffness", "--torques", EFFICIENCY_TORQUE, "--csv", "teeth.csv")
    teeth = np.genfromtxt(page.scratch("teeth.csv"), delimiter=",", names=True)
    angles = 2.0 * math.pi * teeth["tooth"] / gear["teeth_flexspline"]
    slip = 2.0 * gear["wave_amplitude"] * np.abs(np.sin(2.0 * angles)) / math.cos(mesh["flank_angle"])
    page.check("catalogue.flank_slip", f"torque of the flanks' friction at {EFFICIENCY_TORQUE:g} N·m",
               "μ = 0.06 × Σ flank force × 2 w0 sin 2α / cos β",
               Within(1e3 * 0.06 * float(np.sum(np.abs(teeth["mesh_force"]) * slip)), relative=0.15),
               1e3 * rated["mesh"], "mN·m",
               "the closed form leaves out that teeth tilt and the rim gives way", evidence=SELF_CONSISTENT)
    part = losses(page, [RPM_2000], [share * RATED_TORQUE for share in PART_LOADS])
    for (share, factor), row in zip(PART_LOADS.items(), part):
        page.check(f"catalogue.efficiency.{share:g}", f"efficiency at {share:g} of the rated torque",
                   f"catalogue: {factor:g} of the one at rated torque", Within(factor * EFFICIENCY, absolute=0.05),
                   row["gear_efficiency"], "", "asked of the twin; the factors are read from a diagram",
                   evidence=measured(FRICTION_SHARES))
    loss_at_tenth = 0.1 * EFFICIENCY_TORQUE / RATIO * (1.0 / (PART_LOADS[0.1] * EFFICIENCY) - 1.0)
    loss_at_rated = EFFICIENCY_TORQUE / RATIO * (1.0 / EFFICIENCY - 1.0)
    page.text(f"""
The part loads are taken of the gear's rated torque, {RATED_TORQUE:g} N·m. Taken of {EFFICIENCY_TORQUE:g} N·m instead,
the catalogue's factors would contradict its own friction: a tenth of the load would lose
{number(1000.0 * loss_at_tenth)} mN·m at the motor, more than the {number(1000.0 * loss_at_rated)} mN·m of the whole
load and than the {number(1000.0 * NO_LOAD)} mN·m of none.
""")
    if page.fast:
        return
    draw_efficiency(page)


def draw_efficiency(page):
    loads = np.linspace(2.0, 150.0, 38)
    rows = losses(page, [RPM_2000], loads)
    slow = losses(page, [RPM_2000 / 4.0], loads)

    def draw(figure):
        left, right = figure.subplots(1, 2)
        left.set_title("Efficiency [%]")
        left.plot(loads, [100.0 * row["gear_efficiency"] for row in rows], color=BLUE, label="twin, 2000 rpm")
        left.plot(loads, [100.0 * row["gear_efficiency"] for row in slow], color=GREEN, label="twin, 500 rpm")
        left.errorbar([EFFICIENCY_TORQUE], [77.0], yerr=3.0, fmt="o", color=ORANGE, label="catalogue, 2000 rpm")
        left.plot([share * RATED_TORQUE for share in PART_LOADS], [77.0 * factor for factor in PART_LOADS.values()],
                  "s",
                  color=RED, label="catalogue, part load")
        left.legend()
        right.set_title("Friction at the motor, 2000 rpm [mN·m]")
        shares = [[1000.0 * row[key] for row in rows] for key in ("bearing", "interface", "mesh")]
        right.stackplot(loads, shares, labels=["bearing and grease", "race in the rim", "tooth flanks"],
                        colors=[BLUE, ORANGE, GREEN], alpha=0.7)
        right.legend(loc="upper left")
        for axes in (left, right):
            axes.set_xlabel("load [N·m]")

    page.figure("catalogue_efficiency", "Efficiency against load, and the friction behind it.", draw)


def walther(parameters, temperature):
    """Kinematic viscosity of the grease's oil [mm^2/s] after Walther (ASTM D341)."""
    known = math.log10(1e6 * parameters["oil_viscosity"] + 0.7)
    ratio = (temperature + 273.15) / (parameters["viscosity_temperature"] + 273.15)
    return 10.0 ** (known * ratio ** -parameters["viscosity_slope"]) - 0.7


def temperature(page):
    page.heading("Friction against temperature")
    page.text("""
The grease thins as its base oil does (Walther, ASTM D341), and the bearing's speed part goes with the viscosity to the
power of 2/3 (Palmgren). The oil's law has the oil's own constants; what the grease acts with beyond it is a factor that
does not depend on the temperature. The range is that of the grease SK-1A, 0 to 80 °C. The rows of consistency compare
the twin with the same law evaluated here: they show that the law is what runs, not that it is right.
""")
    bearing = page.tool("parameters")["bearing"]
    degrees = (0.0, 20.0, 40.0, 80.0)
    running = {degree: losses(page, [0.0, RPM_2000], [0.0], "--set", f"input.temperature={degree:.1f}")
               for degree in degrees}
    # below 2000 mm^2/s rpm
    floor = 160.0 * bearing["lubricant_factor"] * (1e3 * bearing["pitch_diameter"]) ** 3 * 1e-10
    speed_part = {degree: rows[1]["bearing"] - rows[0]["bearing"] + floor for degree, rows in running.items()}
    for degree in (0.0, 40.0, 80.0):
        expected = (walther(bearing, degree) / walther(bearing, 20.0)) ** (2.0 / 3.0)
        page.check(f"catalogue.consistency.temperature.{degree:g}",
                   f"speed part of the friction at {degree:g} °C over that at 20 °C",
                   "self-consistency", Within(expected, relative=1e-3), speed_part[degree] / speed_part[20.0], "",
                   "the same law evaluated on the page", evidence=SELF_CONSISTENT)
    for degree, viscosity in OIL.items():
        page.check(f"catalogue.oil.{degree:g}", f"viscosity of the base oil at {degree:g} °C",
                   "quoted for SK-1A; no data sheet at hand",
                   Within(viscosity, relative=0.03), walther(bearing, degree), "mm²/s",
                   "its law starts from the thesis' 80 mm²/s at 25 °C; these two give 77.5 there",
                   evidence=fitted("bearing.viscosity_slope is made of these two figures"))


def dials(page):
    page.heading("Fitted parameters, and a comparison")
    bearing, cup = (page.tool("parameters")[section] for section in ("bearing", "cup"))
    page.text("""
Two fitted parameters for five figures of friction, one for the torsion loop, and the cup's law, with as many numbers
as the catalogue's curve.
""")
    page.table(["dial", "value", "set by", "order of size without it"],
               [["`bearing.viscosity`", f"{number(1e6 * bearing['viscosity'])} mm²/s at 25 °C",
                 "no-load running torque",
                 "base oil of the grease alone: 80 mm²/s (thesis, Table 3.2); thins as that"],
                ["`bearing.race_preload`", f"{number(bearing['race_preload'])} N", "starting torque",
                 "0: no interference between the races, whose bending is in the model"],
                ["`cup.friction_torque`", f"{number(cup['friction_torque'])} N·m",
                 "direction gap of a real 101:1 drive",
                 "at most 4.5 N·m by the catalogue's 1 arcmin"],
                ["`cup.torsion_stiffness`", ", ".join(f"{number(value / 1e3)}" for value in cup["torsion_stiffness"]) +
                 " ·10³ N·m/rad", "torsion at 14, 48 and 150 N·m", "31, 50, 57 ·10³: the whole gear's"]])
    by_name = {row.name: row for row in page.rows}

    def error(name):
        row = by_name["catalogue." + name]
        return row.value - row.bound.target, row.bound.target

    points = 100.0 * abs(error("efficiency")[0])
    percent = {key: 100.0 * error(key)[0] / error(key)[1] for key in ("no_load", "starting", "back_driving")}
    torsion = max(abs(100.0 * error(f"torsion.{torque:g}")[0] / error(f"torsion.{torque:g}")[1]) for torque in TORQUES)
    page.text("""
In comparison, the worst errors over four sizes that
[zhulu248/harmonic-drive-twin](https://github.com/zhulu248/harmonic-drive-twin), the best public static twin found,
reaches with three fitted parameters. It covers more sizes; size 14 of this twin is judged below.
""")
    page.table(["quantity", "this twin, size 25", "zhulu248/harmonic-drive-twin, worst of four sizes"],
               [["efficiency at rated load", f"{points:.1f} points", OTHER_TWIN["efficiency"]],
                *[[title, f"{percent[key]:+.1f} %", sign + OTHER_TWIN[key]] for key, title, sign in
                  (("no_load", "no-load running torque", "+"), ("starting", "starting torque", "−"),
                   ("back_driving", "back-driving torque", "+"))],
                ["torsional stiffness", f"{torsion:.1f} %", OTHER_TWIN["stiffness"] + " above the catalogue"]])
