# SPDX-License-Identifier: BSD-3-Clause
"""Thesis, chapter 3: ratio, torques, inertias, where a crack goes, FMECA."""
import csv
import math
import os

import numpy as np

from bounds import AtLeast, AtMost, Within, number
from evidence import IDENTITY
from thesis_data import MEASURED, TEETH_CS, TEETH_FS, parameters, turn


def ring_coefficients(ratio):
    """c1, c2 of eq. 3.16 for semi-axes b/a = ratio: mean squares of x and y over a thin elliptical ring, by a^2."""
    angle = (np.arange(2000) + 0.5) * (0.5 * math.pi / 2000)
    k = 1.0 - ratio**2
    by_sine, by_cosine = np.sqrt(1.0 - k * np.sin(angle)**2), np.sqrt(1.0 - k * np.cos(angle)**2)
    return (float(np.sum(by_sine * np.sin(angle)**2) / np.sum(by_sine)),
            float(ratio**2 * np.sum(by_cosine * np.sin(angle)**2) / np.sum(by_cosine)))


def tube_mass(density, outer, inner, length):
    return density * math.pi * (outer**2 - inner**2) * length


def wave_generator_inertia(hub_mass=None):
    """Eq. 3.10-3.16 with Table 3.1; the hub as deep as the outer race unless its mass is given. [kg], [kg m^2]"""
    m = MEASURED
    outer = m.inner_race_inner_radius + m.inner_race_thickness
    hub = hub_mass or tube_mass(m.density, outer, m.shaft_radius, m.race_depth)
    ball = m.density * math.pi / 6.0 * m.ball_diameter**3
    ring = outer_race_mass()
    c1, c2 = ring_coefficients(m.minor_semi_axis / m.major_semi_axis)
    inertia = (0.5 * hub * (outer**2 + m.shaft_radius**2) + m.balls * ball *
               (0.1 * m.ball_diameter**2 + m.ball_circle_radius**2) + ring * m.major_semi_axis**2 * (c1 + c2))
    return hub + m.balls * ball + ring, inertia


def outer_race_mass():
    m = MEASURED
    return tube_mass(m.density, m.outer_race_inner_radius + m.outer_race_thickness, m.outer_race_inner_radius,
                     m.race_depth)


def circular_spline_mass():
    m = MEASURED
    return tube_mass(m.density, m.circular_spline_outer_radius, m.circular_spline_inner_radius,
                     m.circular_spline_length)


def circular_spline_inertia(mass, printed=False):
    """Eq. 3.18 as printed, squares of a sum, or as a thick tube has it. [kg m^2]"""
    outer, inner = MEASURED.circular_spline_outer_radius, MEASURED.circular_spline_inner_radius
    return 0.5 * mass * ((outer + inner)**2 if printed else outer**2 + inner**2)


def crack_direction(backup_ratio):
    """Section 3.4.2."""
    if backup_ratio > 1.0:
        return "into the tooth, wherever it starts"
    return "either way" if backup_ratio > 0.4 else "into the rim, wherever it starts"


def ratio_and_torques(page):
    page.heading("Chapter 3: ratio and torques (eq. 3.1–3.9)")
    page.text("""
The wave generator is turned once at a constant load of 20 N·m, friction left out. The circular spline's angle is
whatever balances the load on the tooth flanks; no ratio is imposed anywhere. With the flexspline held this is the UR5's
mounting. Seen from the circular spline or from the wave generator the same run is the other two mountings: angles are
taken relative to the held part, torques stay. The torque of the housing on the flexspline is read from the cup, so that
the sum of the three is a result too.
""")
    run, _ = turn(page)
    theta, phi = (run[key][-1] - run[key][0] for key in ("wave_generator_angle", "output_angle"))
    motor = -float(np.mean(run["wave_generator_torque"][:-1]))
    housing = float(np.mean(run["housing_torque"][:-1]))
    load = 20.0
    mountings = (
        ("flexspline", "3.1, 3.9", TEETH_CS / (TEETH_CS - TEETH_FS), "ω_WG/ω_CS", theta / phi, "T_CS/T_WG",
         load / motor),
        ("circular spline", "3.4, 3.5, 3.8", TEETH_FS / (TEETH_FS - TEETH_CS), "ω_WG/ω_FS", (theta - phi) / -phi,
         "T_FS/T_WG", -housing / motor),
        ("wave generator", "3.2", TEETH_CS / TEETH_FS, "ω_FS/ω_CS", -theta / (phi - theta), "T_CS/T_FS",
         load / housing),
    )
    for held, equation, expected, speeds, speed_ratio, torques, torque_ratio in mountings:
        name = held.replace(" ", "_")
        page.check(f"thesis.ratio_{name}_held", f"{speeds}, {held} held", f"thesis eq. {equation}",
                   Within(expected, relative=1e-9), speed_ratio, "",
                   "a whole turn brings every tooth back: only rounding is left", evidence=IDENTITY)
        page.check(f"thesis.torque_{name}_held", f"{torques}, {held} held, mean over the turn",
                   f"thesis eq. {equation}, lossless",
                   Within(expected, relative=1e-6), torque_ratio, "",
                   "virtual work; the solver leaves 5e-7 N on a tooth", evidence=IDENTITY)
    page.check("thesis.torque_sum", "largest sum of the torques on wave generator, circular spline and flexspline",
               "third law", AtMost(1e-6), np.max(np.abs(-run["wave_generator_torque"] - load + run["housing_torque"])),
               "N·m", "5e-7 N left on a tooth, at 0.03 m", evidence=IDENTITY)


def inertias(page):
    page.heading("Chapter 3: inertias (eq. 3.10–3.18)")
    m = MEASURED
    given = parameters(page)
    mass, inertia = wave_generator_inertia()
    rest = m.wave_generator_mass - (
        mass - tube_mass(m.density, m.inner_race_inner_radius + m.inner_race_thickness, m.shaft_radius, m.race_depth))
    _, deep = wave_generator_inertia(rest)
    c1, c2 = ring_coefficients(m.minor_semi_axis / m.major_semi_axis)
    radius = m.flexspline_radius + m.rim_thickness
    volume_mass = circular_spline_mass()
    in_use = given["output"]["circular_spline_inertia"]
    corrected = circular_spline_inertia(volume_mass)
    swapped = (m.minor_semi_axis / m.major_semi_axis)**2 * c1
    page.text(f"""
The thesis computes inertias from calliper measurements. Its integrals for an elliptical ring (eq. 3.16) give c1 =
{c1:.3f} and c2 = {c2:.3f}; it prints 0.497 and 0.476, the second with the first one's integrand: (b/a)² c1 =
{swapped:.3f}. Table 3.1 gives one depth only, the outer race's 9 mm; a hub of the same depth makes the wave generator
too light. The circular spline's mass is not that of its dimensions, and eq. 3.18 squares a sum where a tube has a sum
of squares.
""")
    page.table([
        "inertia [kg·m²]", "formula as printed", "corrected", "printed result", "in the twin's configuration"
    ], [
        [
            "wave generator, 3.10–3.16", f"{inertia:.3g} (hub 9 mm deep, {mass:.4f} kg in all)",
            f"{deep:.3g} (hub mass that brings the whole to the printed 0.1527 kg)", "8.12e-05",
            f"{given['motor']['wave_generator_inertia']:.3g} (`motor.wave_generator_inertia`)"
        ],
        ["flexspline, 3.17", f"{m.flexspline_mass * radius**2:.3g}", "the same", "3.72e-05", "none: it is held"],
        [
            "circular spline, 3.18",
            f"{circular_spline_inertia(m.circular_spline_mass, True):.3g} with the printed 0.595 kg",
            f"{circular_spline_inertia(m.circular_spline_mass):.3g} with 0.595 kg, {corrected:.3g} with the "
            f"{volume_mass:.4f} kg of its volume", "0.00544", f"{in_use:.3g} (`output.circular_spline_inertia`)"
        ],
    ])
    page.check("thesis.inertia_circular_spline",
               "inertia of the circular spline in use", "eq. 3.18 corrected, mass from the volume",
               Within(circular_spline_inertia(volume_mass),
                      relative=0.002), in_use, "kg·m²", "three digits in the configuration", evidence=IDENTITY)
    page.check("thesis.inertia_wave_generator", "inertia of the wave generator in use", "thesis Table 3.2",
               Within(8.12e-5, relative=1e-3), given["motor"]["wave_generator_inertia"], "kg·m²", "the digits given",
               evidence=IDENTITY)


def cracks(page):
    gear = parameters(page)["gear"]
    ratio = gear["rim_thickness"] / gear["tooth_height_flexspline"]
    page.heading("Chapter 3: where a crack goes, and what fails (3.4)")
    page.text(f"""
Backup ratio b_R = rim thickness / tooth height (eq. 3.20). According to tests cited in the thesis a crack at the tooth
root runs into the tooth above 1, either way between 0.4 and 1, through the rim below 0.4; 1.3 is advised. This gear:
b_R =
{number(ratio)}, so {crack_direction(ratio)}.
""")
    page.check("thesis.backup_ratio", "backup ratio of the configured gear", "thesis eq. 3.21",
               Within(1.6, absolute=1e-9), ratio, "", "0.8/0.5, two exact figures", evidence=IDENTITY)
    page.check("thesis.backup_ratio_advised", "backup ratio against the advised least", "thesis 3.4.2", AtLeast(1.3),
               ratio, "", "the advice itself", evidence=IDENTITY)
    with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "fmeca.csv"), encoding="utf-8") as file:
        modes = list(csv.DictReader(file))
    page.text(
        "The thesis' FMECA (Table 3.7): severity, occurrence, detection and their product; the last column gives the "
        "quantity of the twin that such a fault changes.")
    page.table(["failure", "effects", "S", "O", "D", "RPN printed", "S·O·D", "in the twin"], [[
        mode["mode"], mode["effects"], mode["severity"], mode["occurrence"], mode["detection"], mode["rpn"],
        product(mode), mode["in_the_twin"]
    ] for mode in modes])
    page.check("thesis.fmeca_products", "largest difference between printed RPN and S·O·D, 12 failures",
               "thesis eq. 3.19, Table 3.7", Within(0.0), max(abs(int(mode["rpn"]) - product(mode)) for mode in modes),
               "", "whole numbers", evidence=IDENTITY)
    page.check("thesis.fmeca_order", "rows out of order of S·O·D", "thesis Table 3.7", Within(0.0),
               sum(product(above) < product(below) for above, below in zip(modes, modes[1:])), "", "whole numbers",
               evidence=IDENTITY)


def product(mode):
    return int(mode["severity"]) * int(mode["occurrence"]) * int(mode["detection"])


def build(page):
    ratio_and_torques(page)
    inertias(page)
    cracks(page)
