// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace hjt
{
/// State of the joint and its energy ledger; a plain vector, so that Boost.odeint can march it.
using JointState = Eigen::Matrix<double, 8, 1>;

namespace joint_state
{
constexpr int MOTOR_ANGLE = 0;   ///< [rad]
constexpr int OUTPUT_ANGLE = 1;  ///< [rad]
constexpr int MOTOR_SPEED = 2;   ///< [rad/s]
constexpr int OUTPUT_SPEED = 3;  ///< [rad/s]
constexpr int MOTOR_WORK = 4;    ///< done by the motor's torque [J]
constexpr int LOAD_WORK = 5;     ///< done on the external load torque [J]
constexpr int DISSIPATED = 6;    ///< by all friction [J]
constexpr int DRIVE_TORQUE = 7;  ///< of the motor's current at 25 degC [N.m]
}  // namespace joint_state
}  // namespace hjt
