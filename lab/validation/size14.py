# SPDX-License-Identifier: BSD-3-Clause
"""Another size of the same gear, HFUS-14-2SH, as a parameter file and nothing else."""
from bounds import Within
from evidence import SELF_CONSISTENT, fitted
from catalogue import ARCMIN, AT_20_DEGREES, RPM_2000, catalogue_angle, losses

SIZE_14 = ("--config", "size_14.yaml")
STIFFNESSES, BREAKPOINTS = (4.7e3, 6.1e3, 7.1e3), (2.0, 6.9)  # whole gear, N.m/rad and N.m
TORQUES = (2.0, 6.9, 10.0, 20.0, 28.0)
RATED_TORQUE, EFFICIENCY_TORQUE = 7.8, 10.0  # N.m
NO_LOAD, STARTING, EFFICIENCY = 0.035, 0.021, 0.67


def build(page):
    page.text("""
The gear of the UR5's wrists, `config/size_14.yaml`: lengths and stiffnesses of size 25 scaled by 14/25, the cup
fitted to this size's torsion, the grease and the race's preload to its friction (the maker fills it with another
grease). Efficiency, hysteresis and lost motion are not fitted.
""")
    insertion = page.tool("insert", *SIZE_14)
    large = page.tool("insert")
    page.check("size14.insertion", "force of the wave generator on the rim, over that of size 25",
               "similarity: the square of 14/25",
               Within((14.0 / 25.0) ** 2, relative=0.01),
               insertion["wave_generator_force_sum"] / large["wave_generator_force_sum"], "",
               "values in the file are rounded", evidence=SELF_CONSISTENT)
    rows = page.tool("stiffness", "--torques", ",".join(map(str, TORQUES)), *SIZE_14)["rows"]
    for row in rows:
        torque = row["torque"]
        page.check(f"size14.torsion.{torque:g}", f"torsion at {torque:g} N·m",
                   "catalogue: 4.7/6.1/7.1e3 N·m/rad, 2/6.9 N·m",
                   Within(catalogue_angle(torque, STIFFNESSES, BREAKPOINTS) / ARCMIN, relative=0.02),
                   -row["output_angle"] / ARCMIN, "arcmin", "as for size 25",
                   evidence=fitted("cup.torsion_* to the catalogue's slopes"))
    loop = page.tool("hysteresis", "--amplitude", RATED_TORQUE, "--lost-motion-torque", 0.04 * RATED_TORQUE, *SIZE_14)
    for key, name in (("hysteresis", "hysteresis"), ("lost_motion", "lost motion at ± 4 % of the rated torque")):
        page.value(f"size14.{key}", loop[key] / ARCMIN, "arcmin")
    running = losses(page, [RPM_2000], [0.0, EFFICIENCY_TORQUE], *AT_20_DEGREES, *SIZE_14)
    starts = page.tool("breakaway", *AT_20_DEGREES, *SIZE_14)
    page.check("size14.no_load", "no-load running torque, 2000 rpm, 20 °C", "catalogue (RT1-H-CS-14)",
               Within(1e3 * NO_LOAD, relative=0.10), 1e3 * running[0]["gear_loss"], "mN·m", "as for size 25",
               evidence=fitted("bearing.race_preload and viscosity of size 14 to starting and running torque and "
                               "efficiency"))
    page.check("size14.starting", "starting torque, 20 °C", "same", Within(1e3 * STARTING, relative=0.10),
               1e3 * starts["starting_torque"], "mN·m", "as for size 25",
               evidence=fitted("bearing.race_preload and viscosity of size 14 to starting and running torque and "
                               "efficiency"))
    page.check("size14.efficiency", f"efficiency at {EFFICIENCY_TORQUE:g} N·m, 2000 rpm, 20 °C", "same",
               Within(EFFICIENCY, absolute=0.03), running[1]["gear_efficiency"], "", "the catalogue's own tolerance",
               evidence=fitted("bearing.race_preload and viscosity of size 14 to starting and running torque and "
                               "efficiency"))
