# SPDX-License-Identifier: BSD-3-Clause
"""Runs of the locked drive that several parts of the section on teeth look at."""
PROFILES = {"trapezoid": "trapezoid", "involute": "involute", "cycloid": "cycloid", "double_arc": "double arc"}
TEETH = 200
LOADS = [0, 7, 14, 30, 48, 67, 87, 108, 130, 150, 200, 250, 284, 350, 400, 450, 500]  # N.m


def set_all(*assignments):
    return [word for assignment in assignments for word in ("--set", assignment)]


def golden(*assignments):
    """The gear as the thesis computes it: profiles and supports are compared on this one, whatever is shipped."""
    return ["--config", "golden.yaml", *set_all(*assignments)]


def loaded(page, *assignments, loads=LOADS):
    return page.tool("stiffness", "--torques", ",".join(str(load) for load in loads), "--teeth",
                     *golden(*assignments))["rows"]


def row_at(rows, torque):
    return next(row for row in rows if row["torque"] == torque)


def lobe(values):
    """The teeth around the first lobe: angles from the major axis [deg] and their values."""
    quarter = TEETH // 4
    order = range(-quarter, quarter + 1)
    return [360.0 * i / TEETH for i in order], [values[i] for i in order]
