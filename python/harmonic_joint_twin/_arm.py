# SPDX-License-Identifier: BSD-3-Clause
"""A whole arm in closed loop as an object, which is run piece by piece (docs/python.md)."""
import os
from typing import TYPE_CHECKING, Any, Dict, List, Optional, Sequence

import numpy as np

from harmonic_joint_twin._commands import Overlays, Path, Progress, Recording, _arguments

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["Arm"]


class Arm:
    """An arm's drives, links and controller in closed loop (docs/arm_twin.md), run piece by piece.

    arm: name in config/arms, or a file. start: angles of all joints where it stands [rad]; None: all 0. payload: at the
    tip [kg]; None: that of the arm's file. The controller knows it. faults: each JOINT:KIND:SEVERITY[:PLACE[:ONSET]],
    there from the start, or from `time` = ONSET on. identified: directory of an arm's overlays. overlays, progress: as
    of identify.

    InputError, ParameterError.
    """

    def __init__(self, arm: Path, start: Optional[Sequence[float]] = None, *, payload: Optional[float] = None,
                 faults: Sequence[str] = (), identified: Optional[Path] = None, overlays: Overlays = (),
                 progress: Optional[Progress] = None) -> None:
        given = {name: value for name, value in locals().items() if name != "self"}
        from harmonic_joint_twin import _recordings
        self._arm = _recordings.Arm(_arguments(given))

    @property
    def joints(self) -> List[str]:
        """Short names, from the base on."""
        return self._arm.joints

    @property
    def time(self) -> float:
        """Since the brakes were released and the arm held itself [s]."""
        return self._arm.time

    @property
    def protective_stop(self) -> Optional[Dict[str, Any]]:
        """'joint', 'reason' and 'time' [s] of the stop in which the arm stands in its brakes until reset; or None."""
        return self._arm.protective_stop

    @property
    def counters(self) -> Dict[str, int]:
        """How the steps since reset went: 'solver_failures' those of no equilibrium, which are also warned of;
        'feedback_limited' controls of a joint at the limit of its feedback, ..."""
        return self._arm.counters

    def move(self, motion: Recording) -> float:
        """A motion from now on, in place of the last one: as of arm(). It begins where the arm is wanted now, in place
        of its first set point. Returns how long it takes [s]; then the arm is held at its end, or comes to rest if that
        is in motion."""
        return self._arm.move(os.fspath(motion) if isinstance(motion, os.PathLike) else motion)

    def run(self, duration: float, *, rate: Optional[float] = None) -> Dict[str, "NDArray[np.float64]"]:
        """Goes on for `duration` [s]. rate: of the rows [Hz], the next one that divides the solver's; None: that
        of the arm's states.

        Returns the rows as arm() does; 'timestamp' is `time`. A KeyboardInterrupt leaves the arm where it is.
        """
        return self._arm.run(duration, rate)

    def inject_fault(self, fault: str) -> None:
        """JOINT:KIND:SEVERITY[:PLACE[:ONSET]], onset from now on; severity 0 takes it away. Until its joint has a table
        with the fault, that runs on its full ring."""
        self._arm.inject_fault(fault)

    def set_wrench(self, force: Sequence[float] = (0.0, 0.0, 0.0), moment: Sequence[float] = (0.0, 0.0, 0.0)) -> None:
        """On the tip from outside until the next one, in the frame of the base [N], [N.m]."""
        self._arm.set_wrench(force, moment)

    def set_payload(self, mass: float, centre: Sequence[float] = (0.0, 0.0, 0.0)) -> None:
        """At the tip until the next one, its centre in the frame of the tip [kg], [m]. The controller knows it; of one
        that it does not know the weight is a wrench."""
        self._arm.set_payload(mass, centre)

    def set_temperature(self, temperature: float, joint: Optional[str] = None) -> None:
        """Of the drive of a joint, or of all; with thermal.model = two_nodes that of its surroundings [degC]."""
        self._arm.set_temperature(temperature, joint)

    def reset(self) -> None:
        """Back to the start, with the faults given at construction and the configured temperatures; wrench and payload
        stay."""
        self._arm.reset()

    def __repr__(self) -> str:
        try:
            state = f"time = {self.time:.6g} s"
        except RuntimeError:
            state = "being run by another thread"
        return f"Arm({', '.join(self.joints)}; {state})"
