# SPDX-License-Identifier: BSD-3-Clause
"""Runs the stress matrix and writes the page of stability. See `lab/run stress --help`."""
import argparse
import collections
import concurrent.futures
import csv
import os
import sys
import tempfile
import time

import arm
import cells
import judge
import stability
from stability import percent

sys.path.append(os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "validation"))
from page import markdown_table, say  # noqa: E402  (its folder is known now)


def write_cells(path, judged):
    """Every cell, a row each."""
    with open(path, "w", encoding="utf-8", newline="") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(["cell", "verdict", "error", "doubt", "drift", "newton_iterations_mean",
                       "newton_iterations_most", "cuts", "message"])
        rows.writerows([j.cell.name, j.verdict,
                        *(f"{value:.3g}" for value in (j.error, j.doubt, j.drift, j.iterations)), j.iterations_max,
                        j.cuts, j.reason.split("\n")[0]] for j in judged)


def parse(arguments):
    parser = argparse.ArgumentParser(
        prog="stress", description="Runs the twin far from where it is meant to run and judges each run against "
        "converged ones. Writes all cells to out/stability/cells.csv and, if none was left out, the page "
        "docs/stability.md. Exit code 1 if a cell is silently wrong, not finite, hung or crashed.")
    parser.add_argument("--tool", required=True, help=argparse.SUPPRESS)
    parser.add_argument("--docs", required=True, help=argparse.SUPPRESS)
    parser.add_argument("--seeds", type=int, default=30, metavar="N", help="random cells, seeds 1 ... N [30]")
    parser.add_argument("--only", metavar="TEXT",
                        help="only cells whose name has this in it; needs --out to write them")
    parser.add_argument("--out", metavar="DIR",
                        help="folder of cells.csv (default: out/stability of the checkout)")
    parser.add_argument("--arm", action="store_true",
                        help="a whole arm in closed loop in place of one joint; writes docs/arm_stress.csv and a line "
                        "of docs/arm_twin.md")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), metavar="N", help="cells at a time")
    return parser.parse_args(arguments)


def main(arguments):
    options = parse(arguments)
    if options.arm:
        with tempfile.TemporaryDirectory(prefix="stress.") as work:
            return arm.main(options.tool, options.docs, work, options.only)
    chosen = [cell for cell in cells.matrix(options.seeds) if not options.only or options.only in cell.name]
    if not chosen:
        sys.exit(f"stress: no cell has '{options.only}' in its name")
    started = time.monotonic()
    judged = []
    shipped = judge.judge(cells.Cell("shipped", ("parameters",)))
    if shipped.verdict != judge.ACCURATE:
        sys.exit(f"stress: the shipped parameters themselves are {shipped.verdict}: {shipped.reason}")
    with concurrent.futures.ProcessPoolExecutor(max(1, options.jobs)) as pool:
        for j in pool.map(judge.judge, chosen):
            judged.append(j)
            if j.verdict not in judge.GOOD:
                say(f"{j.verdict}: {j.cell.name}: {j.reason or 'error ' + percent(j.error)}")
            if len(judged) % 20 == 0 or len(judged) == len(chosen):
                say(f"[{len(judged)}/{len(chosen)}] {time.monotonic() - started:.0f} s")
    out = options.out or (None if options.only else os.path.join(os.path.dirname(options.docs), "out", "stability"))
    if out:
        os.makedirs(out, exist_ok=True)
        write_cells(os.path.join(out, "cells.csv"), judged)
        say(f"cells: {os.path.join(out, 'cells.csv')}")
        if not options.only:
            stability.write(options.docs, judged, markdown_table)
    counts = collections.Counter(j.verdict for j in judged)
    print(", ".join(f"{counts[verdict]} {verdict}" for verdict in judge.VERDICTS if counts[verdict]))
    return 0 if all(j.verdict in judge.GOOD for j in judged) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
