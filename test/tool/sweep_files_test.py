# SPDX-License-Identifier: BSD-3-Clause
"""`joint_twin sweep`: what the files of the runs hold."""
import json

import h5py
import numpy
import rosbag

import tool
from sweep_test import PLAN, RUNS, SweepTest, tree


class SweepFiles(SweepTest):
    def test_file_holds_signals_units_and_labels(self):
        self.sweep("a", "--jobs", 2)
        rows = self.index("a")
        self.assertEqual([int(row["run"]) for row in rows], list(range(RUNS)))
        self.assertEqual([float(row["set.input.temperature"]) for row in rows], [10.0] * 3 + [40.0] * 3)
        for row in rows:
            self.assertEqual((row["status"], row["class"], row["duty"]), ("ok", "healthy", "turning"))
            with h5py.File(self.path("a/" + row["file"]), "r") as file:
                record = json.loads(file["record"][()])
                for key, value in record["variables"].items():
                    self.assertEqual(float(row[key]), value)
                self.assertEqual(file.attrs["run"], int(row["run"]))
                signals = file["signals"]
                self.assertEqual(signals.attrs["sample_rate"], 500.0)
                self.assertAlmostEqual(signals.attrs["first_time"], 0.012)
                angle = signals["motor_angle_encoder"]
                self.assertEqual((angle.dtype, angle.shape, angle.attrs["unit"]),
                                 (numpy.float32, (25,), "rad"))
                numpy.testing.assert_allclose(signals["time"], 0.01 + 0.002 * numpy.arange(1, 26), atol=1e-12)
                self.assertEqual(file["teeth/mesh_force"].shape, (5, 200))
                self.assertGreater(numpy.abs(file["teeth/mesh_force"]).max(), 10.0)
                self.assertIn(f"input.temperature: {float(row['set.input.temperature'])}",
                              file["parameters"][()].decode())

    def test_signals_are_those_of_the_twin(self):
        self.write("plan.yaml", PLAN.replace("overlays: [real_sensors.yaml]\n", "").split("repeats")[0] + """
repeats: 1
duty: [{name: push, torque: {constant: 0.4}, load: {constant: 3.0}}]
record:
  format: hdf5
  start: 0.0
  deflate: 4
  groups: {all: {rate: 1000.0, type: float64, columns: [motor_angle, joint_torque, motor_angle_encoder]}}
""")
        self.sweep("a")
        row = self.index("a")[1]
        self.succeed("simulate", "--torque", 0.4, "--load", 3, "--duration", 0.06, "--out", "b.csv",
                     "--set", "input.temperature=40.0", "--set",
                     f"output.load_inertia={row['set.output.load_inertia']}")
        simulated = numpy.genfromtxt(self.path("b.csv"), delimiter=",", names=True)
        with h5py.File(self.path("a/" + row["file"]), "r") as file:
            self.assertEqual(file["all/severity"][:].max(), 0.0)
            for name, column in file["all"].items():
                if name == "severity":
                    continue
                numpy.testing.assert_array_equal(column[:], simulated[name])

    def test_the_temperature_may_change_within_a_run(self):
        wave = "temperature: {sinus: {mean: 20.0, amplitude: 20.0, frequency: 25.0, phase: 0.0}}"
        self.write("plan.yaml", PLAN.replace("load: {constant: 5.0}", "load: {constant: 5.0}\n    " + wave)
                   .replace("repeats: 3", "repeats: 1").replace("{grid: [10.0, 40.0]}", "10.0")
                   .replace("speed: {sinus: {mean: 0.5, amplitude: {uniform: [0.5, 1.5]}, frequency: 8.0, phase: 0.0}}",
                            "speed: {constant: 1.0}")
                   .replace("[mesh_force, joint_torque]", "[temperature, friction_torque]")
                   .replace("rate: 100.0", "rate: 1000.0"))
        self.sweep("a")
        with h5py.File(self.path("a/" + self.index("a")[0]["file"]), "r") as file:
            time_axis = 0.01 + 0.001 * numpy.arange(1, 51)
            temperature = file["teeth/temperature"][:]
            friction = file["teeth/friction_torque"][:]
        numpy.testing.assert_allclose(temperature, 20.0 + 20.0 * numpy.sin(2.0 * numpy.pi * 25.0 * time_axis),
                                      atol=1e-9)
        settled = time_axis > 0.03
        self.assertLess(numpy.corrcoef(temperature[settled], friction[settled])[0, 1], -0.8)

    def test_indicators_of_each_window_stand_in_the_file(self):
        self.write("plan.yaml", PLAN.replace("duration: 0.06", "duration: 0.5").replace("repeats: 3", "repeats: 1")
                   .replace("speed: {sinus: {mean: 0.5, amplitude: {uniform: [0.5, 1.5]}, frequency: 8.0, phase: 0.0}}",
                            "speed: {constant: 1.0}")
                   .replace("  output.load_inertia: {log_uniform: [0.5, 2.0]}", "  indicators.window_turns: 2.0")
                   .replace("deflate: 0", "deflate: 0\n  indicators: true"))
        self.sweep("a")
        cold, warm = [row["file"] for row in self.index("a")]
        torque = {}
        for file_name in (cold, warm):
            with h5py.File(self.path("a/" + file_name), "r") as file:
                indicators = file["indicators"]
                self.assertGreaterEqual(len(indicators["window_end"]), 2)
                self.assertTrue((numpy.diff(indicators["window_end"]) > 0.0).all())
                self.assertEqual(indicators["running_torque"].attrs["unit"], "N.m")
                self.assertEqual(len(indicators["torque_outer"]), len(indicators["window_end"]))
                self.assertAlmostEqual(indicators["window_turns"][-1], 2.0, delta=0.1)
                torque[file_name] = indicators["running_torque"][-1]
        self.assertGreater(torque[cold], 1.2 * torque[warm])

    def test_the_first_window_is_like_the_others_though_the_load_is_there_at_once(self):
        self.write("plan.yaml", """
duration: 8.0
overlays: [real_sensors.yaml]
set: {solver.scene: auto, indicators.window_turns: 20.0}
duty: [{speed: {constant: 1.0}, load: {constant: 30.0}}]
record:
  indicators: true
  groups: {signals: {rate: 2000.0, columns: [motor_angle_encoder, motor_velocity_encoder, output_angle_encoder,
                                             motor_torque_reading, load_torque, housing_temperature]}}
""")
        self.sweep("a")
        file_name = self.index("a")[0]["file"]
        with h5py.File(self.path("a/" + file_name), "r") as file:
            windows = {name: column[:] for name, column in file["indicators"].items()}
        self.assertGreaterEqual(len(windows["window_end"]), 5)
        self.assertEqual(windows["window_start"][0], 1.0)
        numpy.testing.assert_array_equal(windows["window_start"][1:], windows["window_end"][:-1])
        for name in ("kinematic_error", "running_torque", "ratio_deviation", "efficiency", "error_outer"):
            first, others = windows[name][0], windows[name][1:]
            with self.subTest(name):
                self.assertLess(abs(first - others.mean()), max(5.0 * others.std(ddof=1), 0.05 * abs(others.mean())))

    def test_a_fault_grows_within_a_run(self):
        self.write("plan.yaml", """
duration: 3.0
set: {indicators.window_turns: 2.0}
duty: [{speed: {constant: 1.0}}]
classes:
  grease: [{kind: lubricant_degradation, severity: 0.8, onset: 1.0, ramp: 1.5}]
record:
  start: 0.4
  indicators: true
  groups: {signals: {rate: 100.0, columns: [friction_torque]}}
""")
        self.sweep("a")
        row = self.index("a")[0]
        self.assertEqual((row["fault_kind"], row["fault_severity"], row["fault_ramp"]),
                         ("lubricant_degradation", "0.8", "1.5"))
        with h5py.File(self.path("a/" + row["file"]), "r") as file:
            time_axis, severity = file["signals/time"][:], file["signals/severity"][:]
            friction = file["signals/friction_torque"][:]
            windows = file["indicators"]
            numpy.testing.assert_allclose(severity, numpy.clip(0.8 * (time_axis - 1.0) / 1.5, 0.0, 0.8), atol=1e-6)
            numpy.testing.assert_allclose(windows["window_severity"],
                                          numpy.interp(windows["window_end"], time_axis, severity), atol=0.01)
            self.assertGreater(numpy.corrcoef(windows["window_severity"], windows["running_torque"])[0, 1], 0.98)
        growing = (time_axis > 1.0) & (time_axis < 2.5)
        self.assertGreater(numpy.corrcoef(severity[growing], friction[growing])[0, 1], 0.95)
        steps = numpy.abs(numpy.diff(friction[growing]))
        self.assertLess(steps.max(), 0.15 * (friction[-20:].mean() - friction[time_axis < 1.0].mean()))

    def test_bags_hold_the_nodes_topics_and_the_record(self):
        text = PLAN.split("record:")[0].replace("repeats: 3", "repeats: 1") + "record: {format: bag}\n"
        self.write("plan.yaml", text)
        self.sweep("one", "--jobs", 1)
        self.sweep("two", "--jobs", 2)
        self.assertEqual(tree(self.path("one")), tree(self.path("two")))
        with rosbag.Bag(self.path("one/" + self.index("one")[0]["file"])) as bag:
            topics = bag.get_type_and_topic_info().topics
            self.assertEqual(topics["/joint_twin/joint_states"].message_count, 60)
            record = [message for _, message, _ in bag.read_messages(topics=["/joint_twin/run"])]
        self.assertEqual(json.loads(record[0].data)["duty"], "turning")

    def test_forces_that_were_not_found_are_not_numbers(self):
        # Teeth of one gear that differ: their forces come from the ring beside the loop.
        self.write("plan.yaml", """
duration: 0.3
set:
  solver.scene: auto
  solver.max_iterations: {grid: [2, 20]}
  manufacture.flexspline_pitch_deviation: 2.0e-5
  motor.torque_limit: 0.5
  output.load_torque_limit: 40.0
duty: [{torque: {sinus: {mean: 0.0, amplitude: 0.5, frequency: 5.0, phase: 0.0}}, load: {constant: 20.0}}]
record:
  start: 0.01
  groups: {teeth: {rate: 1000.0, columns: [mesh_force, tooth_x, motor_angle]}}
""")
        done = self.sweep("a")
        few, enough = self.index("a")
        self.assertEqual((few["status"], enough["status"], enough["rows_without_forces"]), ("ok", "ok", "0"))
        self.assertGreater(int(few["rows_without_forces"]), 0)
        self.assertIn(few["rows_without_forces"] + " rows have no tooth forces", done.stderr)
        for row in (few, enough):
            with h5py.File(self.path("a/" + row["file"]), "r") as file:
                unknown = numpy.isnan(file["teeth/mesh_force"])
                self.assertEqual(file.attrs["rows_without_forces"], int(row["rows_without_forces"]))
                self.assertEqual(unknown.any(axis=1).sum(), int(row["rows_without_forces"]))
                numpy.testing.assert_array_equal(unknown.all(axis=1), unknown.any(axis=1))
                numpy.testing.assert_array_equal(unknown, numpy.isnan(file["teeth/tooth_x"]))
                self.assertTrue((numpy.abs(file["teeth/mesh_force"][:][~unknown.any(axis=1)]).max(axis=1) > 0.0).all())
                self.assertTrue(numpy.isfinite(file["teeth/motor_angle"]).all())

    def test_a_trapezoid_without_peak_hold_and_pause_stands_still(self):
        self.write("plan.yaml", PLAN.replace("repeats: 3", "repeats: 1").replace("[10.0, 40.0]", "[10.0]").replace(
            "sinus: {mean: 0.5, amplitude: {uniform: [0.5, 1.5]}, frequency: 8.0, phase: 0.0}",
            "trapezoid: {peak: {grid: [0.0, 1.0]}, slope: 20.0, hold: 0.0, pause: 0.0}").replace(
                "[mesh_force,", "[speed_reference,"))
        self.sweep("a")
        reference = []
        for row in self.index("a"):
            with h5py.File(self.path("a/" + row["file"]), "r") as file:
                reference.append(file["teeth/speed_reference"][:])
        self.assertEqual(numpy.abs(reference[0]).max(), 0.0)
        self.assertGreater(numpy.abs(reference[1]).max(), 0.1)

    def test_the_table_of_a_duty_may_be_drawn(self):
        for name, speed in [("slow.csv", 0.5), ("fast.csv", 1.0)]:
            self.write(name, f"time,speed\n0,{speed}\n1,{speed}\n")
        self.write("plan.yaml", PLAN.replace("repeats: 3", "repeats: 5").replace("[mesh_force,", "[speed_reference,")
                   .replace("sinus: {mean: 0.5, amplitude: {uniform: [0.5, 1.5]}, frequency: 8.0, phase: 0.0}",
                            "csv: {file: {choice: [slow.csv, fast.csv]}, column: speed}")
                   .replace("{constant: 5.0}", "{sinus: {amplitude: 5.0, frequency: 2.0}}"))
        self.sweep("a")
        drawn = set()
        for row in self.index("a"):
            with h5py.File(self.path("a/" + row["file"]), "r") as file:
                table = row["duty.0.speed.csv.file"]
                self.assertEqual(file["teeth/speed_reference"][-1], {"slow.csv": 0.5, "fast.csv": 1.0}[table])
                drawn.add(table)
        self.assertEqual(len(drawn), 2)

    def test_a_file_carries_the_hash_of_its_bytes(self):
        self.sweep("a", "--jobs", 1)
        for row in self.index("a"):
            content = tool.read_bytes(self.path("a/" + row["file"]))
            known = 14695981039346656037
            for byte in content.replace(row["file_hash"].encode(), b"0" * 16):
                known = (known ^ byte) * 1099511628211 % 2 ** 64
            self.assertEqual(f"{known:016x}", row["file_hash"])


if __name__ == "__main__":
    tool.main()
