# SPDX-License-Identifier: BSD-3-Clause
"""Thesis, chapter 6: the insertion of the wave generator, every figure drawn again."""
import functools
import math

import numpy as np

from bounds import AtMost, Within, number
from evidence import IDENTITY, OWN_PROGRAM, THESIS_PROGRAM
from independent_ring import IndependentRing
from page import BLUE, GREEN, GREY, ORANGE, PURPLE, RED
from thesis_data import INSERTION, MEASURED, OPERATION, TEETH_FS, insertion, thesis_insertion

# Table 6.3: literature [86] for the largest force on a ball, the last extrapolated by the thesis. [mm], [N]
LITERATURE = ((0.35, 506.8), (0.5, 708.4), (0.6, 845.3), (0.7, 980.8), (0.8, 1114.8))
SHOWN_TEETH = (0, 10, 20, 30, 50)
INDEPENDENT = "independent_ring.py"
CHAPTER_5 = (1e8, 5e9, 400.0)  # stiffness of contact and tension [N/m], of bending [N.m/rad]: Table 6.1


def largest_gap(ring):
    """Fig. 6.4: coordinates against (a cos, b sin) of the angle at rest, eq. 6.1. [m]"""
    return ring.x - ring.a * np.cos(ring.psi0), ring.y - ring.b * np.sin(ring.psi0)


def growth(page):
    """Largest force on a tooth and on a ball for every w0 of Table 6.3. [N]"""
    per_tooth, per_ball = [], []
    for w0, _ in LITERATURE:
        arguments = () if w0 == 0.35 else ("--set", f"gear.wave_amplitude={w0}e-3")
        numbers, ring = insertion(page, f"insertion_{w0}" if arguments else "insertion", *INSERTION, *arguments)
        per_tooth.append(numbers["wave_generator_force_max"])
        per_ball.append(ball_load(ring.teeth["wave_generator_force"]))
    return np.array(per_tooth), np.array(per_ball)


def ball_load(force):
    """What the ball under the major axis carries: the teeth up to half a ball pitch on either side. [N]"""
    half = 0.5 * TEETH_FS / MEASURED.balls
    return sum(force[i] * min(1.0, max(0.0, half - abs(i) + 0.5)) for i in range(-int(half) - 1, int(half) + 2))


def perimeter_growth(ring):
    return float(np.sum(ring.distance)) / (TEETH_FS * ring.rest_distance) - 1.0


def thesis_rows(page, numbers, ring):
    page.text("""
**Against the thesis.** Its numbers are read off figures where it says *circa*.
""")
    force = numbers["wave_generator_force_max"]
    gap_x, gap_y = largest_gap(ring)
    rows = (
        (THESIS_PROGRAM,
         "force_max", "largest force of the wave generator on a tooth", "Table 6.3, fig. 6.5",
         Within(538.8, absolute=0.05), force, "N", "the digits given"),
        (THESIS_PROGRAM,
         "force_minor_axis", "the same force at the minor axis, tooth 50", "6.2", Within(0.0),
         ring.teeth["wave_generator_force"][50], "N", "the thesis: no contact there"),
        (THESIS_PROGRAM,
         "tension_min", "least force between neighbouring teeth", "6.3, fig. 6.8", Within(2300.0, absolute=50.0),
         numbers["tension_min"], "N", "*circa 2300*"),
        (THESIS_PROGRAM,
         "tension_max", "largest force between neighbouring teeth", "6.3, fig. 6.8", Within(8000.0, absolute=50.0),
         numbers["tension_max"], "N", "*circa 8000*"),
        (IDENTITY,
         "tooth_0", "x of tooth 0", "6.3", Within(31.0, absolute=0.05), 1e3 * ring.x[0], "mm", "the digits given"),
        (THESIS_PROGRAM,
         "tooth_50", "y of the tooth on the minor axis", "6.3", Within(30.4, absolute=0.05), 1e3 * ring.y[50], "mm",
         "the digits given"),
        (THESIS_PROGRAM,
         "gap", "largest gap to the polar estimate of eq. 6.1", "6.1, fig. 6.4", Within(0.15, absolute=0.01),
         1e3 * max(np.max(np.abs(gap_x)), np.max(np.abs(gap_y))), "mm", "*up to about 0.15*"),
        (IDENTITY,
         "balance", "largest force left on a tooth when eq. 5.1–5.2, with the bending force of either segment, "
         "are summed from the positions alone", "eq. 5.1–5.2",
         AtMost(1e-4), ring.out_of_balance(), "N", "rounding of the positions times 5e9 N/m"),
        (IDENTITY,
         "contact_law", "largest difference of contact force from eq. 5.23 at these positions", "eq. 5.11–5.23",
         AtMost(1e-4), np.max(np.abs(ring.contact_force() - ring.teeth["wave_generator_force"])), "N", "rounding"),
        (IDENTITY,
         "tension_law", "largest difference of tension from eq. 5.33 at these positions", "eq. 5.33, plus put in",
         AtMost(1e-4), np.max(np.abs(ring.tension - ring.teeth["rim_tension"])), "N", "rounding"),
        (IDENTITY,
         "bending_law", "largest difference of bending force from eq. 5.52 at these positions", "eq. 5.47–5.52",
         AtMost(1e-4), np.max(np.abs(ring.bending - ring.teeth["bending_force"])), "N", "rounding"),
    )
    page.value("thesis.force_shipped", page.tool("insert")["wave_generator_force_max"], "N")
    for evidence, name, quantity, where, bound, value, unit, reason in rows:
        page.check(f"thesis.{name}", quantity, f"thesis {where}", bound, value, unit, reason, evidence=evidence)


@functools.lru_cache(maxsize=None)
def independent_ring(contact_law, bending_law):
    """The equilibrium by the page's own program, with the numbers of the thesis: its Tables 3.4 and 6.1, w0 of 5.1."""
    return IndependentRing(MEASURED.flexspline_radius, CHAPTER_5, contact_law, bending_law).insert(0.35e-3)


def independent_teeth(ring):
    """Of all teeth, as the columns of Ring.teeth: radius [m], angle_deviation [rad], wave_generator_force, rim_tension,
    bending_force [N]."""
    x, y = ring.points()
    tension, bending, _ = ring.segments(x, y)
    deviation = np.angle(np.exp(1j * (np.arctan2(y, x) - 2.0 * math.pi / TEETH_FS * np.arange(TEETH_FS))))
    return {
        "radius": np.hypot(x, y),
        "angle_deviation": deviation,
        "wave_generator_force": ring.contact_forces(x, y)[0],
        "rim_tension": tension,
        "bending_force": bending
    }


def independent_rows(page, ring):
    page.text("""
**Against an independent program** of the same equations, `lab/validation/independent_ring.py`, written from the
text of the thesis and run for this page: the twin's value, its in brackets.
""")
    columns = (("radius", "ρ [mm]", 1e3, 4), ("angle_deviation", "ψ − ψ0 [mrad]", 1e3, 3),
               ("wave_generator_force", "F_WG [N]", 1.0, 2), ("rim_tension", "F to tooth i+1 [N]", 1.0, 1))
    own = independent_teeth(independent_ring("polar", "absolute"))
    page.table(["tooth"] + [title for _, title, _, _ in columns], [[i] + [
        f"{scale * ring.teeth[name][i]:.{digits}f} ({scale * own[name][i]:.{digits}f})"
        for name, _, scale, digits in columns
    ] for i in SHOWN_TEETH])
    _, normal_ring = insertion(page, "insertion_normal", *INSERTION, "--set", "contact.law=normal")
    working, working_ring = insertion(page, "insertion_operation", *OPERATION)
    cases = (("polar", "laws of the thesis", ring, own),
             ("normal", "true normal instead of eq. 5.11", normal_ring,
              independent_teeth(independent_ring("normal", "absolute"))),
             ("operation", "working laws", working_ring, independent_teeth(independent_ring("normal", "curvature"))))
    quantities = (
        ("radius", "radius", "µm", 1e6, 1e-5),
        ("wave_generator_force", "force of the wave generator", "N", 1.0, 1e-3),
        ("rim_tension", "force to the next tooth", "N", 1.0, 0.01),
        ("bending_force", "bending force", "N", 1.0, 1e-3),
    )
    for case, laws, of_twin, of_program in cases:
        for name, quantity, unit, scale, bound in quantities:
            worst = scale * float(np.max(np.abs(of_twin.teeth[name] - of_program[name])))
            page.check(f"thesis.independent_{case}_{name}", f"{laws}: {quantity} of any tooth, largest difference",
                       INDEPENDENT, AtMost(bound), worst, unit, "both solve to 1e-5 N; a rim of 5e9 N/m",
                       evidence=OWN_PROGRAM)
    per_ball = ball_load(working_ring.teeth["wave_generator_force"])
    page.text(f"""
*Working laws*: bending resists a change of curvature between neighbours, not a segment's turn from rest, and contact
acts along the true normal. The thesis' bending law resists every turn of the rim, which is why its rim is pulled with
2.3 to 8 kN. With a frame-indifferent law the same stiffness gives {working['wave_generator_force_max']:.1f} N on a
tooth and {per_ball:.0f} N on a ball.
""")


def shape_figures(page, ring):
    page.figure(
        "thesis_shape",
        "Thesis fig. 6.2 and 6.3. Positions after insertion, and their change; in the polar plots the displacement is "
        "enlarged 15 times, dashed: before. The rim bulges along the major axis (0°) by nearly w0 and draws in along "
        "the minor one by less: it is stretched.",
        lambda figure: draw_shape(figure, ring),
        size=(8.6, 5.6))
    page.figure(
        "thesis_gap",
        "Thesis fig. 6.4 and 6.7. Left: gap between the equilibrium and the polar estimate (a cos ψ, b sin ψ), nearly "
        "nil at the major axis; elsewhere teeth also move along the rim, and at the minor axis they do not follow the "
        "ellipse inwards. Right: overlap of tooth and wave generator; only where it is positive is there force.",
        lambda figure: draw_gap(figure, ring),
        size=(8.6, 2.8))
    angles = np.degrees(ring.psi0)
    contact = ring.teeth["wave_generator_force"] > 0.0
    page.text(
        f"Contact ends {np.max(angles[contact & (angles < 90)]):.1f}° from the major axis; the thesis sees the force "
        "fall off quickly beyond about 30°.")


def force_figures(page, ring):
    per_tooth, per_ball = growth(page)
    page.figure(
        "thesis_force",
        "Thesis fig. 6.5 and Table 6.3. Left and middle: force of the wave generator on each tooth. Right: growth with "
        "w0; the literature's forces are on one ball of a bearing, the thesis' on one tooth, so the twin is shown both "
        "ways.",
        lambda figure: draw_force(figure, ring, per_tooth, per_ball),
        size=(8.6, 3.0))
    page.table(
        ["w0 [mm]", "literature [86], force on a ball [N]", "twin, force on a tooth [N]", "twin, force on a ball [N]"],
        [[number(w0), number(literature), f"{tooth:.1f}", f"{ball:.0f}"]
         for (w0, literature), tooth, ball in zip(LITERATURE, per_tooth, per_ball)])
    page.text(f"""
Table 6.3 compares 506.8 N from the literature with the thesis' 538.8 N. The first is the force on a **ball**, the
second on a **tooth**, and {TEETH_FS / MEASURED.balls:.1f} teeth share a ball: like for like the thesis' model gives
{per_ball[0]:.0f} N on the most loaded ball, {per_ball[0] / LITERATURE[0][1]:.0f} times the literature. Only the
growth with w0 can be compared: both are nearly proportional.
""")
    spread = per_tooth / np.array([w0 for w0, _ in LITERATURE])
    page.check("thesis.growth", "force by w0: at 0.8 mm against 0.35 mm", "thesis 6.2: *direct proportionality*",
               Within(1.0, absolute=0.05), spread[-1] / spread[0], "",
               "the literature's own values depart by 4 %, downwards; those of the thesis' equations upwards",
               evidence=THESIS_PROGRAM)


def rim_figures(page, ring):
    _, working_ring = insertion(page, "insertion_operation", *OPERATION)
    page.figure(
        "thesis_neighbours",
        "Thesis fig. 6.8. Forces between neighbouring teeth, largest at the minor axis, and the distances they come "
        "from: the rim is so stiff that a stretch of 0.5 to 1.6 µm carries kilonewtons.",
        lambda figure: draw_neighbours(figure, ring),
        size=(8.6, 2.8))
    page.figure(
        "thesis_bending",
        "Thesis fig. 6.10 and 6.11. Bending force of the segment from tooth i to i+1: its components on the two teeth "
        "are equal and opposite, nil at the axes and largest between them.",
        lambda figure: draw_bending(figure, ring),
        size=(8.6, 5.4))
    middle = [24, 25]  # the segments on either side of tooth 25, which lies at 45 degrees in the round ring
    fx, fy = -ring.bending * np.sin(ring.slope), ring.bending * np.cos(ring.slope)
    ratio = float(np.sum(np.abs(fx[middle])) / np.sum(np.abs(fy[middle])))
    page.check(
        "thesis.bending_45", "bending components at 45°, x over y", "thesis 6.4: *identical*",
        Within(1.0, absolute=0.05), ratio, "",
        f"read off a figure; the segments there are turned by {np.degrees(np.mean(ring.turn[middle])):.2f}° from 45°",
        evidence=IDENTITY)
    page.check(
        "thesis.bending_axes", "bending force at the axes by its largest", "thesis 6.4: *nil*", AtMost(0.05),
        max(abs(ring.bending[i]) + abs(ring.bending[i - 1])
            for i in (0, 50, 100, 150)) / 2 / np.max(np.abs(ring.bending)), "",
        "segments lie half a pitch off the axes", evidence=IDENTITY)
    ellipse = 2.0 * math.pi * math.sqrt((31.0**2 + 30.4**2) / 2.0)
    x, y = independent_ring("polar", "absolute").points()
    stretched = float(np.sum(np.hypot(np.roll(x, -1) - x, np.roll(y, -1) - y))) / (TEETH_FS * ring.rest_distance) - 1.0
    page.check("thesis.perimeter", "growth of the perimeter, sum of the distances", INDEPENDENT,
               Within(100.0 * stretched, absolute=1e-6), 100.0 * perimeter_growth(ring), "%", "both solve to 1e-5 N",
               evidence=OWN_PROGRAM)
    page.check("thesis.perimeter_formula", "perimeter by eq. 6.3 from tooth 0 and tooth 50, rounded to 0.1 mm as there",
               "thesis 6.3", Within(192.90, absolute=5e-3), 2.0 * math.pi * math.sqrt(
                   (round(1e3 * ring.x[0], 1)**2 + round(1e3 * ring.y[50], 1)**2) / 2.0), "mm", "the digits given",
               evidence=IDENTITY)
    page.text(f"""
The thesis finds +0.16 % ({ellipse:.2f} mm after, 192.59 mm before), with an ellipse's formula on radii rounded to 0.1
mm. The distances themselves add up to +{100 * perimeter_growth(ring):.3f} %. The finite-element study it cites has
+0.0084 %. It is the thesis' bending law that stretches the rim so; the working laws give
+{100 * perimeter_growth(working_ring):.4f} %.
""")


def tooth_axis(axes, label):
    axes.set(xlabel="tooth", ylabel=label, xlim=(0, TEETH_FS), xticks=range(0, TEETH_FS + 1, 50))


def around(ring, values):
    """A closed curve for a polar plot."""
    return np.append(ring.psi0, ring.psi0[0]), np.append(values, values[0])


def draw_shape(figure, ring):
    grid = figure.add_gridspec(2, 2, width_ratios=(1.5, 1))
    place, change = figure.add_subplot(grid[0, 0]), figure.add_subplot(grid[1, 0])
    shape, amount = figure.add_subplot(grid[0, 1], projection="polar"), figure.add_subplot(grid[1, 1],
                                                                                           projection="polar")
    for axes, scale, pairs, title in ((place, 1e3, ((ring.x, "x"), (ring.y, "y")), "Fig. 6.2: position"),
                                      (change, 1e3, ((ring.x - ring.x0, "x − x0"), (ring.y - ring.y0, "y − y0")),
                                       "Fig. 6.3: change of position")):
        for (values, label), colour in zip(pairs, (BLUE, ORANGE)):
            axes.plot(scale * values, color=colour, label=label)
        tooth_axis(axes, "[mm]")
        axes.set_title(title)
        axes.legend(ncol=2, loc="upper center")
    radius = 1e3 * math.hypot(ring.x0[0], ring.y0[0])
    shape.plot(*around(ring, np.full(TEETH_FS, radius)), "--", color=GREY, linewidth=1)
    shape.plot(*around(ring, radius + 15.0 * (1e3 * ring.rho - radius)), color=BLUE)
    shape.set(ylim=(0, 38), yticks=[10, 20, 30], title="Fig. 6.2: shape, ×15 [mm]")
    for values, colour, label in ((ring.x - ring.x0, BLUE, "|x − x0|"), (ring.y - ring.y0, ORANGE, "|y − y0|")):
        amount.plot(*around(ring, 1e3 * np.abs(values)), color=colour, label=label)
    amount.set(yticks=[0.1, 0.2, 0.3], title="Fig. 6.3: change [mm]")


def draw_gap(figure, ring):
    left, right = figure.subplots(1, 2)
    for values, colour, label in zip(largest_gap(ring), (BLUE, ORANGE), ("x − x_p", "y − y_p")):
        left.plot(1e3 * values, color=colour, label=label)
    tooth_axis(left, "[mm]")
    left.set(title="Fig. 6.4: gap to the polar estimate", ylim=(-0.21, 0.17))
    left.legend(ncol=2, loc="lower center")
    overlap = 1e6 * ring.overlap()
    right.fill_between(range(TEETH_FS),
                       0.0,
                       np.maximum(overlap, 0.0),
                       color=RED,
                       alpha=0.4,
                       linewidth=0,
                       label="contact")
    right.plot(overlap, color=BLUE)
    right.set_ylim(-130, 15)
    tooth_axis(right, "[µm]")
    right.set_title("Fig. 6.7: overlap of tooth and wave generator")
    right.legend(loc="lower center")


def draw_force(figure, ring, per_tooth, per_ball):
    grid = figure.add_gridspec(1, 3, width_ratios=(1.2, 0.9, 1.3))
    left, polar, right = figure.add_subplot(grid[0]), figure.add_subplot(
        grid[1], projection="polar"), figure.add_subplot(grid[2])
    force = ring.teeth["wave_generator_force"]
    left.plot(force, color=BLUE)
    tooth_axis(left, "[N]")
    left.set_title("Fig. 6.5: F_WG,FS")
    polar.plot(*around(ring, force), color=BLUE)
    polar.set(yticks=[200, 400], title="Fig. 6.5: polar [N]")
    w0, literature = np.array(LITERATURE).T
    right.plot(w0, literature, "s", color=GREY, label="literature, per ball", markersize=4)
    right.plot(w0, per_tooth, "o-", color=BLUE, label="twin, per tooth", markersize=3.5)
    right.plot(w0, per_ball, "o-", color=ORANGE, label="twin, per ball", markersize=3.5)
    right.set(yscale="log",
              xlabel="w0 [mm]",
              ylabel="largest force [N]",
              title="Table 6.3: growth with w0",
              ylim=(300, 60000))
    right.legend(loc="upper left")


def draw_neighbours(figure, ring):
    left, right = figure.subplots(1, 2)
    left.plot(1e-3 * ring.teeth["rim_tension"], color=BLUE, label="F to tooth i+1")
    left.plot(1e-3 * np.roll(ring.teeth["rim_tension"], 1), "--", color=ORANGE, label="F to tooth i−1")
    tooth_axis(left, "[kN]")
    left.set(title="Fig. 6.8: forces between neighbours", ylim=(0, 10))
    left.legend(ncol=2, loc="upper center")
    right.plot(1e6 * ring.distance, color=BLUE, label="after insertion")
    right.axhline(1e6 * ring.rest_distance, color=GREY, linestyle="--", label="before")
    tooth_axis(right, "δ [µm]")
    right.ticklabel_format(axis="y", useOffset=False)
    right.set(title="Fig. 6.8: distance of neighbours", ylim=(962.4, 964.7))
    right.legend(ncol=2, loc="lower center")


def draw_bending(figure, ring):
    grid = figure.add_gridspec(2, 2, width_ratios=(1.5, 1))
    fx, fy = -1e-3 * ring.bending * np.sin(ring.slope), 1e-3 * ring.bending * np.cos(ring.slope)
    parts = ((fx, BLUE, "-", "x on tooth i"), (fy, ORANGE, "-", "y on tooth i"), (-fx, GREEN, "--", "x on tooth i+1"),
             (-fy, PURPLE, "--", "y on tooth i+1"))
    components, whole = figure.add_subplot(grid[0, 0]), figure.add_subplot(grid[1, 0])
    polar, whole_polar = figure.add_subplot(grid[0, 1], projection="polar"), figure.add_subplot(grid[1, 1],
                                                                                                projection="polar")
    for values, colour, line, label in parts:
        components.plot(values, line, color=colour, label=label)
        polar.plot(*around(ring, np.abs(values)), line, color=colour)
    tooth_axis(components, "[kN]")
    components.set(title="Fig. 6.10: components of the bending force", ylim=(-6.5, 8.5))
    components.legend(ncol=2, loc="upper center", fontsize=7)
    polar.set(yticks=[2, 4], title="Fig. 6.10: sizes [kN]")
    whole.plot(1e-3 * np.abs(ring.bending), color=BLUE)
    tooth_axis(whole, "[kN]")
    whole.set_title("Fig. 6.11: resultant")
    whole_polar.plot(*around(ring, 1e-3 * np.abs(ring.bending)), color=BLUE)
    whole_polar.set(yticks=[2, 4, 6], title="Fig. 6.11: polar [kN]")


def build(page):
    page.heading("Chapter 6: insertion of the wave generator")
    page.text("""
The thesis solves one case: the wave generator is pushed into the round flexspline, its ellipse growing to w0 = 0.35 mm,
the circular spline left out. `joint_twin insert` finds that equilibrium directly, with the thesis' own laws and
stiffnesses (`config/thesis_insertion.yaml`). Teeth are numbered 0 to 199, tooth 0 on the major axis, tooth 50 on the
minor one.
""")
    numbers, ring = thesis_insertion(page)
    thesis_rows(page, numbers, ring)
    independent_rows(page, ring)
    shape_figures(page, ring)
    force_figures(page, ring)
    rim_figures(page, ring)
