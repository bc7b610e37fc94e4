// SPDX-License-Identifier: BSD-3-Clause
#include "apps/tool/signal_options.hpp"

namespace hjt
{
void addSignalOptions(Command& command, SignalOptions& options)
{
  command
      .add("recordings", options.recordings,
           "one recording, or several of the same joint; a run of a data set (HDF5) is read with the parameters in its "
           "file, "
           "over them those of --config and --set")
      .required()
      .type("IN.csv|IN.bag|IN.h5")
      .check(wrongSignalFile);
  command.add("--joint", options.joint,
              "bag: a robot's joint on /joint_states, effort in A, by telemetry.torque_per_current: base, shoulder, "
              "elbow, wrist_1 ..., or its name in the messages; default: the twin's own");
  SignalSource& source = options.source;
  const auto column = [&command](const char* name, std::string& field, const char* meaning)
  { command.add(name, field, meaning).type("COLUMN"); };
  column("--time", source.time, "CSV, HDF5: time [s]; default: time");
  column("--motor-torque", source.motor_torque,
         "CSV, HDF5: motor torque, or current with --torque-scale; default: motor_torque_reading, else "
         "motor_torque");
  column("--motor-angle", source.motor_angle, "CSV, HDF5: motor encoder [rad]; default: motor_angle_encoder");
  column("--output-angle", source.output_angle, "CSV, HDF5: output encoder [rad]; default: output_angle_encoder");
  column("--motor-velocity", source.motor_velocity,
         "CSV, HDF5: motor speed [rad/s]; default: motor_velocity_encoder, else differences of the angle");
  column("--load-torque", source.load_torque,
         "CSV, HDF5: load torque at the output, > 0 resists positive motion [N.m]; default: load_torque");
  column("--temperature", source.temperature,
         "CSV, HDF5: temperature [degC]; default: housing_temperature, else temperature");
  column("--target-angle", source.target_angle,
         "CSV, HDF5: set point of the output angle [rad]; default: target_angle");
  command.add("--torque-scale", options.torque_scale,
              "motor torque per unit of the recorded signal [N.m]; default: 1, and with --joint "
              "telemetry.torque_per_current / ratio [N.m/A]");
  command
      .add("--states-topic", options.states_topic,
           "bag: JointState messages; default: NAMESPACE/joint_states, and with --joint /joint_states")
      .type("TOPIC");
  command.add("--load-topic", options.load_topic, "bag: load torque; default: NAMESPACE/load").type("TOPIC");
  addNamespaceOption(command, options.joint_namespace);
}
}  // namespace hjt
