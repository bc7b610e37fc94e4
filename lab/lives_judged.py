# SPDX-License-Identifier: BSD-3-Clause
"""Makes lives with signals, forecasts them at every check-up from the recordings, and scores that beside plain
lines."""
import json
import pathlib
import subprocess
import sys

import h5py
import numpy
import pandas

ALPHA = 0.3       # accuracy of the alpha-lambda plot
LEVELS = ("q10", "q50", "q90")
CURVE = 3         # degree of the wear by stiffness that the line is taught
LIMIT = 20e-6     # of the flanks [m]
LOST_MOTION = 5e-4  # end by what can be measured [rad]
FORECASTS = {"line": "straight line through K1", "play": "straight line through lost motion",
             "last": "`remaining`, last check-up", "all": "`remaining`, all check-ups"}
LEARNED = {"seed": 11, "drives": 5, "duties": ["rated.csv"]}
JUDGED = {"seed": 707, "drives": 10, "duties": ["rated.csv", "two_ways.csv"]}
TWO_WAYS = "duration,motor_speed,load_torque,temperature\n3,150,90,45\n5,120,-45,40\n2,0,0,30\n"
PLAN = """name: lives
seed: {seed}
duration: 20.0
overlays: [real_sensors.yaml]
set:
  solver.scene: auto
  indicators.window_turns: 20.0
  life.bearing_l10: 7.0e+4       # so that wear ends them
  life.bearing_l50: 3.5e+5
  life.flank_wear_coefficient: 1.5e-18
  life.interface_wear_coefficient: 3.0e-18
  manufacture.wave_generator_ellipticity: {{normal: [0.0, 2.0e-6, -6.0e-6, 6.0e-6]}}
  bearing.viscosity: {{log_uniform: [1.2e-4, 2.0e-4]}}
  sensors.output_eccentricity: {{log_uniform: [2.0e-4, 8.0e-4]}}
lives:
  drives: {drives}
  every: 1500.0
  longest: 15000.0
  duties: {duties}
duty:
  - name: check_up
    speed: {{trapezoid: {{peak: 1.0, slope: 4.0, hold: 3.2, pause: 0.1}}}}
    load: {{sinus: {{mean: 0.0, amplitude: 34.0, frequency: 0.4, phase: 0.0}}}}
    temperature: {{constant: {{uniform: [21.0, 29.0]}}}}
record:
  indicators: true
  groups:
    signals: {{rate: 125.0, type: float64, columns: [motor_angle_encoder, output_angle_encoder, motor_torque_reading,
                                                    load_torque, housing_temperature]}}
"""
NUMBERS = ("torsional_stiffness", "second_stiffness", "lost_motion")


def tool(options, *arguments):
    done = subprocess.run([options.tool, *map(str, arguments)], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"lives: {' '.join(map(str, arguments))} failed:\n{done.stderr}")
    return done.stdout


def read(folder):
    """A row for each check-up: truth, path, mean of each number over its windows."""
    index = pandas.read_csv(folder / "index.csv").drop(columns="duty")
    index = index.rename(columns=lambda name: name.replace("life.", ""))
    for row in index.index:
        path = folder / index.loc[row, "file"]
        with h5py.File(path, "r") as file:
            for name in NUMBERS:
                index.loc[row, name] = numpy.nanmean(file["indicators"][name])
        index.loc[row, "path"] = str(path)
    return index.sort_values(["drive", "hours"])


def taught(rows, number):
    """Worse flank [m] by the change of a number since new: a curve through the drives that it is taught by."""
    change, wear = [], []
    for _, life in rows[rows.cause == "flank wear"].groupby("drive"):
        change += list(life[number] / life[number].iloc[0] - 1.0)
        wear += list(life.flank_wear)
    return numpy.poly1d(numpy.polyfit(change, wear, CURVE))


def line(life, curve, number, limit):
    """Remaining hours [h] at each check-up but the first: wear by the curve, evenly over the hours."""
    wear = numpy.maximum(curve(life[number].to_numpy() / life[number].iloc[0] - 1.0), 1e-3 * limit)
    hours = life.hours.to_numpy()
    return numpy.maximum(hours * (limit / wear - 1.0), 0.0)[1:]


def crps(document, truth):
    """Of the density that `remaining --json` prints, even within each bin [h]."""
    edges, shares = (numpy.array(document["density"][key]) for key in ("hours", "probability"))
    reached = numpy.concatenate(([0.0], numpy.cumsum(shares[:-1])))
    grid = numpy.unique(numpy.concatenate((edges, [min(truth, edges[-1])])))
    below = numpy.interp(grid, edges, reached)
    low, high = below[:-1], below[1:]
    step = (grid[:-1] >= truth).astype(float)
    parts = numpy.diff(grid) * ((low - step) ** 2 + (low - step) * (high - step) + (high - step) ** 2) / 3.0
    return parts.sum() + max(truth - edges[-1], 0.0)


def lost_motion_end(life):
    """Hours at which a life's lost motion comes to LOST_MOTION; none: it does not."""
    over = numpy.flatnonzero(life.lost_motion.to_numpy() >= LOST_MOTION)
    if not len(over) or over[0] == 0:
        return None
    pair = life.iloc[over[0] - 1:over[0] + 1]
    return numpy.interp(LOST_MOTION, pair.lost_motion, pair.hours)


def remaining(options, baseline, duty, recordings, hours, *more):
    return json.loads(tool(options, "remaining", *recordings, "--hours", ",".join(f"{value:g}" for value in hours),
                           "--duty", duty, "--baseline", baseline, "--json", *more))


def forecasts_of(options, life, duties, curves):
    """Rows for the check-ups of one life, of its end by wear and of that by lost motion."""
    baseline = options.work / f"reference_{life.drive.iloc[0]}.yaml"
    # A check-up has six windows of each kind, a reference takes eight; means alone are made use of here.
    tool(options, "indicators", *[life.path.iloc[0]] * 2, "--save-baseline", baseline, "--force")
    lines = {name: line(life, curve, number, LIMIT) for name, (number, curve) in curves.items()}
    by_play = lost_motion_end(life)
    new = life.lost_motion.iloc[0]
    rows = []
    for i in range(1, len(life)):
        now, seen = life.iloc[i], life.iloc[1:i + 1]
        duty = duties[pathlib.Path(now.duty).name]
        row = {"drive": now.drive, "cause": now.cause, "hours": now.hours, "truth": now.remaining}
        for name, used in (("last", seen.iloc[-1:]), ("all", seen)):
            found = remaining(options, baseline, duty, used.path, used.hours)
            row.update({f"{name}_{level}": found["remaining_" + level] for level in LEVELS})
            row[f"{name}_crps"] = crps(found, now.remaining)
        row.update({f"{name}_q50": values[i - 1] for name, values in lines.items()})
        if now.cause != "still in use":
            rows.append(row)
        if by_play is not None and now.hours < by_play:
            truth = by_play - now.hours
            found = remaining(options, baseline, duty, seen.path, seen.hours, "--lost-motion-limit", LOST_MOTION)
            grown = max(now.lost_motion - new, 1e-3 * LOST_MOTION)
            rows.append({"drive": now.drive, "cause": "lost motion", "hours": now.hours, "truth": truth,
                         "play_q50": now.hours * max((LOST_MOTION - new) / grown - 1.0, 0.0),
                         "all_crps": crps(found, truth),
                         **{f"all_{level}": found["remaining_" + level] for level in LEVELS}})
    return rows


def held(rows, name):
    return (rows.truth >= rows[name + "_q10"]) & (rows.truth <= rows[name + "_q90"])


def good(rows, name):
    return (rows[name + "_q50"] - rows.truth).abs() <= ALPHA * rows.truth


def gone(rows):
    """Share of the life [-]."""
    return rows.hours / (rows.hours + rows.truth)


def horizon(lives, accurate, share):
    """Share of a life that is left when the median comes within ALPHA of the truth for good: median of all [-].

    Arrays with a row for each forecast, in order of time: number of its life, whether the median is within ALPHA, share
    of the life that is gone [-]."""
    shares = []
    for life in numpy.unique(lives):
        good_rows, gone_rows = accurate[lives == life], share[lives == life]
        bad = numpy.flatnonzero(~good_rows)
        first = bad[-1] + 1 if len(bad) else 0
        shares.append(1.0 - gone_rows[first] if first < len(gone_rows) else 0.0)
    return numpy.median(shares)


def tables(rows):
    parts = [f"{number} half of the life [%]" for number in ("first", "second")]
    columns = ["end of the lives", "lives", "check-ups", "forecast", "error of the median forecast, median [h]",
               "error of the median forecast, mean [h]", "mean CRPS [h]",
               *(f"median within 30 % of the truth, {part}" for part in parts), "horizon [-]",
               *(f"truth in the 80 % interval, {part}" for part in parts)]
    lines = ["| " + " | ".join(columns) + " |", "|---" * len(columns) + "|"]

    def halves(of, cause):
        parts = [of[gone(cause) < 0.5], of[gone(cause) >= 0.5]]
        return " | ".join(f"{100.0 * part.mean():.0f}" if len(part) else "-" for part in parts)

    for end, cause in rows.groupby("cause"):
        for name, words in FORECASTS.items():
            if name + "_q50" not in cause or cause[name + "_q50"].isna().any():
                continue
            error = (cause[name + "_q50"] - cause.truth).abs()
            score = cause[name + "_crps"].mean() if name + "_crps" in cause else error.mean()
            cover = halves(held(cause, name), cause) if name + "_q10" in cause else " | "
            left = horizon(cause.drive.to_numpy(), good(cause, name).to_numpy(), gone(cause).to_numpy())
            lines.append(f"| {end} | {cause.drive.nunique()} | {len(cause)} | {words} "
                         f"| {error.median():.0f} | {error.mean():.0f} | {score:.0f} "
                         f"| {halves(good(cause, name), cause)} | {left:.2f} | {cover} |")
    return lines


def lives(options, name, settings):
    """Makes the lives of a plan, or takes those that stand there."""
    folder = options.work / name
    duties = [options.duties / duty if (options.duties / duty).exists() else options.work / duty
              for duty in settings["duties"]]
    plan = options.work / f"{name}.yaml"
    plan.write_text(PLAN.format(seed=settings["seed"], drives=settings["drives"],
                                duties="[" + ", ".join(map(str, duties)) + "]"), encoding="utf-8")
    tool(options, "lives", plan, "--out", folder, "--jobs", "1")
    return read(folder), {duty.name: duty for duty in duties}


def judged(options):
    """Rows of the lives that are judged, the lines taught by others."""
    (options.work / "two_ways.csv").write_text(TWO_WAYS, encoding="utf-8")
    learned, _ = lives(options, "learned", LEARNED)
    curves = {name: (number, taught(learned, number)) for name, number in
              (("line", "torsional_stiffness"), ("play", "lost_motion"))}
    rows, duties = lives(options, "judged", JUDGED)
    found = []
    for drive, life in rows.groupby("drive"):
        print(f"life: forecasts of drive {drive}", file=sys.stderr)
        found += forecasts_of(options, life, duties, curves)
    return pandas.DataFrame(found)
