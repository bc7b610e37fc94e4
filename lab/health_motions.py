# SPDX-License-Identifier: BSD-3-Clause
"""Judges drives in motions that no signature was made in, with the windows of the drive and with what a recording of
the joint's states has: no temperature, no load."""
import collections
import functools
import math

import numpy
import scipy.stats
import sklearn.covariance

from health_runs import (COMPARED, FURTHER_MODEL, MODEL, OTHER_FLANKS, OTHER_MODEL, Motion, Trial, as_measured, drawn,
                         once)

WINDOW = 20.0                   # [s]
SLOPE = 300.0                   # of a trapezoid [deg/s^2]
REFERENCE, SOUND = 24, 10       # windows of each gear and motion, each on a path of its own
TEMPERATURE = "{uniform: [20.5, 29.5]}"  # within one class [degC]
SEVERITIES = (0.3, 0.6)
# Those that a whole member has, less worn teeth and ratcheting, which nothing is like and whose tables take long.
KINDS = ("interface_wear", "rear_section_crack", "lubricant_degradation", "flange_crack", "wave_generator_wear",
         "buckling")
STATES = [option for pair in (("--config", "joints/shoulder.yaml"), ("--config", "real_sensors.yaml"),
                              ("--set", f"indicators.window_time={WINDOW}"), ("--set", "indicators.window_turns=1e5"))
          for option in pair]
CLASSES = [0.0, 0.5, 0.7, 0.85, 0.95, 1.0]  # of the confidence
# `twin`: its indicators on the same path are subtracted.
Source = collections.namedtuple("Source", "options twin", defaults=[False])
SOURCES = {"all signals": Source(["--windows"]), "twin subtracted": Source(["--windows"], True),
           "joint states alone": Source(STATES)}


def quintic(share):
    """Speed over the mean speed of a move."""
    return 30.0 * share ** 2 * (1.0 - share) ** 2


def moves(profile, targets, speed, pause, end):
    """Rows of moves to targets [deg] at a mean speed [deg/s]; `profile`: None for trapezoids."""
    time, position, rows = 0.5, 0.0, [(0.0, 0.0), (0.5, 0.0)]
    for target in targets:
        way, sign = abs(target - position), math.copysign(1.0, target - position)
        length = max(way / speed, 2.1 * math.sqrt(way / SLOPE), 0.4)
        if time + length > end:
            return rows
        if profile:
            rows += [(time + length * share, math.radians(sign * way / length * float(profile(share))))
                     for share in numpy.linspace(0.02, 1.0, 50)]
        else:
            root = math.sqrt((SLOPE * length) ** 2 - 4.0 * SLOPE * way)
            peak = 0.5 * (SLOPE * length - root)
            rise = peak / SLOPE
            top = math.radians(sign * peak)
            rows += [(time + rise, top), (time + length - rise, top), (time + length, 0.0)]
        time += length + pause
        rows.append((time, 0.0))
        position = target
    return rows


def three_places(profile, draw, end):
    places = numpy.array([-50.0, 35.0, -20.0]) + draw.uniform(-3.0, 3.0, 3)
    return moves(profile, numpy.tile(places, 40), 55.0, draw.uniform(0.2, 0.4), end)


def random_points(profile, draw, end):
    sides = numpy.tile([1.0, -1.0], 60)
    return moves(profile, sides * draw.uniform(10.0, 55.0, 120), 45.0, 0.01, end)


def sweep(draw, end):
    size = draw.uniform(28.0, 32.0)
    return moves(None, numpy.tile([size, -size], 60), 12.0, 0.2, end)


def sine(draw, end):
    time = numpy.arange(0.0, end, 0.02)
    size, rate = math.radians(draw.uniform(38.0, 42.0)), 2.0 * math.pi * 0.22
    begun, growth = 1.0 - numpy.exp(-0.5 * time ** 2), time * numpy.exp(-0.5 * time ** 2)
    return list(zip(time, size * (begun * rate * numpy.cos(rate * time) + growth * numpy.sin(rate * time))))


def motion_of(name, tag, path):
    return Motion(name, tag, WINDOW, False, path=path)


MOTIONS = [motion_of("slow sweep", "slow_sweep", sweep),
           motion_of("quintic, three places", "quintic_places", functools.partial(three_places, quintic)),
           motion_of("quintic, random points", "quintic_points", functools.partial(random_points, quintic)),
           motion_of("trapezoids, three places", "trapezoid_places", functools.partial(three_places, None)),
           motion_of("sine", "sine", sine)]
FITTED_GEARS = [drawn(905), drawn(930), OTHER_FLANKS]
OTHER_MODELS = [OTHER_MODEL, FURTHER_MODEL]
JUDGED_GEARS = [drawn(1007), as_measured(1011), as_measured(1012), *OTHER_MODELS]
SEEDS = {"drawn 905": 50, "drawn 930": 150, "drawn 1007": 250, OTHER_FLANKS.name: 270, OTHER_MODEL.name: 280,
         FURTHER_MODEL.name: 300, "as measured 1011": 310, "as measured 1012": 320}  # first

# `kind` "healthy" of a sound one; `plain`: scores of the plain detectors.
Judged = collections.namedtuple("Judged", "gear motion kind severity window score plain")


def trials(gears):
    """One of each gear and severity."""
    return [Trial(f"motions {severity}", gear, MOTIONS, [severity], 40, SEEDS[gear.name] + place)
            for gear in gears for place, severity in enumerate(SEVERITIES)]


def options_of(gear, source):
    options = source.options
    return options[:2] + ["--config", gear.overlay] + options[2:] if options == STATES and gear.overlay else options


def bags_of(bench, own_trials, own, twin):
    """Runs of a gear in one motion, each part with the twin's beside them: the reference, the sound ones, the faulty
    ones of each trial."""
    gear, seed = own_trials[0].gear, own_trials[0].seed

    def with_twin(bags, own_seed, repeats=1, paths=1):
        return bags, bench.beside(MODEL, bags, own, TEMPERATURE, own_seed, repeats, paths) if twin else []

    yield with_twin(bench.sound("motions_reference", gear, own, TEMPERATURE, REFERENCE, seed + 1000), seed + 1000,
                    paths=REFERENCE)
    yield with_twin(bench.sound("motions_sound", gear, own, TEMPERATURE, SOUND, seed + 2000), seed + 2000, paths=SOUND)
    for trial in own_trials:
        yield with_twin(bench.faulty(trial, own, TEMPERATURE, KINDS), trial.seed, len(KINDS))


def numbers_of(windows):
    """Indicators that all windows have, by window."""
    names = [name for name in windows[0]["indicators"]
             if all(window["indicators"][name] is not None for window in windows)]
    return numpy.array([[window["indicators"][name] for name in names] for window in windows])


def plain_scores(reference, judged):
    """(Mahalanobis distance with Ledoit and Wolf's covariance, largest deviation in spreads) of each."""
    numbers = numbers_of(reference + judged)
    own, others = numbers[:len(reference)], numbers[len(reference):]
    spread = own.std(axis=0, ddof=1)
    used = spread > 0.0
    mean = own.mean(axis=0)
    own, others = ((table - mean)[:, used] / spread[used] for table in (own, others))
    fitted = sklearn.covariance.LedoitWolf(assume_centered=True).fit(own)
    return numpy.column_stack([numpy.sqrt(fitted.mahalanobis(others)), numpy.abs(others).max(axis=1)])


def judged(bench, own_trials, own, source):
    """What was made of each window; the reference is of the same source."""
    gear = own_trials[0].gear
    (reference, models), *parts = bags_of(bench, own_trials, own, source.twin)
    options = options_of(gear, source)
    file = bench.work / f"motions_{gear.name}_{own.tag}.yaml".replace(" ", "_")
    learned = bench.indicators(reference, ["--set", "indicators.baseline_windows=10000", "--save-baseline", file,
                                           "--force"], models, options)["windows"]
    bags, models = (sum(own_parts, []) for own_parts in zip(*parts))
    windows = bench.indicators(bags, ["--baseline", file, *once(own)], models, options)["windows"]
    rows = {str(bag): row for bag, row in bags}
    for window, plain in zip(windows, plain_scores(learned, windows)):
        row = rows[window["recording"]]
        compared = window["assessment"]["state"] in COMPARED
        yield Judged(gear, own.name, row["fault_kind"] or "healthy", float(row["fault_severity"] or 0.0), window,
                     window["assessment"]["largest_score"] if compared else 0.0, plain)


def all_judged(bench, gears, source):
    return [one for gear in gears for own in MOTIONS
            for one in judged(bench, [trial for trial in trials(gears) if trial.gear == gear], own, source)]


def area(faulty, sound):
    """Under the curve: share of pairs in which the faulty one has the higher score."""
    faulty, sound = numpy.array(faulty)[:, None], numpy.array(sound)
    return float(numpy.mean((faulty > sound) + 0.5 * (faulty == sound)))


def calibration_windows(bench):
    """(kind, severity, window) as health_signatures fits its errors to."""
    return [(one.kind, one.severity, one.window) for source in SOURCES.values()
            for one in all_judged(bench, FITTED_GEARS, source) if one.kind != "healthy"]


def share(found, of):
    """With its interval of 95 % (Clopper and Pearson)."""
    low = scipy.stats.beta.ppf(0.025, found, of - found + 1) if found else 0.0
    high = scipy.stats.beta.ppf(0.975, found + 1, of - found) if found < of else 1.0
    return f"{found} of {of} ({100.0 * low:.0f} to {100.0 * high:.0f} %)"


def missed(own):
    """(kind, severity) of the faults without an alarm."""
    return [(one.kind, one.severity) for one in own if one.window["assessment"]["level"] == "OK"]


def missed_table(found):
    """Missed faults of all gears, by kind, source and severity."""
    columns = [(name, severity) for name in found for severity in SEVERITIES]
    lines = ["| missed faults, all five gears | "
             + " | ".join(f"{name}, severity {severity:g}" for name, severity in columns) + " |",
             "|" + (len(columns) + 1) * "---|"]
    return lines + [f"| `{kind}` | " + " | ".join(str(missed(found[name]).count((kind, severity)))
                                                  for name, severity in columns) + " |" for kind in KINDS]


def shares_table(found):
    """What was found of all gears, by source."""
    lines = ["| source, all five gears | " + " | ".join(f"found, severity {severity:g}" for severity in SEVERITIES)
             + " | false alarms | windows not judged |", "|" + (len(SEVERITIES) + 3) * "---|"]
    for name, own in found.items():
        alarmed = [one for one in own if one.window["assessment"]["level"] != "OK"]
        cells = [share(*(sum(one.severity == severity for one in chosen) for chosen in (alarmed, own)))
                 for severity in SEVERITIES]
        cells.append(share(*(sum(one.kind == "healthy" for one in chosen) for chosen in (alarmed, own))))
        not_judged = sum(one.window["assessment"]["state"] not in COMPARED for one in own)
        lines.append(f"| {name} | " + " | ".join(cells) + f" | {not_judged} of {len(own)} |")
    return lines


def row_of(name, own):
    sound = [one for one in own if one.kind == "healthy"]
    faulty = [one for one in own if one.kind != "healthy"]
    alarms = [one for one in faulty if one.window["assessment"]["level"] != "OK"]
    verdicts = [one.window["assessment"] for one in alarms]
    right = [verdict["cause"] == one.kind for one, verdict in zip(alarms, verdicts)]
    in_set = [is_right or one.kind in verdict["alternatives"] for one, verdict, is_right in
              zip(alarms, verdicts, right)]
    areas = [area([one.score for one in faulty], [one.score for one in sound])]
    areas += [area([one.plain[place] for one in faulty], [one.plain[place] for one in sound]) for place in (0, 1)]
    found = [f"{sum(one.severity == severity for one in alarms)} of "
             f"{sum(one.severity == severity for one in faulty)}" for severity in SEVERITIES]
    false = sum(one.window["assessment"]["level"] != "OK" for one in sound)
    confidence = f"{numpy.mean([verdict['confidence'] for verdict in verdicts]):.2f}" if verdicts else "-"
    return (f"| {name} | " + " | ".join(f"{value:.2f}" for value in areas)
            + f" | {false} of {len(sound)} | {found[0]} | {found[1]} | {sum(right)} of {len(alarms)} "
            f"| {sum(in_set)} of {len(alarms)} | {confidence} |")


def table(found):
    """`found`: what was judged, by source."""
    lines = ["| gears or motion, source | area of the score | area of the Mahalanobis distance "
             "| area of the largest deviation | false alarms | "
             + " | ".join(f"found, severity {severity:g}" for severity in SEVERITIES)
             + " | named cause right, of alarms | true cause in the set, of alarms | mean confidence |",
             "|" + 10 * "---|"]
    for name, own in found.items():
        drawn_ones = [one for one in own if one.gear not in OTHER_MODELS]
        rows = [(motion.name, [one for one in drawn_ones if one.motion == motion.name]) for motion in MOTIONS]
        rows += [("three gears", drawn_ones)]
        rows += [(model.name, [one for one in own if one.gear == model]) for model in OTHER_MODELS]
        lines += [row_of(f"{title}, {name}", chosen) for title, chosen in rows]
    return lines


def calibration_error(right, confidence):
    """Mean distance of the share that is right from the stated confidence, by class of confidence."""
    of = numpy.digitize(confidence, CLASSES, right=True)
    return sum(abs(numpy.sum(right[of == one] - confidence[of == one])) for one in set(of)) / len(right)


CAUSE_COLUMNS = ["named cause right, of alarms", "mean confidence", "calibration error",
                 "true cause in the set, of alarms", "error of the severity, rms",
                 "severities within the stated deviation"]


def causes_row(title, own):
    """CAUSE_COLUMNS of the alarms of all sources; severities where the cause is right."""
    alarms = [one for one in own if one.kind != "healthy" and one.window["assessment"]["level"] != "OK"]
    verdicts = [one.window["assessment"] for one in alarms]
    right = numpy.array([verdict["cause"] == one.kind for one, verdict in zip(alarms, verdicts)])
    in_set = sum(one.kind in (verdict["cause"], *verdict["alternatives"]) for one, verdict in zip(alarms, verdicts))
    confidence = numpy.array([verdict["confidence"] for verdict in verdicts])
    errors = [(verdict["severity"] - one.severity, verdict["severity_deviation"])
              for one, verdict, is_right in zip(alarms, verdicts, right) if is_right]
    off = math.sqrt(numpy.mean([error ** 2 for error, _ in errors])) if errors else math.nan
    within = 100.0 * numpy.mean([abs(error) <= stated for error, stated in errors]) if errors else math.nan
    return (f"| {title} | {share(sum(right), len(alarms))} | {confidence.mean():.2f} | "
            f"{calibration_error(right, confidence):.2f} | {share(in_set, len(alarms))} | {off:.2f} | {within:.0f} % |")


def judged_table(bench):
    found = {name: all_judged(bench, JUDGED_GEARS, source) for name, source in SOURCES.items()}
    everything = [one for own in found.values() for one in own]
    return [*table(found), "", *missed_table(found), "", *shares_table(found), "",
            "| gears, all sources | " + " | ".join(CAUSE_COLUMNS) + " |",
            "|" + (len(CAUSE_COLUMNS) + 1) * "---|",
            causes_row("three gears", [one for one in everything if one.gear not in OTHER_MODELS]),
            *(causes_row(model.name, [one for one in everything if one.gear == model]) for model in OTHER_MODELS)]
