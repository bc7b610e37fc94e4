# SPDX-License-Identifier: BSD-3-Clause
"""Scores the failure modes of the thesis' Table 3.7 again: how well each is detected is what docs/health_robots.csv
says of the signals of two robots. Writes the table of docs/faults.md."""
import argparse
import csv

import lab

KINDS = {  # by their order in the thesis' table
    "Wear of the interface wave generator - flexspline": "interface_wear",
    "Crack behind the toothed rim": "rear_section_crack",
    "Degraded lubricant": "lubricant_degradation",
    "Worn teeth": "tooth_wear",
    "Crack at the tooth root": "tooth_root_crack",
    "Crack in the flexspline's flange": "flange_crack",
    "Crack at the tooth tip": "tooth_tip_crack",
    "Pitting": "pitting",
    "Wear of the wave generator": "wave_generator_wear",
    "Crack in the flexspline": "flexspline_crack",
    "Buckling": "buckling",
    "Ratcheting": "ratcheting"}
ROBOTS = ("UR5", "UR5e")


def detection(seen):
    """D by the alarms of two robots at severity 0.3 and at 1, "2, 2": 1 sure ... 10 not at all."""
    slight, full = map(int, seen.split(", "))
    return 2 if slight == 2 else {2: 5, 1: 8, 0: 10}[full]


def places(numbers):
    """Rank of each, the largest first; equal ones share theirs."""
    return [1 + sum(other > number for other in numbers) for number in numbers]


def main():
    argparse.ArgumentParser(description=__doc__).parse_args()
    with open(lab.CHECKOUT / "docs" / "health_robots.csv", encoding="utf-8", newline="") as file:
        seen = {row[0]: row[1:1 + len(ROBOTS)] for row in csv.reader(file)}
    with open(lab.CHECKOUT / "lab" / "validation" / "fmeca.csv", encoding="utf-8") as file:
        modes = list(csv.DictReader(file))
    scores = [[int(mode["detection"])] + [detection(cell) for cell in seen[KINDS[mode["mode"]]]] for mode in modes]
    risks = [[int(mode["severity"]) * int(mode["occurrence"]) * score for score in row]
             for mode, row in zip(modes, scores)]
    ranks = list(zip(*map(places, zip(*risks))))
    lines = ["| failure mode | S | O | "
             + " | ".join(f"{source}: D, RPN (rank)" for source in ("thesis", *ROBOTS)) + " |",
             "|---" * (4 + len(ROBOTS)) + "|"]
    for mode, score, risk, rank in sorted(zip(modes, scores, risks, ranks), key=lambda row: row[3][0]):
        cells = [f"{d}, {number} ({place})" for d, number, place in zip(score, risk, rank)]
        lines.append(f"| {mode['mode']} | {mode['severity']} | {mode['occurrence']} | " + " | ".join(cells) + " |")
    lines.append("| sum | | | " + " | ".join(str(sum(column)) for column in zip(*risks)) + " |")
    lab.write(lab.CHECKOUT / "docs" / "faults.md", "risk", lines)


if __name__ == "__main__":
    main()
