# SPDX-License-Identifier: BSD-3-Clause
"""Teeth in mesh and what each carries, against load and pressure angle."""
import math

from bounds import AtMost, Between, Within
from evidence import IDENTITY, MEASUREMENT
from page import RED
from teeth_runs import LOADS, PROFILES, TEETH, golden, lobe, loaded, row_at

RATED = 67  # N.m
LIMIT = 150  # of the joint, N.m
MOMENTARY = 284  # peak of the catalogue, N.m
FE_BAND = (12, 14)  # % of the teeth, thesis section 3.2.2 [51]
CLAIMED_BAND = (25, 35)  # % of the teeth, thesis section 7.4 [35, 38]


def in_mesh(row):
    return 100.0 * row["teeth_loaded"] / TEETH


def largest_share(row):
    forces = [abs(force) for force in row["teeth"]["mesh_force"]]
    return 100.0 * max(forces) / sum(forces)


def leading_share(row):
    forces = row["teeth"]["mesh_force"]
    return 100.0 * sum(max(force, 0.0) for force in forces) / sum(abs(force) for force in forces)


def draw_load(page, rows):
    def draw_share(figure):
        left, right = figure.subplots(1, 2)
        for name, (label, colour) in PROFILES.items():
            left.plot(LOADS, [in_mesh(row) for row in rows[name]], color=colour, label=label)
            right.plot(LOADS[1:], [largest_share(row) for row in rows[name][1:]], color=colour, label=label)
        for (low, high), words in ((FE_BAND, "finite elements"), (CLAIMED_BAND, "claimed")):
            left.axhspan(low, high, color="k", alpha=0.08, linewidth=0)
            left.text(5 if low > 20 else 497, 0.5 * (low + high), words, va="center",
                      ha="left" if low > 20 else "right", fontsize=8)
        for axis in (left, right):
            axis.axvline(LIMIT, color=RED, linewidth=0.8, linestyle="--")
            axis.set_xlabel("load [N·m]")
        left.set(ylabel="teeth in mesh [%]", title="Of 200 teeth (dashed: the joint's limit)", ylim=(0, 45))
        right.set(ylabel="share [%]", title="Largest share of one tooth", ylim=(0, 17))
        right.legend()

    page.figure("teeth_share", "Teeth that carry, and the largest share of one, against load; wave generator locked, "
                "no friction.", draw_share)

    def draw_forces(figure):
        axis = figure.subplots()
        for name, (label, colour) in PROFILES.items():
            axis.plot(*lobe(row_at(rows[name], LIMIT)["teeth"]["mesh_force"]), ".-", markersize=4, color=colour,
                      label=label)
        axis.set(xlabel="angle from the major axis [°]", ylabel="flank force [N]", xlim=(-40, 50))
        axis.legend()

    page.figure("teeth_forces", f"Force on each tooth of one lobe at {LIMIT} N·m.", draw_forces, size=(8.0, 2.8))


def load_share(page, rows):
    page.heading("Teeth in mesh and load share")
    draw_load(page, rows)
    table = []
    for name, (label, _) in PROFILES.items():
        for load in (14, RATED, LIMIT, MOMENTARY):
            row = row_at(rows[name], load)
            table.append([label, load, f"{in_mesh(row):.0f}", f"{row['mesh_force_max']:.0f}",
                          f"{largest_share(row):.2f}",
                          f"{leading_share(row):.1f} / {100.0 - leading_share(row):.1f}"])
    page.table(["profile", "load [N·m]", "teeth in mesh [%]", "largest force [N]", "largest share [%]",
                "leading / trailing flanks [%]"], table)
    share = {name: [f"{in_mesh(row_at(rows[name], load)):.0f}" for load in (RATED, LIMIT, MOMENTARY)]
             for name in PROFILES}
    page.text(f"""
Both published figures are met, each by its profile: at {RATED}, {LIMIT} and {MOMENTARY} N·m (rated, the joint's
limit, the catalogue's momentary peak) involute flanks carry on {" / ".join(share["involute"])} % of the teeth, double
arcs (the teeth of the UR5's gear, thesis fig. 3.7) on {" / ".join(share["double_arc"])} %, with about half the force
on the hardest pressed tooth. Cycloid flanks touch all along the mesh on both sides before any load; load only opens
the trailing ones. Wear, pitch errors and the teeth's own bending shape are not in these figures.
""")
    page.check("teeth.involute_in_mesh", f"involute: teeth in mesh at {LIMIT} N·m",
               "finite elements, thesis 3.2.2 [51]", Between(*FE_BAND),
               in_mesh(row_at(rows["involute"], LIMIT)), "%",
               "published for 27° and 16°; its load is not given, the joint's limit is taken", evidence=MEASUREMENT)
    page.check("teeth.trapezoid_in_mesh", f"trapezoid: teeth in mesh at {LIMIT} N·m",
               "finite elements, thesis 3.2.2 [51]", Between(*FE_BAND),
               in_mesh(row_at(rows["trapezoid"], LIMIT)), "%", "as above; at this size an involute is nearly straight",
               evidence=MEASUREMENT)
    for load in (LIMIT, MOMENTARY):
        page.check(f"teeth.double_arc_in_mesh_{load}", f"double arc: teeth in mesh at {load} N·m",
                   "thesis 7.4 [35, 38]",
                   Between(*CLAIMED_BAND), in_mesh(row_at(rows["double_arc"], load)), "%",
                   "claimed without profile and load", evidence=MEASUREMENT)
    shipped = page.tool("stiffness", "--torques", f"{RATED},{LIMIT},{MOMENTARY}")["rows"]
    for load in (RATED, LIMIT, MOMENTARY):
        page.check(f"teeth.shipped_in_mesh_{load}", f"as shipped, double arc on balls: teeth in mesh at {load} N·m",
                   "thesis 7.4 [35, 38]", Between(*CLAIMED_BAND), in_mesh(row_at(shipped, load)), "%",
                   "claimed without load", known="at the rated load fewer teeth carry" if load == RATED else "",
                   evidence=MEASUREMENT)
    ratio = row_at(rows["double_arc"], LIMIT)["mesh_force_max"] / row_at(rows["involute"], LIMIT)["mesh_force_max"]
    page.check("teeth.double_arc_relief", f"double arc over involute: largest tooth force at {LIMIT} N·m",
               "thesis 3.2.4: spread on more teeth",
               AtMost(0.75), ratio, "",
               "the optimised involute of thesis 3.2.2 [49] reaches 0.58; more teeth must show in the force",
               evidence=MEASUREMENT)


def turning(page):
    """Over a tooth pitch each profile must return the work it took, whatever it does in between."""
    load, pitch, ratio = 20.0, 2.0 * math.pi / TEETH, 101.0
    table = []
    for name, (label, _) in PROFILES.items():
        rows = page.tool("turn", "--load", load, "--angle-range", repr(pitch), "--steps", 100,
                         *golden("mesh.profile=" + name))["rows"]
        mean = sum(row["wave_generator_torque"] for row in rows[:-1]) / (len(rows) - 1)
        errors = [row["output_angle"] - row["wave_generator_angle"] / ratio for row in rows]
        table.append([label, f"{math.degrees(max(errors) - min(errors)) * 3600.0:.3f}"])
        page.check(f"teeth.virtual_work_{name}",
                   f"{label}: mean wave generator torque over a pitch times 101 over the load",
                   "virtual work", Within(-1.0, absolute=1e-6), mean * ratio / load, "",
                   "the mean of 100 steps; a clearance whose slope were not its derivative would leave more",
                   evidence=IDENTITY)
    page.table(["profile", "kinematic error of the perfect gear [″]"], table)


def pressure_angle(page):
    """What 27 instead of 16 degrees costs, beside the finite elements of thesis 3.2.2 [51]."""
    loads = (30, LIMIT)
    found = {}
    for angle in (27, 16):
        low, high = loaded(page, "mesh.profile=involute", f"mesh.flank_angle={math.radians(angle):.9f}", loads=loads)
        found[angle] = ((loads[1] - loads[0]) / (low["output_angle"] - high["output_angle"]), in_mesh(high))
    page.text(f"""
Pressure angle of the involute from 27° to 16°: teeth in mesh {found[27][1]:.0f} → {found[16][1]:.0f} % (finite
elements: 12 → 14 %), torsional stiffness between {loads[0]} and {loads[1]} N·m {found[27][0] / 1e4:.2f}e4 →
{found[16][0] / 1e4:.2f}e4 N·m/rad (6.36e4 → 6.54e4, another gear).
""")
    page.check("teeth.pressure_angle_stiffness", "involute: gain in torsional stiffness from 27° to 16°",
               "finite elements, thesis 3.2.2 [51]",
               Within(2.83, absolute=1.0), 100.0 * (found[16][0] / found[27][0] - 1.0), "%",
               "another size of gear, whose cup takes another part of the torsion", evidence=MEASUREMENT)
