# SPDX-License-Identifier: BSD-3-Clause
"""The torque at which the teeth jump, and what gives way."""
import math

import numpy as np
from bounds import Between
from evidence import MEASUREMENT
from page import ToolError
from teeth_runs import PROFILES, TEETH, golden, loaded, row_at, set_all

CATALOGUE_JUMP = 500.0  # N.m
BALLS = 23
BALL_LOADS = (284.0, 500.0, 650.0, 800.0, 1000.0)  # N.m
GAUSS = math.sqrt(3.0 / 5.0)  # outer places of its three points, weights 5, 8, 5
FEWEST_BALLS = 3  # that the tool takes
# Of a lobe with plug and circular spline, this in a housing of 20 mm steel, 20 mm aluminium, 10 mm aluminium, in none;
# docs/model.md derives them [N/m].
LOBES = (1.7e8, 8.8e7, 4.6e7, 3.5e7)


def ratchet(page, *options, limit=2000, gear=tuple(golden())):
    try:
        return page.tool("ratchet", "--torque-limit", limit, *gear, *options, unfinished=True)
    except ToolError:  # with a wrong parameter a soft gear may stand nowhere: that fails its row, not the page
        nowhere = {"torque": math.nan, "output_angle": math.nan, "wave_amplitude": math.nan}
        return {"end": "nowhere", "peak": nowhere, "rows": [nowhere]}


def support(stiffness):
    return set_all(f"contact.stiffness={stiffness:.6e}")


def on_balls(*assignments):
    return set_all("contact.support=balls", *assignments)


def support_for(page, torque):
    """Wave generator stiffness per tooth at which the teeth jump at a torque, by halving its logarithm [N/m]."""
    low, high = 1e5, 1e8

    def jumps_below(stiffness):
        return ratchet(page, *support(stiffness), limit=torque)["end"] != "limit reached"

    if not jumps_below(low) or jumps_below(high):
        return math.nan
    while high / low > 1.01:
        middle = math.sqrt(low * high)
        low, high = (middle, high) if jumps_below(middle) else (low, middle)
    return math.sqrt(low * high)


def jump(page):
    page.heading("Jump of the teeth")
    parameters = page.tool("parameters", *golden())
    gear, mesh = parameters["gear"], parameters["mesh"]
    rigid = ratchet(page, limit=20000)
    lobes = {stiffness: ratchet(page, "--lobe-stiffness", f"{stiffness:.3e}")
             for stiffness in (1e8, 3e7, 6.8e6, 1e6, 1e5)}
    at_catalogue = row_at(loaded(page), 500)
    hertz = ratchet(page, *on_balls(), limit=20000)["peak"]
    hertz_force = hertz["wave_generator_force_max"] * TEETH / BALLS
    few = ratchet(page, *on_balls(f"bearing.balls={FEWEST_BALLS}"), limit=20000)["peak"]["torque"]
    whole = ratchet(page, limit=20000, gear=())
    shipped = whole["peak"]["torque"]
    needed = support_for(page, CATALOGUE_JUMP)

    radius = gear["flexspline_inner_radius"] + gear["rim_thickness"] + 0.5 * gear["tooth_height_flexspline"]
    depth = gear["flexspline_inner_radius"] + gear["wave_amplitude"] + gear["rim_thickness"] \
        + gear["tooth_height_flexspline"] \
        - gear["tip_radius_circular_spline"]
    radial = 0.5 * CATALOGUE_JUMP / radius * math.tan(mesh["flank_angle"])
    parts = amplitude_parts(at_catalogue, gear, mesh["flank_angle"])
    softest = lobes[1e5]["peak"]

    page.text(f"""
The catalogue lets the teeth of a CSF-25-100 jump at {CATALOGUE_JUMP:.0f} N·m. The twin's output is driven against a
locked wave generator until the torque falls (`joint_twin ratchet`); where the ring snaps, it descends in energy
to its next equilibrium. Friction is neglected; sliding outwards at {mesh["friction_static"]:.2f} on the flanks it
would divide the radial force by {friction_relief(mesh):.1f}, and so raise a jump.

**On the springs of the thesis nothing jumps** below {rigid["peak"]["torque"] / 1e3:.0f} kN·m. The simple estimate:
at 500 N·m each lobe carries {500 / radius / 2e3:.1f} kN, flanks of {math.degrees(mesh["flank_angle"]):.0f}° push it in
with {radial / 1e3:.2f} kN, and to lose the depth of {1e3 * depth:.2f} mm to that force its radial stiffness would have
to be {radial / depth:.1e} N/m. On **straight flanks** this is not what gives way. With the wave amplitude as an
unknown on springs of that size, or of almost none ({softest['torque']:.0f} N·m at 1e5 N/m a lobe), no tooth jumps up to
2 kN·m: the amplitude ends at {1e3 * softest['wave_amplitude']:.2f} mm. The ring is inextensible, so a smaller wave
also moves the teeth around by −(w/2) sin 2ψ. At 500 N·m the flanks press on the amplitude with
{parts['radial'] / 1e3:.2f} kN a lobe radially but pull with {parts['around'] / 1e3:.2f} kN around; as the amplitude
falls the load moves to teeth further from the axis, until the two balance. On the shipped gear, with its double arcs
and balls, the lobes do decide: below.

**The local support yields.** The loaded side of the ring is in tension and presses into the wave
generator, the other side is slack and lifts off; the last tooth of the loaded side leaves its space and hands its
load to the next. That happens at a torque nearly proportional to the wave generator's stiffness per tooth, and
{CATALOGUE_JUMP:.0f} N·m belong to {needed:.2g} N/m. The thesis sets 1e8 N/m for each tooth and holds the forces
against those of a ball (Table 6.3), but there are {TEETH} teeth and {BALLS} balls.

**Balls harden.** On balls after Hertz (`contact.support: balls`) the teeth jump at {hertz["torque"] / 1e3:.1f} kN·m,
on the shipped gear, which has such balls and double-arc teeth, at {shipped / 1e3:.1f} kN·m. A ball would carry
{1e-3 * hertz_force:.0f} kN then. With
{FEWEST_BALLS} balls, so {FEWEST_BALLS / BALLS:.2f} of the stiffness at the same depth, it is {few:.0f} N·m.
""")
    soft_lobes(page, shipped)
    tries = third_dimension(page, whole)
    check_jump(page, tries, lobes[6.8e6]["peak"]["torque"], hertz["torque"], few)


def soft_lobes(page, rigid):
    """The shipped gear on lobes that give way. `rigid`: its jump on rigid ones [N.m]."""
    runs = {stiffness: ratchet(page, "--lobe-stiffness", f"{stiffness:.2e}", limit=20000, gear=())
            for stiffness in LOBES}
    page.text(f"""
**The lobes of the shipped gear** give way with the plug and the circular spline, whose ovalisation is the same
mode: its ring alone (42.5 / 33.5 mm, 13 mm wide, thin-ring formula) has {circular_spline_stiffness():.1e} N/m a lobe,
and more in a housing ([model.md](../../docs/model.md), *Jump*). On rigid lobes its teeth jump at
{rigid / 1e3:.1f} kN·m.
""")
    page.table(["stiffness of a lobe [N/m]", "largest torque [N·m]", "end of the search"],
               [[f"{stiffness:.1e}", f"{run['peak']['torque']:.0f}", run["end"]] for stiffness, run in runs.items()])
    page.text("""
No compliance that was tried decides as much. The figures scatter, since at a snap of the ring it is a matter of the
step of the angle into which of several equilibria it falls; where the search gave up, its torque is a lower bound.
""")
    page.value("teeth.jump_stiff_housing", runs[LOBES[0]]["peak"]["torque"], "N·m")
    page.value("teeth.jump_no_housing_at_least", runs[LOBES[-1]]["peak"]["torque"], "N·m")


def third_dimension(page, whole):
    """What a plane model has not, of the jump of the gear as it is. Torques [N.m]: of the jump, with coning, and from
    which on the bearing is not elastic."""
    shipped, coned, elastic = whole["peak"]["torque"], first_slice(page, whole["rows"]), elastic_limit(page)
    page.text(f"""
So the twin does **not** predict the catalogue's figure: on rigid lobes it holds {shipped / CATALOGUE_JUMP:.0f} times as
much, on soft ones still several times. Two things of the third dimension were tried, on rigid lobes.

**Coning**: the wave grows from the flange on, so the cup's end of the teeth has {100.0 * slice_wave(page):.0f} % of the
wave at their middle and less depth. In three slices along the face, each a gear of its own wave, all at the same angle,
the one at the cup's end jumps when they carry {coned / 1e3:.1f} kN·m together: if it takes the others along, coning is
a factor of {shipped / coned:.1f}, not fifteen.

**The bearing**: from {elastic / 1e3:.2f} kN·m on the hardest ball is above its static rating (ISO 76, 5 C0/Z =
{static_ball_load(page) / 1e3:.1f} kN: races of 4.2 GPa take a dent), {elastic / CATALOGUE_JUMP:.1f} times the
catalogue's jump. Hertz's law ends there: what the twin says of a jump beyond is outside of its law. What gives way
then, balls, races and the depth that is left, no source at hand has measured.
""")
    return shipped, coned, elastic


def slice_wave(page, place=-1.0):
    """Wave of a slice over that at the middle of the face, in proportion to the distance from the flange; `place` along
    the face, -1 at the cup's end ... 1."""
    given = page.tool("parameters")
    width, length = given["life"]["face_width"], given["stress"]["cup_length"]
    return 1.0 + 0.5 * width * place / (length - 0.5 * width)


def first_slice(page, middle):
    """Torque of three slices along the face together, by Gauss, where the one at the cup's end jumps [N.m]. `middle`:
    rows of the gear as it is."""
    wave = page.tool("parameters")["gear"]["wave_amplitude"]
    ends = {sign: ratchet(page, *set_all(f"gear.wave_amplitude={slice_wave(page, sign * GAUSS) * wave:.9e}"),
                          limit=20000, gear=()) for sign in (-1.0, 1.0)}
    jump_angle = ends[-1.0]["peak"]["output_angle"]

    def torque(rows):
        return np.interp(-jump_angle, [-row["output_angle"] for row in rows], [row["torque"] for row in rows])

    return (5.0 * ends[-1.0]["peak"]["torque"] + 8.0 * torque(middle) + 5.0 * torque(ends[1.0]["rows"])) / 18.0


def static_ball_load(page):
    """5 C0 / Z of ISO 76, C0 = f0 Z D^2 with f0 of its table for D / d_m = 0.10 [N]."""
    return 5.0 * 16.4 * (1e3 * page.tool("parameters")["bearing"]["ball_diameter"]) ** 2


def elastic_limit(page):
    """Torque at which the hardest ball of the gear as shipped carries that [N.m]."""
    rows = page.tool("stiffness", "--torques", ",".join(f"{load:g}" for load in BALL_LOADS), "--teeth")["rows"]
    hardest = [max(row["teeth"]["wave_generator_force"]) * TEETH / BALLS for row in rows]
    return float(np.interp(static_ball_load(page), hardest, BALL_LOADS))


def check_jump(page, tries, lobe, hertz, few):
    def jump(name):
        return ratchet(page, *on_balls("mesh.profile=" + name), limit=20000)["peak"]["torque"]

    page.table(["profile", "jump on balls [N·m]"],
               [[label, f"{jump(name):.0f}"]
                for name, label in PROFILES.items()])
    shipped, coned, elastic = tries
    page.check("teeth.jump_as_shipped",
               "largest torque without a jump, as shipped, rigid lobes (the search ends at 20 kN·m)",
               "catalogue, CSF-25-100", Between(CATALOGUE_JUMP, 3.0 * CATALOGUE_JUMP), shipped, "N·m",
               "a guaranteed figure: the gear holds it, and a model of the jump comes within a factor of 3",
               known="the model is plane, with Hertzian balls on rigid lobes. Lobes as soft as the circular spline "
               f"more than halve the torque. Coning of the teeth lowers the torque to {coned / 1e3:.1f} kN·m. Above "
               f"{elastic / 1e3:.2f} kN·m the most loaded ball exceeds its static rating, where Hertz's law ends",
               evidence=MEASUREMENT)
    page.value("teeth.jump_coned", coned, "N·m")
    page.value("teeth.jump_static_rating", elastic, "N·m")
    page.value("teeth.jump_lobe", lobe, "N·m")
    page.value("teeth.jump_hertz", hertz, "N·m")
    page.value("teeth.jump_support", few, "N·m")


def amplitude_parts(row, gear, flank_angle):
    """Force of the straight flanks on the wave amplitude, per lobe: by the radial motion and by that around [N]."""
    mid_height = gear["rim_thickness"] + 0.5 * gear["tooth_height_flexspline"]
    around = 0.5 * (1.0 - 3.0 * mid_height / gear["flexspline_inner_radius"])
    angles = [4.0 * math.pi * i / TEETH for i in range(TEETH)]
    forces = row["teeth"]["mesh_force"]
    return {"radial": 0.5 * sum(abs(f) * math.sin(flank_angle) * math.cos(a) for f, a in zip(forces, angles)),
            "around": 0.5 * sum(f * math.cos(flank_angle) * around * math.sin(a) for f, a in zip(forces, angles))}


def friction_relief(mesh):
    """Radial force of a flank without friction over that with the largest friction, the tooth about to slide out
    [-]."""
    return math.tan(mesh["flank_angle"]) / math.tan(mesh["flank_angle"] - math.atan(mesh["friction_static"]))


def circular_spline_stiffness():
    """Of the circular spline's ring under two opposite forces, radial: EI / (0.0745 R^3), Tables 3.5 and 3.6 [N/m]."""
    outer, inner, width, modulus = 42.5e-3, 33.5e-3, 13e-3, 210e9
    inertia = width * (outer - inner) ** 3 / 12.0
    return modulus * inertia / ((math.pi / 8.0 - 1.0 / math.pi) * (0.5 * (outer + inner)) ** 3)
