# SPDX-License-Identifier: BSD-3-Clause
"""Teeth: the four profiles and what each carries, interference of the straight flank, the jump of the teeth."""
from teeth_interference import interference
from teeth_jump import jump
from teeth_load import load_share, pressure_angle, turning
from teeth_profiles import clearance_at_rest, profiles
from teeth_runs import PROFILES, loaded


def build(page):
    path = profiles(page)
    rows = {name: loaded(page, "mesh.profile=" + name) for name in PROFILES}
    clearance_at_rest(page, rows, path)
    load_share(page, rows)
    turning(page)
    pressure_angle(page)
    interference(page, path)
    jump(page)
