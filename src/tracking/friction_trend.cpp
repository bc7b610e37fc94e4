// SPDX-License-Identifier: BSD-3-Clause
#include "tracking/friction_trend.hpp"

#include <algorithm>

#include <Eigen/Dense>

#include "base/statistics.hpp"
#include "tracking/common_friction.hpp"

namespace hjt
{
namespace
{
/// Prior standard deviation of a joint's response to common factors, relative to the response of the other joints [-].
constexpr double OTHER_ANSWER = 0.5;

double weightOf(const DatedFriction& recording)
{
  return 1.0 / (recording.deviation * recording.deviation);
}

/// Time, `common` and logarithm of `factor`, each minus its weighted mean over the recordings. Each row is a recording.
Eigen::MatrixX3d aboutMeans(const std::vector<DatedFriction>& recordings)
{
  Eigen::MatrixX3d rows(static_cast<Eigen::Index>(recordings.size()), 3);
  Eigen::RowVector3d mean = Eigen::RowVector3d::Zero();
  double weights = 0.0;
  for (std::size_t i = 0; i < recordings.size(); ++i)
  {
    const DatedFriction& recording = recordings[i];
    const auto row = static_cast<Eigen::Index>(i);
    rows.row(row) << recording.time, recording.common, std::log(recording.factor);
    mean += weightOf(recording) * rows.row(row);
    weights += weightOf(recording);
  }
  rows.rowwise() -= Eigen::RowVector3d(mean / weights);
  return rows;
}
}  // namespace

FrictionTrend frictionTrend(const std::vector<DatedFriction>& recordings)
{
  FrictionTrend trend;
  trend.recordings = recordings.size();
  if (recordings.empty())
  {
    return trend;
  }
  const auto is_earlier = [](const DatedFriction& a, const DatedFriction& b) { return a.time < b.time; };
  const auto [first, last] = std::minmax_element(recordings.begin(), recordings.end(), is_earlier);
  trend.span = last->time - first->time;
  if (trend.recordings < FrictionTrend::MIN_RECORDINGS || !(trend.span > 0.0))
  {
    return trend;
  }
  const Eigen::MatrixX3d rows = aboutMeans(recordings);
  Eigen::Matrix2d normal;
  normal << 0.0, 0.0, 0.0, 1.0 / (OTHER_ANSWER * OTHER_ANSWER);
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < recordings.size(); ++i)
  {
    const Eigen::Vector2d at = rows.row(static_cast<Eigen::Index>(i)).head<2>().transpose();
    normal += weightOf(recordings[i]) * at * at.transpose();
    right += weightOf(recordings[i]) * at * rows(static_cast<Eigen::Index>(i), 2);
  }
  const Eigen::Matrix2d inverse = normal.inverse();
  const Eigen::Vector2d line = inverse * right;
  trend.slope = line[0];
  double left = 0.0;  // sum of the squared residuals over the squared deviations [-]
  double fast = 0.0;  // variance of the slope by the parts of the deviations that are not slow
  double slow = 0.0;
  for (std::size_t i = 0; i < recordings.size(); ++i)
  {
    const DatedFriction& recording = recordings[i];
    const Eigen::Vector2d at = rows.row(static_cast<Eigen::Index>(i)).head<2>().transpose();
    const double part = weightOf(recording) * inverse.row(0) * at;
    fast += part * part * (std::pow(recording.deviation, 2) - std::pow(recording.slow_deviation, 2));
    slow += std::abs(part) * recording.slow_deviation;
    const double rest = rows(static_cast<Eigen::Index>(i), 2) - line.dot(at);
    left += std::pow(rest / recording.deviation, 2);
  }
  // Degrees of freedom: recordings - 2 for mean and slope - the part of the response that the recordings determine.
  const double of_known_answer = inverse(1, 1) / (OTHER_ANSWER * OTHER_ANSWER);
  const double freedom = static_cast<double>(trend.recordings - 3) + of_known_answer;
  const double scatter = std::max(1.0, left / freedom);
  const double answer = inverse(0, 1) / OTHER_ANSWER;
  trend.deviation = std::sqrt(scatter * std::max(0.0, fast) + slow * slow + answer * answer);
  return trend;
}

std::vector<std::optional<double>> commonOfRecordings(const std::vector<std::vector<std::optional<double>>>& logarithms)
{
  std::vector<std::vector<double>> known(logarithms.empty() ? 0 : logarithms.front().size());
  for (const std::vector<std::optional<double>>& joint : logarithms)
  {
    std::vector<double> of_joint;
    for (const std::optional<double>& one : joint)
    {
      if (one)
      {
        of_joint.push_back(*one);
      }
    }
    for (std::size_t k = 0; k < joint.size(); ++k)
    {
      if (joint[k])
      {
        known[k].push_back(*joint[k] - medianOf(of_joint));
      }
    }
  }
  std::vector<std::optional<double>> common;
  for (const std::vector<double>& one : known)
  {
    common.push_back(one.size() >= MIN_WITNESSES ? std::make_optional(medianOf(one)) : std::nullopt);
  }
  return common;
}
}  // namespace hjt
