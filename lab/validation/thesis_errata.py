# SPDX-License-Identifier: BSD-3-Clause
"""Where the thesis contradicts itself or its own results; each with a number worked out here."""
import math

import numpy as np

from bounds import Within
from evidence import IDENTITY, THESIS_PROGRAM
from thesis_data import (INSERTION, MEASURED, OPERATION, PITCH, RATIO, TEETH_CS, TEETH_FS, locked_table, parameters,
                         thesis_insertion, turn)
from thesis_drive import share_engaged
from thesis_gear import circular_spline_inertia, circular_spline_mass, ring_coefficients, wave_generator_inertia
from thesis_insertion import LITERATURE, ball_load, independent_ring, independent_teeth, perimeter_growth
from thesis_forms import foot, palmgren, printed_height, quartic_root, ray_point


def chapter_3(page):
    m = MEASURED
    run, _ = turn(page)
    phi = run["output_angle"][-1] - run["output_angle"][0]
    c1, c2 = ring_coefficients(m.minor_semi_axis / m.major_semi_axis)
    mass, inertia = wave_generator_inertia()
    printed, corrected = circular_spline_inertia(m.circular_spline_mass,
                                                 True), circular_spline_inertia(m.circular_spline_mass)
    given = parameters(page)
    gear, viscosity = given["gear"], 1e6 * given["bearing"]["viscosity"]
    grease, oil = palmgren(2000.0, 280.0, 53.34), palmgren(2000.0, 80.0, 53.34)
    return [
        ["3.5–3.8", "τ = −100, then (τ + 1) and −τ",
         f"with τ = −100, eq. 3.6 makes {-99.0 * phi:.4f} rad of the run's {phi:.5f} rad at the joint; the motor "
         f"turned {2 * math.pi:.4f} rad. They hold with τ = +100", "ratio a result of the mesh"],
        ["3.9", "index FS on the quantities of the circular spline",
         f"the flexspline is held: 101 · 0 = 0 rad against {2 * math.pi:.4f} rad", "index CS"],
        ["3.16b", "c2 = 0.476",
         f"the equation gives {c2:.3f}; 0.476 is (b/a)² c1 = {(m.minor_semi_axis / m.major_semi_axis)**2 * c1:.3f}",
         "not used"],
        ["3.10, Table 3.2", "J_WG 8.12e-5 kg·m², 0.1527 kg",
         f"{inertia:.3g} kg·m², {mass:.4f} kg with the one depth that Table 3.1 gives",
         "8.12e-5 kept; the catalogue has 1.07e-4"],
        ["3.18, Table 3.5", "J_CS 5.44e-3 kg·m²; (r_e + r_i)²",
         f"{printed:.3g} as printed, {corrected:.3g} with r_e² + r_i²: 5.44e-3 is neither",
         f"{circular_spline_inertia(circular_spline_mass()):.3g}"],
        ["Table 3.5", "m_CS 0.595 kg", f"{circular_spline_mass():.4f} kg from the same dimensions and density",
         "from the volume"],
        ["Table 3.6", "r_m = 32.15 mm",
         f"tip radius and half the tooth height make "
         f"{1e3 * (m.circular_spline_tip_radius + 0.5 * m.circular_spline_tooth_height):.2f} mm",
         "teeth by their positions"],
        ["Table 3.1, 5.7b", "b = 30.33 mm measured, b = r0 − w0 used",
         f"r0 − w0 = {1e3 * (gear['flexspline_inner_radius'] - gear['wave_amplitude']):.2f} mm", "r0 − w0"],
        ["3.3.1", "viscosity of the grease SK-1A 265–295 mm²/s",
         f"that is its penetration (0.1 mm). As a viscosity it would give {1e3 * grease:.0f} mN·m at 2000 rpm, "
         f"the oil's 80 mm²/s {1e3 * oil:.0f}",
         f"{viscosity:.0f} mm²/s, fitted to the catalogue; the thesis then takes 80"],
    ]


SHOWN_TOOTH = 10


def contact_point(page, ring, force):
    a, b, tooth = ring.a, ring.b, SHOWN_TOOTH
    x, y = float(ring.x[tooth]), float(ring.y[tooth])
    exact_x, exact_y = foot(a, b, ring.x, ring.y)
    depth = (exact_x - ring.x) * np.cos(ring.normal) + (exact_y - ring.y) * np.sin(ring.normal)
    touching = force > 0.0
    off = float(np.max(np.abs(depth - ring.overlap())[touching]))
    right = quartic_root(a, b, x, y, a**4 + b**4 - 2.0 * a**2 * b**2)
    wrong = quartic_root(a, b, x, y, a**2 + b**2 - 2.0 * a**2 * b**2)
    normal = wrapped_degrees(math.atan2(a * a * x, b * b * y))
    page.check("thesis.contact_point",
               "eq. 5.11 against the true foot of the normal: largest difference of overlap among teeth in contact",
               "the equilibrium of chapter 6", Within(2.0, absolute=0.5), 1e6 * off, "µm", "known to be *up to 2 µm*",
               evidence=IDENTITY)
    return [
        ["5.8b", "slope of the normal a²x/(b²y)",
         f"tooth 10: normal at {normal:.1f}°, by eq. 5.15 {math.degrees(ring.normal[tooth]):.1f}°", "a²y/(b²x)"],
        ["5.10a", "A = a² + b² − 2a²b²",
         f"tooth 10: x_WG {describe(wrong)}; with a⁴ + b⁴ − 2a²b² {1e3 * right:.4f} mm, the foot by Newton "
         f"{1e3 * exact_x[tooth]:.4f} mm",
         "closest point by iteration"],
        ["5.9", "*cannot be solved analytically*",
         f"it is of fourth degree; its root lies {1e12 * abs(right - exact_x[tooth]):.1g} pm from the foot", "–"],
        ["5.11", "(a cos ψ, b sin ψ) as the point on the ray",
         f"lies up to {1e3 * ray_distance(ring):.3f} mm off it; overlap wrong by up to {1e6 * off:.2f} µm, "
         f"{off * ring.contact_stiffness:.0f} N, among teeth in contact",
         "foot of the normal; polar law kept for chapter 6"],
    ]


def chapter_5(page):
    m = MEASURED
    numbers, ring = thesis_insertion(page)
    force = ring.teeth["wave_generator_force"]
    tooth = SHOWN_TOOTH
    x, y = float(ring.x[tooth]), float(ring.y[tooth])
    third_quadrant = int(
        np.sum((ring.normal % (2.0 * math.pi) >= math.pi) & (ring.normal % (2.0 * math.pi) < 1.5 * math.pi)))
    stiffness = m.young_modulus * m.rim_thickness * m.tooth_length / (PITCH * m.flexspline_radius - m.tooth_base)
    literal = independent_teeth(independent_ring("polar", "one_force"))
    fourth = math.radians(-30.0)
    printed_overlap = (ring.a * math.cos(ring.psi[tooth]) - x) * math.cos(ring.normal[tooth]) + (
        ring.b * math.sin(ring.psi[tooth]) + y) * math.sin(ring.normal[tooth])
    return [
        ["5.1, 5.2", "one bending force F_F on a tooth",
         f"then the wave generator presses a tooth with {np.max(literal['wave_generator_force']):.0f} N; with the "
         f"bending forces of both segments, as in fig. 5.16, with chapter 6's {np.max(force):.1f} N", "both segments"],
        ["5.5", "x = r sin ψ0, y = r cos ψ0",
         f"puts tooth 0 on the minor axis, where the force is {force[50]:.0f} N and not {force[0]:.1f} N", "cos, sin"],
        *contact_point(page, ring, force),
        ["5.19, 5.35, 5.36, 7.7", "second case up to 2π, third from 2π",
         f"no angle meets the third case; {third_quadrant} teeth should. Harmless: all four cases are one "
         "expression",
         "one expression"],
        ["5.29, Table 6.1", "5.12e9 N/m; 5e9 N·m", f"E s b/(p − L) = {stiffness:.3g} N/m", "5e9 N/m"],
        ["5.33, 5.34", "no sign between spring and dashpot",
         f"a product: 0 N at rest, where the rim carries {numbers['tension_max']:.0f} N", "sum"],
        ["5.16, 5.21", "tangent at π/2 − α_N",
         f"tooth 10: {90.0 - math.degrees(ring.normal[tooth]):.1f}°, a mirror image; at right angles to the normal "
         f"is {90.0 + math.degrees(ring.normal[tooth]):.1f}°", "not used"],
        ["5.22", "no parentheses around the displacement of the flexspline",
         f"tooth 10: as printed an overlap of {1e3 * printed_overlap:.1f} mm, with them "
         f"{1e6 * float(ring.overlap()[tooth]):.2f} µm", "parentheses"],
        ["5.27, 5.39", "fourth and third quadrant: F_y = −F sin",
         f"at {math.degrees(fourth):.0f}° a push outwards would have F_y = {-math.sin(fourth):+.1f} F, not the "
         f"normal's {math.sin(fourth):+.1f} F; eq. 5.28 and 5.41 are right", "eq. 5.28, 5.41"],
        *dashpots_and_bending(page),
    ]


def dashpots_and_bending(page):
    bending = parameters(page, *INSERTION)["ring"]["bending_stiffness"]
    return [
        ["5.51, Table 6.1", "c_F = 0 in 5.4, 1e-2 in the table; c_T = 1e-2 in 7.2", "two values of one constant",
         "neither dashpot; the cup has dry friction"],
        ["5.33", "damping on ẋ_i − ẋ_{i+1}",
         "is −V_rel of eq. 5.32: with Table 6.1's c two teeth parting at 1 m/s gain "
         f"{1e3 * 1e-2 * 1.0**2:.0f} mW instead of losing them", "c V_rel"],
        ["5.4", "bending couple on each segment's turn from rest",
         f"a rigid turn of the whole rim by 1 mrad meets {TEETH_FS * bending * 1e-3:.0f} N·m",
         "curvature, between neighbours"],
    ]


def describe(root):
    return f"{1e3 * root:.4f} mm" if math.isfinite(root) else "has no real solution"


def wrapped_degrees(angle):
    return math.degrees(angle) % 360.0


def ray_distance(ring):
    """Largest distance between eq. 5.11 and the ray's intersection, eq. 7.16 at theta = 0. [m]"""
    points = np.array([ray_point(ring.a, ring.b, 0.0, angle) for angle in ring.psi])
    return float(np.max(np.hypot(ring.a * np.cos(ring.psi) - points[:, 0], ring.b * np.sin(ring.psi) - points[:, 1])))


def chapter_6(page):
    numbers, ring = thesis_insertion(page)
    tuned = {}
    for key, value in (("contact.stiffness", "1.1e+8"), ("ring.bending_stiffness", "440.0")):
        other = page.tool("insert", *INSERTION, "--set", f"{key}={value}")
        tuned[key] = other["wave_generator_force_max"] / numbers["wave_generator_force_max"] - 1.0
    rows, _ = locked_table(page)
    at_14 = next(row for row in rows if row["torque"] == 14.0)
    before = 2.0 * math.pi * 30.65
    after = 2.0 * math.pi * math.sqrt(0.5 * (31.0**2 + 30.4**2))
    return [
        ["[51], [83]", "two sources",
         "one paper, the same DOI; pressure angle, stiffness and stress appear as 16° and 17°, 6.54e4 and "
         "6.56e4 N·m/rad, 638 and 640 MPa", "one source"],
        ["Table 6.2", "teeth 51 and 151 at 90° and 270°",
         f"tooth 50 lies at {math.degrees(ring.psi[50]):.2f}°, tooth 51 at {math.degrees(ring.psi[51]):.2f}°",
         "50 and 150"],
        ["Table 6.1, 7.1", "K_T 3.05e5 N·m/rad; 31e3 to 57e3",
         f"14 N·m twist the first by {14e3 / 3.05e5:.3f} mrad, the second by {-1e3 * at_14['cup_rotation']:.3f}",
         "Table 7.1"],
        ["Table 6.3", "538.8 N beside 506.8 N",
         "force per tooth beside force per ball; the ball carries "
         f"{ball_load(ring.teeth['wave_generator_force']):.0f} N",
         "both given above"],
        ["6.2", "tuning K_WG could bring 538.8 N to 506.8",
         f"10 % more K_WG changes the force by {100.0 * tuned['contact.stiffness']:+.2f} %, 10 % more bending "
         f"stiffness K_F by {100.0 * tuned['ring.bending_stiffness']:+.1f} %",
         "–"],
        ["Table 6.3", "*direct proportionality*",
         f"its own F/w0 falls from {LITERATURE[0][1] / 0.35:.0f} to {LITERATURE[-1][1] / 0.8:.0f} N/mm; the model's "
         "rises",
         "–"],
        ["6.3", "perimeter +0.1609 %, 192.59 mm before",
         f"2π r0 = {before:.2f} mm; eq. 6.3 with radii rounded to 0.1 mm +{100.0 * (after / before - 1.0):.3f} %; "
         f"the teeth's distances +{100.0 * perimeter_growth(ring):.3f} %", "sum of the distances"],
    ]


def chapter_7(page):
    numbers, ring = thesis_insertion(page)
    rows, rings = locked_table(page)
    force = ring.teeth["wave_generator_force"]
    absolute = float(np.sum(ring.rho * force * np.sin(np.abs(ring.gamma))))
    signed = float(np.sum(ring.rho * force * np.sin(ring.gamma)))
    friction = 0.07 * float(np.sum(ring.rho * force * np.cos(ring.gamma)))
    theta, psi = math.radians(45.0), math.radians(30.0)
    x, y = ray_point(ring.a, ring.b, theta, psi)
    given = parameters(page, *OPERATION)
    wave = float(np.max(np.abs(rings[0].teeth["angle_deviation"])))
    page.check("thesis.absolute_gamma", "eq. 7.27 with |γ| and no friction, at rest, no load",
               "the equilibrium of chapter 6", Within(12.0, absolute=0.5), absolute, "N·m", "known to two digits",
               evidence=THESIS_PROGRAM)
    page.check("thesis.symmetric_gamma", "the same with signed γ", "symmetry", Within(0.0, absolute=1e-6), signed,
               "N·m", "rounding", evidence=IDENTITY)
    page.check("thesis.literal_friction", "friction of eq. 7.25–7.28 on a sliding race, μ = 0.07",
               "the equilibrium of chapter 6", Within(74.0, absolute=1.0), friction, "N·m", "known to two digits",
               evidence=THESIS_PROGRAM)
    return [
        ["7.2", "the cup's stiffness on each tooth's own angle",
         f"{given['cup']['torsion_stiffness'][0] * wave:.0f} N·m on a tooth with no load; {TEETH_FS} K_T in all",
         "mean rotation"],
        ["7.1, 7.2", "K_T of the step times the whole angle",
         "at 14 N·m the torque jumps from 14.0 to "
         f"{14.0 * 50.0 / 31.0:.1f} N·m with Table 7.1's 31e3 and 50e3 N·m/rad", "slopes integrated"],
        ["7.18, 7.19", "F2 − G2 under the root",
         f"ellipse at 45°, tooth at 30°: y = {1e3 * printed_height(ring.a, ring.b, theta, x):.3f} mm, right "
         f"{1e3 * y:.3f} mm. Used at x = 0 only, where both are nil", "closest point"],
        ["7.20", "eq. 5.11 as the case θ = 0 of 7.15", f"beside it by up to {1e3 * ray_distance(ring):.3f} mm",
         "closest point"],
        ["7.26, 7.27", "|γ|",
         f"{absolute:.1f} N·m on the wave generator at rest, no load; signed {abs(signed):.0e} N·m", "signed"],
        ["7.25, 7.28", "μ F on a race that slides at motor speed",
         f"{friction:.0f} N·m against a motor of {given['motor']['torque_limit']:g} N·m",
         "the race rolls; μ F on its slip"],
        *motor_and_teeth(given, rows, rings),
    ]


def motor_and_teeth(given, rows, rings):
    m = MEASURED
    bearing = given["bearing"]
    load_torque = bearing["load_factor"] * rows[-1]["wave_generator_force_sum"] * bearing["pitch_diameter"]
    module = m.circular_spline_tooth_height / 2.25
    degrees = np.linspace(0.0, 12.0, 1201)
    shares = np.array([share_engaged(rings[0].rho, math.radians(angle)) for angle in degrees])
    published = degrees[(shares >= 0.25) & (shares <= 0.35)]
    inertia = given["output"]["circular_spline_inertia"]
    flank = math.degrees(given["mesh"]["flank_angle"])
    friction_share = given["mesh"]["friction_kinetic"] * math.tan(given["mesh"]["flank_angle"])
    return [
        ["7.32, 7.33", "d_m *mean diameter*, *distance from the axis*, 26.67 mm",
         f"{1e3 * palmgren(2000.0, 80.0, 26.67):.1f} mN·m at 2000 rpm, with the diameter "
         f"{1e3 * palmgren(2000.0, 80.0, 53.34):.1f}", "diameter, 53.34 mm"],
        ["7.33", "no sign of the speed",
         f"turning backwards under 150 N·m, {1e3 * load_torque:.0f} mN·m would drive the motor", "against the speed"],
        ["7.3", "limits of the motor from 100 times the joint's",
         f"180°/s and 2292°/s² make {RATIO * math.pi:.1f} rad/s and {RATIO * math.radians(2292.0):.0f} rad/s² with "
         f"101, {100 * math.pi:.1f} and {100 * math.radians(2292.0):.0f} with 100",
         f"{given['motor']['speed_limit']:g} rad/s"],
        ["7.34", "module h/2.25",
         f"{1e3 * module:.3f} mm; the pitch has 2 r/Z = {2e3 * m.circular_spline_mean_radius / TEETH_CS:.3f} mm",
         "teeth by their positions"],
        ["7.35", "engaged if the tip passes the base circle",
         f"every tooth, from {degrees[np.argmax(shares >= 1.0)]:.1f}° of flank angle; 25 to 35 % of them only at "
         f"{published[0]:.1f} to {published[-1]:.1f}°", "contact of flanks"],
        ["7.37", "friction −μ F_t sin β whichever way the flanks slide",
         f"at a flank angle of {flank:.0f}° it takes {100.0 * friction_share:.1f} % of the torque either way "
         "the flanks slide, where dry friction changes its sign", "against the slip"],
        ["7.38", "ΣF/J − T_R − c φ̇",
         f"20 N·m in balance would accelerate the output by {20.0 / inertia - 20.0:.0f} rad/s²; with brackets 0",
         "brackets"],
        ["7.29, 7.37, 7.35", "c_WG, c_CS, μ_CS,FS, β never given", "four numbers",
         f"{given['motor']['viscous_friction']:g} N·m·s/rad, {given['output']['viscous_friction']:g}, "
         f"{given['mesh']['friction_kinetic']:g}, {math.degrees(given['mesh']['flank_angle']):.0f}°"],
    ]


def build(page):
    page.heading("Errors in the thesis")
    page.text("""
The twin repeats none of these. Each entry has a number as evidence, computed from the runs above or from the thesis'
own tables. The claim that the run of chapter 6 settles within 0.05 s is discussed under
[the quasi-static claim](#the-quasi-static-claim).
""")
    entries = chapter_3(page) + chapter_5(page) + chapter_6(page) + chapter_7(page)
    page.table(["thesis", "printed", "what shows it", "in the twin"], entries)
