# SPDX-License-Identifier: BSD-3-Clause
"""The torque at which the teeth jump, and what gives way."""
import math

from bounds import AtLeast
from page import BLUE, GREEN, GREY, ORANGE, PURPLE, RED, ToolError
from teeth_runs import PROFILES, TEETH, golden, loaded, row_at, set_all

CATALOGUE_JUMP = 500.0  # N.m
BALLS = 23
FEWEST_BALLS = 3  # that the tool takes


def ratchet(page, *options, limit=2000, gear=tuple(golden())):
    try:
        return page.tool("ratchet", "--torque-limit", limit, *gear, *options)
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
    supports = [1e5, 2e5, 3e5, 5e5, 1e6, 2e6, 3e6, 5e6, 1e7, 2e7]
    curves = [ratchet(page, *support(stiffness), limit=20000) for stiffness in supports]
    at_catalogue = row_at(loaded(page), 500)
    hertz = ratchet(page, *on_balls(), limit=20000)["peak"]
    hertz_force = hertz["wave_generator_force_max"] * TEETH / BALLS
    few = ratchet(page, *on_balls(f"bearing.balls={FEWEST_BALLS}"), limit=20000)["peak"]["torque"]
    shipped = ratchet(page, limit=20000, gear=())["peak"]["torque"]
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
to be {radial / depth:.1e} N/m. This is **not** the cause of the jump. With the wave amplitude as an unknown on
springs of that size, or of almost none ({softest['torque']:.0f} N·m at 1e5 N/m a lobe), no tooth jumps: the amplitude
ends at {1e3 * softest['wave_amplitude']:.2f} mm. The ring is inextensible, so a smaller wave also moves the teeth
around by −(w/2) sin 2ψ. At 500 N·m the flanks press on the amplitude with {parts['radial'] / 1e3:.2f} kN a lobe
radially but pull with {parts['around'] / 1e3:.2f} kN around; as the amplitude falls the load moves to teeth further
from the axis, until the two balance. Ovalisation of the circular spline is the same mode: its ring (42.5 / 33.5 mm,
13 mm wide, thin-ring formula) has {circular_spline_stiffness():.1e} N/m a lobe, and does not matter either.

**The local support yields.** The loaded side of the ring is in tension and presses into the wave
generator, the other side is slack and lifts off; the last tooth of the loaded side leaves its space and hands its
load to the next. That happens at a torque nearly proportional to the wave generator's stiffness per tooth, and
{CATALOGUE_JUMP:.0f} N·m belong to {needed:.2g} N/m. The thesis sets 1e8 N/m for each tooth and holds the forces
against those of a ball (Table 6.3), but there are {TEETH} teeth and {BALLS} balls.

**Balls harden.** On balls after Hertz (`contact.support: balls`) the teeth jump at {hertz["torque"] / 1e3:.1f} kN·m,
on the shipped gear, which has such balls and double-arc teeth, at {shipped / 1e3:.1f} kN·m. A ball would carry
{1e-3 * hertz_force:.0f} kN then. With
{FEWEST_BALLS} balls, so {FEWEST_BALLS / BALLS:.2f} of the stiffness at the same depth, it is {few:.0f} N·m.

So the twin does **not** predict the catalogue's figure: it holds {shipped / CATALOGUE_JUMP:.0f} times as much. The
rest is what a plane model has not (races bending between balls and along their width, coning, which leaves the
cup's end of the teeth at less depth, a bearing that does not survive the load) and the margin in a guaranteed figure.
""")
    draw_jump(page, rigid["rows"], dict(zip(supports, curves)), lobes, hertz["torque"])
    check_jump(page, shipped, lobes[6.8e6]["peak"]["torque"], hertz["torque"], few)


def check_jump(page, shipped, lobe, hertz, few):
    def jump(name):
        return ratchet(page, *on_balls("mesh.profile=" + name), limit=20000)["peak"]["torque"]

    page.table(["profile", "jump on balls [N·m]"],
               [[label, f"{jump(name):.0f}"]
                for name, (label, _) in PROFILES.items()])
    page.check("teeth.jump_as_shipped", "largest torque without a jump, as shipped (the search ends at 20 kN·m)",
               "catalogue, CSF-25-100",
               AtLeast(CATALOGUE_JUMP), shipped, "N·m", "a guaranteed figure: the gear must hold it")
    page.check("teeth.jump_lobe", "straight flanks on springs, lobes of 6.8e6 N/m, the simple estimate (up to 2 kN·m)",
               "catalogue, CSF-25-100",
               AtLeast(CATALOGUE_JUMP), lobe, "N·m", "as above")
    page.check("teeth.jump_hertz", "straight flanks on balls: jump torque", "catalogue, CSF-25-100",
               AtLeast(CATALOGUE_JUMP),
               hertz, "N·m", "as above; how much more it holds is the finding, not a success")
    page.check("teeth.jump_support", f"the same with {FEWEST_BALLS} of {BALLS} balls", "catalogue, CSF-25-100",
               AtLeast(CATALOGUE_JUMP), few, "N·m",
               "as above: the balls are one compliance of several in series, and even an eighth of them is enough")


def draw_jump(page, rigid, supports, lobes, hertz):
    """`supports`, `lobes`: curves by stiffness; `hertz`: torque of the jump on balls."""
    def draw(figure):
        left, right = figure.subplots(1, 2)
        for stiffness, colour in ((1e6, GREEN), (2e6, BLUE), (5e6, PURPLE)):
            curve = supports[stiffness]["rows"]
            left.plot([-1e3 * row["output_angle"] for row in curve], [row["torque"] for row in curve], color=colour,
                      label=f"{stiffness:.0e} N/m a tooth".replace("e+0", "e"))
        start = rigid[:180]
        left.plot([-1e3 * row["output_angle"] for row in start], [row["torque"] for row in start], color=GREY,
                  label="1e8 N/m, thesis")
        left.axhline(CATALOGUE_JUMP, color=RED, linestyle="--", linewidth=0.8)
        left.set(xlabel="output angle [mrad]", ylabel="torque [N·m]", title="Output driven, wave generator locked",
                 ylim=(-300, 2900))
        left.legend()
        right.loglog(list(supports), [curve["peak"]["torque"] for curve in supports.values()], "o-",
                     color=BLUE, markersize=3, label="local support, per tooth")
        right.loglog(list(lobes), [lobes[k]["peak"]["torque"] for k in lobes], "^", color=ORANGE,
                     label="whole lobe: no jump up to here")
        right.axhline(CATALOGUE_JUMP, color=RED, linestyle="--", linewidth=0.8, label="catalogue")
        right.axhline(hertz, color=GREEN, linestyle=":", label="balls, Hertz")
        right.axvline(1e8, color=GREY, linestyle=":", label="thesis")
        right.set(xlabel="stiffness [N/m]", ylabel="jump torque [N·m]", title="Jump against stiffness")
        right.legend(fontsize=7, loc="lower right")

    page.figure("teeth_jump", "Left: torque over driven output angle; single teeth leave before the whole jumps. "
                "Right: the torque of the jump "
                "against the wave generator's stiffness.", draw, size=(8.0, 3.5))


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
