# SPDX-License-Identifier: BSD-3-Clause
"""The co-simulation unit that is a whole arm, as a small importer runs it. Arguments: those of fmu_unit."""
import csv
import math

import tool
from fmu_unit import ERROR, OK, Fmu

POSE = [0.0, -1.2, 1.0, -1.3, -1.5, 0.3]
ROWS = 125.0  # [Hz]


def set_points(time, duration=0.4, speed=0.5):
    """Elbow and wrist 2 go there and back, the others stand still: angles, speeds, accelerations, which begin at 0."""
    rate = 2.0 * math.pi / duration
    way = 1.0 - math.cos(rate * time)
    rows = [list(POSE), [0.0] * 6, [0.0] * 6]
    for joint in 2, 4:
        rows[0][joint] += 0.5 * speed / rate * way**2
        rows[1][joint] = speed * way * math.sin(rate * time)
        rows[2][joint] = speed * rate * (math.sin(rate * time)**2 + way * math.cos(rate * time))
    return rows


class Arm(Fmu):
    """A unit that is a whole arm."""
    NAMES = "target_q", "target_qd", "target_qdd"

    def stand(self, unit, instance=0, **values):
        unit.start(instance, start_q=POSE, **{"target_q": POSE, **values})

    def follow(self, unit, first, last, instance=0):
        """From row to row of the set points."""
        for k in range(first, last):
            for name, values in zip(self.NAMES, set_points((k + 1) / ROWS)):
                self.assertEqual(unit.set(name, *values, instance=instance), OK)
            self.assertEqual(unit.call("step", instance, k / ROWS, 1.0 / ROWS), OK)

    def test_gives_the_numbers_of_the_tool(self):
        with open(self.path("motion.csv"), "w", encoding="ascii", newline="") as file:
            rows = csv.writer(file)
            rows.writerow(["timestamp"] + [f"{name}_{i}" for name in self.NAMES for i in range(6)])
            for k in range(51):
                rows.writerow([k / ROWS] + [value for values in set_points(k / ROWS) for value in values])
        options = ["--set", "sensors.motor_noise=1.0e-4", "--arm", "ur5"]
        self.succeed("arm", "motion.csv", "--out", "run.csv", "--fault", "elbow:tooth_wear:0.4:20", *options)
        rows = self.rows("run.csv")
        unit = self.unit(*options)
        first = dict(zip(self.NAMES, set_points(1.0 / ROWS)))  # importers give the first inputs before the start, too
        self.stand(unit, elbow__fault_tooth_wear=0.4, elbow__fault_tooth_wear_place=20, **first)
        for k in 0, 1, 25, 49:
            self.follow(unit, {0: 0, 1: 0, 25: 1, 49: 25}[k], k)
            for name in "target_current", "actual_q", "actual_qd", "actual_current", "target_moment", \
                        "actual_TCP_pose", "target_TCP_pose":
                # Before its first step a recording's row has no set point's rates.
                if k > 0 or name.startswith("actual"):
                    expected = [rows[k][f"{name}_{i}"] for i in range(unit.size(name))]
                    self.assertEqual(unit.get(name), expected, (k, name))
        self.assertEqual(unit.ask("allocations", 0), ["0"])
        distance = math.dist(unit.get("actual_TCP_pose"), unit.get("target_TCP_pose"))
        self.assertAlmostEqual(unit.get("tool_error")[0], distance, delta=1e-12)
        self.assertEqual(unit.close(), "")

    def test_a_state_goes_into_another_process(self):
        """On the table, under its controller."""
        options = ["--arm", "ur5", "--set", "sensors.motor_noise=1.0e-4"]
        unit = self.unit(*options)
        self.stand(unit)
        for k in range(6):
            self.follow(unit, k, k + 1)
            unit.get("elbow.tooth_mesh_force")
        unit.set("wrench_force", 0.0, 0.0, -40.0)
        unit.set("payload_mass", 2.0)
        self.follow(unit, 6, 12)
        self.assertEqual(unit.call("keep", 0, 0), OK)
        self.assertEqual(unit.call("save", 0, 0, self.path("a state")), OK)
        other = self.unit(*options)
        self.assertEqual(other.call("new", 0), OK)
        self.assertEqual(other.call("load", 0, 0, self.path("a state")), OK)
        self.assertEqual(other.call("restore", 0, 0), OK)
        for one in unit, other:
            self.follow(one, 12, 18)
        self.assertEqual(other.outputs(), unit.outputs())
        self.assertEqual(other.close(), "")

    def test_inputs_act_and_steps_may_have_any_length(self):
        unit = self.unit("--arm", "ur5")
        self.stand(unit)
        self.assertEqual(unit.call("step", 0, 0.0, 0.0037, 20), OK)
        before = unit.get("actual_current")
        self.assertLess(unit.get("tool_error")[0], 2e-4)
        unit.set("wrench_force", 0.0, 0.0, -40.0)
        unit.set("payload_mass", 2.0)
        self.assertEqual(unit.call("step", 0, 0.074, 0.00015, 2000), OK)
        self.assertAlmostEqual(unit.get("time")[0], 0.374, delta=1e-9)
        # Both press down: the shoulder needs more of the current that it has.
        self.assertGreater(abs(unit.get("actual_current")[1]), 1.3 * abs(before[1]))
        stiffness = unit.get("elbow.torsional_stiffness")[0]
        unit.set("elbow.fault_flange_crack", 0.9)
        self.assertEqual(unit.call("step", 0, 0.374, 0.02), OK)
        self.assertLess(unit.get("elbow.torsional_stiffness")[0], stiffness)
        self.assertEqual(unit.get("protective_stop"), [0.0])
        unit.set("target_q", POSE[0] + 0.5, *POSE[1:])
        self.assertEqual(unit.call("step", 0, 0.394, 0.05), OK)
        self.assertEqual(unit.get("protective_stop"), [1.0])
        for values in (["nan"] + POSE[1:], [1e6] + POSE[1:], POSE[1:]):
            self.assertEqual(unit.set("target_q", *values), ERROR)
        self.assertEqual(unit.set("controller.on", 0), ERROR)
        self.assertIn("target_q[1] = .nan [rad] out of range", unit.close())

    def test_parameters_of_the_arm_act(self):
        unit = self.unit("--arm", "ur5")
        self.stand(unit, 0)
        self.stand(unit, 1, gravity=[0.0, 0.0, 0.0])
        self.stand(unit, 2, controller__position=[1.0] * 6)
        for instance in 0, 1, 2:
            self.follow(unit, 0, 25, instance)
        # Without weight the shoulder has friction to overcome; with a slow position control the elbow is off more.
        self.assertLess(abs(unit.get("actual_current", 1)[1]), 0.5 * abs(unit.get("actual_current")[1]))
        wanted = set_points(25 / ROWS)[0][2]
        self.assertGreater(abs(wanted - unit.get("actual_q", 2)[2]), abs(wanted - unit.get("actual_q")[2]))
        self.assertEqual(unit.close(), "")

    def test_without_its_controller_motors_do_what_they_are_told(self):
        unit = self.unit("--arm", "ur5")
        held = {f"{joint}__brake": 1 for joint in ("base", "shoulder", "elbow", "wrist_1", "wrist_2", "wrist_3")}
        self.stand(unit, 0, controller__on=0, **held)
        self.stand(unit, 1, controller__on=0, **held)
        for instance in 0, 1:
            self.assertEqual(unit.call("step", instance, 0.0, 0.01, 10), OK)
        self.assertLess(math.dist(unit.get("actual_q"), POSE), 2e-3)
        unit.set("wrist_3.motor_torque", 0.1)
        unit.set("wrist_3.brake", 0)
        unit.set("elbow.brake", 0, instance=1)
        for instance in 0, 1:
            self.assertEqual(unit.call("step", instance, 0.1, 0.01, 40), OK)
        self.assertGreater(unit.get("actual_q")[5], POSE[5] + 0.05)
        self.assertLess(math.dist(unit.get("actual_q")[:5], POSE[:5]), 2e-3)
        self.assertGreater(abs(unit.get("actual_q", 1)[2] - POSE[2]), 0.02)  # by its weight
        self.assertEqual(unit.close(), "")

    def test_faults_of_the_drives_set_in_by_the_importers_time(self):
        with open(self.path("fault.yaml"), "w", encoding="ascii") as file:
            file.write("faults: [{kind: flange_crack, severity: 0.9, place: -1, onset: 0.05}]\n")
        angles = []
        for options in [], ["--config", self.path("fault.yaml")]:
            unit = self.unit("--arm", "ur5", *options)
            angles.append([])
            for on in 0, 1:
                self.stand(unit, on, controller__on=on)
                for time in 0.0, 0.05:
                    self.assertEqual(unit.call("step", on, time, 0.05), OK)
                    angles[-1].append(unit.get("actual_q", on))
            self.assertEqual(unit.close(), "")
        self.assertEqual([sound == faulty for sound, faulty in zip(*angles)], [True, False] * 2)


if __name__ == "__main__":
    tool.main()
