# SPDX-License-Identifier: BSD-3-Clause
"""Fits the signatures of the causes to the model's own faults, and writes them as data of the source and as a table."""
import collections
import math

import numpy

import page_section
from health_runs import COOL, STEADY_POINTS, TRAINING, TRAINING_POINTS

LEAST = 1.0  # of a window's strongest score, over the threshold: what is weaker says little of its cause
NOISE = 2.0  # a score within it says nothing
TABLE_LEAST = 0.1  # shown from this size on


def compressed(features):
    """As in the assessment; features not compared are NaN."""
    return numpy.array([math.nan if score is None else math.copysign(math.asinh(max(abs(score) - NOISE, 0.0)), score)
                        for score in features.values()])


def unit(direction):
    return direction / math.sqrt(numpy.nansum(direction ** 2))


def fit(runs):
    """Mean direction of the runs that raise an alarm, by cause and motion."""
    directions = collections.defaultdict(list)
    for run in runs:
        if run.windows and all(window.largest >= LEAST for window in run.windows):
            motion = "steady" if run.point in STEADY_POINTS else "swinging"
            directions[run.kind, motion] += [unit(compressed(window.features)) for window in run.windows]
    return {key: unit(numpy.ma.masked_invalid(own).mean(axis=0).filled(0.0)) for key, own in directions.items()}


def by_kinematics(names):
    """What stands at a line of its own, whatever else it moves; a tooth of the circular spline is not among the
    faults."""
    lines = {"bearing_inner_race": "inner", "bearing_outer_race": "outer", "bearing_ball": "ball",
             "bearing_cage": "cage",
             "circular_spline_tooth": "circular_spline"}
    # A line also widens the kinematic error's peak to peak.
    return {(cause,
             "kinematics"): unit(numpy.array([{line: 1.0, "kinematic_error": 0.5}.get(name, 0.0) for name in names]))
            for cause, line in lines.items()}


def cause_name(cause):
    """As the source has it."""
    if cause == "circular_spline_tooth":
        return "Cause::CIRCULAR_SPLINE_TOOTH"
    return f"causeOf(FaultKind::{cause.upper()})"


def write(bench, source, page):
    runs = []
    reference = bench.reference(COOL)
    for point in TRAINING_POINTS:
        runs += bench.judge(bench.faulty(TRAINING, COOL, point), COOL, point, reference)
    names = list(next(window for run in runs for window in run.windows).features)
    signatures = fit(runs) | by_kinematics(names)
    order = [kind["kind"] for kind in bench.kinds] + ["circular_spline_tooth"]
    rows = sorted(signatures.items(), key=lambda item: (order.index(item[0][0]), item[0][1]))
    lines = ["// SPDX-License-Identifier: BSD-3-Clause",
             "// Written by `scripts/evaluate_health --fit`: cause, direction by Feature.",
             "#pragma once", "", '#include "harmonic_joint_twin/health/fault_signatures.hpp"', "", "namespace hjt", "{",
             "// clang-format off", "inline const std::vector<Signature> FITTED_SIGNATURES{"]
    lines += [f"{{ {cause_name(cause)}, {{ {', '.join(f'{value:.3f}' for value in direction)} }} }},  // {motion}"
              for (cause, motion), direction in rows]
    source.write_text("\n".join([*lines, "};", "// clang-format on", "}  // namespace hjt"]) + "\n")
    shown = ["<details>", f"<summary>{len(rows)} signatures</summary>", "",
             "| cause | motion | " + " | ".join(name.replace("_", " ") for name in names) + " |",
             "|---|---|" + "---|" * len(names)]
    shown += [f"| {cause} | {motion} | "
              + " | ".join(f"{value:.1f}" if abs(value) >= TABLE_LEAST else "" for value in direction)
              + " |" for (cause, motion), direction in rows]
    page_section.write(page, "signatures", [*shown, "", "</details>"])
