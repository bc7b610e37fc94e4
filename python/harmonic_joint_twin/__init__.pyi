# SPDX-License-Identifier: BSD-3-Clause
from harmonic_joint_twin._hjt import *
from harmonic_joint_twin._commands import *
from harmonic_joint_twin._arm import *
from harmonic_joint_twin._data_sets import *
