# SPDX-License-Identifier: BSD-3-Clause
"""A twin in a Python program of one's own: see outside_test.py."""
import os

import harmonic_joint_twin as hjt
from harmonic_joint_twin.msg import Health

parameters = hjt.Parameters({"output.load_inertia": 1.5})
twin = hjt.Twin(parameters)
twin.run(500, motor_torque=0.5)
loaded = Health(teeth_loaded=twin.health().teeth_loaded).teeth_loaded
try:
    hjt.Parameters("no_such_file.yaml")
except hjt.ParameterError as error:
    assert "no_such_file.yaml" in str(error)
# The state of a copy for another process begins with the directory of the default configuration.
configuration = os.path.dirname(os.path.dirname(os.path.dirname(parameters.__getstate__()[0])))
print(f"from {os.path.dirname(hjt.__file__)}, configuration of {configuration}, teeth loaded {loaded}, "
      f"tooth forces {len(twin.tooth_forces().mesh_force)}")
