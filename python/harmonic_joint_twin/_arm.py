# SPDX-License-Identifier: BSD-3-Clause
"""Class of a whole arm in closed loop (docs/python.md)."""
import os
from typing import TYPE_CHECKING, Any, Dict, List, Optional, Sequence

import numpy as np

from harmonic_joint_twin._commands import Overlays, Path, Progress, Recording, _arguments

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["Arm"]


class Arm:
    """Simulation of an arm's drives, links and controller in closed loop (docs/arm_twin.md), by periods of time.

    arm: name in config/arms, or a file. start: initial angles of all joints [rad]; None: all 0. payload: mass at the
    tip, which the controller knows [kg]; None: payload of the arm's file. faults: texts
    JOINT:KIND:SEVERITY[:PLACE[:ONSET]]; a fault acts from the start, or from `time` = ONSET on. identified: directory
    of the arm's overlays from identify. overlays, progress: as for identify.

    Raises InputError, ParameterError.
    """

    def __init__(self, arm: Path, start: Optional[Sequence[float]] = None, *, payload: Optional[float] = None,
                 faults: Sequence[str] = (), identified: Optional[Path] = None, overlays: Overlays = (),
                 progress: Optional[Progress] = None) -> None:
        given = {name: value for name, value in locals().items() if name != "self"}
        from harmonic_joint_twin import _recordings
        self._arm = _recordings.Arm(_arguments(given))

    @property
    def joints(self) -> List[str]:
        """Short names of the joints, in the order from the base to the tip."""
        return self._arm.joints

    @property
    def time(self) -> float:
        """Simulated time since the arm holds itself with released brakes [s]."""
        return self._arm.time

    @property
    def protective_stop(self) -> Optional[Dict[str, Any]]:
        """Dict of 'joint', 'reason' and 'time' [s] of the protective stop, after which the brakes hold the arm until
        reset; None without a stop."""
        return self._arm.protective_stop

    @property
    def counters(self) -> Dict[str, int]:
        """Counts of events since the reset. 'solver_failures' is the number of steps without an equilibrium, for which
        a warning is given too. 'feedback_limited' counts how often the feedback of a joint reached its limit."""
        return self._arm.counters

    def move(self, motion: Recording) -> float:
        """Starts a motion, which replaces the present one. motion: as for arm(); its first set point is replaced by the
        present set point of the arm. After the motion, the controller holds the arm at the last set point; if that set
        point has a speed, the arm first comes to rest. Returns the duration of the motion [s]."""
        return self._arm.move(os.fspath(motion) if isinstance(motion, os.PathLike) else motion)

    def run(self, duration: float, *, rate: Optional[float] = None) -> Dict[str, "NDArray[np.float64]"]:
        """Advances the simulation by `duration` [s]. rate: rate of the rows, rounded to a divisor of the solver's rate
        [Hz]; None: rate of the arm's states.

        Returns the rows as arm() does; 'timestamp' is `time`. After a KeyboardInterrupt the arm keeps its state.
        """
        return self._arm.run(duration, rate)

    def inject_fault(self, fault: str) -> None:
        """Injects a fault JOINT:KIND:SEVERITY[:PLACE[:ONSET]]. ONSET counts from now [s]; severity 0 removes the fault.
        The twin of the joint solves its full ring until a response surface with the fault is ready."""
        self._arm.inject_fault(fault)

    def set_wrench(self, force: Sequence[float] = (0.0, 0.0, 0.0), moment: Sequence[float] = (0.0, 0.0, 0.0)) -> None:
        """Sets the external force [N] and moment [N.m] on the tip, in the frame of the base, until the next call."""
        self._arm.set_wrench(force, moment)

    def set_payload(self, mass: float, centre: Sequence[float] = (0.0, 0.0, 0.0)) -> None:
        """Sets mass [kg] and centre of mass [m], in the frame of the tip, of the payload until the next call. The
        controller knows this payload. The weight of a payload that the controller does not know is a wrench."""
        self._arm.set_payload(mass, centre)

    def set_temperature(self, temperature: float, joint: Optional[str] = None) -> None:
        """Sets the temperature of the drive of one joint, or of all drives [degC]. With thermal.model = two_nodes the
        temperature is that of the surroundings."""
        self._arm.set_temperature(temperature, joint)

    def reset(self) -> None:
        """Sets the arm to its state at the start, with the faults given to the constructor and the configured
        temperatures. Wrench and payload do not change."""
        self._arm.reset()

    def __repr__(self) -> str:
        try:
            state = f"time = {self.time:.6g} s"
        except RuntimeError:
            state = "being run by another thread"
        return f"Arm({', '.join(self.joints)}; {state})"
