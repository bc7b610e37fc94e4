# SPDX-License-Identifier: BSD-3-Clause
"""Functions on recordings and data sets. Each returns the JSON document of the tool's command with this name."""
import os
import sys
import warnings
from typing import TYPE_CHECKING, Any, Callable, Dict, List, Mapping, Optional, Sequence, Tuple, Union, cast

import numpy as np

from harmonic_joint_twin import _hjt

if TYPE_CHECKING:  # numpy.typing exists from numpy 1.20 on
    from numpy.typing import NDArray

Path = Union[str, "os.PathLike[str]"]
Value = Union[bool, int, float, str, Sequence[float]]
Overlays = Sequence[Union[Path, Mapping[str, Value]]]
Document = Dict[str, Any]
NOT_JUDGED = "not judged: "  # beginning of a notice, before the recording and the reason
Progress = Callable[[str, float], None]
Arrays = Union[Mapping[str, "NDArray[Any]"], "NDArray[np.void]"]  # columns by their names
Recording = Union[Path, Arrays]

__all__ = ["arm", "check", "checkup", "compare", "follow", "identify", "indicators", "lives", "remaining", "sweep",
           "trend"]


def _remark(notices: Sequence[str]) -> None:
    """Warns at the line that called this package, with one warning for all recordings of equal reason."""
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
    """List of the values; None gives an empty list, and a single value a list of one."""
    if values is None:
        return []
    return list(map(_plain, [values] if isinstance(values, (str, os.PathLike, Mapping)) else values))


# Arguments that may be a single value instead of a list.
LISTS = ("faults", "models", "overlays", "recordings", "reference")


def _arguments(given: Mapping[str, Any]) -> Dict[str, Any]:
    """Arguments for a function of _recordings, without those that are None."""
    return {name: _several(value) if name in LISTS else _plain(value) for name, value in given.items()
            if value is not None}


def _call(function: str, given: Mapping[str, Any]) -> Document:
    """Calls the function of _recordings with the arguments of the function of equal name here."""
    from harmonic_joint_twin import _recordings
    found, notices = getattr(_recordings, function)(_arguments(given))
    _remark(notices)
    assert isinstance(found, dict)
    return found


def check(recording: Recording, arm: Optional[str] = None, *, topic: Optional[str] = None, prefix: Optional[str] = None,
          suffix: Optional[str] = None, time_scale: Optional[float] = None, overlays: Overlays = (),
          progress: Optional[Progress] = None) -> Document:
    """Checks whether a recording of an arm is usable, like the tool's check (docs/arm.md).

    recording: as for identify, with all joints of an arm. arm: name in config/arms, or a file; None: the arm with these
    joint names, or for columns the arm that fits the currents. topic: topic of the telemetry in a bag. prefix, suffix:
    texts before and after the arm's joint names in the messages. time_scale: factor on the stamps [-]. overlays: files
    or dicts of parameters; later ones win. progress: as for identify.

    Returns a dict: 'usable', 'arm', 'findings', 'joints' (one dict per joint), 'next' (commands; empty for columns) and
    more. Raises InputError, ParameterError.
    """
    return _call("check", locals())


def identify(recording: Recording, *, joint: Optional[str] = None, arm: Optional[str] = None,
             out: Optional[Path] = None, train: Optional[Tuple[float, float]] = None,
             judge: Optional[Tuple[float, float]] = None, folds: Optional[int] = None, load: Optional[str] = None,
             identified: Optional[Path] = None, topic: Optional[str] = None, prefix: Optional[str] = None,
             suffix: Optional[str] = None, time_scale: Optional[float] = None, force: bool = False,
             overlays: Overlays = (), progress: Optional[Progress] = None) -> Document:
    """Identifies gain, friction, inertia and ripple of a joint, or of all joints of an arm, like the tool's identify.

    recording: bag, CSV of a UR controller, or columns: a structured array or a mapping of arrays with 'time' [s] or
    dates, shape (rows,), and, of shape (rows,) or for an arm (rows, joints), 'position' [rad], 'current' [A] and, if
    recorded, 'load' (at the output, > 0 resists positive motion) [N.m], 'velocity' [rad/s], 'temperature' [degC],
    'motor_angle' [rad].
    joint or arm: exactly one of the two. out: overlay to write, or for an arm a directory of overlays. train, judge:
    parts (from, to) for identification and for judgement [s]; None: the first third and the rest, for an arm all rows.
    folds: number of pieces for cross-validation, 2 ... 100. load (arm): 'arm' computes the loads from the motion of all
    joints, 'target_moment' uses the recorded ones. identified: directory of the arm's overlays from identify. topic,
    prefix, suffix, time_scale, overlays: as for check. force: overwrite existing files. progress: function that is
    called with the name of the step and its share 0 ... 1.

    Returns a dict: for a joint 'values' (name, key, unit, configured, value, half_width of the 95 % interval, refusal),
    'lines' of the ripple, 'judged' errors of the current [A]; for an arm 'joints' and 'payload'. Warns of values that
    cannot be identified. Raises InputError, ParameterError.
    """
    return _call("identify", locals())


def compare(recording: Recording, report: Optional[Path] = None, *, joint: Optional[str] = None,
            arm: Optional[str] = None, reference: Union[Path, Sequence[Path], None] = None, load: Optional[str] = None,
            identified: Optional[Path] = None, topic: Optional[str] = None, prefix: Optional[str] = None,
            suffix: Optional[str] = None, time_scale: Optional[float] = None, force: bool = False,
            overlays: Overlays = (), progress: Optional[Progress] = None) -> Document:
    """Compares a recorded joint or arm with its twin, like the tool's compare (docs/compare.md).

    report: directory for report.html, its figures and its data; None: no report. reference: earlier reports of the
    sound joint or arm. Other arguments as for identify.

    Returns the report's data as a dict: for a joint 'verdict' (a dict: 'level', 'reason', 'text', 'friction_factor' and
    more), 'friction_ratio', 'motion' and more; for an arm 'level', 'text', 'joints' (one dict per joint). Raises
    InputError, ParameterError.
    """
    return _call("compare", locals())


def trend(recordings: Union[Path, Sequence[Path]], *, joint: Optional[str] = None, arm: Optional[str] = None,
          reference: Union[Path, Sequence[Path], None] = None, out: Optional[Path] = None,
          report: Optional[Path] = None, load: Optional[str] = None, identified: Optional[Path] = None,
          topic: Optional[str] = None, prefix: Optional[str] = None, suffix: Optional[str] = None,
          time_scale: Optional[float] = None, force: bool = False, overlays: Overlays = (),
          progress: Optional[Progress] = None) -> Document:
    """Estimates the trend of friction of a joint or arm over the recordings of months, like the tool's trend.

    recordings: files, or directories of files. out: CSV file with a row for each recording. report: directory for
    report.html and its data. Other arguments as for compare.

    Returns a dict: 'level', 'text', 'joints' (one dict per joint: 'level', 'change' [-], 'slope' [1 / 1000 h, or the
    unit in 'slope_unit'] and their intervals), 'recordings' (one dict per recording, by date). Raises InputError,
    ParameterError.
    """
    return _call("trend", locals())


def follow(recording: Recording, *, joint: Optional[str] = None, arm: Optional[str] = None, mode: str = "motion",
           bag: Optional[Path] = None, load: Optional[str] = None, identified: Optional[Path] = None,
           topic: Optional[str] = None, prefix: Optional[str] = None, suffix: Optional[str] = None,
           time_scale: Optional[float] = None, force: bool = False, overlays: Overlays = (),
           progress: Optional[Progress] = None) -> Document:
    """Simulates a healthy joint or arm along a recording, like the tool's follow.

    mode: 'motion' predicts the current of the recorded motion, 'torque' the motion of the recorded current, 'observer'
    corrects the twin towards the recorded angles. bag: bag to write with the node's topics and the forces on every
    tooth. Other arguments as for identify. The class Tracker does this for blocks of rows.

    Returns the tool's summary as a dict. Its 'comparison' is a structured array of shape (compared rows,) with dtype
    COMPARISON_DTYPE, or for an arm a dict of such arrays by short joint names. Raises InputError, ParameterError.
    """
    return _call("follow", locals())


def arm(motion: Recording, arm: Path, *, faults: Sequence[str] = (), out: Optional[Path] = None,
        rate: Optional[float] = None, identified: Optional[Path] = None, force: bool = False, overlays: Overlays = (),
        progress: Optional[Progress] = None) -> Document:
    """Simulates an arm's drives, links and controller along set points, like the tool's arm (docs/arm_twin.md).

    motion: CSV of set points, program of moves (YAML), or columns: a structured array or a mapping of arrays with
    'time' [s], shape (rows,), and of shape (rows, joints) 'position' [rad] and, if known, 'velocity' [rad/s] and
    'acceleration' [rad/s^2]. arm: name in config/arms, or a file. faults: texts JOINT:KIND:SEVERITY[:PLACE[:ONSET]].
    out: FILE.csv in a controller's columns, FILE.bag of /joint_states, or FILE.h5 as a run of a data set. rate: rate of
    the rows [Hz]; None: rate of the arm's states. Other arguments as for identify.

    Returns a dict: 'joints' (one dict per joint: 'angle_error_rms', 'angle_error_max' [mrad], 'current_rms' [A]),
    'tool_error_rms', 'tool_error_max' [mm], 'energy_residual' [J], 'protective_stop' (None, or 'joint', 'reason',
    'time' [s]), 'feedback_limited' (number of times that the feedback of a joint reached its limit), 'solver_failures'
    and other counts of steps, and 'rows', a dict of arrays with the names of RTDE: 'timestamp' [s], shape (rows,),
    'target_q', 'target_qd', 'target_qdd', 'target_current' [A], 'target_moment' [N.m], 'actual_q', 'actual_qd',
    'actual_current', shape (rows, joints), 'target_TCP_pose', 'actual_TCP_pose' (position [m]), shape (rows, 3).
    Raises InputError, ParameterError.
    """
    return _call("arm", locals())


# Names of the columns in recordings of one joint, unless `columns` gives others.
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
    """Names of the recordings, the columns of those given as arrays, and the names of these columns."""
    is_column = getattr(recordings, "ndim", 0) == 1 and getattr(recordings.dtype, "names", None) is None
    listed = recordings.tolist() if is_column else recordings  # a column of a frame contains paths
    several = listed if isinstance(listed, (list, tuple)) else [listed]
    if not several:
        raise _hjt.InputError("recordings: at least one is required")
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
    """Computes and assesses the health indicators of one joint's recordings, like the tool's indicators
    (docs/health.md).

    recordings: one recording or several. A recording is a bag, a CSV file, a run of a data set (HDF5), or columns: a
    structured array as from Twin.run, a frame of pandas, or a mapping of arrays of shape (rows,): 'time' [s],
    'motor_torque' [N.m] or a signal that torque_scale converts to it, 'motor_angle_encoder' or 'output_angle_encoder'
    [rad] and, if recorded, 'motor_velocity_encoder' [rad/s], 'load_torque' [N.m], 'temperature' [degC], 'target_angle'
    [rad]. models: the twin's recording of each recording, whose indicators are subtracted. joint: joint in a robot's
    bag; None: the twin's topics. columns: other names of the columns 'time', 'motor_torque', 'motor_angle',
    'output_angle', 'motor_velocity', 'load_torque', 'temperature', 'target_angle'. baseline: file of the reference;
    None: a reference learned from the first windows. save_baseline: file for the learned reference. out: CSV of the
    windows. carry: whether the baseline is of another motion. force, overlays, progress: as for identify.

    Returns a dict: 'windows' (one dict per window: 'time', 'indicators', 'scores', 'assessment' ...), 'threshold',
    'assessment' of the last window. Warns of recordings that are not judged. Raises InputError, ParameterError.
    """
    return _call("indicators", {**locals(), **_signals(recordings, columns)})


def remaining(recordings: Union[Recording, Sequence[Recording]], *,
              hours: Union[None, float, Sequence[float]] = None,
              joint: Optional[str] = None, torque_scale: Optional[float] = None,
              columns: Optional[Mapping[str, str]] = None, baseline: Optional[Path] = None,
              duty: Optional[Path] = None, lost_motion_limit: Optional[float] = None,
              use_record: Optional[Path] = None, force: bool = False, overlays: Overlays = (),
              progress: Optional[Progress] = None) -> Document:
    """Forecasts the remaining life of a drive that is used as in the recordings, like the tool's remaining
    (docs/life.md).

    hours: past use of the drive, all of it as in the recordings, 1e-6 ... 1e7 [h]; None: the duration of the
    recordings; a sequence: the past use at each recording, ascending. baseline: reference of the new drive, which gives
    readings and assessments of wear. duty: duty cycle (CSV) that replaces the use in the recordings.
    lost_motion_limit: lost motion that ends the drive's use too, 1e-6 ... 0.1 [rad]. use_record: file for the use.
    Other arguments as for indicators.

    Returns a dict: 'hours' and 'remaining_q10', 'remaining_q50', 'remaining_q90' [h], 'turns', 'nearest' limit and its
    'used' [%], 'density', 'end_probability'; with a baseline also 'level', 'cause', 'wear_flank', 'wear_interface',
    'lost_motion' [rad]; at level OK also 'seen_from', the least detectable severity of each fault (None: not detectable
    at any severity), and 'blind_to', the faults that are not detectable. The laws of ageing are those of the
    configuration, never those of a run. Raises InputError, ParameterError.
    """
    hours = hours if hours is None or np.ndim(hours) > 0 else [cast(float, hours)]
    return _call("remaining", {**locals(), **_signals(recordings, columns)})


def checkup(arm: Path, out: Path, *, joint: Optional[str] = None, file_format: str = "csv",
            force: bool = False) -> Document:
    """Writes a motion within the limits of an arm that shows its faults best, like the tool's checkup.

    arm: name in config/arms, or a file. out: file to write. joint: the only joint that moves; None: all joints.
    file_format: 'csv' (angles, rates, torques every 8 ms), 'urscript' or 'bag' (trajectory_msgs/JointTrajectory).
    force: overwrite an existing file.

    Returns a dict: 'duration' [s], 'moves', 'largest_speed' [rad/s], 'largest_torque' [N.m]. Raises ParameterError,
    InputError.
    """
    return _call("checkup", locals())


def _shard(shard: Optional[Tuple[int, int]]) -> Optional[str]:
    return None if shard is None else "/".join(map(str, shard))


def sweep(plan: Path, out: Path, *, jobs: Optional[int] = None, shard: Optional[Tuple[int, int]] = None,
          overlays: Overlays = (), progress: Optional[Progress] = None) -> Document:
    """Simulates the runs of a plan to a labelled data set, like the tool's sweep (docs/datasets.md).

    plan: YAML file. out: directory of the data set; a call after Ctrl-C keeps its finished runs and simulates the rest.
    jobs: number of runs at the same time; None: one for each processor. shard: (i, n) for every n-th run, from run i
    on. overlays, progress: as for identify.

    Returns a dict: 'index' (path of index.csv, which has a line for each run with its file, HDF5 by default), and the
    numbers of runs 'runs', 'done', 'present', 'failed', 'damaged'. Raises InputError, ParameterError.
    """
    return _call("sweep", {**locals(), "shard": _shard(shard)})


def lives(plan: Path, out: Path, *, jobs: Optional[int] = None, shard: Optional[Tuple[int, int]] = None,
          overlays: Overlays = (), progress: Optional[Progress] = None) -> Document:
    """Simulates drives of a plan from new to the end of their lives, with regular check-ups, like the tool's lives.

    Arguments, result and errors are those of sweep.
    """
    return _call("lives", {**locals(), "shard": _shard(shard)})
