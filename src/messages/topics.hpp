// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace hjt
{
/// Default namespace of the node.
constexpr const char* DEFAULT_NAMESPACE = "/joint_twin";

/// Names of the twin's topics, relative to the private namespace of the node, both live and in bags. A topic that only
/// CHANNELS uses is named only there.
namespace topics
{
constexpr const char* MOTOR_TORQUE_COMMAND = "motor_torque_command";  ///< in, std_msgs/Float64 [N.m]
constexpr const char* COMMAND = "command";  ///< in, sensor_msgs/JointState, stamped form of motor_torque_command
constexpr const char* LOAD_TORQUE = "load_torque";         ///< in, std_msgs/Float64 [N.m]
constexpr const char* LOAD = "load";                       ///< in, sensor_msgs/JointState, stamped form of load_torque
constexpr const char* INJECT_FAULT = "inject_fault";       ///< in, harmonic_joint_twin/Fault
constexpr const char* MEASURED = "joint_states_measured";  ///< in, sensor_msgs/JointState, effort in A
constexpr const char* JOINT_TEMPERATURES = "joint_temperatures";  ///< in, sensor_msgs/Temperature, frame_id = joint
constexpr const char* JOINT_STATES = "joint_states";              ///< out, sensor_msgs/JointState
constexpr const char* ENCODERS = "encoders";                      ///< out, harmonic_joint_twin/Encoders
constexpr const char* CONTACT_FORCES = "contact_forces";          ///< out, harmonic_joint_twin/ContactForces
constexpr const char* HEALTH = "health";                          ///< out, harmonic_joint_twin/Health
constexpr const char* STRESS = "stress";                          ///< out, harmonic_joint_twin/Stress
constexpr const char* INDICATORS = "indicators";                  ///< out, harmonic_joint_twin/Indicators
constexpr const char* ASSESSMENT = "assessment";                  ///< out, harmonic_joint_twin/Assessment
constexpr const char* COMPARISON = "comparison";                  ///< out, harmonic_joint_twin/Comparison
constexpr const char* VERDICT = "verdict";                        ///< out, latched, harmonic_joint_twin/Verdict
constexpr const char* FAULTS = "faults";                          ///< out, latched, harmonic_joint_twin/Faults
constexpr const char* REMAINING_LIFE = "remaining_life";          ///< out, harmonic_joint_twin/RemainingLife
constexpr const char* TIMING = "timing";                          ///< out, live only, harmonic_joint_twin/Timing
}  // namespace topics
}  // namespace hjt
