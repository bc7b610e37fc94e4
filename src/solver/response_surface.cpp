// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/solver/response_surface.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hjt
{
namespace
{
/// Cubic on 0 ... 1 from value and slope at its start and at its end, and its derivatives.
class Hermite
{
public:
  explicit Hermite(double t) noexcept : t_(t), r_(1.0 - t) {}

  double value(const std::array<double, 4>& x) const noexcept
  {
    const double end = t_ * t_ * (3.0 - 2.0 * t_);
    return x[0] + end * (x[2] - x[0]) + t_ * r_ * (r_ * x[1] - t_ * x[3]);
  }
  double rate(const std::array<double, 4>& x) const noexcept
  {
    return 6.0 * t_ * r_ * (x[2] - x[0]) + r_ * (1.0 - 3.0 * t_) * x[1] + t_ * (3.0 * t_ - 2.0) * x[3];
  }
  double curvature(const std::array<double, 4>& x) const noexcept
  {
    return 6.0 * (1.0 - 2.0 * t_) * (x[2] - x[0]) + (6.0 * t_ - 4.0) * x[1] + (6.0 * t_ - 2.0) * x[3];
  }

private:
  double t_;
  double r_;
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

RingResponse ResponseSurface::response(const Place& place, Eigen::Vector2d& housing_stiffness) const noexcept
{
  using Table = SurfaceTable;
  const Hermite along_v(place.v);
  const Hermite along_u(place.u);
  const double h = place.height;
  const double width = 1.0 / table_.columns;  // of an interval in u [pitches]
  const double per_height = 1.0 / h;
  const double per_width = table_.columns * pitches_per_radian_;  // [1/rad]
  // At the lower and the higher u, at this v; derivatives by the place within the interval.
  std::array<double, 2> energy;
  std::array<double, 2> by_u;
  std::array<double, 2> by_v;
  std::array<double, 2> by_uv;
  std::array<double, 2> by_vv;
  std::array<double, 2> by_uvv;
  for (int i = 0; i < 2; ++i)
  {
    const Table::Node& a = place.below[i];
    const Table::Node& b = place.above[i];
    const std::array<double, 4> values{ a[Table::ENERGY], h * a[Table::ENERGY_BY_V], b[Table::ENERGY],
                                        h * b[Table::ENERGY_BY_V] };
    const std::array<double, 4> slopes{ width * a[Table::ENERGY_BY_U], width * h * a[Table::ENERGY_BY_UV],
                                        width * b[Table::ENERGY_BY_U], width * h * b[Table::ENERGY_BY_UV] };
    energy[i] = along_v.value(values);
    by_v[i] = along_v.rate(values);
    by_vv[i] = along_v.curvature(values);
    by_u[i] = along_v.value(slopes);
    by_uv[i] = along_v.rate(slopes);
    by_uvv[i] = along_v.curvature(slopes);
  }
  const std::array<double, 4> energies{ energy[0], by_u[0], energy[1], by_u[1] };
  const std::array<double, 4> rates{ by_v[0], by_uv[0], by_v[1], by_uv[1] };
  const double slope_u = along_u.rate(energies) * per_width;
  const double slope_v = along_u.value(rates) * per_height;
  const double k_uu = along_u.curvature(energies) * per_width * per_width;
  const double k_uv = along_u.rate(rates) * per_width * per_height;
  const double k_vv = along_u.value({ by_vv[0], by_uvv[0], by_vv[1], by_uvv[1] }) * per_height * per_height;
  RingResponse response;
  response.energy = along_u.value(energies);
  response.output_torque = -slope_v;
  response.wave_generator_torque = slope_v * inverse_ratio_ - slope_u;
  response.follow = value(place, Table::FOLLOW);
  response.output_stiffness = value(place, Table::OUTPUT_STIFFNESS);
  response.motor_stiffness = k_uu - inverse_ratio_ * (2.0 * k_uv - inverse_ratio_ * k_vv);
  // The housing holds what wave generator and output bring: (1 - 1/ratio) dU/dv + dU/du.
  const double by_output = (1.0 - inverse_ratio_) * k_vv + k_uv;
  housing_stiffness[0] = (1.0 - inverse_ratio_) * k_uv + k_uu - inverse_ratio_ * by_output;
  housing_stiffness[1] = by_output;
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
  friction.viscous << x[Table::VISCOUS - FIRST], x[Table::VISCOUS - FIRST + 1], x[Table::VISCOUS - FIRST + 2];
  constexpr int GROUPS = RingFrictionResponse::FLANK_GROUPS;
  constexpr int FLANKS = Table::FLANKS - FIRST;
  friction.flank_by_motor = x.segment<GROUPS>(FLANKS);
  friction.flank_by_output = x.segment<GROUPS>(FLANKS + GROUPS);
  friction.rms_slip_by_motor = x.segment<GROUPS>(FLANKS + 2 * GROUPS);
  friction.rms_slip_by_output = x.segment<GROUPS>(FLANKS + 3 * GROUPS);
}
}  // namespace hjt
