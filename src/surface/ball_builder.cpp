// SPDX-License-Identifier: BSD-3-Clause
#include "surface/surface_builder.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <vector>

#include "gear/angle.hpp"
#include "surface/surface_ring.hpp"

namespace hjt
{
namespace
{
constexpr int LINES = 48;         // number of intervals of w (u, v, w and chi: see BallTable)
constexpr int COLUMNS = 8;        // number of intervals of the wave generator angle u in a tooth pitch
constexpr int PLACES = 80;        // number of intervals of the ball's angle chi in half a turn
constexpr double SCALE = 1e-3;    // scale of v: for |v| below it lines are equidistant, above it geometric [rad]
constexpr double LONGEST = 1e-3;  // largest change of v between two solves of the ring [rad]

using Coefficients = BallTable::Coefficients;

/// Replaces values on an even periodic grid by the coefficients of the cubic spline through them.
void makeRoundSpline(std::vector<Coefficients>& values)
{
  // The solution of (c[i-1] + 4 c[i] + c[i+1]) / 6 = value[i] is a sum over all values, weighted by powers of the pole.
  const double pole = std::sqrt(3.0) - 2.0;
  const std::size_t count = values.size();
  const double closed = 1.0 / (1.0 - std::pow(pole, static_cast<double>(count)));
  Coefficients sum = Coefficients::Zero();
  for (std::size_t i = 0; i < count; ++i)
  {
    sum = values[i] + pole * sum;
  }
  sum *= closed;  // sum over all periods before the first value
  for (Coefficients& value : values)
  {
    sum = value + pole * sum;
    value = sum;
  }
  sum.setZero();
  for (std::size_t i = count; i-- > 0;)
  {
    sum = values[i] + pole * sum;
  }
  sum *= closed;
  for (std::size_t i = count; i-- > 0;)
  {
    sum = values[i] + pole * sum;
    values[i] = -6.0 * pole * sum;
  }
}

/// Coefficients of the spline through `values` without curvature at its ends: two more coefficients than values.
std::vector<Coefficients> naturalSpline(const std::vector<Coefficients>& values)
{
  const std::size_t last = values.size() - 1;
  std::vector<Coefficients> inner = values;  // here the coefficients at the ends equal the values
  std::vector<double> factor(values.size());
  for (std::size_t i = 1; i < last; ++i)
  {
    const double pivot = 4.0 - (i > 1 ? factor[i - 1] : 0.0);
    factor[i] = 1.0 / pivot;
    inner[i] = (6.0 * values[i] - inner[i - 1]) / pivot;
    if (i + 1 == last)
    {
      inner[i] -= values[last] / pivot;
    }
  }
  for (std::size_t i = last - 1; i-- > 1;)
  {
    inner[i] -= factor[i] * inner[i + 1];
  }
  std::vector<Coefficients> all{ 2.0 * inner[0] - inner[1] };
  all.insert(all.end(), inner.begin(), inner.end());
  all.push_back(2.0 * inner[last] - inner[last - 1]);
  return all;
}

/// One line of the BallTable, measured with a newly inserted ring.
class BallLine
{
public:
  BallLine(const Parameters& parameters, const JointModel& sound, double deepest, double turn)
    : ring_(parameters, sound)
    , sound_gap_(sound.ring.of<WaveGeneratorContact>().gap())
    , deepest_(deepest)
    , turn_(turn)
    , ball_pitch_(TWO_PI / parameters.bearing.balls)
    , share_(Eigen::VectorXd::Zero(sound_gap_.size()))
  {
  }

  /// Measures the line at `v`. `values`: results by column, then place. @returns false if the ring has no equilibrium.
  bool measure(double v, int columns, int places, std::vector<Coefficients>& values)
  {
    bool good = ring_.insert();
    const int pieces = static_cast<int>(std::ceil(std::abs(v) / LONGEST));
    for (int i = 1; i <= pieces && good; ++i)
    {
      good = ring_.moveTo(0.0, v * i / pieces);
    }
    for (int column = 0; column < columns && good; ++column)
    {
      const double angle = ring_.pitch() * column / columns;
      good = dropTo(0.0, angle, v);
      const Sample sound = sample();
      const Eigen::VectorXd force = ring_.contactForce();
      for (int place = 0; place < places && good; ++place)
      {
        for (Eigen::Index i = 0; i < share_.size(); ++i)
        {
          share_[i] = RaceDeflection::shareAt(static_cast<double>(i) * ring_.pitch() - angle - turn_ * place / places,
                                              ball_pitch_);
        }
        const double by_drop = -deepest_ * force.dot(share_);
        values.emplace_back(Coefficients::Zero());
        // A ball that carries no load drops without effect.
        good = by_drop == 0.0 || measureBall(angle, v, sound, by_drop, values.back());
      }
    }
    return good;
  }

private:
  struct Sample
  {
    double energy, by_drop, contact_force, flanks;
  };

  /// Values of the ring at its present position, with the derivative of the energy by the relative drop.
  Sample sample()
  {
    const SurfaceNode node = ring_.measure();
    return { node[SurfaceNode::ENERGY], -deepest_ * ring_.contactForce().dot(share_), node[SurfaceNode::CONTACT_FORCE],
             ring_.flankFriction(node) };
  }

  /// Solves with the ball dropped by `part` of the largest drop. @returns false if the ring has no equilibrium.
  bool dropTo(double part, double angle, double v)
  {
    ring_.editModel().ring.edit<WaveGeneratorContact>().gap() = sound_gap_ + part * deepest_ * share_;
    return ring_.moveTo(angle, v);
  }

  /// Computes the coefficients for one ball from the ring at two drops. `c1`: derivative of the energy by x, drop /
  /// largest drop, at x = 0 [J]. @returns false if the ring has no equilibrium.
  bool measureBall(double angle, double v, const Sample& sound, double c1, Coefficients& coefficients)
  {
    if (!dropTo(0.5, angle, v))
    {
      return false;
    }
    const Sample half = sample();
    if (!dropTo(1.0, angle, v))
    {
      return false;
    }
    const Sample whole = sample();
    // The energy c1 x + c2 x^2 + c3 x^3 + c4 x^4 has the measured slopes at x = 0 and 1 and values at x = 1/2 and 1.
    const double at_half = 16.0 * (half.energy - sound.energy - 0.5 * c1);
    const double at_whole = whole.energy - sound.energy - c1;
    const double c2 = at_half - 5.0 * at_whole + whole.by_drop - c1;
    const double c3 = at_half - at_whole - 3.0 * c2;
    coefficients.head<4>() << c1, c2, c3, at_whole - c2 - c3;
    const double square = 2.0 * (whole.contact_force - 2.0 * half.contact_force + sound.contact_force);
    const double flanks = whole.flanks / sound.flanks - 1.0;
    const double flanks_square = 2.0 * (flanks - 2.0 * (half.flanks / sound.flanks - 1.0));
    coefficients.tail<4>() << whole.contact_force - sound.contact_force - square, square, flanks - flanks_square,
        flanks_square;
    if (!(sound.flanks > 0.0))
    {
      coefficients.tail<2>().setZero();
    }
    return true;
  }

  SurfaceRing ring_;
  Eigen::VectorXd sound_gap_;
  double deepest_;
  double turn_;
  double ball_pitch_;
  Eigen::VectorXd share_;  // sag of the race at each tooth, divided by the drop of the ball [-]
};
using Lines = std::array<std::vector<Coefficients>, LINES + 1>;

BallTable emptyTable(const Parameters& parameters, const JointModel& sound, double deepest, double lowest,
                     double highest)
{
  const bool lobes_alike = sound.ring.of<WaveGeneratorContact>().repeats();
  const SurfaceRing reference(parameters, sound);
  BallTable table;
  table.pitch = reference.pitch();
  table.ratio = reference.ratio();
  table.deepest = deepest;
  table.turn = lobes_alike ? PI : TWO_PI;
  table.scale = SCALE;
  table.lowest = std::asinh(lowest / SCALE);
  table.lines = LINES;
  table.step = (std::asinh(highest / SCALE) - table.lowest) / LINES;
  table.columns = COLUMNS;
  table.places = lobes_alike ? PLACES : 2 * PLACES;
  return table;
}

/// Measures all lines of `table` on several threads. @returns false if a ring has no equilibrium.
bool measureLines(const Parameters& parameters, const JointModel& sound, const BallTable& table,
                  const std::function<void(double)>& progress, unsigned threads, Lines& lines)
{
  std::atomic<bool> failed{ false };
  runTasks(
      lines.size(), threads,
      [&](std::size_t i)
      {
        if (!failed)
        {
          const double v = SCALE * std::sinh(table.lowest + static_cast<double>(i) * table.step);
          failed = !BallLine(parameters, sound, table.deepest, table.turn)
                        .measure(v, table.columns, table.places, lines[i]) ||
                   failed;
        }
      },
      [&](std::size_t done)
      {
        if (progress)
        {
          progress(static_cast<double>(done) / static_cast<double>(lines.size()));
        }
      });
  return !failed;
}

/// Replaces the values of a line by the coefficients of splines along u and chi.
void makeSplines(std::size_t columns, std::size_t places, std::vector<Coefficients>& line)
{
  for (std::size_t j = 0; j < columns; ++j)
  {
    std::vector<Coefficients> row(line.begin() + static_cast<std::ptrdiff_t>(j * places),
                                  line.begin() + static_cast<std::ptrdiff_t>((j + 1) * places));
    makeRoundSpline(row);
    std::copy(row.begin(), row.end(), line.begin() + static_cast<std::ptrdiff_t>(j * places));
  }
  for (std::size_t k = 0; k < places; ++k)
  {
    std::vector<Coefficients> row;
    for (std::size_t j = 0; j < columns; ++j)
    {
      row.push_back(line[j * places + k]);
    }
    makeRoundSpline(row);
    for (std::size_t j = 0; j < columns; ++j)
    {
      line[j * places + k] = row[j];
    }
  }
}

std::vector<Coefficients> acrossLines(const Lines& lines)
{
  const std::size_t size = lines.front().size();
  std::vector<Coefficients> coefficients((lines.size() + 2) * size);
  for (std::size_t k = 0; k < size; ++k)
  {
    std::vector<Coefficients> across;
    for (const std::vector<Coefficients>& line : lines)
    {
      across.push_back(line[k]);
    }
    const std::vector<Coefficients> spline = naturalSpline(across);
    for (std::size_t i = 0; i < spline.size(); ++i)
    {
      coefficients[i * size + k] = spline[i];
    }
  }
  return coefficients;
}
}  // namespace

BallBuild buildBallTable(const Parameters& parameters, const JointModel& sound, double deepest, double lowest,
                         double highest, const std::function<void(double)>& progress, unsigned threads)
{
  BallBuild result;
  result.table = emptyTable(parameters, sound, deepest, lowest, highest);
  Lines lines;
  if (!measureLines(parameters, sound, result.table, progress, threads, lines))
  {
    result.failure_reason = "the ring has no equilibrium when a ball drops";
    return result;
  }
  for (std::vector<Coefficients>& line : lines)
  {
    makeSplines(static_cast<std::size_t>(result.table.columns), static_cast<std::size_t>(result.table.places), line);
  }
  result.table.coefficients = acrossLines(lines);
  return result;
}
}  // namespace hjt
