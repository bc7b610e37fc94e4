// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/solver/response_surface.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hjt
{
namespace
{
/// Cubic Hermite basis on 0 ... 1 and its derivatives: weights of value and slope at both ends.
struct Hermite
{
  explicit Hermite(double t) noexcept
    : end(t * t * (3.0 - 2.0 * t))
    , start(1.0 - end)
    , start_slope(t * (1.0 - t) * (1.0 - t))
    , end_slope(-t * t * (1.0 - t))
    , end_rate(6.0 * t * (1.0 - t))
    , start_slope_rate((1.0 - t) * (1.0 - 3.0 * t))
    , end_slope_rate(t * (3.0 * t - 2.0))
  {
  }

  double value(double a, double slope_a, double b, double slope_b) const noexcept
  {
    return start * a + start_slope * slope_a + end * b + end_slope * slope_b;
  }

  double rate(double a, double slope_a, double b, double slope_b) const noexcept
  {
    return end_rate * (b - a) + start_slope_rate * slope_a + end_slope_rate * slope_b;
  }

  double end;
  double start;
  double start_slope;
  double end_slope;
  double end_rate;
  double start_slope_rate;
  double end_slope_rate;
};
}  // namespace

ResponseSurface::ResponseSurface(SurfaceTable table)
  : table_(std::move(table)), pitches_per_radian_(1.0 / table_.pitch), inverse_ratio_(1.0 / table_.ratio)
{
  double least = highest() - lowest();
  for (std::size_t i = 0; i + 1 < table_.lines.size(); ++i)
  {
    const double height = table_.lines[i + 1] - table_.lines[i];
    inverse_height_.push_back(1.0 / height);
    least = std::min(least, height);
  }
  const auto bins = static_cast<std::size_t>(std::ceil((highest() - lowest()) / least)) + 1;
  bins_per_radian_ = static_cast<double>(bins) / (highest() - lowest());
  std::uint32_t line = 0;
  for (std::size_t bin = 0; bin <= bins; ++bin)
  {
    const double edge = lowest() + static_cast<double>(bin) / bins_per_radian_;
    while (line + 2 < table_.lines.size() && table_.lines[line + 1] <= edge)
    {
      ++line;
    }
    line_.push_back(line);
  }
}

bool ResponseSurface::locate(double motor_angle, double output_angle, Place& place) const noexcept
{
  constexpr double MOST_PITCHES = 1e15;  // beyond it an angle has no place within a pitch
  const double pitches = motor_angle * pitches_per_radian_;
  const double v = output_angle - motor_angle * inverse_ratio_;
  if (!(v >= lowest() && v <= highest() && std::abs(pitches) < MOST_PITCHES))
  {
    return false;
  }
  const auto truncated = static_cast<double>(static_cast<std::int64_t>(pitches));
  const double part = pitches - truncated + (pitches < truncated ? 1.0 : 0.0);
  const double columns = part * table_.columns;
  const int column = std::min(static_cast<int>(columns), table_.columns - 1);
  // Bins are narrower than the intervals between lines, so at most one line lies within a bin.
  std::uint32_t line = line_[static_cast<std::size_t>((v - lowest()) * bins_per_radian_)];
  line += line + 2 < table_.lines.size() && v >= table_.lines[line + 1] ? 1 : 0;
  const std::size_t stride = static_cast<std::size_t>(table_.columns) + 1;
  place.below = &table_.nodes[line * stride + static_cast<std::size_t>(column)];
  place.above = place.below + stride;
  place.u = columns - column;
  place.at = v;
  place.height = table_.lines[line + 1] - table_.lines[line];
  place.v = (v - table_.lines[line]) * inverse_height_[line];
  return true;
}

RingResponse ResponseSurface::response(const Place& place) const noexcept
{
  using Table = SurfaceTable;
  const Hermite along_v(place.v);
  const Hermite along_u(place.u);
  const double width = 1.0 / table_.columns;  // of an interval in u
  std::array<double, 2> energy;               // at the lower and higher u, at this v
  std::array<double, 2> by_u;
  std::array<double, 2> by_v;
  std::array<double, 2> by_uv;
  for (int i = 0; i < 2; ++i)
  {
    const Table::Node& a = place.below[i];
    const Table::Node& b = place.above[i];
    const double h = place.height;
    energy[i] = along_v.value(a[Table::ENERGY], h * a[Table::ENERGY_BY_V], b[Table::ENERGY], h * b[Table::ENERGY_BY_V]);
    by_v[i] = along_v.rate(a[Table::ENERGY], h * a[Table::ENERGY_BY_V], b[Table::ENERGY], h * b[Table::ENERGY_BY_V]);
    by_u[i] = width * along_v.value(a[Table::ENERGY_BY_U], h * a[Table::ENERGY_BY_UV], b[Table::ENERGY_BY_U],
                                    h * b[Table::ENERGY_BY_UV]);
    by_uv[i] = width * along_v.rate(a[Table::ENERGY_BY_U], h * a[Table::ENERGY_BY_UV], b[Table::ENERGY_BY_U],
                                    h * b[Table::ENERGY_BY_UV]);
  }
  const double slope_v = along_u.value(by_v[0], by_uv[0], by_v[1], by_uv[1]) / place.height;
  const double slope_u = along_u.rate(energy[0], by_u[0], energy[1], by_u[1]) * table_.columns * pitches_per_radian_;
  RingResponse response;
  response.energy = along_u.value(energy[0], by_u[0], energy[1], by_u[1]);
  response.output_torque = -slope_v;
  response.wave_generator_torque = slope_v * inverse_ratio_ - slope_u;
  response.follow = value(place, Table::FOLLOW);
  response.output_stiffness = value(place, Table::OUTPUT_STIFFNESS);
  return response;
}

void ResponseSurface::friction(const Place& place, RingFrictionResponse& friction) const noexcept
{
  using Table = SurfaceTable;
  constexpr int FIRST = Table::CONTACT_FORCE;
  constexpr int COUNT = Table::TEETH_LOADED - FIRST;
  using Values = Eigen::Array<double, COUNT, 1>;
  const auto at = [](const Table::Node& node) { return Eigen::Map<const Values>(node.data() + FIRST); };
  const double w11 = place.u * place.v;
  const double w10 = place.v - w11;
  const double w01 = place.u - w11;
  const double w00 = 1.0 - place.u - w10;
  const Values x =
      w00 * at(place.below[0]) + w01 * at(place.below[1]) + w10 * at(place.above[0]) + w11 * at(place.above[1]);
  friction.contact_force = x[Table::CONTACT_FORCE - FIRST];
  friction.interface_torque = x[Table::INTERFACE_TORQUE - FIRST];
  friction.cup_slip << x[Table::CUP_SLIP - FIRST], x[Table::CUP_SLIP - FIRST + 1];
  friction.viscous << x[Table::VISCOUS - FIRST], x[Table::VISCOUS - FIRST + 1], x[Table::VISCOUS - FIRST + 2];
  for (int g = 0; g < RingFrictionResponse::FLANK_GROUPS; ++g)
  {
    const int i = Table::FLANKS - FIRST + 4 * g;
    friction.flanks[g].slip << x[i], x[i + 1];
    friction.flanks[g].rms_slip << x[i + 2], x[i + 3];
  }
}
}  // namespace hjt
