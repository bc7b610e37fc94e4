# SPDX-License-Identifier: BSD-3-Clause
"""`joint_twin sweep`: how a plan of many runs is worked off."""
import csv
import json
import os
import resource
import shutil
import signal
import subprocess
import time

import h5py

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
DRIVES = "drives: {number: 4, set: {bearing.viscosity: {log_uniform: [1.0e-4, 2.0e-4]}}}\n"
OF_DRIVES = PLAN.replace("repeats: 3", DRIVES + "repeats: 3")


def tree(directory):
    """Bytes of every file below."""
    return {os.path.relpath(os.path.join(path, name), directory): tool.read_bytes(os.path.join(path, name))
            for path, _, names in os.walk(directory) for name in names}


class SweepTest(tool.ToolTest):

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


class Sweep(SweepTest):
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
        name = f"run_{len(finished):09}.h5"
        self.assertNotIn(name, finished)
        self.write(f"killed/runs/{name}.12345678.part", "what it was at when it was killed")
        done = self.sweep("killed", "--jobs", 2)
        self.assertIn(f"{len(finished)} already present", done.stderr)
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
        index = self.index("a")
        rows = [row for row in index if row["status"] != "missing"]
        self.assertGreaterEqual(len(rows), 2)
        self.assertLess(len(rows), len(index))
        self.assertEqual([int(row["run"]) for row in index], list(range(len(index))))
        self.assertEqual(sorted(os.path.basename(row["file"]) for row in rows), sorted(os.listdir(self.path("a/runs"))))

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

    def test_a_drive_has_the_same_values_in_all_its_runs_whatever_these_are(self):
        def drives(plan):
            self.write("other.yaml", plan)
            found = {}
            for row in csv.DictReader(self.sweep("unused", "--list", plan="other.yaml").stdout.splitlines()):
                found.setdefault(int(row["drive"]), []).append(row)
            for runs in found.values():
                self.assertEqual(len({(row["drives.set.bearing.viscosity"], row["split"]) for row in runs}), 1)
            return found, {drive: (runs[0]["drives.set.bearing.viscosity"], runs[0]["split"])
                           for drive, runs in found.items()}
        runs, first = drives(OF_DRIVES)
        self.assertEqual(list(first), [0, 1, 2, 3])
        self.assertEqual([split for _, split in first.values()], ["train"] * 3 + ["test"])
        self.assertEqual(len({viscosity for viscosity, _ in first.values()}), 4)
        for number, of_drive in runs.items():
            self.assertEqual([int(row["run"]) for row in of_drive], list(range(RUNS * number, RUNS * (number + 1))))
            self.assertEqual([(float(row["set.input.temperature"]), row["repeat"]) for row in of_drive],
                             [(degrees, repeat) for degrees in (10.0, 40.0) for repeat in "012"])
        for name in ("set.output.load_inertia", "noise_seed"):
            self.assertEqual(len({row[name] for of_drive in runs.values() for row in of_drive}), 4 * RUNS)
        faults = "classes:\n  healthy: []\n  old: [{kind: lubricant_degradation, severity: {uniform: [0.1, 0.4]}}]\n"
        runs, others = drives(OF_DRIVES.replace("repeats: 3", faults + "repeats: 1"))
        self.assertEqual(others, first)
        self.assertEqual([[row["class"] for row in of_drive] for of_drive in runs.values()],
                         4 * [["healthy", "healthy", "old", "old"]])
        _, more = drives(OF_DRIVES.replace("number: 4", "number: 9"))
        self.assertEqual({drive: more[drive] for drive in first}, first)
        self.assertEqual([drive for drive, (_, split) in more.items() if split == "test"], [3, 7])
        _, others = drives(OF_DRIVES.replace("seed: 7", "seed: 8"))
        self.assertFalse(set(others.values()) & set(first.values()))

    def test_drives_give_the_same_bytes_in_shards_and_files_that_name_them(self):
        self.write("plan.yaml", OF_DRIVES)
        self.sweep("one", "--jobs", 1)
        for shard in ("2/3", "0/3", "1/3"):
            self.sweep("shards", "--jobs", 2, "--shard", shard)
        self.assertEqual(tree(self.path("shards")), tree(self.path("one")))
        rows = self.index("one")
        self.assertEqual(len(rows), 4 * RUNS)
        for row in rows:
            with h5py.File(self.path("one/" + row["file"]), "r") as file:
                self.assertEqual((file.attrs["drive"], file.attrs["split"]), (int(row["drive"]), row["split"]))
                self.assertIn(f"bearing.viscosity: {row['drives.set.bearing.viscosity']}",
                              file["parameters"][()].decode())
        self.assertIn("runs 0 ... 23: class healthy", self.sweep("unused", "--dry-run").stdout)

    def test_the_runs_of_a_drive_share_its_response_surface(self):
        drawn = DRIVES.replace("4, set", "2, test: 0.5, set").replace(
            "bearing.viscosity: {log_uniform: [1.0e-4, 2.0e-4]}", "contact.fit: {uniform: [2.0e-6, 4.0e-6]}")
        scene = "set:\n  solver.scene: auto\n"
        self.write("plan.yaml", PLAN.replace("set:\n", scene).replace("repeats", drawn + "repeats"))
        cache = {"XDG_CACHE_HOME": self.path("cache")}
        done = self.succeed_json("sweep", "plan.yaml", "--out", "a", environment=cache)
        self.assertEqual((done["done"], done["failed"]), (2 * RUNS, 0))
        self.assertEqual(len(os.listdir(self.path("cache/harmonic_joint_twin"))), 2)

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
        self.assertIn("4 runs done, 0 already present, 2 failed", done.stderr)
        rows = self.index("a")
        self.assertEqual([row["status"] for row in rows], ["ok", "failed", "ok", "failed"])
        self.assertIn("the solver found no equilibrium at 0.0", rows[1]["error"])
        self.assertIn("the insertion of the wave generator did not converge", rows[3]["error"])
        with h5py.File(self.path("a/" + rows[1]["file"]), "r") as file:
            self.assertLess(len(file["signals/motor_torque_reading"]), 25)
            self.assertEqual(file.attrs["status"], "failed")
        done = self.run_tool("sweep", "plan.yaml", "--out", "a")  # nothing is left to do, and it still says so
        self.assertEqual(done.returncode, 1)
        self.assertIn("0 runs done, 4 already present, 2 failed", done.stderr)

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
                ("mesh_force,", "mesh_forces,", ["record.groups.teeth.columns.0 = 'mesh_forces' is not a column"]),
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
                ("log_uniform: [0.5, 2.0]", "normal: [1.0, 0.1, 1.0, 1.0]", ["must contain at least 0.001"]),
                ("log_uniform: [0.5, 2.0]", "normal: [1.0, 0.1, 1.0, 1.00001]", ["must contain at least 0.001"]),
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

    def test_bad_drives_are_refused(self):
        for old, new, part in [
                ("number: 4", "number: 1", "drives.number = 1 [-] is out of range, allowed: 2 ... 1.0e+6"),
                ("number: 4", "number: 3",
                 "drives with test = 0.25 [-] leaves no drive of 3 for the test, allowed: 0.333333"),
                ("number: 4", "number: 4, test: 1.0", "leaves no drive of 4 to learn from, allowed: 0.25 ... below 1"),
                ("number: 4", "number: 4, test: 1.1", "drives.test = 1.1 [-] is out of range, allowed: 0 ... 1"),
                ("number: 4", "number: 4, tests: 0.5", "drives.tests = 0.5 is unknown; allowed: number, test, set"),
                ("bearing.viscosity", "bearing.viscosit", "unknown parameter bearing.viscosit"),
                ("[1.0e-4, 2.0e-4]", "[1.0e+4, 2.0e+4]", "bearing.viscosity = "),
                ("bearing.viscosity", "input.temperature", "drives.set.input.temperature is also in the mapping 'set'"),
                ("log_uniform", "grid", "drives.set.bearing.viscosity cannot be a grid over drives"),
                ("{log_uniform: [1.0e-4, 2.0e-4]}", "1.0e-4", "drives.set must draw at least one parameter")]:
            with self.subTest(new):
                self.assertIn(old, DRIVES)
                self.write("plan.yaml", OF_DRIVES.replace(old, new))
                self.fail_with(1, ["plan.yaml:9: ", part], "sweep", "plan.yaml", "--out", "a")
                self.assertFalse(os.path.exists(self.path("a")))

    def test_a_directory_with_files_of_something_else_is_left_as_it_is(self):
        for name, said in (("index.csv", "index.csv belongs to something else"), ("plan.json", "plan.json"),
                           ("runs/run_000000.h5", "contains other files")):
            with self.subTest(name):
                folder = self.path("of_" + os.path.basename(name))
                os.makedirs(os.path.dirname(os.path.join(folder, name)))
                self.write(os.path.join(folder, name), "precious")
                self.fail_with(1, [said], "sweep", "plan.yaml", "--out", folder)
                self.assertEqual(tool.read_bytes(os.path.join(folder, name)), b"precious")

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
                    self.assertIn("3 runs done, 3 already present, 0 failed, 3 damaged and repeated",
                                  self.sweep(name).stderr)
                    self.assertEqual(tree(self.path(name)), before)

    def test_a_full_disk_leaves_no_half_run(self):
        plan = PLAN.replace("0.06", "3.0").replace("100.0", "1000.0").replace("repeats: 3", "repeats: 1")
        for name, text in (("hdf5", plan), ("bag", plan[:plan.index("  format:")] + "  format: bag\n")):
            with self.subTest(name):
                self.write("plan.yaml", text)
                done = self.run_with_file_limit(2000000, "sweep", "plan.yaml", "--out", name, "--jobs", 1)
                self.assertEqual((done.returncode, done.stdout), (1, ""), done.stderr)
                self.assertRegex(done.stderr, "run_00000000.* cannot be written")
                self.assertEqual(os.listdir(self.path(name + "/runs")), [])
                self.sweep(name)  # with space again it goes on

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
        self.fail_with(1, ["a/plan.json belongs to another plan; give another --out"], "sweep", "plan.yaml", "--out",
                       "a")
        self.write("plan.yaml", PLAN)
        self.fail_with(1, ["a/plan.json belongs to another configuration"], "sweep", "plan.yaml", "--out", "a",
                       "--set", "output.load_inertia=2.0")
        with open(self.path("a/plan.json")) as file:
            text = file.read()
        version = json.loads(text)["version"]
        self.write("a/plan.json", text.replace(f'"version": "{version}"', '"version": "0.0.1"'))
        before["plan.json"] = tool.read_bytes(self.path("a/plan.json"))
        self.fail_with(1, ["a/plan.json belongs to another version of the software"], "sweep", "plan.yaml", "--out",
                       "a")
        self.assertEqual(tree(self.path("a")), before)

    def test_dry_run_tells_runs_and_size_and_writes_nothing(self):
        done = self.sweep("a", "--dry-run")
        self.assertIn("runs 0 ... 5: class healthy, duty turning", done.stdout)
        self.assertRegex(done.stdout, r"expected time, \d+ jobs +[0-9.]{1,6} (s|min)\n")
        self.assertRegex(done.stdout, r"response surfaces to build +0\n")
        self.assertFalse(os.path.exists(self.path("a")))

    def test_the_shipped_plans_are_right(self):
        for name in ["small.yaml", "temperature_grid.yaml", "fault_grid.yaml", "drives.yaml"]:
            rows = self.sweep("unused", "--list", plan=os.path.join(tool.CHECKOUT, "plans", name)).stdout.splitlines()
            self.assertGreater(len(rows), 2)


if __name__ == "__main__":
    tool.main()
