// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace hjt
{
constexpr const char* DEFAULT_NAMESPACE = "/joint_twin";

/// Names of the twin's topics, relative to the private namespace of the node, for live topics and for bags. A topic
/// that only CHANNELS uses is named only there.
namespace topics
{
constexpr const char* MOTOR_TORQUE_COMMAND = "motor_torque_command";  ///< input, std_msgs/Float64 [N.m]
constexpr const char* COMMAND = "command";          ///< input, sensor_msgs/JointState, the stamped motor_torque_command
constexpr const char* LOAD_TORQUE = "load_torque";  ///< input, std_msgs/Float64 [N.m]
constexpr const char* LOAD = "load";                ///< input, sensor_msgs/JointState, the stamped load_torque
constexpr const char* INJECT_FAULT = "inject_fault";              ///< input, harmonic_joint_twin/Fault
constexpr const char* MEASURED = "joint_states_measured";         ///< input, sensor_msgs/JointState, efforts in A
constexpr const char* JOINT_TEMPERATURES = "joint_temperatures";  ///< input, sensor_msgs/Temperature of the joint
constexpr const char* JOINT_STATES = "joint_states";              ///< output, sensor_msgs/JointState
constexpr const char* ENCODERS = "encoders";                      ///< output, harmonic_joint_twin/Encoders
constexpr const char* CONTACT_FORCES = "contact_forces";          ///< output, harmonic_joint_twin/ContactForces
constexpr const char* HEALTH = "health";                          ///< output, harmonic_joint_twin/Health
constexpr const char* STRESS = "stress";                          ///< output, harmonic_joint_twin/Stress
constexpr const char* INDICATORS = "indicators";                  ///< output, harmonic_joint_twin/Indicators
constexpr const char* ASSESSMENT = "assessment";                  ///< output, harmonic_joint_twin/Assessment
constexpr const char* COMPARISON = "comparison";                  ///< output, harmonic_joint_twin/Comparison
constexpr const char* VERDICT = "verdict";                        ///< output, latched, harmonic_joint_twin/Verdict
constexpr const char* FAULTS = "faults";                          ///< output, latched, harmonic_joint_twin/Faults
constexpr const char* REMAINING_LIFE = "remaining_life";          ///< output, harmonic_joint_twin/RemainingLife
constexpr const char* TIMING = "timing";                          ///< output when live, harmonic_joint_twin/Timing
}  // namespace topics
}  // namespace hjt
