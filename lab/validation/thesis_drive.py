# SPDX-License-Identifier: BSD-3-Clause
"""Thesis, chapter 7: the working drive, section by section."""
import math

import numpy as np

from bounds import AtMost, Within
from evidence import IDENTITY, OWN_PROGRAM, THESIS_PROGRAM
from independent_drive import IndependentDrive
from thesis_data import (MEASURED, OPERATION, RATIO, TEETH_FS, locked, locked_table, parameters, read_columns,
                         thesis_insertion, turn)
from thesis_insertion import CHAPTER_5, independent_ring

TABLE_7_1 = (31.0e3, 50.0e3, 57.0e3)  # slopes of the cup [N.m/rad]
MOTOR_TORQUE, LOAD = 0.6, 20.0  # N.m, of the run with friction
# Bearing as Table 3.2 has it; the thesis leaves hysteresis of the cup out; c_WG so that the speed settles.
FRICTION = ("--set", "bearing.viscosity=80.0e-6", "--set", "bearing.race_preload=0.0", "--set",
            "cup.friction_torque=0.0", "--set", "motor.viscous_friction=1.0e-3")


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
    start, quarter, half = (locked(page, f"turned_{k}", (0.0,), math.pi * k / 24)[1][0] for k in (0, 6, 24))
    shift = TEETH_FS // 8  # teeth in 45 degrees
    force = start.teeth["wave_generator_force"]
    page.check("thesis.rotation_pattern", "forces at 45° against those at 0°, 25 teeth on: largest difference",
               "thesis 7.2, symmetry", AtMost(1e-5),
               np.max(np.abs(np.roll(force, shift) - quarter.teeth["wave_generator_force"])), "N",
               "25 whole pitches, renumbered; 1e8 N/m times rounding of the positions", evidence=IDENTITY)
    back = np.max(np.hypot(half.x - start.x, half.y - start.y))
    page.check("thesis.rotation_return", "largest distance of a tooth from where it was, half a turn later",
               "thesis 7.2: teeth oscillate", AtMost(1e-12), back, "m",
               "rounding; solved from the round ring at each angle, the cup holds the mean", evidence=IDENTITY)


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


def build(page):
    torsion(page)
    rotation(page)
    equilibrium(page)
    engagement(page)
    coupling(page)
