# SPDX-License-Identifier: BSD-3-Clause
"""Levels and reasons of a verdict: Verdict.msg, the enumerations and the names of the reasons are the same."""
import re

import project

MESSAGE, REASON, LEVEL, NAMES = ("msg/Verdict.msg", "src/tracking/reason.hpp", "src/tracking/verdict.hpp",
                                 "src/tracking/verdict_text.cpp")


def enumeration(text, name):
    body = re.search(rf"enum class {name} : std::uint8_t\s*{{(.*?)}};", text, re.DOTALL)
    return re.findall(r"(\w+) = (\d+)", body.group(1)) if body else []


def check(root):
    constants = re.findall(r"^uint8 (\w+)=(\d+)", project.text(root, MESSAGE), re.MULTILINE)
    levels = enumeration(project.text(root, LEVEL), "VerdictLevel")
    reasons = enumeration(project.text(root, REASON), "Reason")
    listed = re.search(r"REASONS{(.*?)};", project.text(root, NAMES), re.DOTALL)
    names = re.findall(r'"(\w+)"', listed.group(1)) if listed else []
    problems = []
    if constants != levels + reasons:
        odd = sorted(set(constants) ^ set(levels + reasons))
        problems.append(f"{MESSAGE}: not the constants of {LEVEL} and {REASON}, in their order: {odd}")
    if names != [name for name, _ in reasons] or [int(number) for _, number in reasons] != list(range(len(reasons))):
        problems.append(f"{NAMES}: REASONS are not the names in {REASON}, numbered from 0 on")
    return problems if levels and reasons else [f"{LEVEL}, {REASON}: no enumeration found"]


if __name__ == "__main__":
    project.run(check)
