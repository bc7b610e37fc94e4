// SPDX-License-Identifier: BSD-3-Clause
#include "arm/payload_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "arm/residual_statistics.hpp"
#include "arm/unit_payloads.hpp"
#include "base/number_text.hpp"

namespace hjt
{
namespace
{
constexpr double MOVING = 0.05;  // [rad/s]
constexpr double BLOCK = 0.1;    // [s]
constexpr double OUTLIER = 3.0;  // deviations
constexpr int PARTS = 10;        // of the time, of which one after the other is left out
constexpr int PAYLOAD = 4;       // mass and its three moments
constexpr int NUISANCES = 4;     // of each joint: gain, Coulomb and viscous friction, offset
/// What each is known to before: mass [kg], moment [kg.m]; gain [-], Coulomb friction [A], viscous [A.s/rad], offset
/// [A].
constexpr std::array<double, 2> KNOWN_PAYLOAD{ 10.0, 2.0 };
constexpr std::array<double, NUISANCES> KNOWN{ 0.05, 0.3, 0.3, 0.03 };

/// Means of one joint while it moves one way.
struct Rows
{
  std::vector<Eigen::Matrix<double, PAYLOAD + NUISANCES, 1>> columns;
  std::vector<double> residuals;
  std::vector<double> times;  // [s]
};

/// All but those of one of PARTS parts of the time.
std::vector<Rows> without(const std::vector<Rows>& rows, int part, double begin, double end)
{
  std::vector<Rows> left(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    for (std::size_t k = 0; k < rows[i].times.size(); ++k)
    {
      if (static_cast<int>(PARTS * (rows[i].times[k] - begin) / (end - begin)) != part)
      {
        left[i].columns.push_back(rows[i].columns[k]);
        left[i].residuals.push_back(rows[i].residuals[k]);
      }
    }
  }
  return left;
}

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
    Eigen::Matrix<double, PAYLOAD + NUISANCES, PAYLOAD + NUISANCES> products;
    products.setZero();
    Eigen::Matrix<double, PAYLOAD + NUISANCES, 1> sums;
    sums.setZero();
    for (std::size_t k = 0; k < rows.residuals.size(); ++k)
    {
      const double size = std::abs(errors[static_cast<Eigen::Index>(k)]);
      const double row_weight = weight * std::min(1.0, OUTLIER * deviation / std::max(size, LEAST));
      const Eigen::Matrix<double, PAYLOAD + NUISANCES, 1> row = columns(k);
      products.noalias() += row_weight * row * row.transpose();
      sums += row_weight * rows.residuals[k] * row;
    }
    const Eigen::Index own = place(joint);
    information.topLeftCorner<PAYLOAD, PAYLOAD>() += products.topLeftCorner<PAYLOAD, PAYLOAD>();
    information.block<NUISANCES, NUISANCES>(own, own) += products.bottomRightCorner<NUISANCES, NUISANCES>();
    information.block<PAYLOAD, NUISANCES>(0, own) += products.topRightCorner<PAYLOAD, NUISANCES>();
    information.block<NUISANCES, PAYLOAD>(own, 0) += products.bottomLeftCorner<NUISANCES, PAYLOAD>();
    right.head<PAYLOAD>() += sums.head<PAYLOAD>();
    right.segment<NUISANCES>(own) += sums.tail<NUISANCES>();
  }

  std::vector<Rows> rows_;
  Eigen::Index size_;
  Eigen::VectorXd known_;
};
}  // namespace

bool IdentifiedPayload::differs() const
{
  return std::abs(mass - configured.mass) > std::max(mass_half_width, least_claim);
}

Payload IdentifiedPayload::payload() const
{
  Payload payload;
  payload.mass = std::max(mass, 0.0);
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    payload.centre[axis] = payload.mass > 0.0 ? moment[axis] / payload.mass : 0.0;
  }
  return payload;
}

std::string IdentifiedPayload::text() const
{
  const Payload found = payload();
  return "the currents look like a payload of " + fixedText(found.mass, 1) + " +- " + fixedText(mass_half_width, 1) +
         " kg at the flange in place of the configured " + roundedText(configured.mass, 3) + " kg, its centre at " +
         fixedText(found.centre[0], 2) + ", " + fixedText(found.centre[1], 2) + ", " + fixedText(found.centre[2], 2) +
         " m: set payload in the arm's file";
}

struct PayloadFit::Data
{
  struct Open
  {
    Eigen::Matrix<double, PAYLOAD + NUISANCES, 1> columns;
    double residual;
    int count{};
    double start{};
    double velocity{};
  };

  Data(const ArmDescription& arm, std::vector<double> all_gains)
    : payload(arm.payload)
    , gains(std::move(all_gains))
    , unit(arm)
    , torques(static_cast<Eigen::Index>(gains.size()), PAYLOAD)
    , motion(gains.size())
    , open(gains.size())
    , rows(gains.size())
    , loads(gains.size())
    , weights(gains.size())
  {
  }

  void close(std::size_t i, double time)
  {
    Open& block = open[i];
    if (block.count > 0 && time > block.start + 0.5 * BLOCK)
    {
      rows[i].columns.push_back(block.columns / block.count);
      rows[i].residuals.push_back(block.residual / block.count);
      rows[i].times.push_back(block.start);
    }
    block.count = 0;
  }

  /// Of the residuals as torques of all joints, what a payload leaves, rms [-].
  double shareLeft(const Eigen::Vector4d& values) const
  {
    double before = 0.0;
    double after = 0.0;
    for (std::size_t i = 0; i < rows.size(); ++i)
    {
      for (std::size_t k = 0; k < rows[i].residuals.size(); ++k)
      {
        const double residual = gains[i] * rows[i].residuals[k];
        before += residual * residual;
        after += std::pow(residual - gains[i] * rows[i].columns[k].head<PAYLOAD>().dot(values), 2);
      }
    }
    return before > 0.0 ? std::sqrt(after / before) : 1.0;
  }

  /// That 2 % of the links' masses make, as a mass at the tip, at the joint that weighs it best [kg].
  double ofLinks() const
  {
    constexpr double LINKS_SHARE = 0.02;
    double heaviest = 0.0;
    double mass = 0.0;
    for (std::size_t i = 0; i < loads.size(); ++i)
    {
      if (weights[i] > heaviest)
      {
        heaviest = weights[i];
        mass = LINKS_SHARE * std::sqrt(loads[i] / weights[i]);
      }
    }
    return mass;
  }

  Payload payload;
  std::vector<double> gains;
  UnitPayloads unit;
  Eigen::MatrixXd torques;
  std::vector<JointMotion> motion;
  std::vector<Open> open;
  std::vector<Rows> rows;
  std::vector<double> loads;    // sum of squares [(N.m)^2]
  std::vector<double> weights;  // of 1 kg at the tip, likewise
  double moved{};               // [s]
  double last_time{};
};

PayloadFit::PayloadFit(const ArmDescription& arm, std::vector<double> gains)
  : data_(std::make_unique<Data>(arm, std::move(gains)))
{
}

PayloadFit::~PayloadFit() = default;

void PayloadFit::add(const std::vector<MotionSample>& samples, const std::vector<double>& predicted)
{
  Data& data = *data_;
  const double step = samples.front().time - data.last_time;
  data.last_time = samples.front().time;
  for (std::size_t i = 0; i < samples.size(); ++i)
  {
    data.motion[i] = { samples[i].position, samples[i].velocity, samples[i].acceleration };
  }
  const bool moves = std::any_of(data.motion.begin(), data.motion.end(),
                                 [](const JointMotion& joint) { return std::abs(joint.velocity) > MOVING; });
  data.moved += moves && step > 0.0 && step < BLOCK ? step : 0.0;
  if (data.moved > MOST_TIME)
  {
    return;
  }
  if (moves)
  {
    data.unit.torques(data.motion, data.torques);
  }
  for (std::size_t i = 0; i < samples.size(); ++i)
  {
    const MotionSample& sample = samples[i];
    Data::Open& block = data.open[i];
    const bool is_moving = std::abs(sample.velocity) > MOVING && std::isfinite(sample.current);
    if (sample.after_gap || !is_moving || sample.velocity * block.velocity < 0.0 || sample.time > block.start + BLOCK)
    {
      data.close(i, sample.time);
    }
    if (!is_moving)
    {
      continue;
    }
    if (block.count == 0)
    {
      block = { Eigen::Matrix<double, PAYLOAD + NUISANCES, 1>::Zero(), 0.0, 0, sample.time, sample.velocity };
    }
    const auto torques = data.torques.row(static_cast<Eigen::Index>(i));
    block.columns.head<PAYLOAD>() += torques.transpose() / data.gains[i];
    block.columns.tail<NUISANCES>() +=
        Eigen::Vector4d(sample.load / data.gains[i], std::copysign(1.0, sample.velocity), sample.velocity, 1.0);
    block.residual += sample.current - predicted[i];
    ++block.count;
    data.loads[i] += sample.load * sample.load;
    data.weights[i] += torques[0] * torques[0];
  }
}

double PayloadFit::moved() const
{
  return data_->moved;
}

IdentifiedPayload PayloadFit::solve()
{
  Data& data = *data_;
  double begin = std::numeric_limits<double>::infinity();
  double end = -begin;
  for (std::size_t i = 0; i < data.rows.size(); ++i)
  {
    data.close(i, data.last_time);
    for (const double time : data.rows[i].times)
    {
      begin = std::min(begin, time);
      end = std::max(end, time + BLOCK);
    }
  }
  Eigen::Vector4d values;
  Eigen::Vector4d half_widths;
  Problem(data.rows).solve(values, half_widths);
  Eigen::Vector4d squares = Eigen::Vector4d::Zero();
  for (int part = 0; part < PARTS && end > begin; ++part)
  {
    Eigen::Vector4d left;
    Eigen::Vector4d ignored;
    Problem(without(data.rows, part, begin, end)).solve(left, ignored);
    squares += (left - values).cwiseAbs2();
  }
  half_widths = half_widths.cwiseMax(NORMAL_95 * (squares * (PARTS - 1.0) / PARTS).cwiseSqrt());

  IdentifiedPayload found;
  found.configured = data.payload;
  found.mass = data.payload.mass + values[0];
  found.mass_half_width = std::hypot(half_widths[0], NORMAL_95 * data.ofLinks());
  found.residual_share = data.shareLeft(values);
  constexpr double UNLOADED = 0.05;  // of the links' mass: a sound UR5 without a payload shows 0 to 0.8 kg
  found.least_claim = UNLOADED * data.unit.linksMass();
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    const auto at = static_cast<Eigen::Index>(1 + axis);
    found.moment[axis] = data.payload.mass * data.payload.centre[axis] + values[at];
    found.moment_half_width[axis] = half_widths[at];
  }
  return found;
}

IdentifiedPayload identifyPayload(const ArmDescription& arm, const std::vector<std::vector<MotionSample>>& samples,
                                  const std::vector<std::vector<double>>& predicted, const std::vector<double>& gains)
{
  PayloadFit fit(arm, gains);
  std::vector<MotionSample> at(samples.size());
  std::vector<double> currents(samples.size());
  for (std::size_t k = 0; k < samples.front().size(); ++k)
  {
    for (std::size_t i = 0; i < samples.size(); ++i)
    {
      at[i] = samples[i][k];
      currents[i] = predicted[i][k];
    }
    fit.add(at, currents);
  }
  return fit.solve();
}
}  // namespace hjt
