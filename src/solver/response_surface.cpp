// SPDX-License-Identifier: BSD-3-Clause
#include "solver/response_surface.hpp"

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

LineIndex::LineIndex(const std::vector<double>& lines)
{
  if (lines.empty())
  {
    return;
  }
  const double range = lines.back() - lines.front();
  double least = range;
  for (std::size_t i = 0; i + 1 < lines.size(); ++i)
  {
    least = std::min(least, lines[i + 1] - lines[i]);
  }
  const auto bins = static_cast<std::size_t>(std::ceil(range / least)) + 1;
  bins_per_unit_ = static_cast<double>(bins) / range;
  std::uint32_t line = 0;
  for (std::size_t bin = 0; bin <= bins; ++bin)
  {
    const double edge = lines.front() + static_cast<double>(bin) / bins_per_unit_;
    while (line + 2 < lines.size() && lines[line + 1] <= edge)
    {
      ++line;
    }
    line_.push_back(line);
  }
}

SurfaceCell::Energy SurfaceCell::energy() const noexcept
{
  using Table = SurfaceTable;
  const Hermite along_v(v);
  const Hermite along_u(u);
  const double h = height;
  const double w = width;
  // At the lower and the higher u, at this v; derivatives by the place within the cell.
  std::array<double, 2> energy;
  std::array<double, 2> by_u;
  std::array<double, 2> by_v;
  std::array<double, 2> by_uv;
  std::array<double, 2> by_vv;
  std::array<double, 2> by_uvv;
  for (int i = 0; i < 2; ++i)
  {
    const Node& a = below[i];
    const Node& b = above[i];
    const std::array<double, 4> values{ a[Table::ENERGY], h * a[Table::ENERGY_BY_V], b[Table::ENERGY],
                                        h * b[Table::ENERGY_BY_V] };
    const std::array<double, 4> slopes{ w * a[Table::ENERGY_BY_U], w * h * a[Table::ENERGY_BY_UV],
                                        w * b[Table::ENERGY_BY_U], w * h * b[Table::ENERGY_BY_UV] };
    energy[i] = along_v.value(values);
    by_v[i] = along_v.rate(values);
    by_vv[i] = along_v.curvature(values);
    by_u[i] = along_v.value(slopes);
    by_uv[i] = along_v.rate(slopes);
    by_uvv[i] = along_v.curvature(slopes);
  }
  const std::array<double, 4> energies{ energy[0], by_u[0], energy[1], by_u[1] };
  const std::array<double, 4> rates{ by_v[0], by_uv[0], by_v[1], by_uv[1] };
  const double per_width = 1.0 / w;
  const double per_height = 1.0 / h;
  return { along_u.value(energies),
           along_u.rate(energies) * per_width,
           along_u.value(rates) * per_height,
           along_u.curvature(energies) * per_width * per_width,
           along_u.rate(rates) * per_width * per_height,
           along_u.value({ by_vv[0], by_uvv[0], by_vv[1], by_uvv[1] }) * per_height * per_height };
}

ResponseSurface::ResponseSurface(SurfaceTable table, DeviationTable deviations)
  : table_(std::move(table))
  , deviations_(std::move(deviations))
  , pitches_per_radian_(1.0 / table_.pitch)
  , inverse_ratio_(1.0 / table_.ratio)
  , line_index_(table_.lines)
{
  for (const DeviationTable::Pitch& pitch : deviations_.pitches)
  {
    deviation_index_.emplace_back(pitch.lines);
  }
  for (std::size_t i = 0; i + 1 < table_.lines.size(); ++i)
  {
    inverse_height_.push_back(1.0 / (table_.lines[i + 1] - table_.lines[i]));
  }
}

bool ResponseSurface::locate(double motor_angle, double output_angle, Place& place) const noexcept
{
  constexpr double MAX_PITCHES = 1e15;  // beyond it an angle has no place within a pitch
  const double pitches = motor_angle * pitches_per_radian_;
  const double v = output_angle - motor_angle * inverse_ratio_;
  if (!(v >= lowest() && v <= highest() && std::abs(pitches) < MAX_PITCHES))
  {
    return false;
  }
  const auto truncated = static_cast<std::int64_t>(pitches);
  const std::int64_t pitch = truncated - (pitches < static_cast<double>(truncated) ? 1 : 0);
  const double part = pitches - static_cast<double>(pitch);
  const double columns = part * table_.columns;
  const int column = std::min(static_cast<int>(columns), table_.columns - 1);
  const std::size_t line = line_index_.below(table_.lines, v);
  const std::size_t stride = static_cast<std::size_t>(table_.columns) + 1;
  SurfaceCell& cell = place.cell;
  cell.below = &table_.nodes[line * stride + static_cast<std::size_t>(column)];
  cell.above = cell.below + stride;
  cell.u = columns - column;
  cell.v = (v - table_.lines[line]) * inverse_height_[line];
  cell.width = 1.0 / table_.columns;
  cell.height = table_.lines[line + 1] - table_.lines[line];
  place.at = v;
  place.deviation.below = nullptr;
  if (!deviations_.pitches.empty())
  {
    locateDeviation(pitch, part, place);
  }
  return true;
}

/// `part` of a pitch beyond a whole one.
void ResponseSurface::locateDeviation(std::int64_t pitch, double part, Place& place) const noexcept
{
  const auto count = static_cast<std::int64_t>(deviations_.pitches.size());
  const std::int64_t turns = pitch / count - (pitch % count < 0 ? 1 : 0);
  const auto within = static_cast<std::size_t>(pitch - turns * count);
  const DeviationTable::Pitch& table = deviations_.pitches[within];
  if (table.lines.empty())
  {
    return;
  }
  const double columns = part * table.columns;
  const int column = std::min(static_cast<int>(columns), table.columns - 1);
  const std::size_t line = deviation_index_[within].below(table.lines, place.at);
  const std::size_t stride = static_cast<std::size_t>(table.columns) + 1;
  const double height = table.lines[line + 1] - table.lines[line];
  const SurfaceTable::Node* below = &table.nodes[line * stride + static_cast<std::size_t>(column)];
  place.deviation = {
    below, below + stride, columns - column, (place.at - table.lines[line]) / height, 1.0 / table.columns, height
  };
  place.lobes_swapped = deviations_.swaps_lobes && turns % 2 != 0;
}

std::array<double, 2> ResponseSurface::lobeForces(const Place& place) noexcept
{
  std::array<double, 2> forces{ place.cell.value(SurfaceTable::LOBE_FORCE),
                                place.cell.value(SurfaceTable::LOBE_FORCE + 1) };
  if (place.deviation.below != nullptr)
  {
    forces[place.lobes_swapped ? 1 : 0] += place.deviation.value(SurfaceTable::LOBE_FORCE);
    forces[place.lobes_swapped ? 0 : 1] += place.deviation.value(SurfaceTable::LOBE_FORCE + 1);
  }
  return forces;
}

RingResponse ResponseSurface::response(const Place& place, Eigen::Vector2d& housing_stiffness) const noexcept
{
  SurfaceCell::Energy energy = place.cell.energy();
  RingResponse response;
  response.velocity_ratio = place.cell.value(SurfaceTable::VELOCITY_RATIO);
  response.output_stiffness = place.cell.value(SurfaceTable::OUTPUT_STIFFNESS);
  if (place.deviation.below != nullptr)
  {
    const SurfaceCell::Energy more = place.deviation.energy();
    energy.value += more.value;
    energy.by_u += more.by_u;
    energy.by_v += more.by_v;
    energy.by_uu += more.by_uu;
    energy.by_uv += more.by_uv;
    energy.by_vv += more.by_vv;
    response.velocity_ratio += place.deviation.value(SurfaceTable::VELOCITY_RATIO);
    response.output_stiffness += place.deviation.value(SurfaceTable::OUTPUT_STIFFNESS);
  }
  const double per_pitch = pitches_per_radian_;
  const double k_uu = energy.by_uu * per_pitch * per_pitch;
  const double k_uv = energy.by_uv * per_pitch;
  response.energy = energy.value;
  response.output_torque = -energy.by_v;
  response.wave_generator_torque = energy.by_v * inverse_ratio_ - energy.by_u * per_pitch;
  response.motor_stiffness = k_uu - inverse_ratio_ * (2.0 * k_uv - inverse_ratio_ * energy.by_vv);
  // The housing holds what wave generator and output bring: (1 - 1/ratio) dU/dv + dU/du.
  const double by_output = (1.0 - inverse_ratio_) * energy.by_vv + k_uv;
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
  const auto bilinear = [&](const SurfaceCell& cell) -> Values
  {
    const double w11 = cell.u * cell.v;
    const double w10 = cell.v - w11;
    const double w01 = cell.u - w11;
    const double w00 = 1.0 - cell.u - w10;
    return w00 * at(cell.below[0]) + w01 * at(cell.below[1]) + w10 * at(cell.above[0]) + w11 * at(cell.above[1]);
  };
  Values x = bilinear(place.cell);
  if (place.deviation.below != nullptr)
  {
    x += bilinear(place.deviation);
  }
  friction.contact_force = x[Table::CONTACT_FORCE - FIRST];
  friction.ring_torque = x[Table::RING_TORQUE - FIRST];
  friction.viscous << x[Table::VISCOUS - FIRST], x[Table::VISCOUS - FIRST + 1], x[Table::VISCOUS - FIRST + 2];
  constexpr int GROUPS = RingFrictionResponse::FLANK_GROUPS;
  constexpr int FLANKS = Table::FLANKS - FIRST;
  friction.flank_by_motor = x.segment<GROUPS>(FLANKS);
  friction.flank_by_output = x.segment<GROUPS>(FLANKS + GROUPS);
  friction.rms_slip_by_motor = x.segment<GROUPS>(FLANKS + 2 * GROUPS);
  friction.rms_slip_by_output = x.segment<GROUPS>(FLANKS + 3 * GROUPS);
}
}  // namespace hjt
