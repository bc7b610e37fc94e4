# SPDX-License-Identifier: BSD-3-Clause
"""Interference of the straight flank against its angle."""
import math

from bounds import AtLeast, AtMost, Within
from evidence import MEASUREMENT, SELF_CONSISTENT
from teeth_profiles import chord
from teeth_runs import golden, loaded


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
    height = page.tool("parameters", *golden())["gear"]["tooth_height_flexspline"]
    angles = [8, 9, 10, 11, 12, 12.5, 13, 13.25, 13.5, 13.6, 13.7, 13.8, 13.9, 14, 14.5, 15, 15.5, 16, 17, 18, 20, 22.5,
              25]
    forces = []
    gaps = []
    for angle in angles:
        row = loaded(page, f"mesh.flank_angle={math.radians(angle):.9f}", "mesh.flank_clearance=0.0", loads=[0])[0]
        forces.append(sum(abs(force) for force in row["teeth"]["mesh_force"]))
        gaps.append(1e6 * tilted_gap(row["teeth"], height))

    from_forces = crossing(angles, [1.0 - force for force in forces])
    from_gap = crossing(angles, gaps)
    page.text(f"""
Below {from_forces:.1f}° the entering teeth press on their flanks without any load; tilted with the rim, their tips
already overlap below {from_gap:.1f}°. By the closed form it is the chord of the path, {chord(path):.1f}°. The thesis'
16° and 17° are finite elements of whole gears, whose teeth also lean along their width (coning). The order is the
same, and the shipped angle is free.
""")
    page.check("teeth.interference_angle", "flank angle at which the tips of straight flanks cease to interfere",
               "thesis 3.2.2 [51], 4 [83]",
               Within(16.0, absolute=1.0), from_gap, "°",
               "one paper, which has 16° in one place and 17° in another",
               known="the model has plane teeth. The teeth of a real gear also lean along their width",
               evidence=MEASUREMENT)
    page.check("teeth.interference_free", "flank forces at no load and no clearance, 16°",
               "thesis 4 [83]: free from 16°", AtMost(0.0),
               forces[angles.index(16)], "N", "no contact is no force", evidence=SELF_CONSISTENT)
    page.check("teeth.interference_below", "the same at 12°", "interference below 16°", AtLeast(100.0),
               forces[angles.index(12)], "N",
               "a force that would be felt: ten teeth's share of the preload", evidence=SELF_CONSISTENT)


def crossing(angles, values):
    """Where the values rise through zero, by straight lines."""
    for i in range(len(angles) - 1):
        if values[i] < 0.0 <= values[i + 1]:
            return angles[i] + (angles[i + 1] - angles[i]) * values[i] / (values[i] - values[i + 1])
    return math.nan
