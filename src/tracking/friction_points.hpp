// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace hjt
{
/// Mean friction at the joint over the rows of one speed; > 0 against the motion.
struct FrictionPoint
{
  double speed{};      ///< speed, > 0 in positive direction [rad/s]
  double measured{};   ///< measured friction [N.m]
  double deviation{};  ///< standard deviation of the measured friction from row to row [N.m]
  double twin{};       ///< mean friction of the twin in the same rows [N.m]
  std::uint64_t rows{};
  double load{};  ///< mean load of these rows, > 0 resists positive motion [N.m]
};

/// Measured friction over the friction of a reference.
struct FrictionRatio
{
  double value{ std::numeric_limits<double>::quiet_NaN() };  ///< measured over reference friction; NaN: not known [-]
  double deviation{};                 ///< standard deviation of `value` by the scatter of the rows [-]
  double of_points{};                 ///< standard deviation of `value` by a jackknife over the speeds [-]
  std::vector<FrictionPoint> points;  ///< points at the common speeds; `twin` is the reference's friction
};

/// Sums of measured friction and twin's friction in blocks of time. The scatter of these blocks gives the uncertainty
/// of the friction ratio, because successive rows are not independent.
class FrictionBlocks
{
public:
  static constexpr double LENGTH = 2.0;  ///< length of a block [s]

  void add(double time, bool forward, double measured, double twin)
  {
    const double place = std::floor(time / LENGTH);
    if (place != place_)
    {
      close();
      place_ = place;
    }
    const Eigen::Index way = forward ? 1 : 0;
    open_[way] += 1.0;
    open_[2 + way] += measured;
    open_[4 + way] += twin;
  }

  std::uint64_t count() const { return blocks_ + (open_.head<2>().sum() > 0.0 ? 1 : 0); }

  /// Relative standard deviation of FrictionPoints::ratio() by the scatter of the blocks [-]; infinite: fewer than
  /// three blocks. A block adds (part of the numerator - ratio x part of the denominator)^2 to the variance.
  double deviation() const
  {
    FrictionBlocks all = *this;
    all.close();
    if (all.blocks_ < MIN_BLOCKS)
    {
      return std::numeric_limits<double>::infinity();
    }
    double measured = 0.0;
    double twin = 0.0;
    for (const Eigen::Index way : { 0, 1 })
    {
      const double rows = std::max(all.sums_[way], 1.0);
      measured += all.sums_[2 + way] / rows;
      twin += all.sums_[4 + way] / rows;
    }
    const double ratio = measured / twin;
    Vector6 influence;
    for (const Eigen::Index way : { 0, 1 })
    {
      const double rows = std::max(all.sums_[way], 1.0);
      influence[2 + way] = 1.0 / rows;
      influence[4 + way] = -ratio / rows;
      influence[way] = -(all.sums_[2 + way] - ratio * all.sums_[4 + way]) / (rows * rows);
    }
    const double variance = influence.dot(all.products_ * influence);
    const double count = static_cast<double>(all.blocks_);
    return std::sqrt(std::max(0.0, variance) * count / (count - 1.0)) / std::abs(measured);
  }

private:
  static constexpr std::uint64_t MIN_BLOCKS = 3;
  // The matrices are not aligned, so that a class with such a member needs no aligned operator new.
  using Vector6 = Eigen::Matrix<double, 6, 1, Eigen::DontAlign>;
  using Matrix6 = Eigen::Matrix<double, 6, 6, Eigen::DontAlign>;

  void close()
  {
    if (open_.head<2>().sum() > 0.0)
    {
      sums_ += open_;
      products_ += open_ * open_.transpose();
      ++blocks_;
    }
    open_.setZero();
  }

  double place_{ -std::numeric_limits<double>::infinity() };
  Vector6 open_{ Vector6::Zero() };  // for each direction: number of rows, measured friction, twin's friction
  Vector6 sums_{ Vector6::Zero() };
  Matrix6 products_{ Matrix6::Zero() };
  std::uint64_t blocks_{};
};

/// Mean friction by speed, from any number of rows. The two directions of motion are separate.
class FrictionPoints
{
public:
  static constexpr std::uint64_t MIN_ROWS = 30;  ///< least number of rows of a point
  static constexpr double SLOWEST = 0.01;        ///< least speed of a row that counts [rad/s]

  /// Adds a row at `time` [s]. `speed` [rad/s], `load` [N.m]: with sign. `measured`, `twin`: friction against the
  /// motion [N.m].
  void add(double time, double speed, double measured, double twin, double load)
  {
    const double place = placeOf(speed);
    if (!(place >= 0.0 && place < static_cast<double>(BINS)))
    {
      return;
    }
    const auto from_standstill = static_cast<std::size_t>(place);
    Bin& bin = bins_[speed < 0.0 ? BINS - 1 - from_standstill : BINS + from_standstill];
    ++bin.rows;
    bin.speed += speed;
    bin.measured += measured;
    bin.squares += measured * measured;
    bin.twin += twin;
    bin.load += load;
    blocks_.add(time, speed > 0.0, measured, twin);
  }

  /// Points in the order of their speeds, from the fastest negative speed on.
  std::vector<FrictionPoint> points() const
  {
    std::vector<FrictionPoint> points;
    for (const Bin& bin : bins_)
    {
      if (bin.rows >= MIN_ROWS)
      {
        const auto n = static_cast<double>(bin.rows);
        const double mean = bin.measured / n;
        const double deviation = std::sqrt(std::max(0.0, bin.squares / n - mean * mean));
        points.push_back({ bin.speed / n, mean, deviation, bin.twin / n, bin.rows, bin.load / n });
      }
    }
    return points;
  }

  const FrictionBlocks& blocks() const { return blocks_; }

  /// Measured friction over the twin's friction, from the rows of all points. Both directions have equal weight, so
  /// that a wrong load has no effect. The deviation is the larger of two: by FrictionBlocks, and by a jackknife over
  /// the points.
  FrictionRatio ratio() const { return ratio(points()); }

  /// Measured friction over that of `reference`, at the speeds that both have, because the friction of joint and twin
  /// may rise differently with the speed.
  FrictionRatio ratioTo(const std::vector<FrictionPoint>& reference) const
  {
    return ratio(common(points(), reference));
  }

  /// Returns the `points` whose speeds `reference` has too, with the friction of the reference in `twin`: the twin's
  /// friction times the mean of (measured / twin) over the reference's points less than a bin away. Rows and nearness
  /// in speed weight the points in this mean.
  static std::vector<FrictionPoint> common(const std::vector<FrictionPoint>& points,
                                           const std::vector<FrictionPoint>& reference)
  {
    std::vector<FrictionPoint> common;
    for (FrictionPoint point : points)
    {
      double weights = 0.0;
      double sum = 0.0;
      for (const FrictionPoint& other : reference)
      {
        if (std::signbit(other.speed) == std::signbit(point.speed))
        {
          const double nearness = std::max(0.0, 1.0 - std::abs(placeOf(other.speed) - placeOf(point.speed)));
          const double weight = nearness * static_cast<double>(other.rows);
          weights += weight;
          sum += weight * other.measured / other.twin;
        }
      }
      if (weights > 0.0)
      {
        point.twin *= sum / weights;
        common.push_back(point);
      }
    }
    return common;
  }

  /// Mean of the points in each bin of speed, weighted by the rows of the points, in the order of the speeds.
  static std::vector<FrictionPoint> merged(const std::vector<FrictionPoint>& points)
  {
    std::map<double, std::vector<FrictionPoint>>
        at;  // points by the number of their bin, counted from standstill with the sign of the speed
    for (const FrictionPoint& point : points)
    {
      at[std::copysign(std::floor(placeOf(point.speed)) + 1.0, point.speed)].push_back(point);
    }
    std::vector<FrictionPoint> merged;
    for (const auto& [place, same] : at)
    {
      merged.push_back(meanOf(same, std::copysign(1.0, place)));
    }
    return merged;
  }

  /// Measured friction over the twin's friction, with equal weight of both directions [-]; NaN: there is no point.
  static double ratioOf(const std::vector<FrictionPoint>& points)
  {
    const FrictionPoint backward = meanOf(points, -1.0);
    const FrictionPoint forward = meanOf(points, 1.0);
    const double twin = backward.twin + forward.twin;
    return twin > 0.0 ? (backward.measured + forward.measured) / twin : std::numeric_limits<double>::quiet_NaN();
  }

  /// Mean of all points of one direction, +1 or -1, weighted by their rows.
  static FrictionPoint meanOf(const std::vector<FrictionPoint>& points, double way)
  {
    FrictionPoint mean;
    for (const FrictionPoint& point : points)
    {
      if (way * point.speed > 0.0)
      {
        const auto rows = static_cast<double>(point.rows);
        mean.rows += point.rows;
        mean.speed += rows * point.speed;
        mean.measured += rows * point.measured;
        mean.twin += rows * point.twin;
        mean.load += rows * point.load;
      }
    }
    const double rows = std::max(static_cast<double>(mean.rows), 1.0);
    return { mean.speed / rows, mean.measured / rows, 0.0, mean.twin / rows, mean.rows, mean.load / rows };
  }

private:
  FrictionRatio ratio(std::vector<FrictionPoint> points) const
  {
    FrictionRatio found;
    found.value = ratioOf(points);
    found.of_points = jackknife(points);
    found.deviation = std::max(std::abs(found.value) * blocks_.deviation(), found.of_points);
    found.points = std::move(points);
    return found;
  }

  /// Standard deviation of ratioOf(points) from its values without each single point [-]; 0: fewer than two points.
  static double jackknife(const std::vector<FrictionPoint>& points)
  {
    double sum = 0.0;
    double squares = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      std::vector<FrictionPoint> others = points;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
      const double ratio = ratioOf(others);
      sum += ratio;
      squares += ratio * ratio;
    }
    const auto count = static_cast<double>(points.size());
    return count < 2.0 ? 0.0 : std::sqrt(std::max(0.0, (count - 1.0) / count * (squares - sum * sum / count)));
  }

  static double placeOf(double speed) { return BINS_PER_DECADE * std::log10(std::abs(speed) / SLOWEST); }

  struct Bin
  {
    std::uint64_t rows{};
    double speed{};
    double measured{};
    double squares{};
    double twin{};
    double load{};
  };
  static constexpr double BINS_PER_DECADE = 10.0;
  static constexpr std::size_t BINS = 30;  // number of bins of each direction, up to 10 rad/s

  std::array<Bin, 2 * BINS> bins_{};  // bins from the fastest negative to the fastest positive speed
  FrictionBlocks blocks_;
};
}  // namespace hjt
