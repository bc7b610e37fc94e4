# SPDX-License-Identifier: BSD-3-Clause
"""Teeth: the four profiles and what each carries, interference of the straight flank, the jump of the teeth."""
import math

from bounds import AtLeast, AtMost, Between, Within
from page import BLUE, GREEN, GREY, ORANGE, PURPLE, RED, ToolError

PROFILES = {"trapezoid": ("trapezoid", GREY), "involute": ("involute", BLUE), "cycloid": ("cycloid", ORANGE),
            "double_arc": ("double arc", GREEN)}
TEETH = 200
LOADS = [0, 7, 14, 30, 48, 67, 87, 108, 130, 150, 200, 250, 284, 350, 400, 450, 500]  # N.m
RATED = 67  # N.m
LIMIT = 150  # of the joint, N.m
MOMENTARY = 284  # peak of the catalogue, N.m
CATALOGUE_JUMP = 500.0  # N.m
BALLS = 23
BALL_DIAMETER = 5.47e-3  # m, thesis Table 3.1
FE_BAND = (12, 14)  # % of the teeth, thesis section 3.2.2 [51]
CLAIMED_BAND = (25, 35)  # % of the teeth, thesis section 7.4 [35, 38]


def build(page):
    path = profiles(page)
    rows = {name: loaded(page, "mesh.profile=" + name) for name in PROFILES}
    clearance_at_rest(page, rows, path)
    load_share(page, rows)
    turning(page)
    pressure_angle(page)
    interference(page, path)
    jump(page)


def set_all(*assignments):
    return [word for assignment in assignments for word in ("--set", assignment)]


def loaded(page, *assignments, loads=LOADS):
    return page.tool("stiffness", "--torques", ",".join(str(load) for load in loads), "--teeth", *set_all(*assignments))["rows"]


def row_at(rows, torque):
    return next(row for row in rows if row["torque"] == torque)


def in_mesh(row):
    return 100.0 * row["teeth_loaded"] / TEETH


def largest_share(row):
    forces = [abs(force) for force in row["teeth"]["mesh_force"]]
    return 100.0 * max(forces) / sum(forces)


def leading_share(row):
    forces = row["teeth"]["mesh_force"]
    return 100.0 * sum(max(force, 0.0) for force in forces) / sum(abs(force) for force in forces)


def lobe(values):
    """The teeth around the first lobe: angles from the major axis [deg] and their values."""
    quarter = TEETH // 4
    order = range(-quarter, quarter + 1)
    return [360.0 * i / TEETH for i in order], [values[i] for i in order]


# Profiles -----------------------------------------------------------------------------------------------------------


def profiles(page):
    """Gives the path of a tooth: drops and half clearances that touch it [m], its slopes as angles [rad]."""
    page.heading("Four profiles")
    mesh = page.tool("parameters")["mesh"]
    shapes = {name: page.tool("profile", *set_all("mesh.profile=" + name)) for name in PROFILES}
    cycloid = shapes["cycloid"]["clearance"]
    path = {"drop": cycloid["drop"], "across": cycloid["path"], "angle": cycloid["flank_angle"]}
    page.text(f"""
A flank enters the mesh as the half clearance c between tooth and space over the tooth's drop from full engagement. On an ideal ring
(inextensible, w0 cos 2ψ) the tooth's own path through its space is a cycloid; a flank touches where its clearance meets the path. All have
the same clearance at full engagement. Free dimensions:

- **trapezoid**: straight, {math.degrees(mesh["flank_angle"]):.0f}° (thesis, 3.2.2: smallest angle free of interference); the shipped profile.
- **involute**: both gears cut as rigid ones, the same angle at mid-height of the tooth. Nothing is left to choose.
- **cycloid**: both flanks the path on half the scale, one turned by 180° (Ishikawa's similar curves): as close as flanks can be.
- **double arc**: a common tangent at mid-height ({math.degrees(mesh["tangent_angle"]):.0f}°, {1e3 * mesh["tangent_length"]:.2f} mm), a convex arc above and a concave one below; their radius follows from the
  demand that the tip has the slope of the path where it enters. The space is cut as the envelope of this tooth, as makers do. The figure of
  the thesis (3.7) has no dimensions; a published set (Liu et al., Machines 13, 535, 2025) has a tangent of {published_tangent():.1f}°, steeper than
  the chord of this gear's path, {chord(path):.1f}°: such arcs would never touch here.
""")

    def draw_shapes(figure):
        axes = figure.subplots(1, 4, sharey=True)
        half_width = 0.2036e-3  # of a tooth at mid-height: base 0.56 mm less the 17 degree flank (thesis, Table 3.4)
        for axis, (name, (label, colour)) in zip(axes, PROFILES.items()):
            draw_engaged(axis, shapes[name], half_width, colour)
            axis.set(title=label, xlabel="across [mm]", xlim=(-0.32, 0.32), ylim=(-0.52, 0.06))
        axes[0].set_ylabel("from tooth tip [mm]")

    page.figure("teeth_shapes", "Tooth of the flexspline (filled) in its space of the circular spline at full engagement, true to scale; "
                "thickness of the tooth from Table 3.4.", draw_shapes, size=(8.0, 2.6))

    def draw_clearance(figure):
        left, right = figure.subplots(1, 2)
        for name, (label, colour) in PROFILES.items():
            data = shapes[name]["clearance"]
            drop = [1e3 * value for value in data["drop"]]
            left.plot(drop, [1e6 * value for value in data["half_clearance"]], color=colour, label=label)
            right.plot(drop, [math.degrees(value) for value in data["flank_angle"]], color=colour, label=label)
        left.plot(drop, [1e6 * value for value in data["path"]], "k:", label="path of the tooth")
        left.set(xlabel="drop from full engagement [mm]", ylabel="half clearance [µm]", title="Clearance and path")
        right.set(xlabel="drop from full engagement [mm]", ylabel="angle from tooth axis [°]", title="Flank angle in contact")
        left.legend()

    page.figure("teeth_clearance", "Half clearance of the four profiles beside the path of a tooth on the ideal ring. Above the dots: a "
                "gap; below: interference.", draw_clearance)
    return path


def chord(path):
    """Angle of the path's chord from entry to full engagement [deg]."""
    return math.degrees(math.atan2(path["across"][-1], path["drop"][-1]))


def published_tangent():
    """Angle of the common tangent of Liu et al. (Machines 13, 535, section 3.5): arcs of radius r about (-c1, -e1) from the
    tooth's axis and pitch line, and about (c2, e2) from the axis of the next space [deg]."""
    module, r1, c1, e1, r2, c2, e2 = 0.5, 0.685, 0.332, 0.155, 0.785, 0.330, 0.134
    across = 0.5 * math.pi * module + c2 + c1
    return math.degrees(math.atan2(e1 + e2, across) + math.acos((r1 + r2) / math.hypot(across, e1 + e2)))


def draw_engaged(axis, shape, half_width, colour):
    tip_drop = shape["clearance"]["drop"][-1]  # at full engagement the tip is this far above the circular spline's tip
    below = shape["tooth"]["below_tip"]
    thickness = shape["tooth"]["half_thickness"]
    middle = min(range(len(below)), key=lambda j: abs(below[j] - 0.25e-3))
    tooth_x = [1e3 * (value - thickness[middle] + half_width) for value in thickness]
    tooth_y = [-1e3 * value for value in below]
    axis.fill_betweenx(tooth_y, [-x for x in tooth_x], tooth_x, color=colour, alpha=0.35, linewidth=0)
    # The space is known up to a constant: the gap at full engagement, here none.
    space = {round(1e6 * (tip_drop - above)): width for above, width in
             zip(shape["space"]["above_tip"], shape["space"]["half_width"])}
    gap = min(space[depth] - value for depth, value in zip((round(1e6 * b) for b in below), thickness) if depth in space)
    depths = sorted(space)
    space_x = [1e3 * (space[depth] - gap - thickness[middle] + half_width) for depth in depths]
    for side in (-1, 1):
        axis.plot([side * x for x in space_x], [-1e-3 * depth for depth in depths], color="k", linewidth=1.2)
    axis.set_aspect("equal")


def clearance_at_rest(page, rows, path):
    """Gap of every engaged tooth at no load, the ring in equilibrium."""

    def engaged(name):
        teeth = rows[name][0]["teeth"]
        angles, gap = lobe(teeth["gap"])
        _, depth = lobe(teeth["depth"])
        return [(angle, 1e6 * g) for angle, g, d in zip(angles, gap, depth) if d > 20e-6]

    def draw(figure):
        axis = figure.subplots()
        for name, (label, colour) in PROFILES.items():
            axis.plot(*zip(*engaged(name)), color=colour, label=label)
        axis.axhline(0.0, color="k", linewidth=0.8)
        axis.set(xlabel="angle from the major axis [°]", ylabel="gap to the nearer flank [µm]")
        axis.legend(ncol=4, loc="upper center")
        axis.set_ylim(-3, 32)

    page.figure("teeth_gap", "No load, the ring in equilibrium: gap of each engaged tooth to its nearer flank; below zero it is pressed.",
                draw, size=(8.0, 2.8))
    gaps = {name: [gap for _, gap in engaged(name)] for name in PROFILES}
    page.table(["profile", "teeth pressed at no load", "smallest gap [µm]", "largest gap [µm]"],
               [[PROFILES[name][0], rows[name][0]["teeth_loaded"], f"{min(gaps[name]):.2f}", f"{max(gaps[name]):.2f}"] for name in PROFILES])
    mesh, gear = page.tool("parameters")["mesh"], page.tool("parameters")["gear"]
    steep = next(drop for drop, angle in zip(path["drop"], path["angle"]) if angle > mesh["tangent_angle"])
    steep_angle = 0.5 * math.degrees(math.acos(1.0 - steep / gear["wave_amplitude"]))
    page.text(f"""
Flanks made for rigid gears, straight or involute, are hardly to be told apart at this size and stand off by up to
{max(gaps["involute"]):.0f} µm on their way. The cycloid stays within {max(abs(gap) for gap in gaps["cycloid"]):.1f} µm all the way; what it lacks is the
ring's own elasticity. The double arc touches near full engagement; from about {steep_angle:.0f}° on, where the path becomes steeper than
the common tangent, its arc follows the path at a gap of a few micrometres, which its own concave root has cut at full engagement.
""")
    page.check("teeth.cycloid_conjugate", "cycloid: largest less smallest gap along the mesh at no load", "conjugate on the ideal ring",
               AtMost(3.0), max(gaps["cycloid"]) - min(gaps["cycloid"]), "µm",
               "what the elastic ring differs from the ideal one; a tenth of the straight flank's gap")
    for name in ("trapezoid", "involute", "double_arc"):
        page.check(f"teeth.no_interference_{name}", f"{PROFILES[name][0]}: smallest gap at no load beyond 10° from the major axis",
                   "no interference of a sound profile (thesis, 3.2.2)", AtLeast(0.0),
                   min(gap for angle, gap in engaged(name) if abs(angle) > 10.0), "µm",
                   "pressed only near the axis, by the preload of 1 µm")


# Load -------------------------------------------------------------------------------------------------------------------


def load_share(page, rows):
    page.heading("Teeth in mesh and load share")

    def draw_share(figure):
        left, right = figure.subplots(1, 2)
        for name, (label, colour) in PROFILES.items():
            left.plot(LOADS, [in_mesh(row) for row in rows[name]], color=colour, label=label)
            right.plot(LOADS[1:], [largest_share(row) for row in rows[name][1:]], color=colour, label=label)
        for (low, high), words in ((FE_BAND, "finite elements"), (CLAIMED_BAND, "claimed")):
            left.axhspan(low, high, color="k", alpha=0.08, linewidth=0)
            left.text(5 if low > 20 else 497, 0.5 * (low + high), words, va="center", ha="left" if low > 20 else "right", fontsize=8)
        for axis in (left, right):
            axis.axvline(LIMIT, color=RED, linewidth=0.8, linestyle="--")
            axis.set_xlabel("load [N·m]")
        left.set(ylabel="teeth in mesh [%]", title="Of 200 teeth (dashed: the joint's limit)", ylim=(0, 45))
        right.set(ylabel="share [%]", title="Largest share of one tooth", ylim=(0, 17))
        right.legend()

    page.figure("teeth_share", "Teeth that carry, and the largest share of one, against load; wave generator locked, no friction.", draw_share)

    def draw_forces(figure):
        axis = figure.subplots()
        for name, (label, colour) in PROFILES.items():
            axis.plot(*lobe(row_at(rows[name], LIMIT)["teeth"]["mesh_force"]), ".-", markersize=4, color=colour, label=label)
        axis.set(xlabel="angle from the major axis [°]", ylabel="flank force [N]", xlim=(-40, 50))
        axis.legend()

    page.figure("teeth_forces", f"Force on each tooth of one lobe at {LIMIT} N·m.", draw_forces, size=(8.0, 2.8))
    table = []
    for name, (label, _) in PROFILES.items():
        for load in (14, RATED, LIMIT, MOMENTARY):
            row = row_at(rows[name], load)
            table.append([label, load, f"{in_mesh(row):.0f}", f"{row['mesh_force_max']:.0f}", f"{largest_share(row):.2f}",
                          f"{leading_share(row):.1f} / {100.0 - leading_share(row):.1f}"])
    page.table(["profile", "load [N·m]", "teeth in mesh [%]", "largest force [N]", "largest share [%]", "leading / trailing flanks [%]"], table)
    share = {name: [f"{in_mesh(row_at(rows[name], load)):.0f}" for load in (RATED, LIMIT, MOMENTARY)] for name in PROFILES}
    page.text(f"""
Both published figures are met, each by its profile: at {RATED}, {LIMIT} and {MOMENTARY} N·m (rated, the joint's limit, the catalogue's momentary peak)
involute flanks carry on {" / ".join(share["involute"])} % of the teeth, double arcs (the teeth of the UR5's gear, thesis fig. 3.7) on
{" / ".join(share["double_arc"])} %, with about half the force on the hardest pressed tooth. Cycloid flanks touch all along the mesh on both sides
before any load; load only opens the trailing ones. Wear, pitch errors and the teeth's own bending shape are not in these figures.
""")
    page.check("teeth.involute_in_mesh", f"involute: teeth in mesh at {LIMIT} N·m", "finite elements, thesis 3.2.2 [51]", Between(*FE_BAND),
               in_mesh(row_at(rows["involute"], LIMIT)), "%", "published for 27° and 16°; its load is not given, the joint's limit is taken")
    page.check("teeth.trapezoid_in_mesh", f"trapezoid: teeth in mesh at {LIMIT} N·m", "finite elements, thesis 3.2.2 [51]", Between(*FE_BAND),
               in_mesh(row_at(rows["trapezoid"], LIMIT)), "%", "as above; at this size an involute is nearly straight")
    for load in (LIMIT, MOMENTARY):
        page.check(f"teeth.double_arc_in_mesh_{load}", f"double arc: teeth in mesh at {load} N·m", "thesis 7.4 [35, 38]",
                   Between(*CLAIMED_BAND), in_mesh(row_at(rows["double_arc"], load)), "%", "claimed without profile and load")
    ratio = row_at(rows["double_arc"], LIMIT)["mesh_force_max"] / row_at(rows["involute"], LIMIT)["mesh_force_max"]
    page.check("teeth.double_arc_relief", f"double arc over involute: largest tooth force at {LIMIT} N·m", "thesis 3.2.4: spread on more teeth",
               AtMost(0.75), ratio, "", "the optimised involute of thesis 3.2.2 [49] reaches 0.58; more teeth must show in the force")


def turning(page):
    """Over a tooth pitch each profile must return the work it took, whatever it does in between."""
    load, pitch, ratio = 20.0, 2.0 * math.pi / TEETH, 101.0
    table = []
    for name, (label, _) in PROFILES.items():
        rows = page.tool("turn", "--load", load, "--angle-range", repr(pitch), "--steps", 100, *set_all("mesh.profile=" + name))["rows"]
        mean = sum(row["wave_generator_torque"] for row in rows[:-1]) / (len(rows) - 1)
        errors = [row["output_angle"] - row["wave_generator_angle"] / ratio for row in rows]
        table.append([label, f"{math.degrees(max(errors) - min(errors)) * 3600.0:.3f}"])
        page.check(f"teeth.virtual_work_{name}", f"{label}: mean wave generator torque over a pitch times 101 over the load",
                   "virtual work", Within(-1.0, absolute=1e-6), mean * ratio / load, "",
                   "the mean of 100 steps; a clearance whose slope were not its derivative would leave more")
    page.table(["profile", "kinematic error of the perfect gear [″]"], table)


def pressure_angle(page):
    """What 27 instead of 16 degrees costs, beside the finite elements of thesis 3.2.2 [51]."""
    loads = (30, LIMIT)
    found = {}
    for angle in (27, 16):
        low, high = loaded(page, "mesh.profile=involute", f"mesh.flank_angle={math.radians(angle):.9f}", loads=loads)
        found[angle] = ((loads[1] - loads[0]) / (low["output_angle"] - high["output_angle"]), in_mesh(high))
    page.text(f"""
Pressure angle of the involute from 27° to 16°: teeth in mesh {found[27][1]:.0f} → {found[16][1]:.0f} % (finite elements: 12 → 14 %), torsional
stiffness between {loads[0]} and {loads[1]} N·m {found[27][0] / 1e4:.2f}e4 → {found[16][0] / 1e4:.2f}e4 N·m/rad (6.36e4 → 6.54e4, another gear).
""")
    page.check("teeth.pressure_angle_stiffness", "involute: gain in torsional stiffness from 27° to 16°", "finite elements, thesis 3.2.2 [51]",
               Within(2.83, absolute=1.0), 100.0 * (found[16][0] / found[27][0] - 1.0), "%",
               "another size of gear, whose cup takes another part of the torsion")


# Interference -----------------------------------------------------------------------------------------------------------


def tilted_gap(teeth, tooth_height):
    """Smallest gap of the whole tilted flank over the teeth in the second half of the mesh [m].

    The mesh takes the flank at mid-height; a point y further out stands tilt * y further across.
    """
    gaps = []
    for across, depth, tilt, gap in zip(teeth["across"], teeth["depth"], teeth["tilt"], teeth["gap"]):
        if 0.0 < depth < 0.175e-3:
            lowest = max(0.5 * tooth_height - depth, -0.5 * tooth_height)
            lean = math.copysign(1.0, across) * tilt
            gaps.append(gap - max(lean * 0.5 * tooth_height, lean * lowest))
    return min(gaps)


def interference(page, path):
    page.heading("Interference of the straight flank")
    height = page.tool("parameters")["gear"]["tooth_height_flexspline"]
    angles = [8, 9, 10, 11, 12, 12.5, 13, 13.25, 13.5, 13.6, 13.7, 13.8, 13.9, 14, 14.5, 15, 15.5, 16, 17, 18, 20, 22.5, 25]
    forces = []
    gaps = []
    for angle in angles:
        row = loaded(page, f"mesh.flank_angle={math.radians(angle):.9f}", "mesh.flank_clearance=0.0", loads=[0])[0]
        forces.append(sum(abs(force) for force in row["teeth"]["mesh_force"]))
        gaps.append(1e6 * tilted_gap(row["teeth"], height))

    def draw(figure):
        left, right = figure.subplots(1, 2)
        left.plot(angles, forces, "o-", color=BLUE, markersize=3)
        left.set(xlabel="flank angle [°]", ylabel="sum of flank forces [N]", title="No load, no clearance: forces")
        right.plot(angles, gaps, "o-", color=BLUE, markersize=3)
        right.axhline(0.0, color="k", linewidth=0.8)
        right.set(xlabel="flank angle [°]", ylabel="smallest gap [µm]", title="Gap of the tilted flank at entry")
        for axis in (left, right):
            axis.axvspan(16, 17, color=ORANGE, alpha=0.3, linewidth=0)

    page.figure("teeth_interference", "Straight flanks against the flank angle, flank clearance zero. Band: the smallest angles free of "
                "interference in the thesis, 16° and 17°.", draw)
    from_forces = crossing(angles, [1.0 - force for force in forces])
    from_gap = crossing(angles, gaps)
    page.text(f"""
Below {from_forces:.1f}° the entering teeth press on their flanks without any load; tilted with the rim, their tips already overlap below
{from_gap:.1f}°. By the closed form it is the chord of the path, {chord(path):.1f}°. The thesis' 16° and 17° are finite elements of whole
gears, whose teeth also lean along their width (coning). The order is the same, and the shipped angle is free.
""")
    page.check("teeth.interference_angle", "flank angle at which the tips of straight flanks cease to interfere", "thesis 3.2.2 [51], 4 [83]",
               Within(16.0, absolute=2.0), from_gap, "°", "the two sources differ by 1°; plane teeth against whole gears")
    page.check("teeth.interference_free", "flank forces at no load and no clearance, 16°", "thesis 4 [83]: free from 16°", AtMost(0.0),
               forces[angles.index(16)], "N", "no contact is no force")
    page.check("teeth.interference_below", "the same at 12°", "interference below 16°", AtLeast(100.0), forces[angles.index(12)], "N",
               "a force that would be felt: ten teeth's share of the preload")


def crossing(angles, values):
    """Where the values rise through zero, by straight lines."""
    for i in range(len(angles) - 1):
        if values[i] < 0.0 <= values[i + 1]:
            return angles[i] + (angles[i + 1] - angles[i]) * values[i] / (values[i] - values[i + 1])
    return math.nan


# Jump -------------------------------------------------------------------------------------------------------------------


def ratchet(page, *options, limit=2000):
    try:
        return page.tool("ratchet", "--torque-limit", limit, *options)
    except ToolError:  # with a wrong parameter a soft gear may stand nowhere: that fails its row, not the page
        nowhere = {"torque": math.nan, "output_angle": math.nan, "wave_amplitude": math.nan}
        return {"end": "nowhere", "peak": nowhere, "rows": [nowhere]}


def support(stiffness):
    return set_all(f"contact.stiffness={stiffness:.6e}")


def ball_stiffness(force):
    """Secant stiffness of a ball between its races at a force [N], Palmgren: 4.4e-4 mm (F^2 / D)^(1/3), F in N, D in mm [N/m]."""
    return force / (4.4e-7 * (force ** 2 / (1e3 * BALL_DIAMETER)) ** (1.0 / 3.0))


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
    parameters = page.tool("parameters")
    gear, mesh = parameters["gear"], parameters["mesh"]
    rigid = ratchet(page, limit=20000)
    lobes = {stiffness: ratchet(page, "--lobe-stiffness", f"{stiffness:.3e}") for stiffness in (1e8, 3e7, 6.8e6, 1e6, 1e5)}
    supports = [1e5, 2e5, 3e5, 5e5, 1e6, 2e6, 3e6, 5e6, 1e7, 2e7]
    curves = [ratchet(page, *support(stiffness), limit=20000) for stiffness in supports]
    jumps = [curve["peak"]["torque"] for curve in curves]
    at_catalogue = row_at(loaded(page), 500)
    ball_force = max(at_catalogue["teeth"]["wave_generator_force"]) * TEETH / BALLS
    hertz = ball_stiffness(ball_force) * BALLS / TEETH
    hertz_jump = ratchet(page, *support(hertz), limit=20000)["peak"]["torque"]
    needed = support_for(page, CATALOGUE_JUMP)

    radius = gear["flexspline_inner_radius"] + gear["rim_thickness"] + 0.5 * gear["tooth_height_flexspline"]
    depth = gear["flexspline_inner_radius"] + gear["wave_amplitude"] + gear["rim_thickness"] + gear["tooth_height_flexspline"] \
        - gear["tip_radius_circular_spline"]
    radial = 0.5 * CATALOGUE_JUMP / radius * math.tan(mesh["flank_angle"])
    parts = amplitude_parts(at_catalogue, gear, mesh["flank_angle"])
    softest = lobes[1e5]["peak"]

    page.text(f"""
The catalogue lets the teeth of a CSF-25-100 jump at {CATALOGUE_JUMP:.0f} N·m. The twin's output is driven against a locked wave generator until the
torque falls (`joint_twin ratchet`); where the ring snaps, it goes downhill in energy to its next equilibrium. Friction is left out; sliding outwards
at {mesh["friction_static"]:.2f} on the flanks it would divide the radial force by {friction_relief(mesh):.1f}, and so raise a jump.

**As shipped nothing jumps** below {rigid["peak"]["torque"] / 1e3:.0f} kN·m. The simple estimate: at 500 N·m each lobe carries {500 / radius / 2e3:.1f} kN,
flanks of {math.degrees(mesh["flank_angle"]):.0f}° push it in with {radial / 1e3:.2f} kN, and to lose the depth of {1e3 * depth:.2f} mm to that force its radial stiffness would have to be
{radial / depth:.1e} N/m. This is **not** what makes the teeth jump. With the wave amplitude as an unknown on springs of that size, or of almost
none ({softest['torque']:.0f} N·m at 1e5 N/m a lobe), no tooth jumps: the amplitude ends at {1e3 * softest['wave_amplitude']:.2f} mm. The ring is
inextensible, so a smaller wave also moves the teeth around by −(w/2) sin 2ψ. At 500 N·m the flanks press on the amplitude with
{parts['radial'] / 1e3:.2f} kN a lobe radially but pull with {parts['around'] / 1e3:.2f} kN around; as the amplitude falls the load moves to
teeth further from the axis, until the two balance. Ovalisation of the circular spline is the same mode: its ring (42.5 / 33.5 mm, 13 mm
wide, thin-ring formula) has {circular_spline_stiffness():.1e} N/m a lobe, and does not matter either.

**What gives way is the local support.** The loaded side of the ring is in tension and presses into the wave generator, the other side is
slack and lifts off; the last tooth of the loaded side leaves its space and hands its load to the next. That happens at a torque nearly
proportional to the wave generator's stiffness per tooth, and {CATALOGUE_JUMP:.0f} N·m belong to {needed:.2g} N/m. The thesis sets 1e8 N/m for each
tooth and holds the forces against those of a ball (Table 6.3), but there are {TEETH} teeth and {BALLS} balls. A ball of 5.47 mm between its races (Palmgren) has {hertz * TEETH / BALLS:.1e} N/m at
the {ball_force / 1e3:.1f} kN that 500 N·m bring, {hertz:.1e} N/m a tooth; with that the teeth jump at {hertz_jump:.0f} N·m.

So the twin does **not** predict the catalogue's figure: it holds more than {rigid["peak"]["torque"] / CATALOGUE_JUMP:.0f} times as much as shipped, and
{hertz_jump / CATALOGUE_JUMP:.1f} times with the balls' own stiffness. The rest would need a support {hertz / needed:.1f} times softer than the balls: what a plane model
has not (races bending between balls and along their width, coning, which leaves the cup's end of the teeth at less depth) and the margin in a
guaranteed figure.
""")

    def draw(figure):
        left, right = figure.subplots(1, 2)
        for stiffness, colour in ((1e6, GREEN), (2e6, BLUE), (5e6, PURPLE)):
            curve = curves[supports.index(stiffness)]["rows"]
            left.plot([-1e3 * row["output_angle"] for row in curve], [row["torque"] for row in curve], color=colour,
                      label=f"{stiffness:.0e} N/m a tooth".replace("e+0", "e"))
        start = rigid["rows"][:180]
        left.plot([-1e3 * row["output_angle"] for row in start], [row["torque"] for row in start], color=GREY,
                  label="1e8 N/m, as shipped")
        left.axhline(CATALOGUE_JUMP, color=RED, linestyle="--", linewidth=0.8)
        left.set(xlabel="output angle [mrad]", ylabel="torque [N·m]", title="Output driven, wave generator locked", ylim=(-300, 2900))
        left.legend()
        right.loglog(supports, jumps, "o-", color=BLUE, markersize=3, label="local support, per tooth")
        right.loglog(list(lobes), [lobes[k]["peak"]["torque"] for k in lobes], "^", color=ORANGE, label="whole lobe: no jump up to here")
        right.axhline(CATALOGUE_JUMP, color=RED, linestyle="--", linewidth=0.8, label="catalogue")
        right.axvline(hertz, color=GREEN, linestyle=":", label="balls, Hertz")
        right.axvline(1e8, color=GREY, linestyle=":", label="thesis")
        right.set(xlabel="stiffness [N/m]", ylabel="jump torque [N·m]", title="Jump against stiffness")
        right.legend(fontsize=7)

    page.figure("teeth_jump", "Left: torque over driven output angle; single teeth leave before the whole jumps. Right: the torque of the jump "
                "against the wave generator's stiffness.", draw, size=(8.0, 3.5))
    page.table(["profile", "jump with the balls' stiffness [N·m]"],
               [[label, f"{ratchet(page, *support(hertz), *set_all('mesh.profile=' + name), limit=20000)['peak']['torque']:.0f}"]
                for name, (label, _) in PROFILES.items()])
    page.check("teeth.jump_as_shipped", "largest torque without a jump, as shipped (the search ends at 20 kN·m)", "catalogue, CSF-25-100",
               AtLeast(CATALOGUE_JUMP), rigid["peak"]["torque"], "N·m", "a guaranteed figure: the gear must hold it")
    page.check("teeth.jump_lobe", "the same with lobes of 6.8e6 N/m, the simple estimate (up to 2 kN·m)", "catalogue, CSF-25-100",
               AtLeast(CATALOGUE_JUMP), lobes[6.8e6]["peak"]["torque"], "N·m", "as above")
    page.check("teeth.jump_hertz", "jump torque with the balls' stiffness", "catalogue, CSF-25-100", AtLeast(CATALOGUE_JUMP),
               hertz_jump, "N·m", "as above; how much more it holds is the finding, not a success")
    page.check("teeth.jump_support", "stiffness per tooth at which the jump is at 500 N·m, over that of the balls", "Palmgren, 23 balls of 5.47 mm",
               AtMost(1.0), needed / hertz, "", "the balls are one compliance of several in series, so the whole must be softer")


def amplitude_parts(row, gear, flank_angle):
    """Force of the straight flanks on the wave amplitude, per lobe: by the radial motion and by that around [N]."""
    mid_height = gear["rim_thickness"] + 0.5 * gear["tooth_height_flexspline"]
    around = 0.5 * (1.0 - 3.0 * mid_height / gear["flexspline_inner_radius"])
    angles = [4.0 * math.pi * i / TEETH for i in range(TEETH)]
    forces = row["teeth"]["mesh_force"]
    return {"radial": 0.5 * sum(abs(f) * math.sin(flank_angle) * math.cos(a) for f, a in zip(forces, angles)),
            "around": 0.5 * sum(f * math.cos(flank_angle) * around * math.sin(a) for f, a in zip(forces, angles))}


def friction_relief(mesh):
    """Radial force of a flank without friction over that with the largest friction, the tooth about to slide out [-]."""
    return math.tan(mesh["flank_angle"]) / math.tan(mesh["flank_angle"] - math.atan(mesh["friction_static"]))


def circular_spline_stiffness():
    """Of the circular spline's ring under two opposite forces, radial: EI / (0.0745 R^3), Tables 3.5 and 3.6 [N/m]."""
    outer, inner, width, modulus = 42.5e-3, 33.5e-3, 13e-3, 210e9
    inertia = width * (outer - inner) ** 3 / 12.0
    return modulus * inertia / ((math.pi / 8.0 - 1.0 / math.pi) * (0.5 * (outer + inner)) ** 3)
