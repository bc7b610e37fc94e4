// SPDX-License-Identifier: BSD-3-Clause
#include "identification/payload_fit.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "arm/arm_dynamics.hpp"
#include "identification/regression.hpp"

namespace hjt
{
namespace
{
constexpr double MOVING = 0.05;  // [rad/s]
constexpr double BLOCK = 0.1;    // [s]
constexpr double OUTLIER = 3.0;  // deviations
constexpr int PAYLOAD = 4;       // mass and its three moments
constexpr int NUISANCES = 4;     // of each joint: gain, Coulomb and viscous friction, offset
/// What each is known to before: mass [kg], moment [kg.m]; gain [-], Coulomb friction [A], viscous [A.s/rad], offset
/// [A].
constexpr std::array<double, 2> KNOWN_PAYLOAD{ 10.0, 2.0 };
constexpr std::array<double, NUISANCES> KNOWN{ 0.05, 0.3, 0.3, 0.03 };

/// Torques of an arm without payload, and of unit payloads beside.
class UnitPayloads
{
public:
  explicit UnitPayloads(ArmDescription arm)
  {
    arm.payload = {};
    bare_ = std::make_unique<ArmDynamics>(arm);
    const auto add = [&](const std::array<double, 3>& centre)
    {
      arm.payload = { SMALL, centre };
      loaded_.emplace_back(arm);
    };
    add({});
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      std::array<double, 3> centre{};
      for (const double side : { 1.0, -1.0 })
      {
        centre[axis] = side;
        add(centre);
      }
    }
  }

  /// Of mass and moments, at each joint, by column [N.m/kg], [N.m/(kg.m)].
  void torques(const std::vector<JointMotion>& motion, Eigen::MatrixXd& columns)
  {
    const auto at = [&](ArmDynamics& dynamics, std::vector<double>& torques)
    {
      torques.resize(motion.size());
      dynamics.torques(motion, torques);
    };
    at(*bare_, first_);
    at(loaded_[0], second_);
    for (std::size_t i = 0; i < motion.size(); ++i)
    {
      columns(static_cast<Eigen::Index>(i), 0) = (second_[i] - first_[i]) / SMALL;
    }
    // To both sides: what of a payload's inertia is quadratic in its centre cancels out.
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      at(loaded_[1 + 2 * axis], first_);
      at(loaded_[2 + 2 * axis], second_);
      for (std::size_t i = 0; i < motion.size(); ++i)
      {
        columns(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(1 + axis)) =
            (first_[i] - second_[i]) / (2.0 * SMALL);
      }
    }
  }

private:
  static constexpr double SMALL = 1e-3;  // [kg]

  std::unique_ptr<ArmDynamics> bare_;
  std::vector<ArmDynamics> loaded_;
  std::vector<double> first_;
  std::vector<double> second_;
};

/// Means of one joint while it moves one way.
struct Rows
{
  std::vector<Eigen::Matrix<double, PAYLOAD + NUISANCES, 1>> columns;
  std::vector<double> residuals;
};

class Problem
{
public:
  explicit Problem(std::vector<Rows> rows) : rows_(std::move(rows)), size_(place(rows_.size()))
  {
    known_.setConstant(size_, KNOWN_PAYLOAD[1]);
    known_[0] = KNOWN_PAYLOAD[0];
    for (std::size_t i = 0; i < rows_.size(); ++i)
    {
      known_.segment<NUISANCES>(place(i)) = Eigen::Map<const Eigen::Vector4d>(KNOWN.data());
    }
  }

  /// Values and half widths of the payload.
  void solve(Eigen::Vector4d& values, Eigen::Vector4d& half_widths) const
  {
    Eigen::VectorXd all = Eigen::VectorXd::Zero(size_);
    Eigen::MatrixXd information;
    constexpr int ROUNDS = 5;
    for (int round = 0; round < ROUNDS; ++round)
    {
      information = known_.cwiseAbs2().cwiseInverse().asDiagonal();
      Eigen::VectorXd right = Eigen::VectorXd::Zero(size_);
      for (std::size_t i = 0; i < rows_.size(); ++i)
      {
        add(i, all, information, right);
      }
      all = information.ldlt().solve(right);
    }
    const Eigen::MatrixXd variance = information.ldlt().solve(Eigen::MatrixXd::Identity(size_, size_));
    values = all.head<PAYLOAD>();
    half_widths = NORMAL_95 * variance.diagonal().head<PAYLOAD>().cwiseSqrt();
  }

private:
  static Eigen::Index place(std::size_t joint) { return static_cast<Eigen::Index>(PAYLOAD + NUISANCES * joint); }

  /// The rows of one joint, weighed by what `all` leaves of them.
  void add(std::size_t joint, const Eigen::VectorXd& all, Eigen::MatrixXd& information, Eigen::VectorXd& right) const
  {
    const Rows& rows = rows_[joint];
    constexpr std::size_t FEWEST = 5;
    if (rows.residuals.size() < FEWEST)
    {
      return;
    }
    Eigen::Matrix<double, PAYLOAD + NUISANCES, 1> values;
    values << all.head<PAYLOAD>(), all.segment<NUISANCES>(place(joint));
    // An error of the gain is one of the payload's torque too.
    const auto columns = [&](std::size_t k)
    {
      Eigen::Matrix<double, PAYLOAD + NUISANCES, 1> row = rows.columns[k];
      row[PAYLOAD] += row.head<PAYLOAD>().dot(values.head<PAYLOAD>());
      return row;
    };
    Eigen::VectorXd errors(static_cast<Eigen::Index>(rows.residuals.size()));
    for (std::size_t k = 0; k < rows.residuals.size(); ++k)
    {
      errors[static_cast<Eigen::Index>(k)] = rows.residuals[k] - columns(k).dot(values);
    }
    constexpr double LEAST = 0.01;  // [A]
    const double deviation = std::max(robustDeviation(errors), LEAST);
    const double weight = 1.0 / (deviation * deviation * correlationRows(errors));
    for (std::size_t k = 0; k < rows.residuals.size(); ++k)
    {
      const double size = std::abs(errors[static_cast<Eigen::Index>(k)]);
      const double row_weight = weight * std::min(1.0, OUTLIER * deviation / std::max(size, LEAST));
      Eigen::VectorXd row = Eigen::VectorXd::Zero(size_);
      row.head<PAYLOAD>() = columns(k).head<PAYLOAD>();
      row.segment<NUISANCES>(place(joint)) = columns(k).tail<NUISANCES>();
      information.noalias() += row_weight * row * row.transpose();
      right += row_weight * rows.residuals[k] * row;
    }
  }

  std::vector<Rows> rows_;
  Eigen::Index size_;
  Eigen::VectorXd known_;
};
}  // namespace

bool IdentifiedPayload::differs() const
{
  return std::abs(mass - configured.mass) > mass_half_width;
}

IdentifiedPayload identifyPayload(const ArmDescription& arm, const std::vector<std::vector<MotionSample>>& samples,
                                  const std::vector<std::vector<double>>& predicted, const std::vector<double>& gains)
{
  const std::size_t joints = samples.size();
  UnitPayloads unit(arm);
  Eigen::MatrixXd torques(static_cast<Eigen::Index>(joints), PAYLOAD);
  std::vector<JointMotion> motion(joints);
  struct Open
  {
    Eigen::Matrix<double, PAYLOAD + NUISANCES, 1> columns;
    double residual;
    int count{};
    double start{};
    double velocity{};
  };
  std::vector<Open> open(joints);
  std::vector<Rows> rows(joints);
  const auto close = [&](std::size_t i, double time)
  {
    Open& block = open[i];
    if (block.count > 0 && time > block.start + 0.5 * BLOCK)
    {
      rows[i].columns.push_back(block.columns / block.count);
      rows[i].residuals.push_back(block.residual / block.count);
    }
    block.count = 0;
  };
  for (std::size_t k = 0; k < samples.front().size(); ++k)
  {
    for (std::size_t i = 0; i < joints; ++i)
    {
      motion[i] = { samples[i][k].position, samples[i][k].velocity, samples[i][k].acceleration };
    }
    const bool moves = std::any_of(motion.begin(), motion.end(),
                                   [](const JointMotion& joint) { return std::abs(joint.velocity) > MOVING; });
    if (moves)
    {
      unit.torques(motion, torques);
    }
    for (std::size_t i = 0; i < joints; ++i)
    {
      const MotionSample& sample = samples[i][k];
      Open& block = open[i];
      const bool is_moving = std::abs(sample.velocity) > MOVING;
      if (sample.after_gap || !is_moving || sample.velocity * block.velocity < 0.0 || sample.time > block.start + BLOCK)
      {
        close(i, sample.time);
      }
      if (!is_moving)
      {
        continue;
      }
      if (block.count == 0)
      {
        block = { Eigen::Matrix<double, PAYLOAD + NUISANCES, 1>::Zero(), 0.0, 0, sample.time, sample.velocity };
      }
      block.columns.head<PAYLOAD>() += torques.row(static_cast<Eigen::Index>(i)).transpose() / gains[i];
      block.columns.tail<NUISANCES>() +=
          Eigen::Vector4d(sample.load / gains[i], std::copysign(1.0, sample.velocity), sample.velocity, 1.0);
      block.residual += sample.current - predicted[i][k];
      ++block.count;
    }
  }
  Eigen::Vector4d values;
  Eigen::Vector4d half_widths;
  Problem(std::move(rows)).solve(values, half_widths);

  IdentifiedPayload found;
  found.configured = arm.payload;
  found.mass = arm.payload.mass + values[0];
  found.mass_half_width = half_widths[0];
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    const auto at = static_cast<Eigen::Index>(1 + axis);
    found.moment[axis] = arm.payload.mass * arm.payload.centre[axis] + values[at];
    found.moment_half_width[axis] = half_widths[at];
  }
  return found;
}
}  // namespace hjt
