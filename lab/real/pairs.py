# SPDX-License-Identifier: BSD-3-Clause
"""Verdicts of each recording of a sound arm beside each other one."""
import numpy as np

from runs import rms


def is_alarm(joint):
    return joint["level"] in ("WARN", "ERROR")


def pairs_text(arms, groups):
    """`arms`: of each recording beside each other one."""
    judged = [joint for arm in arms for joint in arm["joints"] if joint["friction_ratio"] is not None]
    alarms = sum(is_alarm(joint) for joint in judged)
    spreads = []
    for group in groups:
        together, left = [], []
        for arm in arms:
            joints = [joint for joint in arm["joints"] if joint["joint"] in group]
            if all(joint["friction_ratio"] is not None for joint in joints):
                own = [joint["friction_ratio"] * joint["friction_shared"] for joint in joints]
                together += list(np.log(own))
                left += list(np.log(own) - np.median(np.log(own)))
        spreads.append(f"{group[0]} to {group[-1]}: {100.0 * rms(np.array(together)):.1f} %, apart from the median of "
                       f"the three {100.0 * rms(np.array(left)):.1f} %")
    return f"""
Each recording beside each other one as its reference, {len(arms)} pairs: {alarms} of {len(judged)} judged joints are
WARN or worse. By how much their friction differs, rms, where all three joints of a group are judged:
{"; ".join(spreads)}.
The shares of the [interval](compare.md#interval-of-the-friction) were taken from these pairs: they test no other arm.
"""
