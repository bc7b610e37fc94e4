# SPDX-License-Identifier: BSD-3-Clause
"""Digital twin of a robot joint's harmonic drive, tooth by tooth: `import harmonic_joint_twin as hjt` (docs/python.md).

Parameters, Twin, static analyses and Tracker come from the extension module _hjt, which is loaded when the first of
them is used: programs that want the messages in harmonic_joint_twin.msg alone do without it. Functions on recordings
and data sets come from _commands, whose extension module _recordings is loaded when the first of them runs; the whole
arm as an object from _arm; what gives frames of pandas from _data_sets.
"""
import importlib


def _parts():
    for name in "_hjt", "_commands", "_arm", "_data_sets":
        yield importlib.import_module("harmonic_joint_twin." + name)


def _names(part):
    return getattr(part, "__all__", None) or [name for name in dir(part) if not name.startswith("_")]


def __getattr__(name):
    if name == "__all__":  # of `from harmonic_joint_twin import *`
        return __dir__()
    if not name.startswith("_"):
        for part in _parts():
            if name in _names(part):
                globals()[name] = getattr(part, name)
                return globals()[name]
    raise AttributeError(f"module 'harmonic_joint_twin' has no attribute '{name}'")


def __dir__():
    return [name for part in _parts() for name in _names(part)]
