# SPDX-License-Identifier: BSD-3-Clause
# Names and types of the module; what they mean, with units and shapes, is in its docstrings.
from os import PathLike
from typing import Any, Callable, Dict, Final, ItemsView, Iterable, Iterator, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
Rows = NDArray[np.void]
Input = Optional[ArrayLike]
Progress = Optional[Callable[[float], Any]]
Value = Union[bool, int, float, str, Sequence[float]]

COMPARISON_DTYPE: np.dtype[np.void]
STEP_DTYPE: np.dtype[np.void]

class Assessment:
    alternatives: Final[Dict[str, float]]
    cause: Final[str]
    confidence: Final[float]
    evidence: Final[List[Evidence]]
    largest_score: Final[float]
    level: Final[str]
    severity: Final[float]
    severity_deviation: Final[float]
    stamp: Final[int]
    state: Final[str]
    windows: Final[int]
    windows_here: Final[int]
    windows_needed: Final[int]

class Breakaway:
    back_driving: Final[float]
    starting: Final[float]

class Evidence:
    expected: Final[float]
    indicator: Final[str]
    score: Final[float]
    value: Final[float]

class Fault:
    def __init__(self, kind: str, severity: float, place: Optional[int] = ..., onset: float = ...) -> None: ...
    kind: Final[str]
    onset: Final[float]
    place: Final[int]
    severity: Final[float]

class FaultKind:
    def shows(self, parameters: Parameters) -> str: ...
    name: Final[str]
    place: Final[str]
    severity: Final[str]
    whole: Final[bool]

class Field:
    choices: Final[List[str]]
    key: Final[str]
    maximum: Final[Optional[float]]
    meaning: Final[str]
    minimum: Final[Optional[float]]
    type: Final[str]
    unit: Final[str]

class FitCheck:
    jams: Final[bool]
    teeth_loaded: Final[int]
    wave_generator_force: Final[float]
    wave_generator_force_insertion: Final[float]

class Health:
    efficiency: Final[Optional[float]]
    kinematic_error: Final[Optional[float]]
    lobe_asymmetry: Final[float]
    lobe_mesh_force: Final[Tuple[float, float]]
    mesh_force_error: Final[float]
    solver_state: Final[str]
    teeth_loaded: Final[int]
    torsion: Final[float]
    torsional_stiffness: Final[Optional[float]]
    transmission_ratio: Final[Optional[float]]
    wave_generator_load: Final[float]

class InputError(ValueError): ...

class InsertionResult:
    bending_force_max: Final[float]
    radius_major_axis: Final[float]
    radius_minor_axis: Final[float]
    teeth: Final[ToothTable]
    teeth_in_contact: Final[int]
    tension_max: Final[float]
    tension_min: Final[float]
    wave_generator_force_max: Final[float]
    wave_generator_force_min: Final[float]
    wave_generator_force_sum: Final[float]

class NotConverged(RuntimeError): ...

class ParameterError(InputError): ...

class Parameters:
    @property
    def faults(self) -> List[Fault]: ...
    @faults.setter
    def faults(self, faults: Union[str, Fault, Iterable[Union[str, Fault]]]) -> None: ...
    def __init__(self, *overlays: Union[str, PathLike[str], Mapping[str, Value]], config_dir: str = ...) -> None: ...
    def copy(self) -> Parameters: ...
    def describe(self) -> str: ...
    @staticmethod
    def field(key: str) -> Field: ...
    def items(self) -> ItemsView[str, Any]: ...
    def keys(self) -> List[str]: ...
    def update(self, changes: Mapping[str, Value]) -> None: ...
    def __contains__(self, key: str) -> bool: ...
    def __copy__(self) -> Parameters: ...
    def __deepcopy__(self, memo: Dict[int, Any]) -> Parameters: ...
    def __getitem__(self, key: str) -> Any: ...
    def __getstate__(self) -> Tuple[Any, ...]: ...
    def __iter__(self) -> Iterator[str]: ...
    def __len__(self) -> int: ...
    def __setitem__(self, key: str, value: Value) -> None: ...
    def __setstate__(self, arg0: Tuple[Any, ...]) -> None: ...

class SignalIndicators:
    direction: Final[float]
    inertia: Final[float]
    load: Final[float]
    load_constant: Final[float]
    load_cosine: Final[float]
    load_sine: Final[float]
    speed: Final[float]
    stamp: Final[int]
    temperature: Final[float]
    turns: Final[float]
    uncertainty: Final[Dict[str, float]]
    values: Final[Dict[str, float]]
    windows: Final[int]

class StiffnessRow:
    ball_force: Final[FloatArray]
    cup_rotation: Final[float]
    housing_torque: Final[float]
    mesh_force_max: Final[float]
    output_angle: Final[float]
    residual: Final[float]
    stress: Final[ToothStress]
    teeth: Final[ToothTable]
    teeth_loaded: Final[int]
    torque: Final[float]
    wave_generator_force_sum: Final[float]
    wave_generator_torque: Final[float]

class StressCycle:
    amplitude: Final[float]
    highest: Final[float]
    largest: Final[float]
    lowest: Final[float]
    mean: Final[float]
    shear: Final[float]

class ToothForces:
    def copy(self) -> ToothForces: ...
    bending_force: Final[FloatArray]
    mesh_force: Final[FloatArray]
    rim_tension: Final[FloatArray]
    tooth_x: Final[FloatArray]
    tooth_y: Final[FloatArray]
    wave_generator_force: Final[FloatArray]

class ToothStress:
    def copy(self) -> ToothStress: ...
    def cycle(self, place: str) -> StressCycle: ...
    def worst_tooth(self, place: str) -> int: ...
    flange: Final[FloatArray]
    shear: Final[Tuple[float, float, float]]
    tooth_space: Final[FloatArray]
    transition: Final[FloatArray]

class ToothTable:
    across: Final[FloatArray]
    angle_deviation: Final[FloatArray]
    bending_force: Final[FloatArray]
    depth: Final[FloatArray]
    gap: Final[FloatArray]
    mesh_force: Final[FloatArray]
    radius: Final[FloatArray]
    rim_tension: Final[FloatArray]
    stress_flange: Final[FloatArray]
    stress_tooth_space: Final[FloatArray]
    stress_transition: Final[FloatArray]
    tilt: Final[FloatArray]
    tooth_x: Final[FloatArray]
    tooth_y: Final[FloatArray]
    wave_generator_force: Final[FloatArray]

class TorsionLoop:
    hysteresis: Final[float]
    lost_motion: Final[float]
    output_angle: Final[FloatArray]
    torque: Final[FloatArray]

class Tracker:
    def __init__(
        self, parameters: Parameters, mode: str = ..., cache: Optional[str] = ..., progress: Progress = ...
    ) -> None: ...
    def follow(
        self, time: ArrayLike, position: ArrayLike, current: ArrayLike, load: Optional[ArrayLike] = ...,
        temperature: Optional[ArrayLike] = ..., motor_angle: Optional[ArrayLike] = ..., at_end: bool = ...,
        progress: Progress = ...
    ) -> Rows: ...
    def reset(self) -> None: ...
    assessment: Final[Assessment]
    counters: Final[Dict[str, int]]
    lag: Final[Optional[float]]
    outside_share: Final[float]
    signal_indicators: Final[SignalIndicators]

class Twin:
    watch_signals: bool
    def __init__(
        self, parameters: Parameters, cache: Optional[str] = ..., progress: Progress = ...
    ) -> None: ...
    def command_brake(self, engaged: bool, stamp: Optional[int] = ...) -> None: ...
    def command_load_torque(self, torque: float, stamp: Optional[int] = ...) -> None: ...
    def command_motor_torque(self, torque: float, stamp: Optional[int] = ...) -> None: ...
    def health(self, since: Optional[int] = ...) -> Health: ...
    def inject_fault(self, fault: Union[Fault, str], stamp: Optional[int] = ...) -> None: ...
    def reset(self, stamp: int = ...) -> None: ...
    def run(
        self, steps: Optional[int] = ..., motor_torque: Input = ..., load_torque: Input = ...,
        brake: Input = ..., temperature: Input = ..., every: int = ...,
        out: Optional[Rows] = ..., progress: Progress = ...
    ) -> Rows: ...
    def run_to(
        self, time: float, motor_torque: Input = ..., load_torque: Input = ...,
        brake: Input = ..., temperature: Input = ..., every: int = ...,
        out: Optional[Rows] = ..., progress: Progress = ...
    ) -> Rows: ...
    def set_temperature(self, degrees: float, stamp: Optional[int] = ...) -> None: ...
    def step(self) -> None: ...
    def tooth_forces(self) -> ToothForces: ...
    def tooth_stress(self) -> ToothStress: ...
    active_faults: Final[List[Fault]]
    assessment: Final[Assessment]
    counters: Final[Dict[str, int]]
    on_surface: Final[bool]
    outputs: Final[np.void]
    parameters: Final[Parameters]
    signal_indicators: Final[SignalIndicators]
    stamp: Final[int]
    step_length: Final[int]
    time: Final[float]

class TwinBatch:
    def __init__(
        self, twins: Union[Parameters, Twin, Iterable[Union[Parameters, Twin]]], n: Optional[int] = ...,
        cache: Optional[str] = ..., progress: Progress = ..., threads: Optional[int] = ...
    ) -> None: ...
    def run(
        self, steps: Optional[int] = ..., motor_torque: Input = ..., load_torque: Input = ...,
        brake: Input = ..., temperature: Input = ..., every: int = ...,
        out: Optional[Rows] = ..., progress: Progress = ...
    ) -> Rows: ...
    def step(
        self, motor_torque: Input = ..., load_torque: Input = ..., brake: Input = ..., temperature: Input = ...,
        steps: int = ..., out: Optional[Rows] = ...
    ) -> Rows: ...
    def __getitem__(self, twin: int) -> Twin: ...
    def __len__(self) -> int: ...
    counters: Final[Dict[str, IntArray]]
    outputs: Final[Rows]
    threads: Final[int]

def analyse_breakaway(parameters: Parameters, positions: int = ...) -> Breakaway: ...
def analyse_insertion(parameters: Parameters) -> InsertionResult: ...
def analyse_losses(
    parameters: Parameters, speeds: Sequence[float], loads: Sequence[float], positions: int = ...
) -> Rows: ...
def analyse_stiffness(parameters: Parameters, torques: Sequence[float], angle: float = ...) -> List[StiffnessRow]: ...
def analyse_torsion_loop(
    parameters: Parameters, amplitude: float, lost_motion_torque: float, steps: int = ...
) -> TorsionLoop: ...
def analyse_turn(parameters: Parameters, load: float, angle_range: float, steps: int) -> Rows: ...
def check_fit(parameters: Parameters) -> FitCheck: ...
def design_gear(
    parameters: Parameters, size: float, ratio: int = ..., bore_radius: Optional[float] = ...,
    rim_thickness: Optional[float] = ..., face_width: Optional[float] = ..., stiffness: Sequence[float] = ...,
    breakpoints: Sequence[float] = ..., ratings: Sequence[float] = ..., starting_torque: Optional[float] = ...,
    no_load_torque: Optional[float] = ...
) -> Tuple[Parameters, Dict[str, str]]: ...
def endurance_share(parameters: Parameters, place: str, cycle: StressCycle) -> float: ...
def fault_kinds() -> Dict[str, FaultKind]: ...
def gear_warnings(parameters: Parameters) -> List[str]: ...
def indicator_units() -> Dict[str, str]: ...
def parameter_fields() -> List[Field]: ...
