# SPDX-License-Identifier: BSD-3-Clause
"""What wear takes of the gear's stiffness, by its depth and by the torque that the stiffness is measured with."""
import math

TORQUES = (0.5, 14.0)  # N.m: near zero, and the catalogue's T1 that K1 is given up to
INTERFACE = (5, 10, 20, 30, 50, 100)  # um
FLANK = (1, 3, 10, 13, 30, 100)  # um


def build(page):
    given = page.tool("parameters")
    fit, clearance = given["contact"]["fit"], given["mesh"]["flank_clearance"]
    cosine = math.cos(given["mesh"]["flank_angle"])

    def stiffness(key, value):
        """Torque over torsion, from each torque backwards to the same forwards [N.m/rad]."""
        rows = page.tool("stiffness", "--torques", ",".join(f"{sign * load:g}" for load in TORQUES for sign in (-1, 1)),
                         "--set", f"{key}={value:.9e}")["rows"]
        angle = {row["torque"]: row["output_angle"] for row in rows}
        return [2.0 * load / (angle[-load] - angle[load]) for load in TORQUES]

    table = []
    for name, key, depths, worn in (
            ("interface", "contact.fit", INTERFACE, lambda depth: max(fit - depth, -1e-4)),
            ("flank", "mesh.flank_clearance", FLANK, lambda depth: clearance + depth / cosine)):
        sound = stiffness(key, worn(0.0))
        for depth in depths:
            lost = [100.0 * (1.0 - left / whole) for left, whole in zip(stiffness(key, worn(1e-6 * depth)), sound)]
            for load, share in zip(TORQUES, lost):
                page.value(f"teeth.wear.{name}.{depth}.{load:g}", share, "%")
            table.append([name, f"{depth} µm", *(f"{share:.0f} %" for share in lost)])
    page.text("""
Gap between outer race and rim (`contact.fit`), or material off each flank (`mesh.flank_clearance`; the thinner tooth's
own softness left out): what is lost of the torque over the torsion, from −T to T. Published are three quarters for a
worn interface and 96 % for worn teeth, without a depth and without a torque.
""")
    page.table(["worn", "depth", *(f"lost at T = {load:g} N·m" for load in TORQUES)], table)
