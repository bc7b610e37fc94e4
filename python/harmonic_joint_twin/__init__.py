# SPDX-License-Identifier: BSD-3-Clause
"""Digital twin of a robot joint's harmonic drive, tooth by tooth: `import harmonic_joint_twin as hjt` (docs/python.md).

Parameters, Twin, static analyses and Tracker come from the extension module _hjt, which is loaded when the first of
them is used: programs that want the messages in harmonic_joint_twin.msg alone do without it.
"""
import importlib


def _extension():
    return importlib.import_module("harmonic_joint_twin._hjt")


def __getattr__(name):
    if not name.startswith("_") and hasattr(_extension(), name):
        return getattr(_extension(), name)
    raise AttributeError(f"module 'harmonic_joint_twin' has no attribute '{name}'")


def __dir__():
    return [name for name in dir(_extension()) if not name.startswith("_")]
