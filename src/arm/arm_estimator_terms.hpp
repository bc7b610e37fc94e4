// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "arm/arm_estimator.hpp"

namespace hjt
{
/// Terms of the arm, then of each joint.
namespace term
{
constexpr int JUMP = ArmEstimator::LOAD;
constexpr int GAIN = JUMP + ArmEstimator::PAYLOAD;
constexpr int FRICTION = GAIN + 1;
constexpr int COLD = FRICTION + 1;
constexpr int GROUP = COLD + 1;  // base to elbow, wrists
constexpr int GROUPS = 2;
constexpr int OWN = GROUP + GROUPS;
constexpr int OWN_GAIN = 0;
constexpr int OWN_FRICTION = 1;
constexpr int OWN_COLD = 2;
constexpr int OWN_OFFSET = 3;
constexpr int OWN_LOSS = 4;
constexpr int OWN_INERTIA = 5;
constexpr int PER_JOINT = 6;
constexpr int USED = GROUP + 1 + PER_JOINT;  // of one joint's rows

constexpr double NEVER = 1e-6;   // width of the prior of a term that is left out
constexpr double STUDENT = 4.0;  // degrees of freedom of what rows leave
constexpr int STARTS = 4;
constexpr int HELD = -1;  // a start with all priors at full weight

inline int groupOf(std::size_t joint)
{
  constexpr std::size_t TO_ELBOW = 3;
  return joint < TO_ELBOW ? GROUP : GROUP + 1;
}

inline int ownOf(std::size_t joint)
{
  return OWN + PER_JOINT * static_cast<int>(joint);
}

/// Of one joint's rows. The payload and its jump have one slope, and so have terms of the arm, the group and the joint:
/// of its load; of the whole, friction, cold friction, an offset, loss and inertia.
inline int slopeOf(int used)
{
  constexpr std::array<int, USED - GAIN> OF_OTHERS{ 0, 1, 2, 1, 0, 1, 2, 3, 4, 5 };
  return used < JUMP ? used :
         used < GAIN ? used - JUMP :
                       ArmEstimator::LOAD + OF_OTHERS[static_cast<std::size_t>(used - GAIN)];
}
}  // namespace term

/// Widths of all terms.
struct ArmEstimator::Prior
{
  Eigen::VectorXd width;
  std::vector<bool> normal;  // else Cauchy's
};

/// Values of all terms, and how they came about.
struct ArmEstimator::Point
{
  Eigen::VectorXd at;
  Eigen::MatrixXd information;
  std::vector<double> deviations;  // of the rows of each joint [A]
  double rareness{};
  double cost{ std::numeric_limits<double>::infinity() };
};

/// Of one round.
struct ArmEstimator::Work
{
  std::vector<Eigen::VectorXd> errors;  // of the rows of each joint [A]
  std::vector<Slope> slopes;            // of those of one joint
};

/// Of the slopes of rows of one state, with each other and with the error.
struct ArmEstimator::Products
{
  Eigen::Matrix<double, SLOPES, SLOPES> slopes = Eigen::Matrix<double, SLOPES, SLOPES>::Zero();
  Slope error = Slope::Zero();
};
}  // namespace hjt
