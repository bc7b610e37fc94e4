# SPDX-License-Identifier: BSD-3-Clause
"""Data sets and verdicts as frames of pandas, which is loaded when the first of these functions runs."""
import hashlib
import importlib
import json
import os
from typing import TYPE_CHECKING, Any, Dict, List, Mapping, Optional, Sequence, Union

import numpy as np

from harmonic_joint_twin import _commands, _hjt
from harmonic_joint_twin._commands import Arrays, Document, Overlays, Path, Progress, Recording

if TYPE_CHECKING:
    from numpy.typing import NDArray

Frame = Any  # pandas.DataFrame; pandas has no types

__all__ = ["as_factorynet", "assess", "drive_fault", "load", "reference", "write_card", "write_cmapss"]

# Parameters that judge a check-up as a single window (docs/health.md).
CHECK_UP = {"indicators.evidence_windows": 1, "indicators.false_alarm_rate": 1e-3}
ALL_WINDOWS = {"indicators.baseline_windows": 10000}
DIRECTION_ROWS = 5  # rows of the motor's direction, so that a count of noise gives no direction
# Columns of a group that are labels. All columns of the index are labels or settings.
TRUTH = ("severity", "window_severity")
# Names of FactoryNet's columns, for an arm without the number of the joint at the end. Source: schema.json, version
# 1.0, of huggingface.co/datasets/Forgis/factorynet-hackathon; for setpoint_acc, _current, _torque and _cartesian its
# data of a UR3e.
FACTORYNET = {"time": "timestamp", "class": "fault_label", "speed_reference": "setpoint_vel_0",
              "output_angle_encoder": "feedback_pos_0", "output_velocity_encoder": "feedback_vel_0",
              "motor_torque_reading": "effort_torque_0", "housing_temperature": "ctx_temp_0"}
FACTORYNET_ARM = {"target_q": "setpoint_pos", "target_qd": "setpoint_vel", "target_qdd": "setpoint_acc",
                  "target_current": "setpoint_current", "target_moment": "setpoint_torque",
                  "target_TCP_pose": "setpoint_pos_cartesian", "actual_q": "feedback_pos", "actual_qd": "feedback_vel",
                  "actual_current": "effort_current", "actual_TCP_pose": "feedback_pos_cartesian"}


def _group(file: str, group: str, is_arm: bool, wanted: Optional[Sequence[str]]) -> Dict[str, "NDArray[Any]"]:
    """Columns of a group with one number per row. wanted: names of the columns; None: all."""
    h5py = importlib.import_module("h5py")
    with h5py.File(file, "r") as run:
        groups = [name for name, item in run.items() if isinstance(item, h5py.Group) and name != "parameters"]
        if group not in groups:
            raise _hjt.InputError(f"{file} has no group '{group}'; it holds {', '.join(groups)}")
        found: Dict[str, Any] = {name: (column, None) for name, column in run[group].items() if column.ndim == 1}
        if is_arm:
            found.update({f"{name}_{i}": (column, i) for name, column in run[group].items() if column.ndim == 2
                          for i in range(column.shape[1])})
        return {name: column[:] if i is None else column[:, i] for name, (column, i) in found.items()
                if wanted is None or name in wanted}


def load(folder: Path, group: Optional[str] = "indicators", *, columns: Optional[Sequence[str]] = None) -> Frame:
    """Loads a data set of sweep or lives as one frame.

    folder: directory of the data set. group: group in its files, 'indicators' or a name in the plan; None: only the
    index. columns: names of the columns of group and index to be read, in addition to 'file'; None: all.

    Returns a pandas.DataFrame with a row for each sample or window of the group, or without a group for each run. Its
    columns are those of the group with one number per row, those of the run in index.csv, and 'file', the path. Whole
    arms have a column for each joint from the base on, such as 'actual_q_0' and 'severity_0'. attrs["features"] names
    the columns that can be measured at a joint; attrs["labels"] names all others, which are settings and labels. The
    frame contains no failed runs. Files that cannot be read are skipped with a warning. Raises InputError.
    """
    pandas = importlib.import_module("pandas")
    path = os.path.join(os.fspath(folder), "index.csv")
    if not os.path.exists(path):
        raise _hjt.InputError(f"{path} does not exist, so that this is no data set or its sweep has not ended")
    index = pandas.read_csv(path)
    missing = int((index["status"] == "missing").sum())
    _commands._remark([f"{folder} is unfinished: {missing} of {len(index)} runs are missing; the same sweep again "
                       "simulates them"] if missing else [])
    index = index[index["status"] == "ok"].reset_index(drop=True)
    index["file"] = [os.path.join(os.fspath(folder), file) for file in index["file"]]
    if group is None:
        return _chosen(index, columns, index.columns)
    parts, unread = [], []
    for file in index["file"]:
        if not file.endswith(".h5"):
            raise _hjt.InputError(f"{file} is no HDF5 file; of a data set of bags only the index can be loaded, with "
                                  "group=None")
        try:
            part = pandas.DataFrame(_group(file, group, "fault_joint" in index, columns))
            if not len(part.columns) and columns is not None:
                raise _hjt.InputError(f"columns: group '{group}' has none of {', '.join(columns)}")
            part.insert(0, "file", file)
            parts.append(part)
        except OSError as error:
            unread.append(f"not read: {file}: {error}; the same sweep again replaces it")
    if unread and not parts:
        raise _hjt.InputError(unread[0])
    _commands._remark(unread)
    if not any(map(len, parts)):
        raise _hjt.InputError(f"{folder}: no run contains a row of '{group}'; either a window "
                              "(indicators.window_turns, window_time) is longer than a run minus record.start, or "
                              "every run has failed")
    of_group = pandas.concat(parts, ignore_index=True)
    of_index = [name for name in index if columns is None or name in columns or name == "file"]
    return _chosen(of_group.merge(index[of_index], on="file"), columns, index.columns)


def _chosen(frame: Frame, columns: Optional[Sequence[str]], of_index: Sequence[str]) -> Frame:
    """Frame of 'file' and the chosen columns, with attrs that name features and labels."""
    if columns is not None:
        missing = [name for name in columns if name not in frame]
        if missing:
            raise _hjt.InputError(f"columns: there is no '{missing[0]}'; load() without columns returns all")
        frame = frame[["file", *(name for name in columns if name != "file")]].copy()
    labels = [name for name in frame if name in of_index or name in TRUTH or name.startswith("severity_")]
    frame.attrs.update(labels=labels, features=[name for name in frame if name not in labels])
    return frame


def drive_fault(recording: Arrays, kind: str, size: float, *, onset: float = 0.0,
                ramp: float = 0.0) -> Dict[str, "NDArray[np.float64]"]:
    """Adds a fault of brake, sensors or motor to a recording of a joint (docs/faults.md).

    recording: columns as for indicators, for example from load(folder, 'signals') or Twin.run. kind and size:
    'brake_drag' with the torque at the motor [N.m], 'lost_counts' with the angle that the motor encoder loses in each
    forward turn [rad], 'encoder_offset' with the offset at the output [rad], 'current_gain' with the relative error of
    the gain [-], 'weak_magnets' with the lost share of the flux [-]. onset: time of the fault's begin [s]. ramp: time
    of the linear growth from the onset to the full size [s]; 0: at once.

    Returns a dict of the columns. They do not contain the response of a controller to the fault. Raises InputError.
    """
    columns = _commands._columns(recording)
    needed = {"brake_drag": ("motor_torque_reading", "motor_angle_encoder"), "lost_counts": ("motor_angle_encoder",),
              "encoder_offset": ("output_angle_encoder",), "current_gain": ("motor_torque_reading",),
              "weak_magnets": ("motor_torque_reading",)}
    if kind not in needed:
        raise _hjt.InputError(f"kind = '{kind}' must be one of {', '.join(needed)}")
    for name in ("time", *needed[kind]):
        if name not in columns:
            raise _hjt.InputError(f"{kind}: column '{name}' is missing")
    if not np.isfinite([size, onset, ramp]).all() or ramp < 0.0 or kind == "weak_magnets" and not 0.0 <= size < 1.0:
        raise _hjt.InputError(f"{kind}: size = {size}, onset = {onset} [s], ramp = {ramp} [s] must be finite, ramp at "
                              "least 0, and the size of weak_magnets 0 ... below 1")
    since = columns["time"] - onset
    now = size * (np.clip(since / ramp, 0.0, 1.0) if ramp > 0.0 else (since >= 0.0))
    if kind == "encoder_offset":
        columns["output_angle_encoder"] = columns["output_angle_encoder"] + now
        return columns
    if kind in ("current_gain", "weak_magnets"):
        factor = 1.0 + now if kind == "current_gain" else 1.0 / (1.0 - now)
        columns["motor_torque_reading"] = columns["motor_torque_reading"] * factor
        return columns
    travel = np.diff(columns["motor_angle_encoder"], prepend=columns["motor_angle_encoder"][:1])
    if kind == "lost_counts":
        missed = now * np.maximum(travel, 0.0) / (2.0 * np.pi)
        columns["motor_angle_encoder"] = columns["motor_angle_encoder"] - np.cumsum(missed)
        columns.pop("motor_velocity_encoder", None)  # the velocity would not fit the changed angle
    else:
        speed = np.convolve(travel, np.ones(DIRECTION_ROWS), "same")
        columns["motor_torque_reading"] = columns["motor_torque_reading"] + now * np.sign(speed)
    return columns


Recordings = Union[Recording, Sequence[Recording]]


def _expanded(recordings: Any) -> Any:
    """Files of a data set whose directory is given; other recordings do not change."""
    is_folder = isinstance(recordings, (str, os.PathLike)) and os.path.isdir(recordings)
    return list(load(recordings, group=None)["file"]) if is_folder else recordings


def reference(recordings: Recordings, out: Path, *, joint: Optional[str] = None, torque_scale: Optional[float] = None,
              columns: Optional[Mapping[str, str]] = None, force: bool = False, overlays: Overlays = (),
              progress: Optional[Progress] = None) -> Frame:
    """Learns the reference of a sound joint's indicators from all windows of its recordings.

    recordings: as for indicators, or a column of a frame with their paths, or the directory of a data set with sound
    runs only. out: file to write, for assess and for the tool's --baseline. Other arguments as for indicators.

    Returns a pandas.DataFrame with a row for each window: 'recording', operating point and indicators. Raises
    InputError, ParameterError.
    """
    pandas = importlib.import_module("pandas")
    found = _commands.indicators(_expanded(recordings), joint=joint, torque_scale=torque_scale, columns=columns,
                                 save_baseline=out, force=force, progress=progress,
                                 overlays=[ALL_WINDOWS, *_commands._several(overlays)])
    points = ("recording", "time", "turns", "speed", "direction", "load", "temperature")
    return pandas.DataFrame([{**{name: window[name] for name in points}, **window["indicators"]}
                             for window in found["windows"]])


def _verdict(recording: str, windows: List[Dict[str, Any]], is_read: bool) -> Dict[str, Any]:
    """Verdict of the last assessed window, or state of the last window if none is assessed."""
    row: Dict[str, Any] = {"recording": recording, "windows": len(windows),
                           "state": "no whole window" if is_read else "not read", "level": None}
    if not windows:
        return row
    judged = [window for window in windows if window["assessment"]["state"] == "assessed"]
    last = (judged or windows)[-1]
    said = last["assessment"]
    row.update(last["strongest"] or {})
    row.update(state=said["state"], score=said["largest_score"])
    if judged:
        row.update({name: said[name] for name in ("level", "cause", "confidence", "severity", "severity_deviation")})
        row["alternatives"] = ", ".join(said["alternatives"])
        row["blind_to"] = ", ".join(cause for cause, from_ in (last["seen_from"] or {}).items() if from_ is None)
    return row


def assess(recordings: Recordings, reference: Path, *, check_up: bool = False, joint: Optional[str] = None,
           torque_scale: Optional[float] = None, columns: Optional[Mapping[str, str]] = None, overlays: Overlays = (),
           progress: Optional[Progress] = None) -> Frame:
    """Assesses each recording of a joint with the joint's reference. A run of a data set has its own parameters.

    recordings: as for reference. reference: file that the function reference wrote. check_up: True: each recording is a
    check-up, of which a single window is judged; False: each is a part of normal work, of which ten windows are judged
    together. Other arguments as for indicators.

    Returns a pandas.DataFrame with a row for each recording: 'recording', 'windows', 'state' (with 'assessed' the other
    columns are valid), 'level' ('OK', 'WARN', 'ERROR'), 'cause', 'confidence', 'severity', 'severity_deviation',
    'alternatives', 'score' over the threshold, 'indicator' with the largest deviation, this deviation in 'spreads' and
    in 'percent', and at level OK 'blind_to', the faults that are not detectable at any severity. Warns of recordings
    that are not judged or not readable. Raises InputError, ParameterError.
    """
    pandas = importlib.import_module("pandas")
    expanded = _expanded(recordings)
    found = _commands.indicators(expanded, baseline=reference, joint=joint, torque_scale=torque_scale, columns=columns,
                                 overlays=[*([CHECK_UP] if check_up else []), *_commands._several(overlays)],
                                 progress=progress)
    names = _commands._signals(expanded, columns)["recordings"]
    windows: Dict[str, List[Dict[str, Any]]] = {name: [] for name in names}
    for window in found["windows"]:
        windows[window["recording"]].append(window)
    strongest = {"indicator": None, "spreads": float("nan"), "percent": float("nan")}
    order = ["recording", "windows", "state", "level", "cause", "confidence", "severity", "severity_deviation",
             "alternatives", "score", *strongest, "blind_to"]
    unread = [each["recording"] for each in found["unread"]]
    return pandas.DataFrame([_verdict(name, several, name not in unread) for name, several in windows.items()],
                            columns=order)


def write_cmapss(folder: Path, out: Path, *, duty: Optional[str] = None, seed: int = 1) -> Document:
    """Writes a data set of lives in the format of C-MAPSS, with the files train.csv, test.csv and RUL.csv.

    folder: data set of lives with indicators. out: directory of the files, which is made if it does not exist. duty:
    duty cycle of the recordings; None: the only one of the data set. seed: seed for the last check-ups of the test
    drives.

    A row has 'unit' (drive), 'cycle' (check-up, from 1 on), 'hours', settings (speed, load, temperature of the windows)
    and the means, over the windows, of the indicators that every check-up has. The files contain no drives that are
    still in use. train.csv has the drives of the split 'train' up to the end of their lives. test.csv has the other
    drives, each up to one of its check-ups, and RUL.csv their remaining hours.

    Returns a dict: 'train', 'test' (numbers of drives), 'indicators' (names). Raises InputError.
    """
    pandas = importlib.import_module("pandas")
    frame = load(folder)
    if "life.drive" not in frame:
        raise _hjt.InputError(f"{folder} contains no lives")
    duties = sorted(set(frame["duty"]))
    if duty is None and len(duties) > 1 or duty is not None and duty not in duties:
        raise _hjt.InputError(f"duty = {duty} must be one of {', '.join(duties)}")
    frame = frame[(frame["duty"] == (duty or duties[0])) & (frame["life.cause"] != "still in use")]
    window = [name for name in frame if name.startswith("window_")]
    first, last = list(frame).index("run"), list(frame).index("file")
    names = [name for name in list(frame)[last + 1:first] if name not in window]
    life = {"life.drive": "unit", "life.hours": "hours", "life.remaining": "RUL", "life.split": "split"}
    settings = {"window_speed": "speed", "window_load": "load", "window_temperature": "temperature"}
    rows = frame.groupby(list(life), as_index=False)[[*settings, *names]].mean().rename(columns={**life, **settings})
    names = [name for name in names if rows[name].notna().all()]
    rows = rows.sort_values(["unit", "hours"])
    rows.insert(1, "cycle", rows.groupby("unit").cumcount() + 1)
    kept = ["unit", "cycle", "hours", *settings.values(), *names]
    train, test = rows[rows["split"] == "train"], rows[rows["split"] != "train"]
    draw = np.random.RandomState(seed)
    parts = [drive.iloc[:draw.randint(1, len(drive) + 1)] for _, drive in test.groupby("unit")]
    cut = pandas.concat(parts) if parts else test
    os.makedirs(out, exist_ok=True)
    for name, table in (("train", train[kept]), ("test", cut[kept]),
                        ("RUL", cut.groupby("unit", as_index=False).last()[["unit", "RUL"]])):
        table.to_csv(os.path.join(out, name + ".csv"), index=False)
    return {"train": int(train["unit"].nunique()), "test": int(cut["unit"].nunique()), "indicators": names}


def as_factorynet(samples: Frame) -> Frame:
    """Converts samples of a data set to the columns of FactoryNet (docs/datasets.md).

    samples: frame of load(folder, group), of a joint or an arm, with 'file', 'time', a set point and a torque or
    current.

    Returns a pandas.DataFrame: 'episode_id' (name of the run's file), 'timestamp' [s], 'setpoint_', 'effort_',
    'feedback_' and 'ctx_' columns with the number of the joint from the base on, 'fault_label' (class). It contains no
    columns for which FactoryNet has no name. Raises InputError.
    """
    names = {}
    for name in samples:
        stem, _, joint = name.rpartition("_")
        if name in FACTORYNET:
            names[name] = FACTORYNET[name]
        elif joint.isdigit() and stem in FACTORYNET_ARM:
            names[name] = f"{FACTORYNET_ARM[stem]}_{joint}"
    for needed in ("timestamp", "setpoint_", "effort_"):
        if not any(name.startswith(needed) for name in names.values()):
            raise _hjt.InputError(f"none of these columns is one of FactoryNet's {needed}, which an episode needs: "
                                  f"{', '.join(samples)}")
    frame = samples[list(names)].rename(columns=names)
    frame.attrs = {}
    frame.insert(0, "episode_id", [os.path.splitext(os.path.basename(file))[0] for file in samples["file"]])
    return frame


def _columns_of(file: str) -> List[str]:
    """Rows of a table with the columns of a run's groups; indicators have only their number of columns."""
    h5py = importlib.import_module("h5py")
    lines = ["| group | column | unit | meaning |", "|---|---|---|---|"]
    with h5py.File(file, "r") as run:
        for name, group in run.items():
            if not isinstance(group, h5py.Group) or name == "parameters":
                continue
            if name == "indicators":
                lines.append(f"| `indicators` | {len(group)} columns | as its attributes say | a row for each window |")
                continue
            rate = f", {group.attrs['sample_rate']:g} Hz" if "sample_rate" in group.attrs else ""
            lines += [f"| `{name}`{rate} | `{column}` | {data.attrs.get('unit', '')} | "
                      f"{data.attrs.get('meaning', '')} |" for column, data in group.items()]
    return lines


def _digest(path: str) -> str:
    digest = hashlib.sha256()
    with open(path, "rb") as file:
        for part in iter(lambda: file.read(1 << 20), b""):
            digest.update(part)
    return digest.hexdigest()


def write_card(folder: Path, *, licence: str, authors: str, title: Optional[str] = None, text: str = "") -> Document:
    """Writes the card of a data set, README.md for Hugging Face and Zenodo, and SHA256SUMS for sha256sum -c.

    folder: directory of the complete data set. licence: SPDX identifier of the licence. authors: authors for the
    citation. title: title of the card; None: name of the plan, or of the directory if the plan has no name. text:
    description in Markdown.

    Returns a dict: 'card' and 'sums' (paths of the two files), 'files' (number of files). Raises InputError.
    """
    index = load(folder, group=None)
    place = os.fspath(folder)
    with open(os.path.join(place, "plan.json"), encoding="utf-8") as file:
        document = json.load(file)
    if len(index) != document["runs"]:
        raise _hjt.InputError(f"{place}: {len(index)} of {document['runs']} runs are present, but a card needs a "
                              "complete data set")
    name, version = title or document["plan"].get("name", os.path.basename(os.path.abspath(place))), document["version"]
    counts = index["class"].value_counts(sort=False)
    is_life = "life.drive" in index
    of_drive = "life." if is_life else ""
    has_drives = of_drive + "drive" in index
    files = sorted(os.path.relpath(os.path.join(at, one), place) for at, _, several in os.walk(place) for one in several
                   if one not in ("README.md", "SHA256SUMS"))
    lines = ["---", f"pretty_name: {json.dumps(name)}", f"license: {licence.lower()}", "tags: [simulated, prognostics, "
             "harmonic drive]", "---", f"# {name}", "", *([text, ""] if text else []),
             f"Simulated recordings of a robot joint's harmonic drive: {len(index)} runs"
             + (f" of {index[of_drive + 'drive'].nunique()} drives" if has_drives else "")
             + (" from new to their end" if is_life else "") + ".", "",
             "| class | runs |", "|---|---|", *(f"| {each} | {count} |" for each, count in counts.items()), "",
             "## How it was made", "",
             f"By harmonic_joint_twin {version}, `joint_twin {'lives' if is_life else 'sweep'}`, from the plan in "
             "`plan.json` (seed, draws, faults, sensors' errors, all parameters): the same plan gives the same bytes.",
             "",
             "## What is in it", "",
             "`index.csv` has a row for each run: file, class, faults, seeds, drawn variables. All of its columns are "
             "labels or settings; so are `severity` and `window_severity` of the files. Runs are in the order of "
             "their classes: shuffle them, and split by "
             + (f"drive, as `{of_drive}split` says" if has_drives else "run") + ".", "",
             *(_columns_of(index["file"][0]) if index["file"][0].endswith(".h5") else ["Bags of ROS."]), "",
             "## Licence and citation", "", f"{licence}. {authors}: {name}. Made with harmonic_joint_twin {version}.",
             "",
             "`sha256sum -c SHA256SUMS` checks the files."]
    sums = os.path.join(place, "SHA256SUMS")
    with open(sums, "w", encoding="utf-8") as file:
        file.writelines(f"{_digest(os.path.join(place, one))}  {one}\n" for one in files)
    card = os.path.join(place, "README.md")
    with open(card, "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")
    return {"card": card, "sums": sums, "files": len(files)}
