# SPDX-License-Identifier: BSD-3-Clause
"""Digital twin of a robot joint's harmonic drive, tooth by tooth: `import harmonic_joint_twin as hjt` (docs/python.md).

The package loads its modules at the first use of a name, so that a program that only imports the messages of
harmonic_joint_twin.msg needs none of them. The extension module _hjt has Parameters, Twin, the static analyses and
Tracker. The module _commands has the functions on recordings and data sets; the first call of a function loads the
extension module _recordings. The module _arm has the class Arm, and _data_sets has the functions that return frames of
pandas.
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
