# SPDX-License-Identifier: BSD-3-Clause
"""The family: gears that joint_twin gear makes by size and ratio, beside their catalogue."""
from bounds import AtMost, Within
from evidence import fitted, measured
from catalogue import ARCMIN, AT_20_DEGREES, RPM_2000, losses
from page import BLUE, GREEN, ORANGE, PURPLE, RED

RATIOS = {14: (50, 80, 100), 17: (50, 80, 100, 120), 20: (50, 80, 100, 120, 160), 25: (50, 80, 100, 120, 160),
          32: (50, 80, 100, 120, 160)}
COLOURS = {14: BLUE, 17: ORANGE, 20: GREEN, 25: RED, 32: PURPLE}
# Schaeffler TPI 275, RT1-H-CS, ratio 100, 2000 rpm, 20 degC: torque the efficiency is given at [N.m], efficiency,
# back-driving torque [N.m].
FRICTION = {14: (10.0, 0.67, 2.21), 17: (31.0, 0.77, 3.06), 20: (52.0, 0.77, 3.89)}  # 25: see *Catalogue*
EFFICIENCY_RATIO = 100


def build(page):
    page.text("""
`joint_twin gear --size S --ratio R` scales the shipped gear by rules of similarity and fits the cup's three slopes to
the torsion of the catalogue, preload and viscosity to starting and no-load torque of ratio 100 (sizes 14 to 25; the
other ratios of a size have the same bearing, and size 32 keeps those of similarity). Nothing else is fitted:
efficiency, back-driving torque, hysteresis and the torsion between the fitted torques are judged. Size 14 is filled
with another grease: with its viscosity fitted to the no-load torque the efficiency is 0.1 point out of the
catalogue's band.
""")
    shown = []
    for size, ratios in RATIOS.items():
        for ratio in ratios:
            if page.fast and ratio != EFFICIENCY_RATIO:
                continue
            name = f"gear_{size}_{ratio}.yaml"
            figures = page.tool("gear", "--size", size, "--ratio", ratio, "--out", name, "--force")["figures"]
            by_name = {row["name"]: row for row in figures}
            twists = [row for row in figures if row["name"].startswith("torsion")]
            worst = max(abs(row["gear"] / row["catalogue"] - 1.0) for row in twists)
            rated = by_name["efficiency at the rated torque"]["gear"]
            page.check(f"family.torsion.{size}.{ratio}", f"size {size}, ratio {ratio}: largest error of the torsion",
                       "catalogue: K1 to K3", AtMost(2.0), 100.0 * worst, "%",
                       "three torques are fitted, the rated one is not; as for size 25",
                       evidence=fitted("cup.torsion_* to the catalogue's slopes, by gear design"))
            shown.append([f"{size}", f"{ratio}", f"{by_name['starting torque']['gear']:.1f}",
                          f"{by_name['no-load torque at 2000 rpm']['gear']:.1f}",
                          f"{by_name['back-driving torque']['gear']:.2f}", f"{rated:.1f}",
                          f"{by_name['teeth in mesh without load']['gear']:.0f}",
                          f"{by_name['teeth in mesh at the rated torque']['gear']:.0f}"])
    for size, (torque, wanted, back_driving) in FRICTION.items():
        overlay = ("--config", f"gear_{size}_{EFFICIENCY_RATIO}.yaml")
        row = losses(page, [RPM_2000], [torque], *AT_20_DEGREES, *overlay)[0]
        page.check(f"family.efficiency.{size}", f"size {size}: efficiency at {torque:g} N·m, 2000 rpm, 20 °C",
                   "catalogue (TPI 275)", Within(wanted, absolute=0.03), row["gear_efficiency"], "",
                   "the catalogue's own tolerance",
                   known="the viscosity of size 14's own grease is fitted to the no-load torque, not to the efficiency"
                   if size == 14 else "",
                   evidence=measured("no-load and starting torque of the same catalogue set the bearing's friction"))
        starts = page.tool("breakaway", *AT_20_DEGREES, *overlay)
        page.check(f"family.back_driving.{size}", f"size {size}: back-driving torque, 20 °C",
                   "catalogue (TPI 275)", Within(back_driving, relative=0.15), starts["back_driving_torque"], "N·m",
                   "as for size 25",
                   evidence=measured("no-load and starting torque of the same catalogue set the bearing's friction"))
        rated = 0.77 * torque  # the standard series is rated at 1/1.3 of this one
        loop = page.tool("hysteresis", "--amplitude", rated, "--lost-motion-torque", 0.04 * rated, *overlay)
        page.value(f"family.hysteresis.{size}", loop["hysteresis"] / ARCMIN, "arcmin")
    page.table(["size", "ratio", "starting [mN·m]", "no load, 2000 rpm [mN·m]", "back-driving [N·m]",
                "efficiency, rated [%]", "teeth in mesh, no load [%]", "teeth in mesh, rated [%]"], shown)
