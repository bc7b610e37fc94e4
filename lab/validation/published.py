# SPDX-License-Identifier: BSD-3-Clause
"""Shape and perimeter of the rim beside published finite elements of other gears."""
import numpy as np

from bounds import Between, Within
from evidence import MEASUREMENT

LOADS = (0.0, 67.0, 150.0)  # N.m
# Thesis 4.1, [37]: how far the rim goes out at the major axis over how far it goes in at the minor one.
DEFORMATION = 1.3
# Thesis 4.1, [88]: growth of the rim's perimeter [%], without load and under 800 N.m of a larger gear.
STRETCH_FREE, STRETCH_LOADED = 0.0084, 0.0143


def rings(page):
    """Tooth points [m] by load, as complex numbers; the wave generator's angle; the perimeter before insertion [m]."""
    result = page.tool("stiffness", "--teeth", "--torques", ",".join(f"{load:g}" for load in LOADS))
    gear = page.tool("parameters")["gear"]
    teeth = gear["teeth_flexspline"]
    perimeter = 2.0 * teeth * gear["flexspline_inner_radius"] * np.sin(np.pi / teeth)
    points = {row["torque"]: np.array(row["teeth"]["tooth_x"]) + 1j * np.array(row["teeth"]["tooth_y"])
              for row in result["rows"]}
    return points, gear["flexspline_inner_radius"], perimeter


def build(page):
    page.text("""
Finite elements of other gears, as the thesis quotes them. They tell the order of a quantity, not its value here.
""")
    points, radius, perimeter = rings(page)
    free = np.abs(points[0.0])
    page.check("published.deformation",
               "outward displacement of the rim at the major axis over its inward displacement at the minor axis; "
               "no load",
               "finite elements, thesis 4.1 [37]", Within(DEFORMATION, absolute=0.1),
               (free.max() - radius) / (radius - free.min()), "",
               "the wave generator's semi-axes are r0 + w and r0 - w here and the rim sits on it all around; "
               "measured on the real part: 31.00 and 30.33 mm, 1.09",
               known="the twin's rim follows an ellipse whose semi-axes change by equal amounts", evidence=MEASUREMENT)
    stretch = {load: 100.0 * (np.abs(np.diff(ring, append=ring[:1])).sum() / perimeter - 1.0)
               for load, ring in points.items()}
    page.check("published.stretch_free", "growth of the rim's perimeter, no load", "finite elements, thesis 4.1 [88]",
               Between(*(round(STRETCH_FREE * 10.0 ** half, 5) for half in (-0.5, 0.5))), stretch[0.0], "%",
               "another gear: the order only, half a decade to either side", evidence=MEASUREMENT)
    page.check("published.stretch_loaded", "growth of the rim's perimeter at 150 N·m over its growth without load",
               "finite elements, thesis 4.1 [88]: 0.0143 over 0.0084 %",
               Within(STRETCH_LOADED / STRETCH_FREE, absolute=0.5),
               stretch[150.0] / stretch[0.0], "",
               f"{stretch[0.0]:.4f}, {stretch[67.0]:.4f}, {stretch[150.0]:.4f} % at 0, 67 and 150 N·m: the cup carries "
               "the load evenly here, so the rim alone takes the teeth's from the lobes",
               known="the cup of the twin carries the load evenly along the rim. A real cup carries more load at the "
               "lobes",
               evidence=MEASUREMENT)
