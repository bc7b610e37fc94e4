// SPDX-License-Identifier: BSD-3-Clause
#include "solver/surface_tables.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace hjt
{
namespace
{
/// The four nodes around a position with their weights [-].
struct Corners
{
  std::array<const float*, 4> node;
  std::array<float, 4> weight;
};

/// Interpolates the values of `count` stored teeth between four nodes. `first`: number of the first of these teeth.
void blend(const Corners& from, std::size_t first, std::size_t count, double* out) noexcept
{
  const float* a = from.node[0] + first;
  const float* b = from.node[1] + first;
  const float* c = from.node[2] + first;
  const float* d = from.node[3] + first;
  const float wa = from.weight[0];
  const float wb = from.weight[1];
  const float wc = from.weight[2];
  const float wd = from.weight[3];
#pragma omp simd
  for (std::size_t i = 0; i < count; ++i)
  {
    out[i] = static_cast<double>(wa * a[i] + wb * b[i] + wc * c[i] + wd * d[i]);
  }
}
void repeat(const double* from, std::size_t count, double sign, double* to) noexcept
{
#pragma omp simd
  for (std::size_t i = 0; i < count; ++i)
  {
    to[i] = sign * from[i];
  }
}
}  // namespace

bool ToothResponse::at(double motor_angle, double output_angle, double* const* out) const noexcept
{
  const double pitches = motor_angle / pitch;
  const double whole = std::floor(pitches);
  const double v = output_angle - motor_angle / ratio;
  if (lines.empty() || !(v >= lines.front() && v <= lines.back()) || !std::isfinite(pitches))
  {
    return false;
  }
  const auto above = std::upper_bound(lines.begin() + 1, lines.end() - 1, v);
  const auto line = static_cast<std::size_t>(above - lines.begin()) - 1;
  const double along = (v - lines[line]) / (lines[line + 1] - lines[line]);
  const double place = (pitches - whole) * columns;
  const auto column = static_cast<std::size_t>(std::clamp(static_cast<int>(place), 0, columns - 1));
  const double across = place - static_cast<double>(column);
  const std::size_t row = (static_cast<std::size_t>(columns) + 1) * nodeSize();
  const float* below = values.data() + line * row + column * nodeSize();
  const auto weight = [](double a, double b) { return static_cast<float>(a * b); };
  Corners corners{ { below, below + nodeSize(), below + row, below + row + nodeSize() },
                   { weight(1.0 - across, 1.0 - along), weight(across, 1.0 - along), weight(1.0 - across, along),
                     weight(across, along) } };

  // The values of stored tooth i belong to tooth i + turned. The tooth half a turn away has the same values, except
  // that its positions have the opposite sign.
  const auto count = static_cast<std::size_t>(stored);
  const auto all = static_cast<std::size_t>(teeth);
  const auto turned = static_cast<std::size_t>(whole - std::floor(whole / teeth) * teeth);
  const std::size_t up_to_end = std::min(count, all - turned);
  for (int quantity = 0; quantity < QUANTITIES; ++quantity)
  {
    double* of_quantity = out[quantity];
    blend(corners, 0, up_to_end, of_quantity + turned);
    blend(corners, up_to_end, count - up_to_end, of_quantity);
    if (count < all)
    {
      const double sign = quantity == X || quantity == Y ? -1.0 : 1.0;
      const std::size_t edge = turned % count;
      const std::size_t from = turned < count ? 0 : count;  // first tooth of the half that begins with stored values
      repeat(of_quantity + from + edge, count - edge, sign, of_quantity + (count - from) + edge);
      repeat(of_quantity + (count - from), edge, sign, of_quantity + from);
    }
    for (const float*& node : corners.node)
    {
      node += count;
    }
  }
  const double angle = static_cast<double>(turned) * pitch;
  const double cosine = std::cos(angle);
  const double sine = std::sin(angle);
  double* x = out[X];
  double* y = out[Y];
  for (int i = 0; i < teeth; ++i)
  {
    const double turned_x = cosine * x[i] - sine * y[i];
    y[i] = sine * x[i] + cosine * y[i];
    x[i] = turned_x;
  }
  return true;
}

namespace
{
using Weights = std::array<double, 4>;

/// Values and derivatives of the cubic B-splines of the four nearest knots. `t`: distance from the second knot [knots].
struct Spline
{
  explicit Spline(double t) noexcept
  {
    const double s = 1.0 - t;
    value = { s * s * s / 6.0, (4.0 - 3.0 * t * t * (2.0 - t)) / 6.0, (4.0 - 3.0 * s * s * (2.0 - s)) / 6.0,
              t * t * t / 6.0 };
    rate = { -0.5 * s * s, 0.5 * t * (3.0 * t - 4.0), 0.5 * s * (4.0 - 3.0 * s), 0.5 * t * t };
    second = { s, 3.0 * t - 2.0, 1.0 - 3.0 * t, t };
  }
  Weights value;
  Weights rate;
  Weights second;
};

/// Position on an even grid with a period of `count` intervals.
struct RoundPlace
{
  RoundPlace(double at, int count) noexcept
  {
    const double turned = at - std::floor(at);
    const double place = turned * count;
    const int below = std::min(static_cast<int>(place), count - 1);
    part = place - below;
    for (int i = 0; i < 4; ++i)
    {
      const int knot = below + i - 1;
      knots[static_cast<std::size_t>(i)] = knot < 0 ? knot + count : knot < count ? knot : knot - count;
    }
  }
  double part;
  std::array<int, 4> knots{};
};

using Energies = Eigen::Array4d;

/// Coefficients of the powers of the drop. e<ijk>: energy, derived i times by u, j times by w and k times by chi.
/// forces: contact force and flank friction.
struct TableEnergies
{
  Energies e000{ Energies::Zero() };
  Energies e100{ Energies::Zero() };
  Energies e010{ Energies::Zero() };
  Energies e001{ Energies::Zero() };
  Energies e200{ Energies::Zero() };
  Energies e110{ Energies::Zero() };
  Energies e101{ Energies::Zero() };
  Energies e020{ Energies::Zero() };
  Energies e011{ Energies::Zero() };
  Energies e002{ Energies::Zero() };
  Energies forces{ Energies::Zero() };
};

/// `w`: position between the line `below` and the next line, 0 ... 1.
TableEnergies energiesIn(const BallTable& table, const RoundPlace& u, double w, int below,
                         const RoundPlace& chi) noexcept
{
  const Spline by_u(u.part);
  const Spline by_w(w);
  const Spline by_chi(chi.part);
  TableEnergies e;
  for (std::size_t i = 0; i < 4; ++i)
  {
    for (std::size_t j = 0; j < 4; ++j)
    {
      const int number = (below + static_cast<int>(i)) * table.columns + u.knots[j];
      const BallTable::Coefficients* row =
          &table.coefficients[static_cast<std::size_t>(number) * static_cast<std::size_t>(table.places)];
      Energies value(0.0, 0.0, 0.0, 0.0);
      Energies rate = value;
      Energies second = value;
      Energies force = value;
      for (std::size_t k = 0; k < 4; ++k)
      {
        const BallTable::Coefficients& c = row[chi.knots[k]];
        value += by_chi.value[k] * c.head<4>();
        rate += by_chi.rate[k] * c.head<4>();
        second += by_chi.second[k] * c.head<4>();
        force += by_chi.value[k] * c.tail<4>();
      }
      const double here = by_w.value[i] * by_u.value[j];
      const double along = by_w.value[i] * by_u.rate[j];
      const double across = by_w.rate[i] * by_u.value[j];
      e.e000 += here * value;
      e.e100 += along * value;
      e.e010 += across * value;
      e.e001 += here * rate;
      e.e200 += by_w.value[i] * by_u.second[j] * value;
      e.e110 += by_w.rate[i] * by_u.rate[j] * value;
      e.e101 += along * rate;
      e.e020 += by_w.second[i] * by_u.value[j] * value;
      e.e011 += across * rate;
      e.e002 += here * second;
      e.forces += here * force;
    }
  }
  return e;
}
}  // namespace

BallDrops::Change BallDrops::at(double motor_angle, double v) const noexcept
{
  const int ball = bearing_.ballThatMayDrop(motor_angle);
  const RaceDeflection::Drop drop = bearing_.drop(ball, motor_angle);
  return drop.value != 0.0 ? ofBall(motor_angle, v, bearing_.ballPlace(ball, motor_angle), drop) : Change{};
}

/// Change of the ring by the drop of one ball. `place`: angle of the ball in the housing [rad].
BallDrops::Change BallDrops::ofBall(double motor_angle, double v, double place,
                                    const RaceDeflection::Drop& drop) const noexcept
{
  const BallTable& table = *table_;
  const RoundPlace u(motor_angle / table.pitch, table.columns);
  const RoundPlace chi((place - motor_angle) / table.turn, table.places);
  const double line = (std::asinh(v / table.scale) - table.lowest) / table.step;
  const int below = std::clamp(static_cast<int>(line), 0, table.lines - 1);
  const TableEnergies e = energiesIn(table, u, line - below, below, chi);

  const double x = drop.value / table.deepest;
  const Energies power(x, x * x, x * x * x, x * x * x * x);
  const Energies by_power = Energies(1.0, 2.0 * x, 3.0 * x * x, 4.0 * x * x * x) / table.deepest;
  const Energies by_power_twice = Energies(0.0, 2.0, 6.0 * x, 12.0 * x * x) / (table.deepest * table.deepest);
  const auto times = [](const Energies& a, const Energies& b) { return (a * b).sum(); };

  const double root = 1.0 / std::sqrt(v * v + table.scale * table.scale);
  const double w_v = root / table.step;  // derivative of w [lines] by v [1/rad]
  const double w_vv = -v * root * root * root / table.step;
  const double u_u = table.columns;  // columns of the table in a pitch
  // Derivatives by u in pitches: chi_u of the ball's angle relative to the wave generator, in grid intervals; h_u and
  // h_uu of the ball's drop [m].
  const double chi_u = (bearing_.cageRate() - 1.0) * table.pitch * table.places / table.turn;
  const double h_u = drop.rate * table.pitch;
  const double h_uu = drop.second * table.pitch * table.pitch;

  SurfaceEnergy energy;
  energy.value = times(e.e000, power);
  energy.by_u = u_u * times(e.e100, power) + chi_u * times(e.e001, power) + h_u * times(e.e000, by_power);
  energy.by_v = w_v * times(e.e010, power);
  energy.by_uu =
      u_u * (u_u * times(e.e200, power) + 2.0 * (chi_u * times(e.e101, power) + h_u * times(e.e100, by_power))) +
      chi_u * (chi_u * times(e.e002, power) + 2.0 * h_u * times(e.e001, by_power)) +
      h_u * h_u * times(e.e000, by_power_twice) + h_uu * times(e.e000, by_power);
  energy.by_uv = w_v * (u_u * times(e.e110, power) + chi_u * times(e.e011, power) + h_u * times(e.e010, by_power));
  energy.by_vv = w_v * w_v * times(e.e020, power) + w_vv * times(e.e010, power);
  return { energy, e.forces[0] * x + e.forces[1] * x * x, e.forces[2] * x + e.forces[3] * x * x };
}
}  // namespace hjt
