// SPDX-License-Identifier: BSD-3-Clause
#include "arm/load_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include <Eigen/Core>

#include "arm/load_problem.hpp"
#include "arm/residual_statistics.hpp"
#include "arm/unit_loads.hpp"

namespace hjt
{
namespace
{
constexpr double MOVING = 0.05;  // [rad/s]
using Rows = LoadProblem::Rows;

/// Of the joints that count in that part of the time: all, or those in which nothing touches the arm.
std::vector<Rows> ofJoints(const std::vector<Rows>& rows, const std::vector<bool>& counts, bool with_touched,
                           const LoadPart& part = {})
{
  std::vector<Rows> left(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    for (std::size_t k = 0; counts[i] && k < rows[i].size(); ++k)
    {
      if ((with_touched || !rows[i].touched[k]) && part.holds(rows[i].times[k]))
      {
        left[i].add(rows[i], k);
      }
    }
  }
  return left;
}

/// Of the residuals as torques of all joints, what is left with `values`, sum of squares [(N.m)^2].
double squaresLeft(const std::vector<Rows>& rows, const std::vector<double>& gains, const LoadProblem::Shared& values)
{
  double squares = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    for (std::size_t k = 0; k < rows[i].size(); ++k)
    {
      const double left = rows[i].residuals[k] - rows[i].columns[k].head<LoadProblem::SHARED>().dot(values);
      squares += std::pow(gains[i] * left, 2);
    }
  }
  return squares;
}

/// The same of all, rms [-].
double shareLeft(const std::vector<Rows>& rows, const std::vector<double>& gains, const LoadProblem::Shared& values)
{
  const double all = squaresLeft(rows, gains, LoadProblem::Shared::Zero());
  return all > 0.0 ? std::sqrt(squaresLeft(rows, gains, values) / all) : 1.0;
}

/// With the best multiple of what is predicted.
struct GainShares
{
  double of_all{ 1.0 };  ///< one multiple of all joints
  double of_one{ 1.0 };  ///< of the joint that it leaves least for
};

GainShares sharesOfGain(const std::vector<Rows>& rows, const std::vector<double>& gains)
{
  const auto taken = [](double both, double squares) { return squares > 0.0 ? both * both / squares : 0.0; };
  double residual = 0.0;
  double both = 0.0;
  double squares = 0.0;
  double most = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    double own_both = 0.0;
    double own_squares = 0.0;
    for (std::size_t k = 0; k < rows[i].size(); ++k)
    {
      residual += std::pow(gains[i] * rows[i].residuals[k], 2);
      own_both += gains[i] * gains[i] * rows[i].residuals[k] * rows[i].predicted[k];
      own_squares += std::pow(gains[i] * rows[i].predicted[k], 2);
    }
    both += own_both;
    squares += own_squares;
    most = std::max(most, taken(own_both, own_squares));
  }
  const auto share = [residual](double less)
  { return residual > 0.0 ? std::sqrt(std::max(residual - less, 0.0) / residual) : 1.0; };
  return { share(taken(both, squares)), share(most) };
}
}  // namespace

struct LoadFit::Data
{
  struct Open
  {
    LoadProblem::Columns columns;
    double residual{};
    double predicted{};
    int count{};
    double start{};
    double velocity{};
    bool touched{};
  };

  Data(const ArmDescription& arm, std::vector<double> all_gains)
    : payload(arm.payload)
    , gravity(arm.gravity.data())
    , gains(std::move(all_gains))
    , unit(arm)
    , torques(static_cast<Eigen::Index>(gains.size()), LoadProblem::SHARED)
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
    if (block.count > 0 && time > block.start + 0.5 * LoadProblem::BLOCK && block.columns.allFinite() &&
        std::isfinite(block.residual) && std::isfinite(block.predicted))
    {
      rows[i].columns.push_back(block.columns / block.count);
      rows[i].residuals.push_back(block.residual / block.count);
      rows[i].predicted.push_back(block.predicted / block.count);
      rows[i].times.push_back(block.start);
      rows[i].touched.push_back(block.touched);
    }
    block.count = 0;
  }

  void closeAll()
  {
    for (std::size_t i = 0; i < rows.size(); ++i)
    {
      close(i, last_time);
    }
  }

  /// That 2 % of the links' masses make, as a mass at the tip, at the joint that weighs it best [kg].
  double ofLinks(const std::vector<bool>& counts) const
  {
    constexpr double LINKS_SHARE = 0.02;
    double heaviest = 0.0;
    double mass = 0.0;
    for (std::size_t i = 0; i < loads.size(); ++i)
    {
      if (counts[i] && weights[i] > heaviest)
      {
        heaviest = weights[i];
        mass = LINKS_SHARE * std::sqrt(loads[i] / weights[i]);
      }
    }
    return mass;
  }

  /// `joints`: rows of each.
  IdentifiedPayload findPayload(const std::vector<Rows>& joints, double of_links) const
  {
    const LoadProblem::Solution solution = LoadProblem(joints, LoadProblem::Term::PAYLOAD).solve();
    IdentifiedPayload found;
    found.configured = payload;
    found.mass = payload.mass + solution.values[0];
    found.mass_half_width = std::hypot(solution.half_widths[0], NORMAL_95 * of_links);
    found.residual_share = shareLeft(joints, gains, solution.values);
    found.share_of_gain = sharesOfGain(joints, gains).of_all;
    constexpr double UNLOADED = 0.05;  // of the links' mass: a sound UR5 without a payload shows 0 to 0.8 kg
    found.least_claim = UNLOADED * unit.linksMass();
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      const auto at = static_cast<Eigen::Index>(1 + axis);
      found.moment[axis] = payload.mass * payload.centre[axis] + solution.values[at];
      found.moment_half_width[axis] = solution.half_widths[at];
    }
    return found;
  }

  /// Parts of that part in which the payload stays what it is, in their order.
  std::vector<LoadPart> parts(const std::vector<bool>& counts, const LoadPart& of, double of_links) const
  {
    const std::vector<Rows> joints = ofJoints(rows, counts, true, of);  // another payload looks like contact
    const std::optional<double> change = LoadProblem(joints, LoadProblem::Term::PAYLOAD).likelyChange();
    if (!change)
    {
      return { of };
    }
    const std::array<LoadPart, 2> sides{ LoadPart{ of.begin, *change }, LoadPart{ *change, of.end } };
    const std::array<std::vector<Rows>, 2> its{ ofJoints(rows, counts, true, sides[0]),
                                                ofJoints(rows, counts, true, sides[1]) };
    const auto left = [&](const std::vector<Rows>& some)
    { return squaresLeft(some, gains, LoadProblem(some, LoadProblem::Term::PAYLOAD).values()); };
    if (left(its[0]) + left(its[1]) > std::pow(FoundLoad::CLEARLY, 2) * left(joints))
    {
      return { of };
    }
    const IdentifiedPayload before = findPayload(its[0], of_links);
    IdentifiedPayload after = findPayload(its[1], of_links);
    after.configured.mass = before.mass;
    after.mass_half_width = std::hypot(before.mass_half_width, after.mass_half_width);
    if (!after.differs())
    {
      return { of };
    }
    std::vector<LoadPart> all = parts(counts, sides[0], of_links);
    const std::vector<LoadPart> later = parts(counts, sides[1], of_links);
    all.insert(all.end(), later.begin(), later.end());
    return all;
  }

  /// With the most rows.
  LoadPart longest(const std::vector<bool>& counts, const std::vector<LoadPart>& all) const
  {
    const auto size = [&](const LoadPart& part)
    {
      std::size_t sum = 0;
      for (const Rows& its : ofJoints(rows, counts, true, part))
      {
        sum += its.size();
      }
      return sum;
    };
    return *std::max_element(all.begin(), all.end(),
                             [&](const LoadPart& a, const LoadPart& b) { return size(a) < size(b); });
  }

  IdentifiedMounting findMounting(const std::vector<Rows>& joints, double of_links) const
  {
    const LoadProblem::Solution solution = LoadProblem(joints, LoadProblem::Term::GRAVITY).solve();
    const Eigen::Vector3d total = gravity + solution.values.tail<LoadProblem::GRAVITY>();
    const Eigen::Vector3d direction = total / std::max(total.norm(), 1e-6);
    const double size = std::max(gravity.norm(), 1e-6);  // weightless as configured: nothing to turn
    // Of the half widths, what lies across the direction.
    const Eigen::Array3d across = (1.0 - direction.array().square()).max(0.0);
    const Eigen::Array3d widths = solution.half_widths.tail<LoadProblem::GRAVITY>().array();
    IdentifiedMounting found;
    Eigen::Map<Eigen::Vector3d>(found.configured.data()) = gravity;
    Eigen::Map<Eigen::Vector3d>(found.gravity.data()) = gravity.norm() * direction;
    found.half_width = std::sqrt((widths.square() * across).sum()) / std::max(total.norm(), 1e-6);
    found.size = total.norm() / size;
    found.residual_share = shareLeft(joints, gains, solution.values);
    if (found.differs())
    {
      found.share_otherwise = shareWithoutMounting(joints, of_links);
    }
    return found;
  }

  /// Of all rows, what is left with whatever else may be the reason. A payload counts where its mass is one.
  double shareWithoutMounting(const std::vector<Rows>& joints, double of_links) const
  {
    const GainShares gain = sharesOfGain(joints, gains);
    const IdentifiedPayload other = findPayload(joints, of_links);
    const bool is_mass = other.mass > -std::max(other.mass_half_width, other.least_claim);
    const double least = std::min(gain.of_all, gain.of_one);
    return other.differs() && is_mass ? std::min(least, other.residual_share) : least;
  }

  Payload payload;
  Eigen::Vector3d gravity;
  std::vector<double> gains;
  UnitLoads unit;
  Eigen::MatrixXd torques;
  std::vector<JointMotion> motion;
  std::vector<Open> open;
  std::vector<Rows> rows;
  std::vector<double> loads;    // sum of squares [(N.m)^2]
  std::vector<double> weights;  // of 1 kg at the tip, likewise
  double moved{};               // [s]
  double last_time{};
};

LoadFit::LoadFit(const ArmDescription& arm, std::vector<double> gains)
  : data_(std::make_unique<Data>(arm, std::move(gains)))
{
}

LoadFit::~LoadFit() = default;

void LoadFit::add(const std::vector<MotionSample>& samples, const std::vector<double>& predicted, bool touched)
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
  data.moved += moves && step > 0.0 && step < LoadProblem::BLOCK ? step : 0.0;
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
    if (sample.after_gap || !is_moving || sample.velocity * block.velocity < 0.0 || touched != block.touched ||
        sample.time > block.start + LoadProblem::BLOCK)
    {
      data.close(i, sample.time);
    }
    if (!is_moving)
    {
      continue;
    }
    if (block.count == 0)
    {
      block = { LoadProblem::Columns::Zero(), 0.0, 0.0, 0, sample.time, sample.velocity, touched };
    }
    const auto torques = data.torques.row(static_cast<Eigen::Index>(i));
    block.columns.head<LoadProblem::SHARED>() += torques.transpose() / data.gains[i];
    block.columns.tail<LoadProblem::NUISANCES>() +=
        Eigen::Vector4d(sample.load / data.gains[i], std::copysign(1.0, sample.velocity), sample.velocity, 1.0);
    block.residual += sample.current - predicted[i];
    block.predicted += predicted[i];
    ++block.count;
    if (!touched)
    {
      data.loads[i] += sample.load * sample.load;
      data.weights[i] += torques[0] * torques[0];
    }
  }
}

double LoadFit::moved() const
{
  return data_->moved;
}

FoundLoad LoadFit::solve(const std::vector<bool>& counts, Part which)
{
  Data& data = *data_;
  data.closeAll();
  const double of_links = data.ofLinks(counts);
  const std::vector<LoadPart> parts = data.parts(counts, {}, of_links);
  const LoadPart part = which == Part::LAST ? parts.back() : data.longest(counts, parts);
  return { data.findPayload(ofJoints(data.rows, counts, !part.isAll(), part), of_links),
           data.findMounting(ofJoints(data.rows, counts, true, part), of_links), part };
}

LoadProblem::Fit LoadFit::explained(const std::vector<bool>& counts, double size)
{
  constexpr double OTHER_MOUNTING = 10.0;  // logarithm of how much rarer it is
  constexpr double GRAVITY_SIZE = 0.1;     // deviation of its size: else it is none [-]
  data_->closeAll();
  std::vector<Rows> joints = ofJoints(data_->rows, counts, true);
  for (Rows& rows : joints)
  {
    for (std::size_t k = 0; k < rows.size(); ++k)
    {
      rows.residuals[k] = (rows.residuals[k] + rows.predicted[k]) / size - rows.predicted[k];
    }
  }
  const double friction = LoadProblem::ANY_FRICTION;  // a faulty joint is no other arm
  const LoadProblem::Fit upright = LoadProblem(joints, LoadProblem::Term::PAYLOAD, friction).fit(data_->payload.mass);
  const LoadProblem both(joints, LoadProblem::Term::BOTH, friction);
  LoadProblem::Fit mounted = both.fit(data_->payload.mass);
  mounted.cost += OTHER_MOUNTING;
  if (mounted.cost < upright.cost)
  {
    const Eigen::Vector3d gravity = data_->gravity + both.solve().values.tail<LoadProblem::GRAVITY>();
    const double of_gravity = gravity.norm() / std::max(data_->gravity.norm(), 1e-6);
    mounted.cost += 0.5 * std::pow((of_gravity - 1.0) / GRAVITY_SIZE, 2);
  }
  return mounted.cost < upright.cost ? mounted : upright;
}

IdentifiedPayload identifyPayload(const ArmDescription& arm, const std::vector<std::vector<MotionSample>>& samples,
                                  const std::vector<std::vector<double>>& predicted, const std::vector<double>& gains)
{
  LoadFit fit(arm, gains);
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
  return fit.solve(std::vector<bool>(samples.size(), true), LoadFit::Part::LONGEST).payload;
}
}  // namespace hjt
