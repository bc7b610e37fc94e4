# SPDX-License-Identifier: BSD-3-Clause
"""Functions on recordings and data sets, as the tool's commands: each returns what the command prints as JSON."""
import os
import sys
import warnings
from typing import TYPE_CHECKING, Any, Callable, Dict, List, Mapping, Optional, Sequence, Tuple, Union, cast

import numpy as np

from harmonic_joint_twin import _hjt

if TYPE_CHECKING:  # numpy has it from 1.20 on
    from numpy.typing import NDArray

Path = Union[str, "os.PathLike[str]"]
Value = Union[bool, int, float, str, Sequence[float]]
Overlays = Sequence[Union[Path, Mapping[str, Value]]]
Document = Dict[str, Any]
NOT_JUDGED = "not judged: "  # before a recording and the reason
Progress = Callable[[str, float], None]
Arrays = Union[Mapping[str, "NDArray[Any]"], "NDArray[np.void]"]  # columns by their names
Recording = Union[Path, Arrays]

__all__ = ["arm", "check", "checkup", "compare", "follow", "identify", "indicators", "lives", "remaining", "sweep",
           "trend"]


def _remark(notices: Sequence[str]) -> None:
    """Warns at the line outside of this package, once for all recordings that are not judged for one reason."""
    package = __name__.partition(".")[0] + "."
    level = 1
    while f"{sys._getframe(level).f_globals.get('__name__')}.".startswith(package):
        level += 1
    reasons: Dict[str, List[str]] = {}
    for notice in notices:
        recording, colon, reason = notice[len(NOT_JUDGED):].partition(": ")
        is_of_one = notice.startswith(NOT_JUDGED) and colon
        reasons.setdefault(reason if is_of_one else notice, []).append(recording if is_of_one else "")
    for reason, [first, *others] in reasons.items():
        more = f" and {len(others)} more" if others else ""
        warnings.warn(f"{NOT_JUDGED}{first}{more}: {reason}" if first else reason, RuntimeWarning, stacklevel=level + 1)


def _plain(value: Any) -> Any:
    return os.fspath(value) if isinstance(value, os.PathLike) else value


def _several(values: Any) -> List[Any]:
    """None is an empty list, one by itself a list of one."""
    if values is None:
        return []
    return list(map(_plain, [values] if isinstance(values, (str, os.PathLike, Mapping)) else values))


# Arguments for which one by itself may stand.
LISTS = ("faults", "models", "overlays", "recordings", "reference")


def _arguments(given: Mapping[str, Any]) -> Dict[str, Any]:
    """Of a function, as _recordings takes them: those that are None are left out."""
    return {name: _several(value) if name in LISTS else _plain(value) for name, value in given.items()
            if value is not None}


def _call(function: str, given: Mapping[str, Any]) -> Document:
    """Calls a function of _recordings with the arguments of the one here."""
    from harmonic_joint_twin import _recordings
    found, notices = getattr(_recordings, function)(_arguments(given))
    _remark(notices)
    assert isinstance(found, dict)
    return found


def check(recording: Recording, arm: Optional[str] = None, *, topic: Optional[str] = None, prefix: Optional[str] = None,
          suffix: Optional[str] = None, time_scale: Optional[float] = None, overlays: Overlays = (),
          progress: Optional[Progress] = None) -> Document:
    """What of an arm's recording is usable and what does not fit: the tool's check (docs/arm.md).

    recording: as of identify, of all joints of an arm. arm: name in config/arms, or a file; None: found by the joints'
    names, of columns by the currents. topic: of the telemetry in a bag. prefix, suffix: around the arm's
    names of the joints in the messages. time_scale: factor on the stamps [-]. overlays: files or dicts of parameters,
    later wins. progress: as of identify.

    Returns a dict: 'usable', 'arm', 'findings', 'joints' (one dict each), 'next' (commands, none of columns) and more.
    InputError, ParameterError.
    """
    return _call("check", locals())


def identify(recording: Recording, *, joint: Optional[str] = None, arm: Optional[str] = None,
             out: Optional[Path] = None, train: Optional[Tuple[float, float]] = None,
             judge: Optional[Tuple[float, float]] = None, folds: Optional[int] = None, load: Optional[str] = None,
             identified: Optional[Path] = None, topic: Optional[str] = None, prefix: Optional[str] = None,
             suffix: Optional[str] = None, time_scale: Optional[float] = None, force: bool = False,
             overlays: Overlays = (), progress: Optional[Progress] = None) -> Document:
    """Gain, friction, inertia and ripple of a joint, or of all joints of an arm, from a recording: the tool's identify.

    recording: bag, CSV of a UR controller, or columns: a structured array or a mapping of arrays with 'time' [s] or
    dates, shape (rows,), and, of shape (rows,) or for an arm (rows, joints), 'position' [rad], 'current' [A] and, if
    recorded, 'load' (at the output, > 0 resists positive motion) [N.m], 'velocity' [rad/s], 'temperature' [degC],
    'motor_angle' [rad].
    joint or arm: one of them. out: the overlay to write, of an arm a directory. train, judge: (from, to), the parts to
    identify and to judge on [s]; None: the first third and the rest, of an arm all. folds: pieces to leave out in turn,
    2 ... 100. load (arm): 'arm', from the motion of all joints, or 'target_moment', as recorded. identified: directory
    of an arm's overlays. topic, prefix, suffix, time_scale, overlays: as of check. force: overwrite. progress: called
    with the name of the step and 0 ... 1.

    Returns a dict: of a joint 'values' (name, key, unit, configured, value, half_width: 95 %, refusal), 'lines' of the
    ripple, 'judged' errors of the current [A]; of an arm 'joints' and 'payload'. What is not identifiable is warned of.
    InputError, ParameterError.
    """
    return _call("identify", locals())


def compare(recording: Recording, report: Optional[Path] = None, *, joint: Optional[str] = None,
            arm: Optional[str] = None, reference: Union[Path, Sequence[Path], None] = None, load: Optional[str] = None,
            identified: Optional[Path] = None, topic: Optional[str] = None, prefix: Optional[str] = None,
            suffix: Optional[str] = None, time_scale: Optional[float] = None, force: bool = False,
            overlays: Overlays = (), progress: Optional[Progress] = None) -> Document:
    """Verdict on a recorded joint or arm beside its twin: the tool's compare (docs/compare.md).

    report: directory that gets report.html, its figures and its data; None: nothing is written. reference: earlier
    reports, in sound condition. Others as of identify.

    Returns the report's data as a dict: of a joint 'verdict' (a dict: 'level', 'reason', 'text', 'friction_factor' and
    more), 'friction_ratio', 'motion' and more; of an arm 'level', 'text', 'joints' (one dict each). InputError,
    ParameterError.
    """
    return _call("compare", locals())


def trend(recordings: Union[Path, Sequence[Path]], *, joint: Optional[str] = None, arm: Optional[str] = None,
          reference: Union[Path, Sequence[Path], None] = None, out: Optional[Path] = None,
          report: Optional[Path] = None, load: Optional[str] = None, identified: Optional[Path] = None,
          topic: Optional[str] = None, prefix: Optional[str] = None, suffix: Optional[str] = None,
          time_scale: Optional[float] = None, force: bool = False, overlays: Overlays = (),
          progress: Optional[Progress] = None) -> Document:
    """Friction of a joint, or of all joints of an arm, over the recordings of months: the tool's trend.

    recordings: files, or folders of them. out: CSV file with a row for each recording. report: directory that gets
    report.html and its data. Others as of compare.

    Returns a dict: 'level', 'text', 'joints' (one dict each: 'level', 'change', 'slope' and their intervals [-],
    'slope' in 1 / 1000 h or what 'slope_unit' says), 'recordings' (one dict each, by date). InputError, ParameterError.
    """
    return _call("trend", locals())


def follow(recording: Recording, *, joint: Optional[str] = None, arm: Optional[str] = None, mode: str = "motion",
           bag: Optional[Path] = None, load: Optional[str] = None, identified: Optional[Path] = None,
           topic: Optional[str] = None, prefix: Optional[str] = None, suffix: Optional[str] = None,
           time_scale: Optional[float] = None, force: bool = False, overlays: Overlays = (),
           progress: Optional[Progress] = None) -> Document:
    """A healthy joint, or arm, beside a recording: the tool's follow.

    mode: 'motion' predicts the current of the recorded motion, 'torque' the motion of the recorded current, 'observer'
    corrects the twin towards the recorded angles. bag: bag to write with the node's topics and the forces on every
    tooth. Others as of identify. Block by block there is Tracker.

    Returns the tool's summary as a dict, and as its 'comparison' a structured array of shape (compared rows,) with
    dtype COMPARISON_DTYPE, of an arm a dict of them by the joint's short name. InputError, ParameterError.
    """
    return _call("follow", locals())


def arm(motion: Recording, arm: Path, *, faults: Sequence[str] = (), out: Optional[Path] = None,
        rate: Optional[float] = None, identified: Optional[Path] = None, force: bool = False, overlays: Overlays = (),
        progress: Optional[Progress] = None) -> Document:
    """A whole arm in closed loop, drives, links and controller, along set points: the tool's arm (docs/arm_twin.md).

    motion: CSV of set points, program of moves (YAML), or columns: a structured array or a mapping of arrays with
    'time' [s], shape (rows,), and of shape (rows, joints) 'position' [rad] and, if known, 'velocity' [rad/s] and
    'acceleration' [rad/s^2]. arm: name in config/arms, or a file. faults: each JOINT:KIND:SEVERITY[:PLACE[:ONSET]].
    out: FILE.csv in a controller's columns, FILE.bag of /joint_states, or FILE.h5 as a run of a data set. rate: of the
    rows [Hz]; None: that of the arm's states. Others as of identify.

    Returns a dict: 'joints' (one dict each: 'angle_error_rms', 'angle_error_max' [mrad], 'current_rms' [A]),
    'tool_error_rms', 'tool_error_max' [mm], 'energy_residual' [J], 'protective_stop' (None, or 'joint',
    'reason', 'time' [s]), 'feedback_limited' (controls of a joint at the limit of its feedback), 'solver_failures' and
    other counts of steps, and as its 'rows' a dict of arrays as RTDE names them: 'timestamp' [s], shape (rows,),
    'target_q', 'target_qd', 'target_qdd', 'target_current' [A], 'target_moment' [N.m], 'actual_q', 'actual_qd',
    'actual_current', shape (rows, joints), 'target_TCP_pose', 'actual_TCP_pose' (position [m]), shape (rows, 3).
    InputError, ParameterError.
    """
    return _call("arm", locals())


# Columns that recordings of one joint are read from, where `columns` names no other.
SIGNALS = ("time", "motor_torque_reading", "motor_torque", "motor_angle_encoder", "output_angle_encoder",
           "motor_velocity_encoder", "load_torque", "housing_temperature", "temperature", "target_angle")


def _numbers(column: Any) -> "Optional[NDArray[np.float64]]":
    array = np.asarray(column)
    if array.ndim != 1 or array.dtype.kind not in "biufOSU":
        return None
    try:
        return array.astype(np.float64)
    except (TypeError, ValueError):
        return None


def _columns(recording: Any, what: str = "recording",
             used: Sequence[str] = SIGNALS) -> Dict[str, "NDArray[np.float64]"]:
    if not (hasattr(recording, "keys") or getattr(getattr(recording, "dtype", None), "names", None)):
        raise _hjt.InputError(f"{what} = {recording!r:.60} must have columns by name: a structured array, a frame "
                              "or a mapping of arrays")
    names = recording.dtype.names if isinstance(recording, np.ndarray) else list(recording)
    arrays = {str(name): _numbers(recording[name]) for name in names}
    for name, array in arrays.items():
        if array is None and name in used:
            raise _hjt.InputError(f"{what}: column '{name}' must be numbers of shape (rows,), not "
                                  f"{np.asarray(recording[name])!r:.60}")
    return {name: array for name, array in arrays.items() if array is not None}


def _names(columns: Optional[Mapping[str, str]]) -> Optional[Dict[str, str]]:
    if columns is not None and not isinstance(columns, Mapping):
        raise _hjt.InputError(f"columns = {columns!r:.60} must be a mapping of signals to the names of their columns")
    return dict(columns) if columns else None


def _signals(recordings: Any, columns: Optional[Mapping[str, str]]) -> Dict[str, Any]:
    """Names of the recordings, the columns of those at hand, and the names of these columns."""
    is_column = getattr(recordings, "ndim", 0) == 1 and getattr(recordings.dtype, "names", None) is None
    listed = recordings.tolist() if is_column else recordings  # of a frame, with paths
    several = listed if isinstance(listed, (list, tuple)) else [listed]
    if not several:
        raise _hjt.InputError("recordings: there is none")
    names: List[str] = []
    at_hand = {}
    for place, recording in enumerate(several):
        if isinstance(recording, (str, os.PathLike)):
            names.append(os.fspath(recording))
        else:
            names.append(f"recordings[{place}]")
            used = (*SIGNALS, *(_names(columns) or {}).values())
            at_hand[names[-1]] = _columns(recording, names[-1], used)
    return {"recordings": names, "at_hand": at_hand, "columns": _names(columns)}


def indicators(recordings: Union[Recording, Sequence[Recording]], *, models: Sequence[Path] = (),
               joint: Optional[str] = None, torque_scale: Optional[float] = None,
               columns: Optional[Mapping[str, str]] = None, baseline: Optional[Path] = None,
               save_baseline: Optional[Path] = None, out: Optional[Path] = None, carry: bool = False,
               force: bool = False, overlays: Overlays = (), progress: Optional[Progress] = None) -> Document:
    """Health indicators of recordings of one joint and their assessment: the tool's indicators (docs/health.md).

    recordings: one or several: bag, CSV, run of a data set (HDF5), or columns: a structured array, as of Twin.run, a
    frame of pandas, or a mapping of arrays of shape (rows,): 'time' [s], 'motor_torque' [N.m], or the signal that
    torque_scale makes one, 'motor_angle_encoder' or 'output_angle_encoder' [rad] and, if recorded,
    'motor_velocity_encoder' [rad/s], 'load_torque' [N.m], 'temperature' [degC], 'target_angle' [rad]. models: the
    twin's own recording of each, to be subtracted. joint: of a robot's bag; None: the twin's topics. columns: names of
    the columns that hold 'time', 'motor_torque', 'motor_angle', 'output_angle', 'motor_velocity', 'load_torque',
    'temperature', 'target_angle', where they are others. baseline: the reference; None: learned from the first windows.
    save_baseline: file for the learned one. out: CSV of the windows. carry: the baseline is of another motion. force,
    overlays, progress: as of identify.

    Returns a dict: 'windows' (one dict each: 'time', 'indicators', 'scores', 'assessment' ...), 'threshold',
    'assessment' of the last. Recordings that are not judged are warned of. InputError, ParameterError.
    """
    return _call("indicators", {**locals(), **_signals(recordings, columns)})


def remaining(recordings: Union[Recording, Sequence[Recording]], *,
              hours: Union[None, float, Sequence[float]] = None,
              joint: Optional[str] = None, torque_scale: Optional[float] = None,
              columns: Optional[Mapping[str, str]] = None, baseline: Optional[Path] = None,
              duty: Optional[Path] = None, lost_motion_limit: Optional[float] = None,
              use_record: Optional[Path] = None, force: bool = False, overlays: Overlays = (),
              progress: Optional[Progress] = None) -> Document:
    """Use of a recorded joint, and how long a drive lasts that is used so: the tool's remaining (docs/life.md).

    hours: use that the drive has behind it, all like the recordings, 1e-6 ... 1e7 [h]; None: theirs; a sequence: at
    each recording, ascending. baseline: reference of the new drive, readings and assessments by it tell of wear. duty:
    duty cycle (CSV) in place of the recordings' use. lost_motion_limit: that ends the drive's use too, 1e-6 ... 0.1
    [rad]. use_record: file for the use. Others as of indicators.

    Returns a dict: 'hours' and 'remaining_q10', 'remaining_q50', 'remaining_q90' [h], 'turns', 'nearest' limit and its
    'used' [%], 'density', 'end_probability', with a baseline 'level', 'cause', 'wear_flank', 'wear_interface',
    'lost_motion' [rad], and at level OK 'seen_from', the least severity of each fault that would have shown, None:
    none would, and 'blind_to', those faults in words. Laws of ageing are those of the configuration, never of a run.
    InputError, ParameterError.
    """
    hours = hours if hours is None or np.ndim(hours) > 0 else [cast(float, hours)]
    return _call("remaining", {**locals(), **_signals(recordings, columns)})


def checkup(arm: Path, out: Path, *, joint: Optional[str] = None, file_format: str = "csv",
            force: bool = False) -> Document:
    """Writes the motion in which an arm's faults are seen best, within its limits: the tool's checkup.

    arm: name in config/arms, or a file. out: file to write. joint: that alone. file_format: 'csv' (angles, rates,
    torques every 8 ms), 'urscript' or 'bag' (trajectory_msgs/JointTrajectory). force: overwrite.

    Returns a dict: 'duration' [s], 'moves', 'largest_speed' [rad/s], 'largest_torque' [N.m]. ParameterError,
    InputError.
    """
    return _call("checkup", locals())


def _shard(shard: Optional[Tuple[int, int]]) -> Optional[str]:
    return None if shard is None else "/".join(map(str, shard))


def sweep(plan: Path, out: Path, *, jobs: Optional[int] = None, shard: Optional[Tuple[int, int]] = None,
          overlays: Overlays = (), progress: Optional[Progress] = None) -> Document:
    """Works off a plan of many runs, a labelled data set: the tool's sweep (docs/datasets.md).

    plan: YAML file. out: directory; runs that stand there finished are kept, so a call after Ctrl-C resumes. jobs: runs
    at the same time; None: one for each processor. shard: (i, n), only every n-th run, from run i on. overlays,
    progress: as of identify.

    Returns a dict: 'index' (path of index.csv, a line for each run with its file, HDF5 as a rule), 'runs', 'done',
    'present', 'failed', 'damaged'. InputError, ParameterError.
    """
    return _call("sweep", {**locals(), "shard": _shard(shard)})


def lives(plan: Path, out: Path, *, jobs: Optional[int] = None, shard: Optional[Tuple[int, int]] = None,
          overlays: Overlays = (), progress: Optional[Progress] = None) -> Document:
    """Works off a plan of drives from new to their end, with a check-up every so often: the tool's lives.

    Arguments, result and errors as of sweep.
    """
    return _call("lives", {**locals(), "shard": _shard(shard)})
