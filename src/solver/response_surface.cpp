// SPDX-License-Identifier: BSD-3-Clause
#include "solver/response_surface.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hjt
{
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

SurfaceEnergy SurfaceCell::energy() const noexcept
{
  // Two cubics side by side along v: of the energy and of its slope by u. By the place within the cell.
  using Pair = Eigen::Array2d;
  const double h = 1.0 / per_height_;
  const double v = v_;
  const double v_left = 1.0 - v;
  const double blend = v * v * (3.0 - 2.0 * v);
  struct Along
  {
    Pair value, rate, curvature;
  };
  const auto along_v = [&](const SurfaceNode& low, const SurfaceNode& high) -> Along
  {
    const Eigen::Map<const Eigen::Array4d> a(low.energies().data());
    const Eigen::Map<const Eigen::Array4d> b(high.energies().data());
    const Pair start = h * a.tail<2>();
    const Pair end = h * b.tail<2>();
    const Pair rise = b.head<2>() - a.head<2>();
    return { a.head<2>() + blend * rise + (v * v_left) * (v_left * start - v * end),
             (6.0 * v * v_left) * rise + (v_left * (1.0 - 3.0 * v)) * start + (v * (3.0 * v - 2.0)) * end,
             (6.0 - 12.0 * v) * rise + (6.0 * v - 4.0) * start + (6.0 * v - 2.0) * end };
  };
  const Along left = along_v(below_[0], above_[0]);
  const Along right = along_v(below_[1], above_[1]);
  const double w = 1.0 / per_width_;
  const double u = u_;
  const double u_left = 1.0 - u;
  const auto value = [&](const Pair& a, const Pair& b)
  { return a[0] + u * u * (3.0 - 2.0 * u) * (b[0] - a[0]) + u * u_left * w * (u_left * a[1] - u * b[1]); };
  const auto rate = [&](const Pair& a, const Pair& b)
  {
    return 6.0 * u * u_left * (b[0] - a[0]) * per_width_ + u_left * (1.0 - 3.0 * u) * a[1] + u * (3.0 * u - 2.0) * b[1];
  };
  const double curvature = (6.0 - 12.0 * u) * (right.value[0] - left.value[0]) * per_width_ +
                           (6.0 * u - 4.0) * left.value[1] + (6.0 * u - 2.0) * right.value[1];
  return { value(left.value, right.value),
           rate(left.value, right.value),
           value(left.rate, right.rate) * per_height_,
           curvature * per_width_,
           rate(left.rate, right.rate) * per_height_,
           value(left.curvature, right.curvature) * per_height_ * per_height_ };
}

ResponseSurface::ResponseSurface(SurfaceTable table, DeviationTable deviations, std::optional<BallDrops> balls)
  : table_(std::move(table))
  , deviations_(std::move(deviations))
  , balls_(std::move(balls))
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
    per_height_.push_back(1.0 / (table_.lines[i + 1] - table_.lines[i]));
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
  const SurfaceNode* below = &table_.nodes[line * stride + static_cast<std::size_t>(column)];
  place.cell = { below,
                 below + stride,
                 columns - column,
                 (v - table_.lines[line]) * per_height_[line],
                 static_cast<double>(table_.columns),
                 per_height_[line] };
  place.at = v;
  place.deviation = {};
  if (!deviations_.pitches.empty())
  {
    locateDeviation(pitch - deviations_.shift, part, place);
  }
  place.balls = balls_ ? balls_->at(motor_angle, v) : BallDrops::Change{};
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
  const double per_height = 1.0 / (table.lines[line + 1] - table.lines[line]);
  const SurfaceNode* below = &table.nodes[line * stride + static_cast<std::size_t>(column)];
  place.deviation = { below,
                      below + stride,
                      columns - column,
                      (place.at - table.lines[line]) * per_height,
                      static_cast<double>(table.columns),
                      per_height };
  place.lobes_swapped = deviations_.swaps_lobes && turns % 2 != 0;
}

std::array<double, 2> ResponseSurface::lobeForces(const Place& place) noexcept
{
  std::array<double, 2> forces{ place.cell.value(SurfaceNode::LOBE_FORCE),
                                place.cell.value(SurfaceNode::LOBE_FORCE + 1) };
  if (!place.deviation.empty())
  {
    forces[place.lobes_swapped ? 1 : 0] += place.deviation.value(SurfaceNode::LOBE_FORCE);
    forces[place.lobes_swapped ? 0 : 1] += place.deviation.value(SurfaceNode::LOBE_FORCE + 1);
  }
  return forces;
}

RingResponse ResponseSurface::response(const Place& place, Eigen::Vector2d& housing_stiffness) const noexcept
{
  SurfaceEnergy energy = place.cell.energy();
  RingResponse response;
  response.velocity_ratio = place.cell.value(SurfaceNode::VELOCITY_RATIO);
  response.output_stiffness = place.cell.value(SurfaceNode::OUTPUT_STIFFNESS);
  if (!place.deviation.empty())
  {
    energy += place.deviation.energy();
    response.velocity_ratio += place.deviation.value(SurfaceNode::VELOCITY_RATIO);
    response.output_stiffness += place.deviation.value(SurfaceNode::OUTPUT_STIFFNESS);
  }
  if (balls_)
  {
    energy += place.balls.energy;
    stiffen(place.balls.energy, response);
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

/// The energy's own curvature changes stiffness and velocity ratio: the stiffness between motor and output is minus
/// ratio times that of the output.
void ResponseSurface::stiffen(const SurfaceEnergy& change, RingResponse& response) const noexcept
{
  const double stiffness = response.output_stiffness + change.by_vv;
  const double across = change.by_uv * pitches_per_radian_ - change.by_vv * inverse_ratio_;
  if (stiffness > 0.0)
  {
    response.velocity_ratio = (response.velocity_ratio * response.output_stiffness - across) / stiffness;
    response.output_stiffness = stiffness;
  }
}

void ResponseSurface::friction(const Place& place, RingFrictionResponse& friction) const noexcept
{
  using Value = SurfaceNode::Value;
  constexpr int GROUPS = RingFrictionResponse::FLANK_GROUPS;
  constexpr int COUNT = Value::LOBE_FORCE - Value::BILINEAR;  // a few more than needed: whole vectors
  constexpr int VISCOUS = Value::VISCOUS - Value::BILINEAR;
  constexpr int FLANKS = Value::FLANKS - Value::BILINEAR;
  Eigen::Array<float, COUNT, 1> x = place.cell.values<COUNT>();
  if (!place.deviation.empty())
  {
    x += place.deviation.values<COUNT>();
  }
  friction.contact_force = x[Value::CONTACT_FORCE - Value::BILINEAR];
  friction.ring_torque = x[Value::RING_TORQUE - Value::BILINEAR];
  friction.viscous << x[VISCOUS], x[VISCOUS + 1], x[VISCOUS + 2];
  for (int i = 0; i < GROUPS; ++i)
  {
    friction.flank_by_motor[i] = x[FLANKS + i];
    friction.flank_by_output[i] = x[FLANKS + GROUPS + i];
    friction.rms_slip_by_motor[i] = x[FLANKS + 2 * GROUPS + i];
    friction.rms_slip_by_output[i] = x[FLANKS + 3 * GROUPS + i];
  }
  if (balls_)
  {
    friction.contact_force += place.balls.contact_force;
    friction.flank_by_motor *= 1.0 + place.balls.flanks;
    friction.flank_by_output *= 1.0 + place.balls.flanks;
  }
}
}  // namespace hjt
