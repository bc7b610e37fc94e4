# SPDX-License-Identifier: BSD-3-Clause
"""`joint_twin sweep`: data sets of many runs."""
import csv
import json
import os
import resource
import shutil
import signal
import subprocess
import time

import h5py
import numpy
import rosbag

import tool

PLAN = """
name: test
seed: 7
duration: 0.06
overlays: [real_sensors.yaml]
set:
  input.temperature: {grid: [10.0, 40.0]}
  output.load_inertia: {log_uniform: [0.5, 2.0]}
repeats: 3
duty:
  - name: turning
    speed: {sinus: {mean: 0.5, amplitude: {uniform: [0.5, 1.5]}, frequency: 8.0, phase: 0.0}}
    bandwidth: 8.0
    load: {constant: 5.0}
record:
  format: hdf5
  start: 0.01
  deflate: 0
  groups:
    signals: {rate: 500.0, type: float32, columns: [motor_angle_encoder, motor_torque_reading]}
    teeth: {rate: 100.0, type: float64, columns: [mesh_force, joint_torque]}
"""
RUNS = 6


def tree(directory):
    """Bytes of every file below."""
    return {os.path.relpath(os.path.join(path, name), directory): tool.read_bytes(os.path.join(path, name))
            for path, _, names in os.walk(directory) for name in names}


class Sweep(tool.ToolTest):

    def setUp(self):
        super().setUp()
        self.write("plan.yaml", PLAN)

    def sweep(self, out, *arguments, plan="plan.yaml"):
        return self.succeed("sweep", plan, "--out", out, *arguments)

    def index(self, out):
        with open(self.path(out + "/index.csv")) as file:
            return list(csv.DictReader(file))

    def start(self, plan, out, *arguments):
        return subprocess.Popen([self.executable, "sweep", plan, "--out", out, *arguments], cwd=self.directory,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE)

    def wait_for_runs(self, out, count):
        deadline = time.monotonic() + 60.0 * tool.SLOWER
        while time.monotonic() < deadline:
            runs = self.path(out + "/runs")
            if os.path.isdir(runs) and sum(name.endswith(".h5") for name in os.listdir(runs)) >= count:
                return
            time.sleep(0.005)
        self.fail("no runs")

    def test_any_number_of_workers_and_shards_gives_the_same_bytes(self):
        self.sweep("one", "--jobs", 1)
        whole = tree(self.path("one"))
        self.assertEqual(len(whole), RUNS + 2)
        self.sweep("two", "--jobs", 2)
        self.assertEqual(tree(self.path("two")), whole)
        for shard in ["1/2", "0/2"]:
            self.sweep("shards", "--jobs", 1, "--shard", shard)
        self.assertEqual(tree(self.path("shards")), whole)

    def test_goes_on_after_being_killed_and_repeats_nothing(self):
        self.write("plan.yaml", PLAN.replace("duration: 0.06", "duration: 0.6").replace("repeats: 3", "repeats: 4"))
        self.sweep("whole", "--jobs", 2)
        process = self.start("plan.yaml", "killed", "--jobs", "1")
        self.wait_for_runs("killed", 2)
        process.kill()
        process.communicate()
        runs = self.path("killed/runs")
        finished = {name: os.stat(os.path.join(runs, name)).st_mtime_ns for name in os.listdir(runs)
                    if name.endswith(".h5")}
        self.assertLess(len(finished), 8)
        self.assertFalse(os.path.exists(self.path("killed/index.csv")))
        done = self.sweep("killed", "--jobs", 2)
        self.assertIn(f"{len(finished)} were there", done.stderr)
        for name, written in finished.items():
            self.assertEqual(os.stat(os.path.join(runs, name)).st_mtime_ns, written)
        self.assertEqual(tree(self.path("killed")), tree(self.path("whole")))

    def test_an_interrupt_keeps_what_is_finished(self):
        self.write("plan.yaml", PLAN.replace("duration: 0.06", "duration: 0.3").replace("repeats: 3", "repeats: 400"))
        process = self.start("plan.yaml", "a", "--jobs", "2")
        self.wait_for_runs("a", 2)
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=30 * tool.SLOWER)
        self.assertEqual(process.returncode, 130, errors)
        self.assertIn(b"interrupted; the same command resumes", errors)
        rows = self.index("a")
        self.assertGreaterEqual(len(rows), 2)
        self.assertEqual(sorted(os.path.basename(row["file"]) for row in rows), sorted(os.listdir(self.path("a/runs"))))

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

    def test_the_recorded_torque_grows_as_the_grease_gets_colder(self):
        plan = PLAN.replace("[10.0, 40.0]", "[0.0, 20.0, 40.0, 60.0]").replace("{log_uniform: [0.5, 2.0]}", "1.0")
        plan = plan.replace("repeats: 3", "repeats: 1").replace("duration: 0.06", "duration: 0.3")
        plan = plan.replace("{sinus: {mean: 0.5, amplitude: {uniform: [0.5, 1.5]}, frequency: 8.0, phase: 0.0}}",
                            "{constant: 1.0}").replace("start: 0.01", "start: 0.2")
        self.write("plan.yaml", plan)
        self.sweep("a")
        torques = []
        for row in self.index("a"):
            with h5py.File(self.path("a/" + row["file"]), "r") as file:
                torques.append(float(numpy.mean(file["signals/motor_torque_reading"])))
        self.assertEqual(torques, sorted(torques, reverse=True))
        self.assertGreater(torques[0], 1.3 * torques[-1])

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
        # The tool finds in the signals what the twin found as it ran.
        reported = self.succeed_json("indicators", "a/" + file_name, "--time", "time")["windows"]
        self.assertEqual(len(reported), len(windows["window_end"]))
        for name in ("kinematic_error", "running_torque", "error_outer"):
            for window, value in zip(reported[1:], windows[name][1:]):
                self.assertAlmostEqual(window["indicators"][name], value, delta=1e-9)

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

    def test_the_grid_of_faults_shows_severity_in_its_files(self):
        with open(os.path.join(tool.CHECKOUT, "plans", "fault_grid.yaml")) as file:
            plan = file.read()
        for old, new in [("duration: 12.0", "duration: 0.2"), ("start: 1.0", "start: 0.1"),
                         # Without the noise that moves the speed control more than a crack of one tooth does.
                         ("solver.scene: auto",
                          "solver.scene: full_ring\n  sensors.motor_noise: 0.0\n  sensors.output_noise: 0.0"),
                         ("{grid: [15.0, 40.0]}", "15.0"), ("{grid: [0.5, 1.5]}", "1.0"),
                         ("{grid: [0.0, 30.0, 60.0]}", "60.0")]:
            self.assertIn(old, plan)
            plan = plan.replace(old, new, 1)
        self.write("plan.yaml", plan)
        self.sweep("a")
        rows = self.index("a")
        self.assertEqual(len(rows), 1 + 16 * 3)
        truth = {}
        for row in rows:
            with h5py.File(self.path("a/" + row["file"]), "r") as file:
                truth.setdefault(row["class"], []).append(
                    numpy.array([file["truth/friction_torque"][:], file["truth/torsional_stiffness"][:]]))
        healthy = truth.pop("healthy")[0]
        scale = numpy.abs(healthy).mean(axis=1)[:, None]
        self.assertEqual(len(truth), 16)
        for kind, runs in truth.items():
            with self.subTest(kind):
                departures = [numpy.sqrt((((run - healthy) / scale) ** 2).mean()) for run in runs]
                self.assertGreater(departures[0], 0.0)
                self.assertEqual(departures, sorted(departures))

    def test_what_is_drawn_depends_on_seed_name_and_run_alone(self):
        def drawn(plan):
            self.write("other.yaml", plan)
            rows = list(csv.DictReader(self.sweep("unused", "--list", plan="other.yaml").stdout.splitlines()))
            return [(row["set.output.load_inertia"], row["noise_seed"]) for row in rows]
        first = drawn(PLAN)
        self.assertEqual(len(set(first)), RUNS)
        for inertia, _ in first:
            self.assertTrue(0.5 <= float(inertia) <= 2.0)
        more = PLAN.replace("set:\n", "set:\n  bearing.viscosity: {normal: [1.0e-4, 1.0e-5, 5.0e-5, 2.0e-4]}\n")
        self.assertEqual(drawn(more), first)
        self.assertFalse(set(drawn(PLAN.replace("seed: 7", "seed: 8"))) & set(first))
        self.assertFalse(os.path.exists(self.path("unused")))

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

    def test_a_run_without_equilibrium_is_recorded_and_the_others_go_on(self):
        # A rim that gives way under flat flanks, and a solver that may not iterate: teeth jump below 600 N.m.
        plan = PLAN.replace("  input.temperature: {grid: [10.0, 40.0]}\n", """
  contact.support: springs
  contact.fit: 0.0
  contact.stiffness: {grid: [1.0e+6, 1.0e+12]}
  mesh.profile: trapezoid
  ring.tension_stiffness: 5.0e+7
  mesh.flank_angle: 1.0
  mesh.engagement_depth: 200.0e-6
  output.load_torque_limit: 1000.0
  solver.max_iterations: {grid: [20, 1]}
""").replace("load: {constant: 5.0}", "load: {trapezoid: {peak: 600.0, slope: 1.0e+5, hold: 1.0, pause: 1.0}}")
        self.write("plan.yaml", plan.replace("repeats: 3", "repeats: 1"))
        done = self.run_tool("sweep", "plan.yaml", "--out", "a")
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("4 runs done, 0 were there, 2 failed", done.stderr)
        rows = self.index("a")
        self.assertEqual([row["status"] for row in rows], ["ok", "failed", "ok", "failed"])
        self.assertIn("the solver found no equilibrium at 0.0", rows[1]["error"])
        self.assertIn("the insertion of the wave generator did not converge", rows[3]["error"])
        with h5py.File(self.path("a/" + rows[1]["file"]), "r") as file:
            self.assertLess(len(file["signals/motor_torque_reading"]), 25)
            self.assertEqual(file.attrs["status"], "failed")
        done = self.run_tool("sweep", "plan.yaml", "--out", "a")  # nothing is left to do, and it still says so
        self.assertEqual(done.returncode, 1)
        self.assertIn("0 runs done, 4 were there, 2 failed", done.stderr)

    def test_bad_plans_are_refused_before_anything_runs(self):
        self.write("steep.csv", "time,load\n0,0\n1,1e300\n")
        for old, new, parts in [
                ("duration: 0.06", "duration: -1.0",
                 ["plan.yaml:4: duration = -1.0 [s] is out of range, allowed: 0.001"]),
                ("duration: 0.06", "duration: long", ["plan.yaml:4: duration = 'long' must be a number [s]"]),
                ("[10.0, 40.0]", "[10.0, 400.0]",
                 ["plan.yaml:7: input.temperature = 400.0 [degC] is out of range, allowed: -40 ... 150 [degC]",
                  "run 3"]),
                ("[0.5, 2.0]", "[0.5, -2.0]",
                 ["plan.yaml:8: set.output.load_inertia.log_uniform", "[lowest, highest]"]),
                ("input.temperature", "input.temperatur", ["unknown parameter input.temperatur", "did you mean"]),
                ("repeats: 3", "repeats: 0", ["plan.yaml:9: repeats = 0 [-] is out of range, allowed: 1"]),
                ("seed: 7", "sead: 7", ["plan.yaml:3: sead = 7 is unknown; allowed: name, seed"]),
                ("    speed: {sinus:", "    sped: {sinus:", ["plan.yaml:12: duty.0.sped is unknown; allowed: name"]),
                ("speed: {sinus:", "speed: {square:", ["duty.0.speed.square is unknown; allowed: constant, sinus"]),
                ("mesh_force,", "mesh_forces,", ["record.groups.teeth.columns.0 = 'mesh_forces' is no column"]),
                ("rate: 500.0", "rate: 333.0", ["rate = 333.0 [Hz] must divide solver.rate = 10000"]),
                ("float32", "float16", ["type = 'float16' is unknown; allowed: float32, float64"]),
                ("format: hdf5", "format: hdf6", ["record.format = 'hdf6' is unknown; allowed: hdf5, bag"]),
                ("load: {constant: 5.0}",
                 "temperature: {sinus: {mean: 100.0, amplitude: 60.0, frequency: 1.0, phase: 0.0}}",
                 ["plan.yaml:14: duty.0.temperature reaches 40 ... 160 [degC], allowed: -40 ... 150 [degC]"]),
                ("sinus: {mean: 0.5, amplitude: {uniform: [0.5, 1.5]}, frequency: 8.0, phase: 0.0}",
                 "trapezoid: {peak: 0.1, slope: 1.0e+9, hold: 0.0, pause: 0.0}",
                 ["plan.yaml:12: duty.0.speed.trapezoid has a half period", "allowed: >= 1.0e-9 [s]"]),
                ("load: {constant: 5.0}", "load: {csv: {file: steep.csv, column: load}}",
                 ["steep.csv:3: column 'load' = 1.0e+300 [N.m] is out of range"]),
                ("load: {constant: 5.0}", "load: {csv: {file: {choice: [steep.csv, none.csv]}, column: time}}",
                 ["none.csv cannot be read"]),
                ("deflate: 0", "deflate: 0\n  indicators: some", ["record.indicators = 'some' must be true or false"]),
                ("load: {constant: 5.0}", "load: {csv: {file: none.csv, column: load}}", ["none.csv cannot be read"]),
                ("[0.5, 2.0]}", "[0.5, 2.0]}\n  gear.wave_amplitude: &loop {choice: [*loop]}",
                 ["plan.yaml:9:", "makes the plan too large"]),
                ("name: test", "name: &a [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n" + "".join(
                    f"l{level}: &{name} [{', '.join(['*' + before] * 10)}]\n"
                    for level, (before, name) in enumerate(zip("abcdefgh", "bcdefghi"))), ["makes the plan too large"]),
                ("log_uniform: [0.5, 2.0]", "normal: [1.0, 0.1, 1.0, 1.0]", ["must leave at least 0.001"]),
                ("log_uniform: [0.5, 2.0]", "normal: [1.0, 0.1, 1.0, 1.00001]", ["must leave at least 0.001"]),
                ("log_uniform: [0.5, 2.0]", "integer: [0, 1.0e+300]", ["must be two whole numbers"]),
                ("seed: 7", "seed: 7\nseed: 8", ["seed"]),
                ("name: test", "name: [", ["plan.yaml:"])]:
            with self.subTest(new):
                self.assertIn(old, PLAN)
                self.write("plan.yaml", PLAN.replace(old, new, 1))
                self.fail_with(1, parts, "sweep", "plan.yaml", "--out", "a")
                self.assertFalse(os.path.exists(self.path("a")))
        self.fail_with(1, ["none.yaml cannot be read"], "sweep", "none.yaml", "--out", "a")
        self.fail_with(2, ["I/N"], "sweep", "plan.yaml", "--out", "a", "--shard", "2/2")

    def test_two_sweeps_into_one_directory_do_not_spoil_it(self):
        for name, plan in [("hdf5", PLAN.replace("repeats: 3", "repeats: 8")),
                           ("bag", PLAN[:PLAN.index("  format:")].replace("repeats: 3", "repeats: 8")
                            + "  format: bag\n")]:
            with self.subTest(name):
                self.write("both.yaml", plan)
                self.sweep("alone", plan="both.yaml")
                both = [self.start("both.yaml", "both") for _ in range(2)]
                ends = [(process.communicate(timeout=120 * tool.SLOWER)[1].decode(), process.returncode)
                        for process in both]
                self.assertIn(0, [code for _, code in ends], ends)
                for note, code in ends:
                    if code != 0:
                        self.assertEqual(code, 1)
                        self.assertIn("is being written by another sweep into both", note)
                self.assertEqual(tree(self.path("both")), tree(self.path("alone")))
                for directory in ("alone", "both"):
                    shutil.rmtree(self.path(directory))

    def test_a_damaged_run_is_done_again_with_an_index_or_without(self):
        for name, plan in [("h5", PLAN), ("bag", PLAN[:PLAN.index("  format:")] + "  format: bag\n")]:
            self.write("plan.yaml", plan)
            self.sweep(name)
            before = tree(self.path(name))
            for indexed, flipped in [(True, [(1, 0.5), (2, 0.9), (4, 0.2)]), (False, [(0, 0.5), (3, 0.9), (5, 0.2)])]:
                with self.subTest(name, indexed=indexed):
                    if not indexed:  # as after a first sweep that was interrupted
                        os.remove(self.path(name + "/index.csv"))
                    for run, place in flipped:
                        path = self.path(f"{name}/runs/run_{run:09}.{name}")
                        content = bytearray(tool.read_bytes(path))
                        content[int(place * len(content))] ^= 0x10
                        with open(path, "wb") as file:
                            file.write(content)
                    self.assertIn("3 runs done, 3 were there, 0 failed, 3 damaged ones done again",
                                  self.sweep(name).stderr)
                    self.assertEqual(tree(self.path(name)), before)

    def test_a_file_carries_the_hash_of_its_bytes(self):
        self.sweep("a", "--jobs", 1)
        for row in self.index("a"):
            content = tool.read_bytes(self.path("a/" + row["file"]))
            known = 14695981039346656037
            for byte in content.replace(row["file_hash"].encode(), b"0" * 16):
                known = (known ^ byte) * 1099511628211 % 2 ** 64
            self.assertEqual(f"{known:016x}", row["file_hash"])

    def test_forces_that_were_not_found_are_not_numbers(self):
        self.write("plan.yaml", """
duration: 0.3
set: {solver.scene: auto, solver.max_iterations: {grid: [2, 20]}}
duty: [{torque: {constant: 0.4}, load: {constant: 20.0}}]
record:
  start: 0.01
  groups: {teeth: {rate: 1000.0, columns: [mesh_force, tooth_x, motor_angle]}}
""")
        done = self.sweep("a")
        few, enough = self.index("a")
        self.assertEqual((few["status"], enough["status"], enough["rows_without_forces"]), ("ok", "ok", "0"))
        self.assertGreater(int(few["rows_without_forces"]), 0)
        self.assertIn(few["rows_without_forces"] + " rows without forces on the teeth", done.stderr)
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

    def test_goes_on_with_the_threads_that_there_are(self):
        def limit():
            resource.setrlimit(resource.RLIMIT_STACK, (2 ** 30, 2 ** 30))  # of each thread, of at most 8 GB together
            resource.setrlimit(resource.RLIMIT_AS, (2 ** 33, 2 ** 33))
        if tool.SLOWER != 1.0:
            self.skipTest("a sanitizer takes all addresses")
        self.write("plan.yaml", PLAN.replace("repeats: 3", "repeats: 20"))
        done = subprocess.run([self.executable, "sweep", "plan.yaml", "--out", "a", "--jobs", "40"], cwd=self.directory,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True, timeout=300,
                              preexec_fn=limit, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stderr, r"[1-9]\d* of 40 threads \(--jobs\) could be started: ")
        self.assertIn("40 runs done", done.stderr)
        self.assertEqual(len(self.index("a")), 40)

    def test_a_long_list_takes_no_minutes(self):
        self.write("plan.yaml", PLAN.replace("repeats: 3", "repeats: 2500"))
        exit_code, seconds, _ = self.measure("sweep", "plan.yaml", "--out", "a", "--list")
        self.assertEqual(exit_code, 0)
        self.assertLess(seconds, 3.0)  # 5000 runs

    def test_a_directory_of_another_plan_is_refused(self):
        self.sweep("a")
        before = tree(self.path("a"))
        self.write("plan.yaml", PLAN.replace("seed: 7", "seed: 8"))
        self.fail_with(1, ["a/plan.json is of another plan; give another --out"], "sweep", "plan.yaml", "--out", "a")
        self.write("plan.yaml", PLAN)
        self.fail_with(1, ["a/plan.json is of another configuration"], "sweep", "plan.yaml", "--out", "a",
                       "--set", "output.load_inertia=2.0")
        with open(self.path("a/plan.json")) as file:
            text = file.read()
        version = json.loads(text)["version"]
        self.write("a/plan.json", text.replace(f'"version": "{version}"', '"version": "0.0.1"'))
        before["plan.json"] = tool.read_bytes(self.path("a/plan.json"))
        self.fail_with(1, ["a/plan.json is of another version of the software"], "sweep", "plan.yaml", "--out", "a")
        self.assertEqual(tree(self.path("a")), before)

    def test_dry_run_tells_runs_and_size_and_writes_nothing(self):
        done = self.sweep("a", "--dry-run")
        self.assertIn("runs 0 ... 5: class healthy, duty turning", done.stdout)
        self.assertRegex(done.stdout, r"expected time, \d+ jobs +[0-9.]{1,6} (s|min)\n")
        self.assertRegex(done.stdout, r"response surfaces to build +0\n")
        self.assertFalse(os.path.exists(self.path("a")))

    def test_the_shipped_plans_are_right(self):
        for name in ["small.yaml", "temperature_grid.yaml", "fault_grid.yaml"]:
            rows = self.sweep("unused", "--list", plan=os.path.join(tool.CHECKOUT, "plans", name)).stdout.splitlines()
            self.assertGreater(len(rows), 2)


if __name__ == "__main__":
    tool.main()
