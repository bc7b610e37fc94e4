# SPDX-License-Identifier: BSD-3-Clause
"""The tool's commands on recordings and data sets, in this process: each returns what the command prints as JSON."""
import json
import os
import tempfile
import warnings
from typing import TYPE_CHECKING, Any, Dict, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np

from harmonic_joint_twin import _hjt

if TYPE_CHECKING:  # numpy has it from 1.20 on
    from numpy.typing import NDArray

Path = Union[str, "os.PathLike[str]"]
Value = Union[bool, int, float, str, Sequence[float]]
Overlays = Sequence[Union[Path, Mapping[str, Value]]]
Document = Dict[str, Any]

__all__ = ["check", "checkup", "compare", "follow", "identify", "lives", "sweep"]

_NOISE = "joint_twin: "  # before the tool's messages


def _own_words(messages: str) -> str:
    lines = (line[len(_NOISE):] if line.startswith(_NOISE) else line for line in messages.splitlines())
    return "\n".join(line for line in lines if line.strip())


def _text(value: Any) -> str:
    if isinstance(value, (list, tuple)):
        return ",".join(_text(entry) for entry in value)
    return str(value)  # of a Path its path


def _write_overlay(values: Mapping[str, Value], path: str) -> None:
    sections: Dict[str, Dict[str, Value]] = {}
    for key, value in values.items():
        section, _, name = key.partition(".")
        sections.setdefault(section, {})[name] = value
    with open(path, "w", encoding="utf-8") as file:
        json.dump(sections, file, default=lambda value: value.tolist())  # numpy's; JSON is YAML


def _run(command: str, positional: Sequence[Path], options: Mapping[str, Any], overlays: Overlays = ()) -> Document:
    """Runs a command; options that are None or False are left out."""
    from harmonic_joint_twin import _tool
    with tempfile.TemporaryDirectory() as folder:
        words: List[str] = ["joint_twin", command, *map(_text, positional), "--json"]
        for name, value in options.items():
            if value is not None and value is not False:
                words += ["--" + name.replace("_", "-")] + ([] if value is True else [_text(value)])
        for place, overlay in enumerate(overlays):
            if isinstance(overlay, Mapping):
                path = os.path.join(folder, f"overlays[{place}]")
                _write_overlay(overlay, path)
            else:
                path = os.fspath(overlay)
            words += ["--config", path]
        code, document, messages = _tool.run(words)
    words_of_tool = _own_words(messages)
    if code == 2:
        raise _hjt.InputError(words_of_tool)
    if not document:
        raise RuntimeError(words_of_tool)
    for line in words_of_tool.splitlines():
        warnings.warn(line, RuntimeWarning, stacklevel=3)
    found = json.loads(document)
    assert isinstance(found, dict)
    return found


def check(recording: Path, arm: Optional[str] = None, *, topic: Optional[str] = None,
          time_scale: Optional[float] = None, overlays: Overlays = ()) -> Document:
    """What of an arm's recording is usable and what does not fit: the tool's check (docs/arm.md).

    recording: bag, or CSV of a UR controller. arm: name in config/arms, or a file; None: found by the joints' names.
    topic: of the telemetry in a bag. time_scale: factor on the stamps [-]. overlays: files or dicts of parameters,
    later wins.

    Returns a dict: 'usable', 'arm', 'findings', 'joints' (one dict each), 'next' (commands) and more. InputError,
    ParameterError.
    """
    return _run("check", [recording], {"arm": arm, "topic": topic, "time_scale": time_scale}, overlays)


def identify(recording: Path, *, joint: Optional[str] = None, arm: Optional[str] = None, out: Optional[Path] = None,
             train: Optional[Tuple[float, float]] = None, judge: Optional[Tuple[float, float]] = None,
             folds: Optional[int] = None, load: Optional[str] = None, identified: Optional[Path] = None,
             topic: Optional[str] = None, time_scale: Optional[float] = None, force: bool = False,
             overlays: Overlays = ()) -> Document:
    """Gain, friction, inertia and ripple of a joint, or of all joints of an arm, from a recording: the tool's identify.

    recording: bag, or CSV of a UR controller. joint or arm: one of them. out: the overlay to write, of an arm a
    directory. train, judge: (from, to), the parts to identify and to judge on [s]; None: the first third and the rest,
    of an arm all. folds: pieces to leave out in turn. load (arm): 'arm', from the motion of all joints, or
    'target_moment', as recorded. identified: directory of an arm's overlays. force: overwrite. Others as of check.

    Returns a dict: of a joint 'values' (name, key, unit, configured, value, half_width: 95 %, refusal), 'lines' of the
    ripple, 'judged' errors of the current [A]; of an arm 'joints' and 'payload'. What is not identifiable is warned of.
    InputError, ParameterError.
    """
    return _run("identify", [recording],
                {"joint": joint, "arm": arm, "out": out, "train": train, "judge": judge, "folds": folds, "load": load,
                 "identified": identified, "topic": topic, "time_scale": time_scale, "force": force}, overlays)


def compare(recording: Path, report: Path, *, joint: Optional[str] = None, arm: Optional[str] = None,
            reference: Optional[Path] = None, load: Optional[str] = None, identified: Optional[Path] = None,
            topic: Optional[str] = None, time_scale: Optional[float] = None, force: bool = False,
            overlays: Overlays = ()) -> Document:
    """Verdict on a recorded joint or arm beside its twin, with a page: the tool's compare (docs/compare.md).

    report: directory that gets report.html, its figures and its data. reference: an earlier report, in sound condition.
    Others as of identify.

    Returns the report's data as a dict: 'level', 'text', of an arm 'joints'. InputError, ParameterError.
    """
    return _run("compare", [recording],
                {"report": report, "joint": joint, "arm": arm, "reference": reference, "load": load,
                 "identified": identified, "topic": topic, "time_scale": time_scale, "force": force}, overlays)


def _rows(path: str) -> "NDArray[np.void]":
    with open(path, encoding="utf-8") as file:
        names = file.readline().strip().split(",")
        columns = np.loadtxt(file, delimiter=",", ndmin=2).reshape(-1, len(names))
    types = _hjt.COMPARISON_DTYPE.fields
    assert types is not None
    rows = np.empty(len(columns), [(name, types[name][0]) for name in names])
    for name, values in zip(names, columns.T):
        rows[name] = values
    return rows


def follow(recording: Path, *, joint: Optional[str] = None, arm: Optional[str] = None, mode: str = "motion",
           bag: Optional[Path] = None, load: Optional[str] = None, identified: Optional[Path] = None,
           topic: Optional[str] = None, time_scale: Optional[float] = None, force: bool = False,
           overlays: Overlays = ()) -> Document:
    """A healthy joint, or arm, beside a recording, a bag's as well: the tool's follow.

    mode: 'motion' predicts the current of the recorded motion, 'torque' the motion of the recorded current, 'observer'
    corrects the twin towards the recorded angles. bag: bag to write with the node's topics and the forces on every
    tooth. Others as of identify; for arrays at hand there is Tracker.

    Returns the tool's summary as a dict, and as its 'comparison' a structured array of shape (compared rows,) with the
    fields of COMPARISON_DTYPE but 'housing_temperature', of an arm a dict of them by the joint's short name.
    InputError, ParameterError.
    """
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "rows.csv" if arm is None else "rows")
        found = _run("follow", [recording],
                     {"joint": joint, "arm": arm, "mode": mode, "out": out, "bag": bag, "load": load,
                      "identified": identified, "topic": topic, "time_scale": time_scale, "force": force}, overlays)
        if arm is None:
            found["comparison"] = _rows(out)
        else:
            found["comparison"] = {line["joint"]: _rows(os.path.join(out, line["joint"] + ".csv"))
                                   for line in found["joints"]}
    return found


def checkup(arm: Path, out: Path, *, joint: Optional[str] = None, file_format: str = "csv",
            force: bool = False) -> Document:
    """Writes the motion in which an arm's faults are seen best, within its limits: the tool's checkup.

    arm: name in config/arms, or a file. out: file to write. joint: that alone. file_format: 'csv' (angles, rates,
    torques every 8 ms), 'urscript' or 'bag' (trajectory_msgs/JointTrajectory). force: overwrite.

    Returns a dict: 'duration' [s], 'moves', 'largest_speed' [rad/s], 'largest_torque' [N.m]. ParameterError,
    InputError.
    """
    return _run("checkup", [], {"arm": arm, "out": out, "joint": joint, "format": file_format, "force": force})


def _data_set(command: str, plan: Path, out: Path, jobs: Optional[int], shard: Optional[Tuple[int, int]],
              overlays: Overlays) -> Document:
    part = None if shard is None else f"{shard[0]}/{shard[1]}"
    return _run(command, [plan], {"out": out, "jobs": jobs, "shard": part}, overlays)


def sweep(plan: Path, out: Path, *, jobs: Optional[int] = None, shard: Optional[Tuple[int, int]] = None,
          overlays: Overlays = ()) -> Document:
    """Works off a plan of many runs, a labelled data set: the tool's sweep (docs/datasets.md).

    plan: YAML file. out: directory; runs that stand there finished are kept, so a call after Ctrl-C resumes. jobs: runs
    at the same time; None: one for each processor. shard: (i, n), only every n-th run, from run i on.

    Returns a dict: 'index' (path of index.csv, a line for each run with its file, HDF5 as a rule), 'runs', 'done',
    'present', 'failed', 'damaged'. InputError, ParameterError.
    """
    return _data_set("sweep", plan, out, jobs, shard, overlays)


def lives(plan: Path, out: Path, *, jobs: Optional[int] = None, shard: Optional[Tuple[int, int]] = None,
          overlays: Overlays = ()) -> Document:
    """Works off a plan of drives from new to their end, with a check-up every so often: the tool's lives.

    Arguments, result and errors as of sweep.
    """
    return _data_set("lives", plan, out, jobs, shard, overlays)
