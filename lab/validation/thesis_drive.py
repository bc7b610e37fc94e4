# SPDX-License-Identifier: BSD-3-Clause
"""Thesis, chapter 7: the working drive, section by section."""
import math

import numpy as np

from bounds import AtMost, Within
from evidence import IDENTITY, OWN_PROGRAM, THESIS_PROGRAM
from independent_drive import IndependentDrive
from page import BLUE, GREEN, GREY, ORANGE, RED
from thesis_data import (MEASURED, OPERATION, PITCH, RATIO, TEETH_FS, locked, locked_table, parameters,
                         read_columns, thesis_insertion, turn)
from thesis_insertion import CHAPTER_5, independent_ring

TABLE_7_1 = (31.0e3, 50.0e3, 57.0e3)  # slopes of the cup [N.m/rad]
MOTOR_TORQUE, LOAD = 0.6, 20.0  # N.m, of the run with friction
# Bearing as Table 3.2 has it; the thesis leaves hysteresis of the cup out; c_WG so that the speed settles.
FRICTION = ("--set", "bearing.viscosity=80.0e-6", "--set", "bearing.race_preload=0.0", "--set",
            "cup.friction_torque=0.0", "--set", "motor.viscous_friction=1.0e-3")
SHADES = ("#9ecae1", "#4292c6", "#08519c", "#041f4a")


def engagement_margin(rho, flank_angle, tooth_height=MEASURED.circular_spline_tooth_height):
    """Eq. 7.34 and 7.36: by how much a tip passes the base circle; the thesis calls >= 0 engaged. [m]"""
    module = tooth_height / 2.25
    base_radius = (MEASURED.circular_spline_tip_radius + module) * math.cos(flank_angle)
    return rho + MEASURED.rim_thickness + MEASURED.tooth_height - base_radius


def share_engaged(rho, flank_angle):
    return float(np.mean(engagement_margin(rho, flank_angle) >= 0.0))


def torsion(page):
    page.heading("Chapter 7.1: torsion of the flexspline")
    page.text("""
Wave generator locked, a load on the circular spline. Every tooth's angle is the sum of two things: the wave, which goes
round with the wave generator and belongs to no torque, and a turn of the rim as a whole, which twists the cup. Eq. 7.2
gives each tooth the whole cup's stiffness against its own angle; the twin lets the cup (Table 7.1) act on the teeth's
**mean** rotation.
""")
    rows, rings = locked_table(page)
    cup = parameters(page, *OPERATION)["cup"]
    first = cup["torsion_stiffness"][0]
    wave = float(np.max(np.abs(rings[0].teeth["angle_deviation"])))
    per_tooth = first * wave
    page.figure(
        "thesis_torsion",
        "Thesis 7.1, fig. 7.1. Left: angle of each tooth from rest; the load moves the whole curve. Middle: increase "
        "by the load; nearly the same on every tooth, most at the lobes (teeth 0 and 100), where the mesh pulls. "
        "Right: "
        "torque of the cup over the mean rotation, dots: runs, line: Table 7.1.",
        lambda figure: draw_torsion(figure, rows, rings, cup),
        size=(8.8, 2.9))
    page.table([
        "load [N·m]", "circular spline turns [mrad]", "rim turns (mean) [mrad]", "share of the cup [%]",
        "cup's torque [N·m]"
    ], [[
        f"{row['torque']:g}", f"{-1e3 * row['output_angle']:.4f}", f"{-1e3 * row['cup_rotation']:.4f}",
        f"{100.0 * row['cup_rotation'] / row['output_angle']:.1f}", f"{row['housing_torque']:.4f}"
    ] for row in rows[1:]])
    page.check("thesis.cup_share", "torque of the cup by load, at 150 N·m", "thesis eq. 3.8: 100/101",
               Within(100.0 / 101.0, relative=5e-5), rows[-1]["housing_torque"] / rows[-1]["torque"], "",
               "the wave generator's torque varies by 0.3 % within a pitch", evidence=THESIS_PROGRAM)
    mean = [float(np.mean(ring.teeth["angle_deviation"])) for ring in rings]
    page.check("thesis.cup_law", "mean of the teeth's angles against the cup's law, largest difference in torque",
               "thesis eq. 7.1, Table 7.1", AtMost(1e-6),
               max(abs(cup_torque(cup, -turn_) - row["housing_torque"]) for turn_, row in zip(mean, rows)), "N·m",
               "rounding", evidence=IDENTITY)
    page.text(f"""
Read literally, with the round ring as zero, eq. 7.2 meets ±{1e3 * wave:.1f} mrad of wave with {first:.0f} N·m/rad on
each tooth: {per_tooth:.0f} N·m, or {per_tooth / rings[0].rho[0]:.0f} N, per tooth with no load at all; and {TEETH_FS}
such springs side by side make the cup {TEETH_FS} times as stiff.
""")


def cup_torque(cup, rotation):
    """Eq. 7.1 as a torque that is continuous. [N.m]"""
    (k1, k2, k3), (t1, t2) = cup["torsion_stiffness"], cup["torsion_breakpoints"]
    edges = np.array([0.0, t1 / k1, t1 / k1 + (t2 - t1) / k2])
    size = abs(rotation)
    torques = np.array([0.0, t1, t2])
    k = int(np.searchsorted(edges, size, side="right")) - 1
    return math.copysign(torques[k] + (k1, k2, k3)[k] * (size - edges[k]), rotation)


def rotation(page):
    page.heading("Chapter 7.2: rotation of the wave generator")
    page.text("""
The ellipse turns, the teeth stay: each is pushed out and let in twice a turn. The thesis turns the ellipse's equation
(7.15–7.23); so does the twin, with the closest point in place of the ray through the tooth.
""")
    positions = 24
    angles = [math.pi * k / positions for k in range(positions + 1)]
    rings = [locked(page, f"turned_{k}", (0.0,), angle)[1][0] for k, angle in enumerate(angles)]
    page.figure(
        "thesis_rotation",
        "Thesis 7.2, fig. 7.5. Left: the force pattern goes round with the wave generator; its peaks come from the "
        "teeth's 1 µm of interference at the lobes. Right: paths of every tenth tooth over half a turn of the wave "
        "generator, enlarged 20 times, red: at 0°. Each tooth goes round a closed curve; the flexspline does not turn.",
        lambda figure: draw_rotation(figure, rings),
        size=(8.0, 3.3))
    quarter, start = rings[positions // 4], rings[0]
    shift = TEETH_FS // 8  # teeth in 45 degrees
    force = start.teeth["wave_generator_force"]
    page.check("thesis.rotation_pattern", "forces at 45° against those at 0°, 25 teeth on: largest difference",
               "thesis 7.2, symmetry", AtMost(1e-5),
               np.max(np.abs(np.roll(force, shift) - quarter.teeth["wave_generator_force"])), "N",
               "25 whole pitches, renumbered; 1e8 N/m times rounding of the positions", evidence=IDENTITY)
    back = np.max(np.hypot(rings[-1].x - start.x, rings[-1].y - start.y))
    page.check("thesis.rotation_return", "largest distance of a tooth from where it was, half a turn later",
               "thesis 7.2: teeth oscillate", AtMost(1e-12), back, "m",
               "rounding; solved from the round ring at each angle, the cup holds the mean", evidence=IDENTITY)


def draw_torsion(figure, rows, rings, cup):
    left, middle, right = figure.subplots(1, 3)
    shown = [i for i, row in enumerate(rows) if row["torque"] in (0.0, 14.0, 48.0, 150.0)]
    rest = rings[0].teeth["angle_deviation"]
    for i, colour in zip(shown, SHADES):
        deviation = rings[i].teeth["angle_deviation"]
        left.plot(1e3 * deviation, color=colour, label=f"{rows[i]['torque']:g} N·m")
        middle.plot(1e3 * (deviation - rest), color=colour)
    for axes in (left, middle):
        axes.set(xlabel="tooth", xlim=(0, TEETH_FS), xticks=range(0, TEETH_FS + 1, 50))
    left.set(ylabel="ψ − ψ0 [mrad]", title="angle from rest", ylim=(-9.5, 12))
    left.legend(ncol=2, loc="upper center", fontsize=7)
    middle.set(ylabel="[mrad]", title="added by the load")
    turns = np.linspace(0.0, 3.2e-3, 100)
    right.plot(1e3 * turns, [cup_torque(cup, value) for value in turns], color=GREY, linewidth=1)
    right.plot([-1e3 * row["cup_rotation"] for row in rows], [row["housing_torque"] for row in rows],
               "o",
               color=BLUE,
               markersize=4)
    right.set(xlabel="mean rotation [mrad]", ylabel="cup's torque [N·m]", title="eq. 7.1")


def draw_rotation(figure, rings):
    grid = figure.add_gridspec(1, 2, width_ratios=(1.25, 1))
    left, right = figure.add_subplot(grid[0]), figure.add_subplot(grid[1])
    for k, colour in zip((0, 4, 8), (BLUE, ORANGE, GREEN)):
        left.plot(rings[k].teeth["wave_generator_force"], color=colour, label=f"{math.degrees(rings[k].angle):.0f}°")
    left.set(xlabel="tooth",
             ylabel="F_WG,FS [N]",
             xlim=(0, TEETH_FS),
             title="force at three angles of the wave generator")
    left.legend(title="angle", loc="upper right")
    x, y = np.array([ring.x for ring in rings]), np.array([ring.y for ring in rings])
    for tooth in range(0, TEETH_FS, 10):
        mid_x, mid_y = rings[0].x0[tooth], rings[0].y0[tooth]
        right.plot(1e3 * (mid_x + 20.0 * (x[:, tooth] - mid_x)),
                   1e3 * (mid_y + 20.0 * (y[:, tooth] - mid_y)),
                   color=BLUE,
                   linewidth=1)
        right.plot(1e3 * mid_x, 1e3 * mid_y, ".", color=GREY, markersize=2)
        start = 1e3 * np.array([mid_x + 20.0 * (x[0, tooth] - mid_x), mid_y + 20.0 * (y[0, tooth] - mid_y)])
        right.plot(*start, ".", color=RED, markersize=4)
    right.set(aspect="equal", xlabel="x [mm]", ylabel="y [mm]", title="paths of the teeth, ×20")


def equilibrium(page):
    page.heading("Chapter 7.3: equilibrium of the wave generator, with friction")
    page.text(f"""
Eq. 7.29: the motor's torque goes into acceleration, into the flexspline, and into friction. The twin is run with a
constant {MOTOR_TORQUE} N·m at the motor against {LOAD:g} N·m at the joint, from rest, with the bearing of Table 3.2 and
no hysteresis of the cup. A viscous friction of 1 mN·m·s at the motor, the thesis' c_WG, whose value it never gives,
makes the speed settle.
""")
    page.run("simulate", "--torque", MOTOR_TORQUE, "--load", LOAD, "--duration", "1.2", *OPERATION, *FRICTION,
             "--set", "publish.joint_states_rate=10000.0", "--out", "equilibrium.csv")
    run = read_columns(page.scratch("equilibrium.csv"))
    given = parameters(page, *OPERATION)
    inertia = given["motor"]["rotor_inertia"] + given["motor"]["wave_generator_inertia"]
    step = run["time"][1] - run["time"][0]
    acceleration = np.gradient(run["motor_velocity"], step)
    left = run["motor_torque"] - run["wave_generator_torque"] - run["friction_torque"]
    page.figure(
        "thesis_equilibrium",
        "Thesis 7.3, eq. 7.29. Left: the first 80 ms, instant by instant; the joint oscillates on the torsion of the "
        "cup, and the torque exchanged with the flexspline accelerates the motor. Right: the whole run-up in means "
        "over "
        "50 ms, stacked; dotted: speed.",
        lambda figure: draw_equilibrium(figure, run, inertia * acceleration, step),
        size=(8.8, 3.0))
    page.check("thesis.equilibrium_sum", "∫(T_in − T_FS − T_f) dt against J ω at the end", "thesis eq. 7.29–7.30",
               Within(1.0, absolute=2e-3),
               float(np.sum(left)) * step / (inertia * run["motor_velocity"][-1]), "",
               "friction is reduced to the motor: the flanks' share at the joint is in it", evidence=IDENTITY)
    page.check("thesis.equilibrium_instant", "T_in − T_FS − T_f − J dω/dt: rms over the run by T_in", "thesis eq. 7.29",
               AtMost(1e-3),
               float(np.sqrt(np.mean((left - inertia * acceleration)[1:-1]**2))) / MOTOR_TORQUE, "",
               "central difference of the speed at 10 kHz", evidence=IDENTITY)
    for row, ring in zip(*locked_table(page)):
        if row["torque"] == 150.0:
            signed = float(np.sum(ring.rho * ring.teeth["wave_generator_force"] * np.sin(ring.gamma)))
            page.check("thesis.signed_gamma", "eq. 7.28 with signed γ, no friction, 150 N·m, against the twin's torque",
                       "thesis eq. 7.26–7.28, sign kept", Within(row["wave_generator_torque"], relative=1e-2), signed,
                       "N·m", "eq. 7.21 takes the normal at the tooth, not at the contact", evidence=THESIS_PROGRAM)
    numbers, ring = thesis_insertion(page)
    force = numbers["wave_generator_force_sum"]
    bearing = given["bearing"]
    rolling = bearing["load_factor"] * force * bearing["pitch_diameter"]  # eq. 7.33
    plain = float(np.sum(ring.rho * ring.teeth["wave_generator_force"] * np.sin(np.abs(ring.gamma))))
    sliding = 0.07 * float(np.sum(ring.rho * ring.teeth["wave_generator_force"] * np.cos(ring.gamma)))
    page.text(f"""
As printed, with |γ|, eq. 7.27 has the wave generator resist {plain:.0f} N·m at rest, without load, in chapter 6's
equilibrium; and with μ = 0.07 on a race that slides at motor speed another {sliding:.0f} N·m, for a motor of 2.87 N·m.
By symmetry the first is nil, and the race does not slide: the friction that holds it is {sliding / rolling:.0f} times
the bearing's load-dependent friction, which would have to drive it.
""")


def draw_equilibrium(figure, run, inertial, step):
    left, right = figure.subplots(1, 2)
    parts = (("friction", ORANGE, run["friction_torque"]), ("flexspline", BLUE, run["wave_generator_torque"]),
             ("acceleration", GREEN, inertial))
    first = run["time"] < 0.08
    for name, colour, values in parts:
        left.plot(1e3 * run["time"][first], values[first], color=colour, label=name)
    left.plot(1e3 * run["time"][first],
              sum(values for _, _, values in parts)[first],
              "--",
              color="black",
              label="sum = T_in")
    left.set(xlabel="time [ms]",
             ylabel="torque at the motor [N·m]",
             ylim=(-0.35, 0.95),
             title="T_in = J dω/dt + T_FS + T_f")
    left.legend(ncol=4, loc="upper center", fontsize=7, handlelength=1.2, columnspacing=1.0)
    width = round(0.05 / step)
    mean = [
        values[:len(values) // width * width].reshape(-1, width).mean(axis=1)
        for values in (run["time"], *(values for _, _, values in parts))
    ]
    right.stackplot(mean[0], *mean[1:], colors=[colour for _, colour, _ in parts], alpha=0.7, linewidth=0)
    right.axhline(MOTOR_TORQUE, color="black", linestyle="--", linewidth=1)
    right.set(xlabel="time [s]", ylabel="[N·m]", ylim=(0, 0.7), title="means over 50 ms")
    speed = right.twinx()
    speed.plot(run["time"], run["motor_velocity"], ":", color="black")
    speed.set(ylabel="ω_WG [rad/s]", ylim=(0, 1.3 * np.max(run["motor_velocity"])))
    speed.grid(False)
    speed.spines["right"].set_visible(True)


def engagement(page):
    page.heading("Chapter 7.4: engagement along the ring")
    rows, rings = locked_table(page)
    free = rings[0]
    twin_angle = parameters(page, *OPERATION)["mesh"]["flank_angle"]
    steepest = math.acos(
        float(np.min(free.rho) + MEASURED.rim_thickness + MEASURED.tooth_height) /
        (MEASURED.circular_spline_tip_radius + MEASURED.circular_spline_tooth_height / 2.25))
    page.text(f"""
Eq. 7.35 calls a tooth engaged when its tip passes the circular spline's base circle. At the twin's flank angle of
{math.degrees(twin_angle):.0f}° every tooth passes it, those on the minor axis too: from {math.degrees(steepest):.1f}°
upwards the condition is always true. In the twin a tooth engages when its flank touches.
""")
    page.figure(
        "thesis_engagement",
        "Thesis 7.4, fig. 7.8 and 7.9. Left: force on each tooth's flank around one end of the major axis; at no load "
        "the pair touches on both flanks. Middle: eq. 7.36, margin of each tooth for three flank angles; above zero "
        "counts as engaged. Right: share of teeth engaged by eq. 7.35, and teeth that carry in the twin, against the "
        "literature's 25 to 35 %.",
        lambda figure: draw_engagement(figure, rows, rings),
        size=(9.0, 3.0))
    page.check("thesis.condition_735",
               "share of teeth engaged by eq. 7.35 at the twin's flank angle",
               "the tips on the minor axis pass the base circle too",
               Within(100.0), 100.0 * share_engaged(free.rho, twin_angle), "%", "a count", evidence=IDENTITY)
    page.table(["load [N·m]"] + [f"{row['torque']:g}" for row in rows],
               [["teeth that carry"] + [row["teeth_loaded"] for row in rows],
                ["share [%]"] + [f"{100.0 * row['teeth_loaded'] / TEETH_FS:g}" for row in rows]])
    carrying = [row["teeth_loaded"] for row in rows]
    page.check("thesis.engagement_grows", "teeth that carry: times the number falls as the load rises",
               "thesis 7.4, 7.1: contact grows with load", Within(0.0),
               sum(after < before for before, after in zip(carrying, carrying[1:])), "",
               "a count", evidence=THESIS_PROGRAM)


def draw_engagement(figure, rows, rings):
    left, middle, right = figure.subplots(1, 3)
    teeth = np.arange(-14, 15)
    for i, colour in zip((0, 2, 3, 5), SHADES):
        left.plot(teeth,
                  rings[i].teeth["mesh_force"][teeth],
                  ".-",
                  color=colour,
                  markersize=3,
                  label=f"{rows[i]['torque']:g} N·m")
    left.set(xlabel="tooth", ylabel="F_t, > 0: leading flank [N]", title="force on the flanks")
    left.legend(fontsize=7)
    free = rings[0]
    for degrees, colour in ((3, GREEN), (8, ORANGE), (17, RED)):
        middle.plot(1e3 * engagement_margin(free.rho, math.radians(degrees)), color=colour, label=f"{degrees}°")
    middle.axhline(0.0, color="black", linewidth=0.8)
    middle.set(xlabel="tooth", ylabel="margin [mm]", xlim=(0, TEETH_FS), title="eq. 7.36", ylim=(-0.6, 2.4))
    middle.legend(ncol=3, loc="upper center")
    angles = np.linspace(0.0, 20.0, 201)
    right.plot(angles, [100.0 * share_engaged(free.rho, math.radians(angle)) for angle in angles],
               color=BLUE,
               label="eq. 7.35")
    right.axhspan(25, 35, color=GREY, alpha=0.3, linewidth=0)
    right.text(19.5, 37, "literature", ha="right", fontsize=8, color=GREY)
    for i, colour in zip((2, 3, 5), SHADES[1:]):
        right.plot([17.0], [100.0 * rows[i]["teeth_loaded"] / TEETH_FS], "o", color=colour, markersize=4)
    right.text(16.3, 12, "twin, 14 … 150 N·m", ha="right", fontsize=8, va="center")
    right.set(xlabel="flank angle [°]", ylabel="teeth engaged [%]", title="eq. 7.35 and the twin")


def coupling(page):
    page.heading("Chapter 7.5: the output, and the ratio as a result")
    rows, rings = locked_table(page)
    page.text("""
**Locked wave generator**, a load on the circular spline, against `lab/validation/independent_drive.py`, written
from the laws alone and run for this page (twin's value, its in brackets). The torque on the wave generator is the load
divided by 101, though no ratio is written anywhere; at this one position, a tooth on the major axis, it departs from
that by up to 0.4 % (5 N·m), in the mean over a pitch by nothing.
""")
    digits = (6, 4, 0, 2, 1)
    found = {
        row["torque"]: (1e3 * row["output_angle"], RATIO * row["wave_generator_torque"] / row["torque"],
                        row["teeth_loaded"], row["mesh_force_max"], row["wave_generator_force_sum"])
        for row in rows[1:]
    }
    own = independent_loads(found)
    page.table([
        "load [N·m]", "output angle [mrad]", "101 T_WG/T", "teeth that carry", "largest force on a flank [N]",
        "ΣF_WG [N]"
    ], [[f"{load:g}"] +
        [f"{value:.{n}f} ({given:.{n}f})" for value, given, n in zip(found[load], own[load], digits)]
        for load in found])
    for k, (name, quantity, unit, most) in enumerate(
        (("angle", "output angle", "mrad", 1e-6), ("torque", "101 T_WG/T", "", 1e-6),
         ("teeth", "teeth that carry", "", 0.0), ("flank", "largest force on a flank", "N", 1e-4),
         ("bearing", "sum of the wave generator's forces", "N", 1e-3))):
        worst = max(abs(found[load][k] - values[k]) for load, values in own.items())
        page.check(f"thesis.locked_{name}", f"{quantity}, five loads: largest difference", "independent_drive.py",
                   AtMost(most), worst, unit,
                   "both solve to 1e-6 N a tooth, on flanks of 5e7 N/m" if most else "a count", evidence=OWN_PROGRAM)
    cosine = math.cos(parameters(page, *OPERATION)["mesh"]["flank_angle"])
    torque = float(np.sum(rings[-1].teeth["mesh_force"])) * cosine * MEASURED.circular_spline_mean_radius
    page.check("thesis.output_balance", "Σ F_t cos β r_CS at 150 N·m by the load", "thesis eq. 7.37 at rest",
               Within(1.0, absolute=0.01),
               abs(torque) / rows[-1]["torque"], "",
               "one radius for all teeth, 32.15 mm; they carry between 31.95 and 32.15 mm", evidence=IDENTITY)
    run, steps = turn(page)
    error = run["output_angle"] - run["wave_generator_angle"] / RATIO
    page.figure(
        "thesis_ratio",
        "Thesis 7.5: the ratio as a control value. Left: output angle less motor angle/101 over three tooth pitches, "
        "20 N·m, no friction: a wave that repeats with every pitch, no drift. Right: torque of the wave generator by "
        "load/101.",
        lambda figure: draw_ratio(figure, run, error, steps),
        size=(8.6, 2.6))
    page.check("thesis.drift_pitch", "drift of the ratio over a tooth pitch, largest over a turn",
               "tooth numbers", AtMost(1e-12), np.max(np.abs(error[steps:] - error[:-steps])), "rad",
               "rounding", evidence=IDENTITY)
    page.check("thesis.drift_turn", "drift of the ratio over a motor turn", "tooth numbers", AtMost(1e-12),
               abs(error[-1] - error[0]), "rad", "rounding", evidence=IDENTITY)
    page.check("thesis.mean_torque", "101 T_WG/T, mean over a turn", "virtual work", Within(-1.0, absolute=5e-6),
               RATIO * float(np.mean(run["wave_generator_torque"][:-1])) / LOAD, "",
               "a mean over the steps of a turn", evidence=IDENTITY)
    arcseconds = math.degrees(np.max(error) - np.min(error)) * 3600.0
    page.value("thesis.perfect_error", arcseconds, "″")
    page.text(f"The kinematic error of the perfect gear is {arcseconds:.2f}″ from peak to peak, tooth pass alone.")


def independent_loads(loads):
    """By load [N.m]: what the page's own program finds, in the order of the table."""
    drive = IndependentDrive(MEASURED.flexspline_radius, CHAPTER_5, TABLE_7_1).start_from(
        independent_ring("normal", "curvature"))
    found = {}
    for load in loads:
        drive.carry(load)
        force = drive.flank_force()
        pressed = drive.contact_forces(*drive.points())[0]
        found[load] = (1e3 * drive.output, RATIO * drive.wave_generator_torque() / load, np.count_nonzero(force),
                       np.max(np.abs(force)), np.sum(pressed))
    return found


def draw_ratio(figure, run, error, steps):
    left, right = figure.subplots(1, 2)
    shown = slice(0, 3 * steps + 1)
    pitches = run["wave_generator_angle"][shown] / PITCH
    wave = np.degrees(error - np.mean(error)) * 3600.0
    left.plot(pitches, wave[shown], color=BLUE)
    left.set(xlabel="motor angle [tooth pitches]", ylabel="[″]", title="kinematic error of the perfect gear")
    right.plot(pitches, -RATIO * run["wave_generator_torque"][shown] / LOAD, color=ORANGE)
    right.axhline(1.0, color="black", linewidth=0.8)
    right.ticklabel_format(axis="y", useOffset=False)
    right.set(xlabel="motor angle [tooth pitches]", ylabel="101 T_WG / T [-]", title="torque ratio within a pitch")


def build(page):
    torsion(page)
    rotation(page)
    equilibrium(page)
    engagement(page)
    coupling(page)
