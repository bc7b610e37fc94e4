# SPDX-License-Identifier: BSD-3-Clause
"""Has the tool make the signatures of the causes, and fits how far they are to be trusted on another gear. Written into
a file of signatures and as a table."""
import collections
import itertools
import math

import numpy

import health_file
import health_motions
import lab
from health_runs import COMPARED, DRAWN, FITTED, FITTED_MODELS, once, split_table

# Changes as a share of the sound value: stiffness and play go with the size of the cup. Thicker grease multiplies the
# friction there is, which differs threefold over the temperatures; preload and wear add to it.
OF_ROBOTS = ["load_friction", "lag_ripple", "lag_order_1", "lag_order_2", "lag_order_4"]  # after the other scalars
SHARES = ["torsional_stiffness", "second_stiffness", "lost_motion", "hysteresis", "hysteresis_area", *OF_ROBOTS]
STIFFNESSES = SHARES[:2]  # change as a compliance does: an eccentric encoder adds the same to that of every drive
SHARES_OF_GREASE = SHARES + ["running_torque", "coulomb_torque", "viscous_friction"]
NEIGHBOURS = ["wave_generator_2", "circular_spline_2"]
# As in the source.
# Strength; drag, over the running torque; noise.
UNKNOWNS = numpy.array([(3.0, 0, 0), (10.0, 0, 0), (30.0, 0, 0), (100.0, 0, 0),
                        (0, 0.05, 0), (0, 0.15, 0), (0, 0.4, 0), (0, 1.0, 0),
                        (0, 0, 0.12), (0, 0, 0.25), (0, 0, 0.5), (0, 0, 1.0)])
TOGETHER = ("tooth_wear", "interface_wear", "lubricant_degradation")  # come together, alike or less by LESS
LESS = 0.4

# A row each; `kinds` of motion: speed [rad/s] and direction, magnitudes, 0 of any. `sound`: values by name. `priors`:
# by cause, 1 of those that are not in it.
Table = collections.namedtuple("Table", "causes motions severities kinds changes sound priors")
# Of the law in fault_signatures.hpp, by its letters: r m l b_0 w_1, which are fitted, then N Q w_0 and the weight of
# what is no fault of a gear, as in the source.
Errors = collections.namedtuple("Errors", "number motion line weight misfit speed direction other no_fault")
IN_FILE = Errors._fields[:5]
START = Errors(0.3, 0.25, 0.5, 0.6, 0.2, 0.2, 0.3, 1e-3, 0.1)  # of the search


def amplitude_change(sound, change):
    """As amplitudeChange in baseline.hpp."""
    size = numpy.where(sound > 0.0, sound, 1.0)
    power = numpy.maximum(1.0 + change / size, 0.0) ** (2.0 / 3.0)
    return numpy.where(sound > 0.0, 1.5 * size * (power - 1.0), change)


def shares(cause):
    return SHARES_OF_GREASE if cause == "lubricant_degradation" else SHARES


class Layout:
    """Names of the numbers of a signature, and the indicators they are made of."""

    def __init__(self, indicators):
        lines = [name for name in indicators if name.endswith("_cos")]
        self.locked = [name[:-4] for name in lines]
        self.names = [name for name in indicators if not name.endswith(("_cos", "_sin"))]
        self.lines = {name for name in self.names if name.startswith(("error_", "torque_", "ripple_"))}

    def terms(self, window):
        """(number, has a phase, half the square of the sound line's amplitude or that of the sound lost motion,
        residual) of each that was compared."""
        residual = window["residual"]
        for number, name in enumerate(self.names):
            parts = [name + "_cos", name + "_sin"] if name in self.locked else [name]
            parts = [part for part in parts if residual[part] is not None]
            # Orders 2 and 1.98 are told apart so little in a motion to and fro that they count as one.
            lines = [name.replace(one, other) for one in NEIGHBOURS for other in NEIGHBOURS if name.endswith(one)]
            amplitudes = [residual[part][0] for line in lines or [name] for part in (line + "_cos", line + "_sin")
                          if name in self.locked and residual[part] is not None]
            for part in parts:
                play = residual[part][0] ** 2 if name == "lost_motion" else 0.0
                yield number, name in self.locked, play + 0.5 * sum(value ** 2 for value in amplitudes), residual[part]


def kind_of(window):
    """Of motion."""
    return window["speed"], abs(window["direction"])


def unlikeness(kinds, kind):
    """(of the speed's logarithm, of the direction): what the motion of each row and the window's differ by."""
    speeds, directions = kinds.T
    return (numpy.log(kind[0] / numpy.where(speeds > 0.0, speeds, kind[0])),
            numpy.where(speeds > 0.0, kind[1] - directions, 0.0))


def together(table):
    """(rows that come together, the first that they count for; weight of each beforehand)."""
    rows = collections.defaultdict(list)
    for row, (cause, kind) in enumerate(zip(table.causes, map(tuple, table.kinds))):
        rows[cause, kind].append(row)
    sums = []
    for first, cause in enumerate(table.causes):
        if cause not in TOGETHER:
            continue
        own, several = TOGETHER.index(cause), []
        for step in (1, 2):
            other = TOGETHER[(own + step) % len(TOGETHER)]
            several.append([None] + [
                row for row in rows[other, tuple(table.kinds[first])]
                if table.severities[row] == table.severities[first]
                or abs(table.severities[row] / table.severities[first] - LESS) < 0.05 * LESS])
        sums += [[row for row in (first, *parts) if row is not None] for parts in itertools.product(*several)
                 if any(part is not None for part in parts)]
    alone = collections.Counter(table.causes)
    of_sums = collections.Counter(table.causes[parts[0]] for parts in sums)
    return sums, numpy.array([alone[table.causes[parts[0]]] / of_sums[table.causes[parts[0]]] for parts in sums])


class Hypotheses:
    """What a window says of every row of the table and of what is in none; the law is in fault_signatures.hpp."""

    def __init__(self, layout, window, table):
        number, phase, line, residual = zip(*layout.terms(window))
        number, self.phase, self.line = list(number), numpy.array(phase), numpy.array(line)
        sound, difference, self.own, *common = numpy.array(residual).T
        self.common = numpy.array(common).T
        self.freedom = window["freedom"]
        self.table = table
        sums, beforehand = together(table)
        first = [parts[0] for parts in sums]
        self.alone = len(table.severities)
        self.causes = numpy.array([*table.causes, *(table.causes[row] for row in first)])
        share = {cause: [layout.names[i] in shares(cause) for i in number] for cause in set(table.causes)}
        known = numpy.array([table.sound[layout.names[i]] if layout.names[i] in STIFFNESSES else 0.0 for i in number])
        unit = numpy.where(known > 0.0, sound ** 2 / numpy.where(known > 0.0, known, 1.0), sound)
        change = table.changes[:, number] * numpy.where([share[cause] for cause in table.causes], unit, 1.0)
        free = [not has_phase and layout.names[i] in layout.lines for i, has_phase in zip(number, phase)]
        change = numpy.where(free, amplitude_change(sound, change), change)
        change = numpy.vstack([change, *(change[parts].sum(axis=0) for parts in sums)])
        self.rows = len(change)
        self.apart = [numpy.append(own, own[first]) for own in unlikeness(table.kinds, kind_of(window))]
        self.beforehand = numpy.append(numpy.ones(self.alone), beforehand)
        sounds = {name: (window["residual"][name] or [0.0])[0] for name in ("running_torque", "kinematic_error")}
        drag, noise = UNKNOWNS[:, 1] * sounds["running_torque"], UNKNOWNS[:, 2] * sounds["kinematic_error"]
        unknown = {"running_torque": drag, "coulomb_torque": drag, "kinematic_error": noise}
        none = numpy.zeros(len(UNKNOWNS))
        self.change = numpy.vstack([change, numpy.array([unknown.get(layout.names[i], none) for i in number]).T])
        severities = numpy.asarray(table.severities)
        self.first = numpy.append(severities, severities[first])  # of what a row counts for
        all_of = numpy.append(severities, [math.hypot(*severities[parts]) for parts in sums])
        self.severity = numpy.pad(all_of, (0, len(UNKNOWNS)))
        self.left = difference - numpy.where(phase, 0.0, self.change)

    def alike(self, errors):
        """How far the motion of each row and the window's are alike, 0 to 1."""
        return numpy.exp(-0.5 * (self.apart[0] / errors.speed) ** 2 - 0.5 * (self.apart[1] / errors.direction) ** 2)

    def log_likelihoods(self, errors):
        strength = numpy.zeros(len(self.change))
        strength[self.rows:] = UNKNOWNS[:, 0] ** 2 + (1.0 + UNKNOWNS[:, 2]) ** 2 - 1.0
        variance = self.own * (1.0 + strength[:, None])
        unlike = numpy.pad(1.0 - self.alike(errors), (0, len(UNKNOWNS)))
        of_number = errors.number ** 2 + unlike[:, None] * errors.motion ** 2
        variance += numpy.where(self.phase, 0.5, of_number) * self.change ** 2
        variance += (errors.line * self.severity[:, None]) ** 2 * self.line
        weighted = self.common / variance[:, :, None]
        inner = numpy.eye(self.common.shape[1]) + numpy.swapaxes(weighted, 1, 2) @ self.common
        projected = numpy.einsum("hia,hi->ha", weighted, self.left)
        square = numpy.sum(self.left ** 2 / variance, axis=1)
        square -= numpy.einsum("ha,ha->h", projected, numpy.linalg.solve(inner, projected[..., None])[..., 0])
        logarithm = numpy.sum(numpy.log(variance / self.own), axis=1) + numpy.linalg.slogdet(inner)[1]
        return -0.5 * (logarithm + (self.freedom + len(self.phase)) *
                       numpy.log1p(numpy.maximum(square, 0.0) / self.freedom))

    def misfit(self, row):
        """Mean square of what a row leaves, in a sound drive's spreads; 1 at least."""
        left, weighted = self.left[row], self.common / self.own[:, None]
        projected = weighted.T @ left
        square = numpy.sum(left ** 2 / self.own) - projected @ numpy.linalg.solve(
            numpy.eye(self.common.shape[1]) + weighted.T @ self.common, projected)
        return max(square / len(left), 1.0)

    def posterior(self, errors):
        """(probability, severity, its variance by the signatures, that by the misfit over its square) by cause."""
        found = self.log_likelihoods(errors)
        misfit = self.misfit(numpy.argmax(found[:self.rows]))
        weight = errors.weight * (errors.misfit + (1.0 - errors.misfit) / misfit)
        names = list(dict.fromkeys(self.table.causes))
        weights = numpy.exp(weight * (found - found.max()))
        prior = self.beforehand * (errors.other + self.alike(errors))
        faults = prior * weights[:self.rows]
        alone = self.causes[:self.alone]
        means = {cause: numpy.sum(faults[self.causes == cause]) / numpy.sum(prior[:self.alone][alone == cause])
                 for cause in names}
        severity, variance = {}, {}
        for cause in names:
            own, shares_of_own = self.first[self.causes == cause], faults[self.causes == cause] + 1e-300
            severity[cause] = numpy.average(own, weights=shares_of_own)
            variance[cause] = numpy.average((own - severity[cause]) ** 2, weights=shares_of_own)
        means["none"] = numpy.average(weights[self.rows:], weights=numpy.where(UNKNOWNS[:, 0] > 0.0, 1.0,
                                                                               errors.no_fault))
        means = {cause: mean * self.table.priors.get(cause, 1.0) for cause, mean in means.items()}
        total = sum(means.values())
        return {cause: mean / total for cause, mean in means.items()}, severity, variance, (1.0 - 1.0 / misfit) ** 2


def calibration_windows(bench, trials):
    """(kind, severity, last compared window as the tool reports it) of faulty runs of other gears."""
    found = health_motions.calibration_windows(bench)
    for trial in trials:
        for motion in trial.motions:
            bags = bench.faulty(trial, motion, DRAWN)
            report = bench.indicators(bags,
                                      ["--baseline", bench.reference(trial.gear, motion), *once(motion)])
            last = {window["recording"]: window for window in report["windows"]
                    if window["assessment"]["state"] in COMPARED}
            found += [(row["class"], float(row["fault_severity"]), last[str(bag)]) for bag, row in bags
                      if str(bag) in last]
    return found


Alarm = collections.namedtuple("Alarm", "kind severity hypotheses")


def alarms_of(layout, windows, table):
    return [Alarm(kind, severity, Hypotheses(layout, window, table)) for kind, severity, window in windows
            if window["assessment"]["level"] != "OK"]


def loss(alarms, errors):
    """Mean of minus the logarithm of the true cause's probability."""
    return -numpy.mean([math.log(max(alarm.hypotheses.posterior(errors)[0][alarm.kind], 1e-3)) for alarm in alarms])


def fitted_errors(alarms):
    """Of least loss: one after the other, larger or smaller by a factor as long as that helps."""
    errors, least = START, loss(alarms, START)
    for factor in (1.6, 1.25):
        for name, step in itertools.product(IN_FILE, (factor, 1.0 / factor)):
            while True:
                tried = errors._replace(**{name: float(f"{getattr(errors, name) * step:.3g}")})
                found = loss(alarms, tried)
                if found > least - 1e-3:
                    break
                errors, least = tried, found
    return errors


def report(alarms, errors):
    found = [alarm.hypotheses.posterior(errors)[0] for alarm in alarms]
    best = [max(probability, key=probability.get) for probability in found]
    confidence = numpy.mean([probability[cause] for probability, cause in zip(found, best)])
    right = sum(alarm.kind == cause for alarm, cause in zip(alarms, best))
    print(f"evaluate_health: {errors}: mean log probability {-loss(alarms, errors):.3f}, cause right in {right} of "
          f"{len(alarms)} alarms, mean confidence {confidence:.3f}")


def severity_errors(alarms, errors):
    """(severity, severity_misfit): shares of the estimate by which it is off on another gear, and more where no
    signature fits; of greatest likelihood of the true severities, taken as normal, where the cause is right."""
    found = []
    for alarm in alarms:
        probability, severity, variance, misfit = alarm.hypotheses.posterior(errors)
        if max(probability, key=probability.get) == alarm.kind:
            estimate = severity[alarm.kind]
            found.append((estimate - alarm.severity, variance[alarm.kind], estimate ** 2, misfit))
    off, by_rows, square, misfit = numpy.array(found).T

    def loss_of(shares_of):
        variance = by_rows + square * (shares_of[0] ** 2 + misfit * shares_of[1] ** 2)
        return numpy.mean(numpy.log(variance) + off ** 2 / variance)

    best = min(itertools.product(numpy.arange(0.05, 0.5, 0.025), numpy.arange(0.0, 1.5, 0.1)), key=loss_of)
    deviation = numpy.sqrt(by_rows + square * (best[0] ** 2 + misfit * best[1] ** 2))
    print(f"evaluate_health: severities of {len(off)} right causes: off by {math.sqrt(numpy.mean(off ** 2)):.2f} rms, "
          f"{100.0 * numpy.mean(abs(off) <= deviation):.0f} % by no more than stated")
    return dict(zip(("severity", "severity_misfit"), (round(float(share), 3) for share in best)))


def constants_table(alarms, errors):
    """What each constant is worth: change of the mean log probability of the true cause without it and with other ones;
    without m no motion is unlike, without w_1 the weight may fall to nothing."""
    least = loss(alarms, errors)
    lines = [f"The mean log probability of the true cause is {-least:.3f} in {len(alarms)} alarms.", "",
             "| constant | value | change without the constant | change with half its value "
             "| change with twice its value |", "|---|---|---|---|---|"]
    for name, value in errors._asdict().items():
        without = {"weight": 1.0, "speed": 1e9, "direction": 1e9}.get(name, 1e-9)
        cells = [f"{least - loss(alarms, errors._replace(**{name: other})):+.3f}"
                 for other in (without, 0.5 * value, 2.0 * value)]
        lines.append(f"| `{name}` | {value:g} | " + " | ".join(cells) + " |")
    return lines


def write(bench, path, page, trials, errors_alone):
    """Errors, fitted to `trials` and to other motions, and `carried` of the file stay until the new ones are known: the
    tool takes them over."""
    if not errors_alone:
        bench.signatures(FITTED, path)
        bench.signatures(FITTED_MODELS, path, health_motions.KINDS, ("--add", path))
    table, _ = read(path)
    windows = calibration_windows(bench, trials)
    layout = Layout(windows[0][2]["indicators"])
    alarms = alarms_of(layout, windows, table)
    report(alarms, START)
    errors = fitted_errors(alarms)
    report(alarms, errors)
    health_file.replace(path, "errors", {**{name: getattr(errors, name) for name in IN_FILE},
                                         **severity_errors(alarms, errors)})
    lab.write(page, "constants", constants_table(alarms, errors))
    write_table(layout, health_file.read(path)["sound"], table, page, trials)


def with_severities_between(rows):
    """As in signature_file.cpp; of (cause, motion, kind, severity, changes)."""
    for one, after in itertools.zip_longest(rows, rows[1:]):
        yield one
        if after and one[:3] == after[:3] and 0.0 < one[3] < after[3]:
            severity = math.sqrt(one[3] * after[3])
            share = (severity - one[3]) / (after[3] - one[3])
            yield (*one[:3], severity, [first + share * (last - first) for first, last in zip(one[4], after[4])])


def priors(occurrence):
    """As in fault_signatures.cpp."""
    mean = numpy.mean(list(occurrence.values()))
    return {cause: 0.5 * (1.0 + rating / mean) for cause, rating in occurrence.items()}


def of_robots(content, cause, severity):
    """Shares of OF_ROBOTS, on straight lines from 0 and between the severities."""
    known = [[0.0] * (1 + len(OF_ROBOTS)), *(row[1:] for row in content.get("robots", ()) if row[0] == cause)]
    severities, *shares = numpy.transpose(known)
    return [float(numpy.interp(severity, severities, share)) for share in shares]


def read(path):
    """(table, errors) of what `write` wrote, as the tool takes it."""
    content = health_file.read(path)
    place = 5 + list(content["indicators"]).index("residual_crest") + 1
    rows = [(row[0], row[1], tuple(map(float, row[2:4])), float(row[4]),
             [*map(float, row[5:place]), *of_robots(content, row[0], float(row[4])), *map(float, row[place:])])
            for row in content["signatures"]]
    causes, motions, *numbers = zip(*with_severities_between(rows))
    kinds, severities, found = (numpy.array(own, float) for own in numbers)
    return (Table(causes, motions, severities, kinds, found, content["sound"], priors(content["occurrence"])),
            START._replace(**{name: content["errors"][name] for name in IN_FILE}))


def write_table(layout, sound, table, page, trials):
    """Severity 0.4, first gear in the check-up: the numbers in which the kinds differ most."""
    shown = [("torsional_stiffness", 1e-3, "K1 [kN·m/rad]"), ("second_stiffness", 1e-3, "K2 [kN·m/rad]"),
             ("lost_motion", 206265.0, "lost motion [″]"), ("hysteresis", 206265.0, "hysteresis [″]"),
             ("hysteresis_area", 1e3, "loop [mJ]"), ("running_torque", 1e3, "running torque [mN·m]"),
             ("viscous_friction", 1e6, "viscous [µN·m·s/rad]"), ("kinematic_error", 206265.0, "kinematic error [″]"),
             ("error_wave_generator_1", 206265.0, "order 1 [″]"), ("error_wave_generator_2", 206265.0, "order 2 [″]"),
             ("error_circular_spline_2", 206265.0, "circular spline [″]"), ("error_cage_lobes", 206265.0, "cage [″]"),
             ("error_outer", 206265.0, "outer [″]"), ("error_inner", 206265.0, "inner [″]")]
    lines = split_table(("signatures fitted to", FITTED), ("those of whole members also to", FITTED_MODELS),
                        ("their errors fitted to", trials),
                        ("and to", health_motions.trials(health_motions.FITTED_GEARS)))
    lines += ["", "| cause | " + " | ".join(text for _, _, text in shown) + " |", "|---|" + "---|" * len(shown)]
    shown_causes = set()
    for cause, motion, severity, change in zip(table.causes, table.motions, table.severities, table.changes):
        if motion == "check_up" and severity == 0.4 and cause not in shown_causes:
            shown_causes.add(cause)
            by_name = {name: number * (sound[name] if name in shares(cause) else 1.0)
                       for name, number in zip(layout.names, change)}
            lines.append(f"| `{cause}` | " + " | ".join(f"{scale * by_name[name]:.2g}" for name, scale, _ in shown)
                         + " |")
    lab.write(page, "signatures", lines)
