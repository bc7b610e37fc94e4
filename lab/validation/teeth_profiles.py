# SPDX-License-Identifier: BSD-3-Clause
"""Shapes of the four tooth profiles, and how near they come to each other at no load."""
import math

from bounds import AtLeast, AtMost
from evidence import SELF_CONSISTENT
from teeth_runs import PROFILES, golden, lobe


def profiles(page):
    """Gives the path of a tooth: drops and half clearances that touch it [m], its slopes as angles [rad]."""
    page.heading("Four profiles")
    mesh = page.tool("parameters", *golden())["mesh"]
    cycloid = page.tool("profile", *golden("mesh.profile=cycloid"))["clearance"]
    path = {"drop": cycloid["drop"], "across": cycloid["path"], "angle": cycloid["flank_angle"]}
    page.text(f"""
Profiles and supports are compared on the gear as the thesis computes it (`config/golden.yaml`): a spring under each
tooth on a rigid wave generator.

A flank enters the mesh as the half clearance c between tooth and space over the tooth's drop from full engagement. On
an ideal ring (inextensible, w0 cos 2ψ) the tooth's own path through its space is a cycloid; a flank touches where its
clearance meets the path. All have the same clearance at full engagement. Free dimensions:

- **trapezoid**: straight, {math.degrees(mesh["flank_angle"]):.0f}° (thesis, 3.2.2: smallest angle free of
  interference); that of `config/golden.yaml`.
- **involute**: both gears cut as rigid ones, the same angle at mid-height of the tooth. Nothing is left to choose.
- **cycloid**: both flanks the path on half the scale, one turned by 180° (Ishikawa's similar curves): as close as
  flanks can be.
- **double arc**, the shipped profile: a common tangent at mid-height ({math.degrees(mesh["tangent_angle"]):.0f}°,
  {1e3 * mesh["tangent_length"]:.2f} mm), a convex arc above and a concave one below; their radius follows from the
  demand that the tip has the slope of the path where it enters. The space is cut as the envelope of this tooth, as
  makers do. The figure of the thesis (3.7) has no dimensions; a published set (Liu et al., Machines 13, 535, 2025) has
  a tangent of
  {published_tangent():.1f}°, steeper than the chord of this gear's path, {chord(path):.1f}°: such arcs would never
  touch here.
""")

    return path


def chord(path):
    """Angle of the path's chord from entry to full engagement [deg]."""
    return math.degrees(math.atan2(path["across"][-1], path["drop"][-1]))


def published_tangent():
    """Angle of the common tangent of Liu et al. (Machines 13, 535, section 3.5): arcs of radius r about (-c1, -e1) from
    the tooth's axis and pitch line, and about (c2, e2) from the axis of the next space [deg]."""
    module, r1, c1, e1, r2, c2, e2 = 0.5, 0.685, 0.332, 0.155, 0.785, 0.330, 0.134
    across = 0.5 * math.pi * module + c2 + c1
    return math.degrees(math.atan2(e1 + e2, across) + math.acos((r1 + r2) / math.hypot(across, e1 + e2)))


def clearance_at_rest(page, rows, path):
    """Gap of every engaged tooth at no load, the ring in equilibrium."""

    def engaged(name):
        teeth = rows[name][0]["teeth"]
        angles, gap = lobe(teeth["gap"])
        _, depth = lobe(teeth["depth"])
        return [(angle, 1e6 * g) for angle, g, d in zip(angles, gap, depth) if d > 20e-6]

    gaps = {name: [gap for _, gap in engaged(name)] for name in PROFILES}
    page.table(["profile", "teeth pressed at no load", "smallest gap [µm]", "largest gap [µm]"],
               [[PROFILES[name], rows[name][0]["teeth_loaded"], f"{min(gaps[name]):.2f}", f"{max(gaps[name]):.2f}"]
                for name in PROFILES])
    mesh, gear = page.tool("parameters", *golden())["mesh"], page.tool("parameters", *golden())["gear"]
    steep = next(drop for drop, angle in zip(path["drop"], path["angle"]) if angle > mesh["tangent_angle"])
    steep_angle = 0.5 * math.degrees(math.acos(1.0 - steep / gear["wave_amplitude"]))
    page.text(f"""
Flanks made for rigid gears, straight or involute, hardly differ at this size and have a gap of up to
{max(gaps["involute"]):.0f} µm on their way. The cycloid stays within {max(abs(gap) for gap in gaps["cycloid"]):.1f}
µm all the way; the difference from conjugate motion is the ring's own elasticity. The double arc touches near full
engagement; from about {steep_angle:.0f}° on, where the path becomes steeper than the common tangent, its arc follows
the path at a gap of a few micrometres, which its own concave root has cut at full engagement.
""")
    page.check("teeth.cycloid_conjugate", "cycloid: largest less smallest gap along the mesh at no load",
               "conjugate on the ideal ring",
               AtMost(3.0), max(gaps["cycloid"]) - min(gaps["cycloid"]), "µm",
               "difference of the elastic ring from the ideal one; a tenth of the straight flank's gap",
               evidence=SELF_CONSISTENT)
    for name in ("trapezoid", "involute", "double_arc"):
        page.check(f"teeth.no_interference_{name}",
                   f"{PROFILES[name]}: smallest gap at no load beyond 10° from the major axis",
                   "no interference of a sound profile (thesis, 3.2.2)", AtLeast(0.0),
                   min(gap for angle, gap in engaged(name) if abs(angle) > 10.0), "µm",
                   "pressed only near the axis, by the preload of 1 µm", evidence=SELF_CONSISTENT)
