# SPDX-License-Identifier: BSD-3-Clause
"""Fits how far a sound drive's reference of the check-up is off in another motion, where the model's indicators are
subtracted from both. Written as data of the source."""
import collections
import math

import numpy
import yaml

import health_source
from health_runs import CARRIED, CARRIED_MOTIONS, CARRIED_RUNS, CARRIED_SEED, CHECK_UP, COMPARED, DRAWN, MODELS, at_work

UNKNOWN = 1e30  # deviation of what no motion determined, as in the source
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
    """As `fitted`, by indicator."""
    found = {}
    for name in pairs[0].squares:
        own = [(pair.squares[name], pair.sizes[name]) for pair in pairs if pair.squares[name] and name in pair.sizes]
        known = len(own) >= len(CARRIED) * len(MODELS)
        found[name] = fitted(*numpy.array(own).T) if known else (UNKNOWN, 0.0, 1.0)
    return found


def write(bench, source):
    pairs = [pair_of(bench, gear, motion, model) for gear in CARRIED for motion in CARRIED_MOTIONS for model in MODELS]
    lines = ["// SPDX-License-Identifier: BSD-3-Clause", "// Written by `scripts/evaluate_health --fit`.",
             "#pragma once", "", "#include <array>", "#include <cstddef>", "",
             '#include "harmonic_joint_twin/health/signal_indicators.hpp"', "", "namespace hjt", "{",
             "/// What the indicators of a sound drive, less a model's, differ by from one motion to another.",
             "struct CarriedError", "{",
             "  double deviation{ 1e30 };  ///< rms of a drive like the model, unit of the indicator; 1e30: not known",
             "  double share{};            ///< of what drive and model differ by, of a line all of its signal [-]",
             "  double freedom{ 1.0 };     ///< degrees of freedom both are known with [-]", "};", "",
             "struct CarriedRow", "{", "  std::size_t indicator;", "  CarriedError error;", "};", "",
             "// clang-format off",
             "inline constexpr CarriedRow CARRIED_ROWS[] = {"]
    for name, (deviation, share, freedom) in errors(pairs).items():
        numbers = f"{deviation:.3g}, {share:.3g}, {freedom:.1f}"
        lines.append(f"{{ {health_source.indicator(name)}, {{ {numbers} }} }},")
    lines += ["};", "// clang-format on", "",
              "/// By indicator; without a row it is not known.",
              "inline constexpr std::array<CarriedError, INDICATOR_COUNT> CARRIED_ERRORS = []", "{",
              "  std::array<CarriedError, INDICATOR_COUNT> errors{};",
              "  for (const CarriedRow& row : CARRIED_ROWS)", "  {", "    errors[row.indicator] = row.error;", "  }",
              "  return errors;", "}();", "}  // namespace hjt"]
    source.write_text("\n".join(lines) + "\n")
