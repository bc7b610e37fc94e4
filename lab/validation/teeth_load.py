# SPDX-License-Identifier: BSD-3-Clause
"""Teeth in mesh and what each carries, against load and pressure angle."""
import math

from bounds import AtMost, Between, Within
from evidence import IDENTITY, MEASUREMENT
from teeth_runs import PROFILES, TEETH, golden, loaded, row_at

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


def load_share(page, rows):
    page.heading("Teeth in mesh and load share")
    table = []
    for name, label in PROFILES.items():
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
                   "claimed without load", known="in the twin fewer teeth carry load at the rated torque than in the "
                   "source" if load == RATED else "",
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
    for name, label in PROFILES.items():
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
