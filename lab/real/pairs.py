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
        spreads.append(f"In pairs of recordings the friction of {group[0]} to {group[-1]} differs "
                       f"by {100.0 * rms(np.array(together)):.1f} % rms, and by "
                       f"{100.0 * rms(np.array(left)):.1f} % rms after division by the median of the three joints.")
    return f"""
The program also judged each recording with every other recording as reference, in {len(arms)} pairs of recordings. Of
the {len(judged)} verdicts on single joints {alarms} are WARN or worse. In some pairs the program judged all three
joints of a group. {" ".join(spreads)} The widths of the [interval](compare.md#interval-of-the-friction) come from the
pairs. So the pairs do not show how often the verdict is wrong on another arm.
"""
