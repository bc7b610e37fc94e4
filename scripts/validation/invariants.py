# SPDX-License-Identifier: BSD-3-Clause
"""What must hold whatever the parameters: books that close, symmetries, frames, limits, potentials, same bytes."""
import math
import random
import statistics

from bounds import AtLeast, AtMost, Within
from page import BLUE, GREEN, GREY, ORANGE, PURPLE, RED

GOLDEN = ("--config", "golden.yaml")
HALF_ULP = 2.0**-53  # relative rounding of a number
LOADS = [0.0, 20.0, 67.0, 150.0, -150.0]  # N.m
RATES = [10000, 20000, 50000, 100000]  # Hz
# Largest motor torque and load of a random motion [N.m].
MOTIONS = {"gentle": (0.4, 15), "brisk": (1.0, 60), "violent": (2.87, 150)}
SEEDS = [1, 2, 5]


def build(page):
    parameters = page.tool("parameters")
    page.text("These rows need no measured drive: they follow from the equations alone, for any parameters. Where "
              "equality is exact, the "
              "tolerance is the rounding of double precision times the condition of the problem, worked out from the "
              "parameters, "
              "not chosen after the result.")
    energy(page, parameters)
    ratio(page, parameters)
    states(page, parameters)
    frame(page, parameters)
    small_wave(page)
    same_bytes(page)


# --- Energy
# ---------------------------------------------------------------------------------------------------------------


def energy(page, parameters):
    page.heading("Energy ledger")
    page.text("Random motions of half a second: another motor torque every 10 to 50 ms, sometimes another load or the "
              "brake. The residual (energy supplied minus energy stored, dissipated and delivered) is computed at "
              "every step; its largest value is compared with the sum of all work done.")
    motions = {"gentle": MOTIONS["gentle"]} if page.fast else MOTIONS
    rates = RATES[:2] if page.fast else RATES
    runs = {(name, seed): ledger(page, *motions[name], seed, rates) for name in motions
            for seed in (SEEDS[:1] if page.fast else SEEDS)}
    page.table(["motion", "seed", "motor torque, load up to [N·m]", "top motor speed [rad/s]", "reversals",
                "through [J]"]
               + [f"left at {rate // 1000} kHz [-]" for rate in rates],
               [[name, seed, f"{motions[name][0]:g}, {motions[name][1]:g}", f"{rows[-1]['top_speed']:.0f}",
                 rows[-1]["reversals"], f"{rows[-1]['throughput']:.1f}"]
                + [f"{row['relative_residual']:.1e}" for row in rows]
                for (name, seed), rows in runs.items()])
    for name in motions:
        ends = [rows[-1] for (motion, _), rows in runs.items() if motion == name]
        page.value(f"invariants.energy_{name}_10kHz",
                   max(rows[0]["relative_residual"] for (motion, _), rows in runs.items() if motion == name), "")
        worst = max(ends, key=lambda row: row["relative_residual"] - kinks(row, parameters))
        page.check(f"invariants.energy_{name}", f"energy left over, {name} motion, {rates[-1] // 1000} kHz, worst seed",
                   "conservation of energy", AtMost(kinks(worst, parameters)), worst["relative_residual"], "",
                   "four touches of a flank a tooth pitch, each kinks the torque by at most k cos²β (w0² + (2 w0 tan "
                   "β)²) and costs an eighth "
                   "of that times (travel in a step)²; signs at random, all at top speed. It counts straight flanks "
                   "alone: a double arc meets more teeth, at up to 24°, and the sliders of the cup kink too",
                   known="the bound counts straight flanks alone; double arcs and the sliders of the cup kink too"
                   if name == "violent" else "")
    if page.fast:
        return
    orders = [slope(rates, [row["relative_residual"] for row in rows]) for rows in runs.values()]
    page.check("invariants.energy_order", f"power of the step it falls with, mean of {len(orders)} motions",
               "quadrature of a force with kinks", Within(2.0, absolute=0.25), -statistics.mean(orders), "",
               "a tooth that touches inside a step leaves an error of step² and random sign: single motions scatter by "
               f"{statistics.stdev(orders):.2f}, their mean by {statistics.stdev(orders) / math.sqrt(len(orders)):.2f}")
    page.text("It vanishes with the square of the step, so the residual at 10 kHz is the quadrature error of the tooth "
              "forces and no leak. The "
              "order holds down to one or two steps a tooth pitch.")

    def draw(figure):
        axes = figure.subplots()
        for (name, seed), rows in runs.items():
            colour = dict(zip(MOTIONS, (GREEN, BLUE, RED)))[name]
            axes.loglog(rates, [row["relative_residual"] for row in rows], "o-", color=colour, markersize=3.5,
                        label=f"{name}, up to {motions[name][0]:g} and {motions[name][1]:g} N·m" if seed == SEEDS[0]
                        else None)
        guide = [3e-4 * (rates[0] / rate)**2 for rate in rates]
        axes.loglog(rates, guide, "--", color=GREY, label="step²")
        axes.set_xticks(rates)
        axes.set_xticklabels([f"{rate // 1000}" for rate in rates])
        axes.minorticks_off()
        axes.set_xlabel("step rate [kHz]")
        axes.set_ylabel("energy left over / through [-]")
        axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))

    page.figure("invariants_energy",
                "Largest energy residual of random motions with reversals, load and brake, against the step rate; "
                "three "
                "seeds each.", draw)


def kinks(row, parameters):
    """A priori size of what the kinks of the tooth forces leave over at this step, relative to the energy gone through
    [-]."""
    gear, mesh = parameters["gear"], parameters["mesh"]
    # of flanks per motor angle, squared
    approach = gear["wave_amplitude"]**2 * (1.0 + (2.0 * math.tan(mesh["flank_angle"]))**2)
    stiffness = mesh["stiffness"] * math.cos(mesh["flank_angle"])**2 * approach
    touches = 4.0 * row["travel"] * gear["teeth_flexspline"] / (2.0 * math.pi)
    return math.sqrt(touches) * stiffness * (row["top_speed"] / row["rate"])**2 / 8.0 / row["throughput"]


def ledger(page, torque, load, seed, rates):
    return page.tool("invariants", "energy", "--rates", ",".join(map(str, rates)), "--duration", 0.5, "--seed", seed,
                     "--load", load, "--set", f"motor.torque_limit={torque:.2f}")["rows"]


# --- Ratio
# ----------------------------------------------------------------------------------------------------------------


def ratio(page, parameters):
    page.heading("Ratio")
    page.text("One turn of the wave generator at constant load, friction left out, in 1009 steps: a prime, so that the "
              "mean over the turn "
              "sees the tooth pitch in 1009 different phases.")
    spaces = parameters["gear"]["teeth_circular_spline"]
    nominal = spaces / (spaces - parameters["gear"]["teeth_flexspline"])
    turns = {load: page.tool("turn", "--load", load, "--angle-range", repr(2.0 * math.pi), "--steps", 1009)["rows"]
             for load in (0.0, 20.0, 150.0)}
    drift = max((rows[-1]["output_angle"] - rows[0]["output_angle"] - 2.0 * math.pi / nominal
                 for rows in turns.values()), key=abs)
    page.check("invariants.ratio_drift",
               f"output's advance per motor turn, less 2π/{nominal:.0f}, worst of 0, 20, 150 N·m", "tooth numbers",
               Within(0.0, absolute=1e-12), drift, "rad",
               "loads are balanced to 1e-8 N·m, over some 3e4 N·m/rad, at either end")
    for load in (20.0, 150.0):
        mean = statistics.fmean(row["wave_generator_torque"] for row in turns[load][:-1])
        page.check(f"invariants.mean_torque_{load:.0f}",
                   f"mean wave generator torque over the turn × {nominal:.0f} / load, less −1; {load:.0f} N·m",
                   "virtual work", Within(0.0, absolute=1e-7), mean * nominal / load + 1.0, "",
                   "the mean of a periodic function from 1009 samples; 1e-8 N·m of load left unbalanced, and rounding")


# --- States at rest
# ---------------------------------------------------------------------------------------------------------


def states(page, parameters):
    steps = [10.0**(-k / 4.0) for k in range(8, 25)]
    document = page.tool("invariants", "state", "--loads", ",".join(map(repr, LOADS)), "--angle", 0.3, "--pitches", 7,
                         "--steps",
                         ",".join(f"{step:.6e}" for step in steps))
    rows = document["states"]
    radius = parameters["gear"]["flexspline_inner_radius"]
    teeth = parameters["gear"]["teeth_flexspline"]
    # Of a force on a tooth: two neighbours' stretch, each from four coordinates rounded to half an ulp.
    rounding = 8.0 * HALF_ULP * radius * parameters["ring"]["tension_stiffness"]
    condition = max(2.0 * math.sqrt(2.0 * teeth) * (row["residual"] + rounding) / row["softest_stiffness"]
                    for row in rows)
    stiffness = max(parameters["contact"]["stiffness"], parameters["mesh"]["stiffness"])

    page.heading("Symmetry and shift")
    page.text(f"The ring in equilibrium, wave generator at 0.3 rad, loads of "
              f"{', '.join(f'{load:g}' for load in LOADS)} N·m; rows give the "
              "worst load. Two states that should be equal may differ by the residual forces, "
              f"{max(row['residual'] for row in rows):.0e} N, and their rounding, {rounding:.0e} N, on all teeth, over "
              f"the softest "
              f"eigenvalue of the ring's tangent, {min(row['softest_stiffness'] for row in rows):.1e} N/m; forces by "
              f"that times the "
              "contact's stiffness. The shifted state is found by an insertion of its own from the round ring, not "
              "from the first.")

    def worst(*keys):
        return max(abs(row[key]) for row in rows for key in keys)

    position_reason = "forces left and rounded on all teeth, over the softest stiffness"
    force_reason = "the same times the contact's stiffness"
    for name, key, what in (("symmetry", "half_turn", f"tooth i + {teeth // 2} against tooth i turned by 180°"),
                            ("shift", "pitch_shift",
                             "seven tooth pitches on (both wheels), against the first state renumbered")):
        page.check(f"invariants.{name}_position", f"{what}: positions", "equal teeth", Within(0.0, absolute=condition),
                   worst(key + "_position"), "m", position_reason)
        page.check(f"invariants.{name}_force", f"{what}: forces of wave generator and flanks", "equal teeth",
                   Within(0.0, absolute=condition * stiffness), worst(key + "_contact_force", key + "_flank_force"),
                   "N", force_reason)
    page.check("invariants.shift_energy", "the same: stored energy, relative", "equal teeth",
               Within(0.0, absolute=1e-10),
               worst("pitch_shift_energy"), "",
               "a segment's stretch, 30 nm, is known to the rounding of its ends, 3e-18 m")

    page.heading("Balance, potential, reciprocity")
    moment = teeth * radius * math.sqrt(2.0) * (max(row["residual"] for row in rows) + rounding)
    page.check("invariants.moment_balance", "torque on wave generator + output + housing, the last through the cup",
               "statics of the whole",
               Within(0.0, absolute=moment),
               max((row["wave_generator_torque"] + row["output_torque"] + row["cup_torque"] for row in rows), key=abs),
               "N·m",
               "forces left and rounded on all teeth, times the radius")
    potential(page, parameters, document, rows)


def potential(page, parameters, document, rows):
    by_load = {load: [row for row in document["potential"] if row["load"] == load] for load in LOADS}
    gear = parameters["gear"]
    terms = 2.0 * gear["teeth_flexspline"]
    energy = max(row["energy"] for row in rows)
    page.text("Each derivative is a central difference between separately solved equilibria. Where a tooth changes "
              "contact inside the step, the step is too long; rows use, for each load, the best step (figure), and "
              "give the worst load.")
    for key, symbol, step in (("wave_generator", "θ", 1e-5), ("output", "φ", 1e-7)):
        page.check(f"invariants.torque_of_{key}", f"torque on the {key.replace('_', ' ')} + dU/d{symbol}", "potential",
                   Within(0.0, absolute=terms * HALF_ULP * energy / step),
                   best_step(by_load, lambda row, k=key: row[k + "_difference"]),
                   "N·m", f"stored energy of up to {energy:.2g} J, {terms:.0f} terms rounded, over {step:.0e} rad")
    # unloaded, a gear with backlash has no stiffness
    loaded = {load: series for load, series in by_load.items() if load}
    coupled = min(abs(row["wave_generator_by_output"]) for series in loaded.values() for row in series)
    noise = max(row["residual"]
                for row in rows) * math.sqrt(0.5 * terms) * 2.0 * gear["wave_amplitude"] / 1e-6 / coupled
    page.check("invariants.reciprocity", "∂T(wave generator)/∂φ against ∂T(output)/∂θ, relative",
               "symmetry of the condensed stiffness",
               Within(0.0, absolute=noise),
               best_step(loaded, lambda row: row["wave_generator_by_output"] / row["output_by_wave_generator"] - 1.0),
               "",
               "forces left on the teeth, their lever of 2 w0, over 1 µrad of the output")
    page.check("invariants.condensed_stiffness", "the same against the stiffness from the ring's tangent, relative",
               "implicit derivative",
               Within(0.0, absolute=1e-3),
               best_step(loaded, lambda row: row["wave_generator_by_output"] / row["condensed_stiffness"] + 1.0), "",
               "Newton may keep factors of a shape a little way back")

    def draw(figure):
        left, right = figure.subplots(1, 2)
        for load, colour in zip(LOADS, (GREY, GREEN, BLUE, RED, PURPLE)):
            series = by_load[load]
            for axes, key in ((left, "wave_generator"), (right, "output")):
                axes.loglog([row[key + "_step"] for row in series], [abs(row[key + "_difference"]) for row in series],
                            "-", color=colour,
                            label=f"{load:g} N·m")
        for axes, name in ((left, "θ, wave generator"), (right, "φ, output")):
            axes.set_title(f"by {name}")
            axes.set_xlabel("step to either side [rad]")
        left.set_ylabel("|torque + dU/dangle| [N·m]")
        right.legend(title="load", loc="upper left", bbox_to_anchor=(1.0, 1.0))

    page.figure("invariants_potential",
                "Torque against the central difference of the stored energy of neighbouring equilibria. From the "
                "right: "
                "teeth change contact inside the step; the difference's own error, step²; rounding of the energy over "
                "the step.",
                draw)


def best_step(by_load, error):
    """The error at each load's best step, of the worst load."""
    return max((min(map(error, series), key=abs) for series in by_load.values()), key=abs)


# --- Frame
# ----------------------------------------------------------------------------------------------------------------


def frame(page, parameters):
    page.heading("Frame indifference")
    document = page.tool("invariants", "frame", "--load", 67, "--samples", 201)
    elements = {element["name"]: element for element in document["elements"]}
    page.text("The ring at 67 N·m, the whole machine turned by 201 random angles: forces, turned back, energies and "
              "torques must stay. The "
              "cup is held by the housing, which has no angle of its own here; its turn with the housing is the shift "
              "above.")
    coordinate = 16.0 * HALF_ULP * parameters["gear"]["flexspline_inner_radius"]
    teeth = parameters["gear"]["teeth_flexspline"]
    pitch = 2.0 * math.pi * parameters["gear"]["flexspline_inner_radius"] / teeth
    stiffness = {"rim_tension": parameters["ring"]["tension_stiffness"],
                 "rim_bending_curvature": 16.0 * parameters["ring"]["bending_stiffness"] / pitch**2,
                 "wave_generator_contact": parameters["contact"]["stiffness"],
                 "tooth_mesh": parameters["mesh"]["stiffness"]}
    for name, stiff in stiffness.items():
        element = elements[name]
        words = name.replace("_", " ").replace("curvature", "(law curvature)")
        page.check(f"invariants.frame_{name}",
                   f"{words}: largest change of a force (of up to {element['force_max']:.0f} N)", "frame indifference",
                   Within(0.0, absolute=coordinate * stiff), element["force_difference"], "N",
                   "coordinates rounded when turned and turned back, 16 half ulps, times the element's stiffness")
    page.check("invariants.frame_energy", "all four: largest change of energy, over the energy", "frame indifference",
               AtMost(1e-10),
               max(elements[name]["energy_difference"] / elements[name]["energy"] for name in stiffness), "",
               "depths and stretches of some 10 nm and more, known to 1e-17 m, over 200 teeth")
    rows = document["bending"]
    middle = rows[len(rows) // 2]
    bending = parameters["ring"]["bending_stiffness"] + parameters["bearing"]["race_bending_stiffness"]
    growth = 0.5 * (rows[0]["absolute_energy"] + rows[-1]["absolute_energy"]) - middle["absolute_energy"]
    page.check("invariants.frame_absolute_energy", "law absolute: energy put in by turning the machine by 0.5 rad",
               "½ N k α²",
               Within(0.5 * teeth * bending * rows[-1]["angle"]**2, relative=1e-9), growth, "J",
               "exact but for rounding: energy that is not there")
    factor = rows[-1]["absolute_force"] / middle["curvature_force"]
    page.check("invariants.frame_absolute_force",
               "law absolute: its force at 0.5 rad over the bending force there really is",
               "fails by design", AtLeast(1000.0), factor, "", "shows that the test above can fail")
    milliradian = bending * 1e-3 / pitch
    fixed = page.tool("invariants", "state", "--loads", "150.0", "--set", "ring.bending_law=absolute")["states"][0]
    lost = abs(fixed["wave_generator_torque"] + fixed["output_torque"] + fixed["cup_torque"])
    page.value("invariants.frame_absolute_lost", lost, "N·m")
    page.text(f"The thesis' absolute law (eq. 5.47–5.53) takes a turn of the whole for a deformation: "
              f"{milliradian:.0f} N on every segment for each "
              f"milliradian, where bending the rim takes {middle['curvature_force']:.0f} N at most. Under load the rim "
              f"turns with the cup; with that law "
              f"in operation, {lost:.0f} of 150 N·m on the output would have no reaction on wave generator or housing. "
              f"So it serves the insertion, where nothing turns, and operation uses the law on curvature.")

    def draw(figure):
        axes = figure.subplots()
        degrees = [math.degrees(row["angle"]) for row in rows]
        axes.semilogy(degrees, [row["absolute_force"] for row in rows], color=RED, label="absolute (thesis)")
        axes.semilogy(degrees, [row["curvature_force"] for row in rows], color=BLUE, label="curvature (default)")
        axes.set_ylim(10.0, 1e6)
        axes.set_xlabel("turn of the whole machine [°]")
        axes.set_ylabel("largest bending force\non a segment [N]")
        axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))

    page.figure("invariants_frame",
                "Bending force of the rim under 67 N·m when the whole machine is turned: the same deformation seen "
                "from "
                "another side.", draw)


# --- Small wave
# -----------------------------------------------------------------------------------------------------------


def small_wave(page):
    page.heading("Small wave against thin-ring theory")
    parameters = page.tool("parameters", *GOLDEN)
    radius = parameters["gear"]["flexspline_inner_radius"]
    amplitude = parameters["gear"]["wave_amplitude"]
    ring = parameters["ring"]
    pitch = 2.0 * math.pi / parameters["gear"]["teeth_flexspline"]
    yielding = ring["tension_stiffness"] * pitch**2 / parameters["contact"]["stiffness"]
    held = page.tool("invariants", "small-wave", "--smallest", 1e-7, "--count", 41, "--hold", *GOLDEN)["rows"]
    free = page.tool("invariants", "small-wave", "--smallest", 1e-7, "--count", 81, *GOLDEN)["rows"]
    page.text(
        f"The ring after the insertion, no circular spline, wave amplitude w from {1e3 * amplitude:g} mm down to 0.1 "
        f"µm. For a thin ring that does not "
        "stretch, to first order in w and counter-clockwise positive: radial w cos 2ψ, tangential −(w/2) sin 2ψ, tilt "
        "+(3w/2R) sin 2ψ. Three effects separate the twin from it:\n\n"
        "- **first order, the ring as it is**: chords instead of arcs, tan(p/2)/tan p for ½ with the tooth pitch p = "
        "2π/200; stretch by the "
        "hoop force of the bending moment, 3 k_F/(k R²); the contact's yielding. Constants, independent of w.\n"
        "- **second order in w**: the ellipse, −(5/8)(w²/R) sin² 2ψ along the radius and +(1/16)(w²/R) sin 4ψ across; "
        "the perimeter, longer "
        "by the strain (w/2R)², whose tension presses the ring into the contact. So the relative error to the first "
        "order must fall with w to the "
        "power 1, from the factors 5/8, 1/8 and 7/8 times w/R.\n"
        "- **lift-off**: the bending moment decreases with w, the tension that presses the rim on the wave generator "
        "with w². Below "
        "w = 36 k_F/(k R), contact's yielding included, the rim stands off at the minor axis and the closed form is "
        "not its shape any more, "
        "however small w. For the limit, bending is therefore taken in proportion to w (`--hold`): the ring touches "
        "all round.")
    keys = ("radial", "tangential", "tilt")
    expected = {"radial": 0.625 + 0.25 * yielding / (1.0 + yielding), "tangential": 0.125, "tilt": 0.875}
    amplitudes = [row["wave_amplitude"] for row in held]
    smallest = held[-1]
    for key in keys:
        errors = [row["linear"][key] for row in held]
        page.check(f"invariants.wave_power_{key}",
                   f"{key}: power of w that the error to the first order falls with, 0.1 µm … 0.35 mm",
                   "second order of the ellipse", Within(1.0, absolute=0.01), slope(amplitudes, errors), "",
                   "at the large end the third order adds w/R, 1 %")
        page.check(f"invariants.wave_factor_{key}", f"{key}: that error × R/w at 0.1 µm", "second order of the ellipse",
                   Within(expected[key], relative=0.005), smallest["linear"][key] * radius / smallest["wave_amplitude"],
                   "",
                   "worked out for arcs; 200 chords change it by some p² = 0.1 %")
    upper = [row for row in held if row["wave_amplitude"] > 0.25 * amplitude]
    for key in keys:
        page.check(f"invariants.wave_second_{key}",
                   f"{key}: power of w of the error to the second order, above {250 * amplitude:.2g} mm",
                   "third order", Within(2.0, absolute=0.1), slope([row["wave_amplitude"] for row in upper],
                                                                   [row["second_order"][key] for row in upper]), "",
                   "below, second-order terms times p² take over")
    page.check("invariants.wave_smallest", "largest of the three errors to the second order at 0.1 µm",
               "thin-ring theory",
               AtMost(5.0 * pitch**2 * smallest["wave_amplitude"] / radius),
               max(smallest["second_order"].values()), "", "second order times p², five times")
    half = math.tan(0.5 * pitch)**2
    page.check("invariants.wave_chords", "tangential error to the arcs' −(w/2) sin 2ψ at 0.1 µm",
               "200 chords: tan²(p/2)",
               Within(half, relative=0.005), smallest["thin_ring"]["tangential"], "",
               "second order in w, 4e-7, and bending, 7e-8")
    lift = 36.0 * ring["bending_stiffness"] * (1.0 + yielding) / (ring["tension_stiffness"] * radius)
    page.check("invariants.wave_lift_off", "amplitude at which the rim leaves the wave generator",
               "36 k_F (1 + k p²/k_WG) / (k R)", Within(1e3 * lift, relative=0.03), 1e3 * lift_off(page, lift), "mm",
               "next order: some ten times w/R")
    limit = free[-1]["linear"]["radial"]
    page.text(f"The gear of the thesis (`golden.yaml`), w0 = {1e3 * amplitude:g} mm, stands "
              f"{amplitude / lift:.1f} times above lift-off: "
              f"the wave generator presses every "
              f"tooth, by {free[0]['contact_force_min']:.2f} to {free[0]['contact_force_max']:.2f} N. A rim that lifts "
              f"off keeps a shape of its own, "
              f"{100.0 * limit:.2f} % of w away from the closed form.")

    def draw(figure):
        left, right = figure.subplots(1, 2)
        millimetres = [1e3 * w for w in amplitudes]
        for key, colour in zip(keys, (BLUE, ORANGE, GREEN)):
            for axes, theory, style in ((left, "thin_ring", ":"), (left, "linear", "-"), (right, "second_order", "-")):
                axes.loglog(millimetres, [row[theory][key] for row in held], style, color=colour,
                            label=key if style == "-" and axes is left else None)
        right.loglog([1e3 * row["wave_amplitude"] for row in free], [row["second_order"]["radial"] for row in free],
                     "-", color=RED,
                     label="radial, bending as it is:\nlifts off")
        right.axvline(1e3 * lift, color=GREY, linewidth=0.8, linestyle="--")
        for axes, power, at in ((left, 1, 3e-3), (right, 2, 4e-6)):
            low = 1e-6 if power == 1 else 3e-5
            guide = [w for w in amplitudes if w > low]
            axes.loglog([1e3 * w for w in guide], [at * (w / amplitudes[0])**power for w in guide], "--", color=GREY,
                        label=f"w to the power {power}")
        left.set_title("to the first order")
        right.set_title("to the second order")
        for axes in (left, right):
            axes.set_xlabel("wave amplitude w [mm]")
            axes.legend(fontsize=7)
        left.set_ylabel("largest relative error [-]")

    page.figure("invariants_small_wave",
                "Shape of the inserted ring against theory, ring held all round. Left: to first order, for arcs "
                "(dotted) and "
                "for the ring as it is (full). Right: with the second order in w; red: bending as it is, the dashed "
                "line is where "
                "it must lift off.", draw, size=(8.0, 3.6))


def lift_off(page, about):
    """The largest amplitude at which a tooth stands off, to three thousandths [m]."""
    rows = page.tool("invariants", "small-wave", "--smallest", repr(0.8 * about), "--count", 600, *GOLDEN)["rows"]
    return max((row["wave_amplitude"] for row in rows if row["contact_force_min"] <= 0.0), default=0.0)


# --- Same bytes
# -----------------------------------------------------------------------------------------------------------


def same_bytes(page):
    page.heading("Same bytes")
    chance = random.Random(5)
    with open(page.scratch("random.csv"), "w", encoding="utf-8") as file:
        file.write("time,motor_torque,load_torque,brake\n")
        for step in range(50):
            file.write(f"{0.02 * step:.2f},{chance.uniform(-1.5, 1.5):.3f},{chance.uniform(-80, 80):.1f},"
                       f"{int(chance.random() < 0.15)}\n")
    contents = []
    for name in ("first.csv", "second.csv"):
        page.run("simulate", "--profile", "random.csv", "--duration", "1", "--out", name)
        with open(page.scratch(name), "rb") as file:
            contents.append(file.read())
    different = sum(a != b for a, b in zip(*contents)) + abs(len(contents[0]) - len(contents[1]))
    page.check("invariants.same_bytes", f"bytes that differ between two runs of a random second, of {len(contents[0])}",
               "same inputs",
               Within(0.0), different, "", "no clock, no order of threads and no address enters a number")


def slope(x, y):
    """Of the line through the logarithms, least squares."""
    log_x = [math.log(value) for value in x]
    log_y = [math.log(value) for value in y]
    mean_x, mean_y = statistics.fmean(log_x), statistics.fmean(log_y)
    return (sum((a - mean_x) * (b - mean_y) for a, b in zip(log_x, log_y)) / sum((a - mean_x)**2 for a in log_x))
