# SPDX-License-Identifier: BSD-3-Clause
"""Which fault of the gear the assessment takes faults of brake, sensors and motor for.

A UR5's shoulder in its check-up, sound, with real sensors: of the first runs a reference is made; into the others each
fault is put (hjt.drive_fault), and the assessment is asked. The runs are kept.

    lab/run other_faults
"""
import argparse
import collections
import math
import pathlib

import harmonic_joint_twin as hjt

import lab

REFERENCE, JUDGED = 24, 6
WINDOW = 29.0                    # [s]
PLAN = f"""
seed: 17
duration: {WINDOW + 1.3}
overlays: [joints/shoulder.yaml, real_sensors.yaml]
set: {{solver.scene: auto, input.temperature: {{uniform: [20.5, 29.5]}}}}
repeats: {REFERENCE + JUDGED}
duty:
  - {{name: check_up, speed: {{csv: {{file: check_up.csv, column: shoulder_velocity}}}}, bandwidth: 8.0}}
record:
  groups:
    signals: {{rate: 2000.0, columns: [motor_angle_encoder, output_angle_encoder, motor_torque_reading,
                                     housing_temperature]}}
"""
OVERLAYS = ["joints/shoulder.yaml", "real_sensors.yaml",
            {"indicators.window_time": WINDOW, "indicators.window_turns": 1e5}]
COUNT = 2.0 * math.pi / 4320.0   # of the motor encoder [rad]
# `sizes`: as printed; `factor`: to SI; `onset` [s].
Fault = collections.namedtuple("Fault", "words kind sizes unit factor onset", defaults=[0.0])
FAULTS = (Fault("brake drags", "brake_drag", (0.005, 0.02, 0.1), "N·m at the motor", 1.0),
          Fault("motor encoder loses counts", "lost_counts", (0.01, 0.1, 1.0), "counts a turn forward", COUNT),
          Fault("output encoder off", "encoder_offset", (5.0,), "mrad", 1e-3),
          Fault("output encoder slips in the middle", "encoder_offset", (0.1, 1.0, 5.0), "mrad", 1e-3, 0.5 * WINDOW),
          Fault("gain of the current", "current_gain", (2.0, 5.0, 10.0), "% too much", 0.01),
          Fault("weak magnets", "weak_magnets", (2.0, 5.0, 10.0), "% of the flux", 0.01))


def stuck():
    """How far the motor turns in 2 s at its limit of torque in an engaged brake [rad]."""
    parameters = hjt.Parameters("joints/shoulder.yaml", {"brake.engaged_at_start": True, "output.gravity_torque": 0.0})
    rows = hjt.Twin(parameters).run(20000, motor_torque=parameters["motor.torque_limit"], every=100)
    return float(abs(rows["motor_angle"]).max())


def row_of(words, size, unit, verdicts):
    alarms = verdicts[verdicts.level.isin(["WARN", "ERROR"])]
    judged = int(verdicts.level.isin(["OK", "WARN", "ERROR"]).sum())
    causes = collections.Counter(alarms.cause).most_common()
    named = ", ".join(f"`{cause}` {count}" for cause, count in causes) or "-"
    shown = ", ".join(f"`{name}`" for name, _ in collections.Counter(alarms.indicator).most_common(2)) or "-"
    means = [f"{alarms[name].mean():.2f}" if len(alarms) else "-" for name in ("confidence", "severity")]
    return (f"| {words} | {size:g} {unit} | {len(alarms)} of {judged} | {len(verdicts) - judged} | {named} | "
            f"{' | '.join(means)} | {shown} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--work", type=pathlib.Path, required=True, help="folder for the runs")
    parser.add_argument("--docs", type=pathlib.Path, help="folder of faults.md; else to the terminal")
    options = parser.parse_args()
    options.work.mkdir(parents=True, exist_ok=True)
    hjt.checkup("ur5", options.work / "check_up.csv", joint="shoulder", force=True)
    (options.work / "plan.yaml").write_text(PLAN)
    hjt.sweep(options.work / "plan.yaml", options.work / "set")
    runs = [run for _, run in hjt.load(options.work / "set", "signals").groupby("run")]
    reference = options.work / "reference.yaml"
    hjt.reference(runs[:REFERENCE], reference, overlays=OVERLAYS, force=True)
    lines = ["| fault outside the gear | size | alarms, of runs judged | runs not judged | named causes, alarms "
             "| mean confidence | mean severity | indicators with the largest deviation |", "|---" * 8 + "|"]
    sound = hjt.assess(runs[REFERENCE:], reference, check_up=True, overlays=OVERLAYS)
    lines.append(row_of("none", 0.0, "", sound))
    for fault in FAULTS:
        for size in fault.sizes:
            faulty = [hjt.drive_fault(run, fault.kind, size * fault.factor, onset=fault.onset)
                      for run in runs[REFERENCE:]]
            verdicts = hjt.assess(faulty, reference, check_up=True, overlays=OVERLAYS)
            lines.append(row_of(fault.words, size, fault.unit, verdicts))
    lines += ["", "The assessment cannot judge a joint with a stuck brake. At its torque limit the motor turns "
              f"{stuck():.2g} rad in 2 s, so that no window is completed."]
    lab.write_or_print(options.docs, "faults.md", "others", lines)


if __name__ == "__main__":
    main()
