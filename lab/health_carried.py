# SPDX-License-Identifier: BSD-3-Clause
"""Fits how far a sound drive's reference of the check-up is off in another motion, where the model's indicators are
subtracted from both. Written into a file of signatures."""
import collections
import math

import numpy
import yaml

import health_file
from health_runs import CARRIED, CARRIED_MOTIONS, CARRIED_RUNS, CARRIED_SEED, CHECK_UP, COMPARED, DRAWN, MODELS, at_work

SHARES = numpy.concatenate([[0.0], numpy.geomspace(1e-3, 1e3, 121)])  # tried, of the deviation at the median size
SIGNALS = ["error_", "torque_", "ripple_"]
Pair = collections.namedtuple("Pair", "squares sizes")  # of a gear in a motion less a model, by indicator


def sizes_of(reference):
    """As sizeOffModel in baseline.cpp, over all classes, by indicator."""
    means = collections.defaultdict(list)
    for row in yaml.safe_load(reference.read_text(encoding="utf-8"))["baseline"]:
        for name, numbers in row["indicators"].items():
            means[name].append(numbers[:2])
    means = {name: numpy.average([mean for _, mean in own], weights=[count for count, _ in own])
             for name, own in means.items()}
    locked = [name[:-4] for name in means if name.endswith("_cos") and "_load" not in name]
    sizes = {}
    for name, mean in means.items():
        signal = name.split("_")[0] + "_"
        lines = [line for line in locked if line.startswith(signal)] if signal in SIGNALS else []
        sizes[name] = math.hypot(*(means[line] for line in lines)) if lines else abs(mean)
    return sizes


def pair_of(bench, gear, motion, model):
    """Mean squares of what the ends of runs without a fault differ by from the carried reference."""
    motion, reference = at_work(motion), bench.reference(gear, CHECK_UP, model)
    bags = bench.sound("carried", gear, motion, DRAWN, CARRIED_RUNS, CARRIED_SEED)
    models = bench.beside(model, bags, motion, DRAWN, CARRIED_SEED, paths=CARRIED_RUNS)
    report = bench.indicators(bags, ["--baseline", reference, "--carry"], models)
    last = {window["recording"]: window["residual"] for window in report["windows"]
            if window["assessment"]["state"] in COMPARED}
    squares = {name: [residual[name][1] ** 2 for residual in last.values() if residual[name]]
               for name in report["windows"][0]["residual"]}
    return Pair({name: numpy.mean(own) if own else None for name, own in squares.items()}, sizes_of(reference))


def fitted(squares, sizes):
    """(deviation, share of the size, degrees of freedom). The squares are taken as those of normal numbers of variance
    deviation^2 + (share size)^2, of greatest likelihood, with one standard error of the scale on top; degrees of
    freedom after Satterthwaite (1946)."""
    unit = numpy.median(sizes) or 1.0
    best = None
    for share in SHARES:
        shape = 1.0 + (share * sizes / unit) ** 2
        square = numpy.mean(squares / shape)
        loss = numpy.mean(numpy.log(square * shape))
        if best is None or loss < best[0]:
            best = loss, share / unit, square, shape
    _, share, square, shape = best
    count = len(squares) / len(MODELS)  # the models see the same runs
    error = numpy.std(squares / shape / square, ddof=1) / math.sqrt(count)
    deviation = math.sqrt(square * (1.0 + error))
    return deviation, deviation * share, min(max(2.0 / error ** 2, 1.0), count)


def errors(pairs):
    """As `fitted`, by indicator, of those that enough motions determined."""
    found = {}
    for name in pairs[0].squares:
        own = [(pair.squares[name], pair.sizes[name]) for pair in pairs if pair.squares[name] and name in pair.sizes]
        if len(own) >= len(CARRIED) * len(MODELS):
            found[name] = fitted(*numpy.array(own).T)
    return found


def write(bench, path):
    pairs = [pair_of(bench, gear, motion, model) for gear in CARRIED for motion in CARRIED_MOTIONS for model in MODELS]
    health_file.replace(path, "carried", {
        name: [float(f"{deviation:.3g}"), float(f"{share:.3g}"), round(freedom, 1)]
        for name, (deviation, share, freedom) in errors(pairs).items()})
