# SPDX-License-Identifier: BSD-3-Clause
"""`joint_twin compare` on simulated robots with hidden faults: other errors of manufacture than the twin's, real sensors.

The robots are made by `joint_twin sweep`, whose drive control holds a speed as a robot's does."""
import tool

SENSORS = ["--config", "real_sensors.yaml"]
TELEMETRY = ["--joint", "joint", "--topic", "/joint_twin/joint_states", *SENSORS]
PLAN = """name: robot
seed: 7
duration: {duration}
overlays: [as_built.yaml, real_sensors.yaml]
set:
  solver.scene: auto
  output.load_inertia: 2.0
  output.gravity_torque: {gravity}
  manufacture.flexspline_pitch_seed: 11
  manufacture.circular_spline_pitch_seed: 12
  publish.joint_states_rate: 500.0
  publish.encoders_rate: 0.01
  publish.contact_forces_rate: 0.01
  publish.health_rate: 0.01
  publish.indicators_rate: 0.01
repeats: 1
duty:
  - name: motion
    speed: {speed}
    bandwidth: 8.0
    load: {{constant: {load}}}
classes:
  robot: [{fault}]
record:
  format: bag
"""


class HiddenFault(tool.ToolTest):
    def robot(self, name, fault="", **motion):
        """Makes NAME.bag of a robot with this fault from the start."""
        listed = "{{kind: {}, severity: 1.0, place: {}, onset: 0.0}}".format(*fault) if fault else ""
        self.write("plan.yaml", PLAN.format(fault=listed, **motion))
        self.succeed("sweep", "plan.yaml", "--out", name, "--quiet")
        return f"{name}/runs/run_000000000.bag"

    def compare(self, recording, report, *arguments):
        return self.succeed_json("compare", recording, *TELEMETRY, "--report", report, "--set", "output.load_inertia=2.0",
                                 *arguments)

    def causes(self, report, title):
        return next(finding["causes"] for finding in report["verdict"]["findings"] if finding["title"] == title)

    def test_what_a_swinging_load_shows_is_named(self):
        motion = {"duration": 25.0, "gravity": 45.0, "load": 0.0,
                  "speed": "{sinus: {mean: 0.0, amplitude: 0.8, frequency: 0.1, phase: 0.0}}"}
        gravity = ["--set", "output.gravity_torque=45.0"]
        sound = self.compare(self.robot("sound", **motion), "r0", *gravity)
        self.assertEqual(sound["verdict"]["level"], "OK")
        again = self.compare("sound/runs/run_000000000.bag", "r1", *gravity, "--reference", "r0")
        self.assertEqual(again["verdict"]["level"], "OK")

        grease = self.robot("grease", ("lubricant_degradation", -1), **motion)
        alone = self.compare(grease, "r2", *gravity)
        self.assertIn("lubricant_degradation", self.causes(alone, "Friction"))
        beside = self.compare(grease, "r3", *gravity, "--reference", "r0")
        self.assertIn("lubricant_degradation", self.causes(beside, "Friction"))
        self.assertEqual(self.causes(beside, "Torsion"), [])

        crack = self.compare(self.robot("crack", ("flange_crack", -1), **motion), "r4", *gravity, "--reference", "r0")
        self.assertIn("flange_crack", self.causes(crack, "Torsion"))
        self.assertEqual(self.causes(crack, "Friction"), [])

    def test_a_spalled_race_is_named_by_its_line(self):
        motion = {"gravity": 0.0, "load": 60.0, "speed": "{constant: 0.2618}"}
        windows = ["--set", "indicators.window_turns=25.0", "--set", "indicators.baseline_windows=16"]
        self.compare(self.robot("sound", duration=105.0, **motion), "r0", *windows)
        spall = self.robot("spall", ("bearing_outer_race", 0), duration=20.0, **motion)
        self.assertEqual(self.causes(self.compare(spall, "r1", *windows, "--reference", "r0"), "Signals by windows"),
                         ["bearing_outer_race"])


if __name__ == "__main__":
    tool.main()
