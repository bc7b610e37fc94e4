// SPDX-License-Identifier: BSD-3-Clause
#include "solver/response_surface.hpp"

#include <algorithm>
#include <cmath>

#include "gear/vector_loops.hpp"

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

HJT_VECTOR_CLONES SurfaceEnergy SurfaceCell::energy() const noexcept
{
  // Values of two cubics along v, for the energy and for the slope of the energy by u, at the position within the cell.
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

ResponseSurface::Tables::Tables(SurfaceTable of_gear, DeviationTable of_teeth)
  : table(std::move(of_gear)), deviations(std::move(of_teeth)), line_index(table.lines)
{
  for (const DeviationTable::Pitch& pitch : deviations.pitches)
  {
    deviation_index.emplace_back(pitch.lines);
  }
  for (std::size_t i = 0; i + 1 < table.lines.size(); ++i)
  {
    per_height.push_back(1.0 / (table.lines[i + 1] - table.lines[i]));
  }
}

ResponseSurface::ResponseSurface(SurfaceTable table, DeviationTable deviations, std::optional<BallDrops> balls)
  : tables_(std::make_shared<const Tables>(std::move(table), std::move(deviations)))
  , balls_(std::move(balls))
  , pitches_per_radian_(1.0 / tables_->table.pitch)
  , inverse_ratio_(1.0 / tables_->table.ratio)
  , lowest_(tables_->table.lines.front())
  , highest_(tables_->table.lines.back())
{
}

ResponseSurface::ResponseSurface(std::vector<Share> shares)
  : tables_(shares.front().surface->tables_)
  , shares_(std::move(shares))
  , pitches_per_radian_(1.0 / tables_->table.pitch)
  , inverse_ratio_(1.0 / tables_->table.ratio)
  , lowest_(tables_->table.lines.front())
  , highest_(tables_->table.lines.back())
{
  for (const Share& share : shares_)
  {
    lowest_ = std::max(lowest_, share.surface->lowest());
    highest_ = std::min(highest_, share.surface->highest());
  }
}

bool ResponseSurface::locate(double motor_angle, double output_angle, Place& place) const noexcept
{
  constexpr double MAX_PITCHES = 1e15;  // larger angles have no digits left for the position within a pitch
  const double pitches = motor_angle * pitches_per_radian_;
  const double v = output_angle - motor_angle * inverse_ratio_;
  if (!(v >= lowest_ && v <= highest_ && std::abs(pitches) < MAX_PITCHES))
  {
    return false;
  }
  place.at = v;
  tables_->locate(pitches, v, place);
  place.balls = balls_ ? balls_->at(motor_angle, v) : BallDrops::Change{};
  place.weight = 1.0;
  place.other_count = 0;
  for (std::size_t i = 0; i < shares_.size(); ++i)
  {
    Cells& cells = i > 0 ? place.others[place.other_count++] : place;
    cells.weight = shares_[i].weight;
    if (i > 0)
    {
      shares_[i].surface->tables_->locate(pitches, v, cells);
    }
  }
  return true;
}

void ResponseSurface::Tables::locate(double pitches, double v, Cells& cells) const noexcept
{
  const auto truncated = static_cast<std::int64_t>(pitches);
  const std::int64_t pitch = truncated - (pitches < static_cast<double>(truncated) ? 1 : 0);
  const double part = pitches - static_cast<double>(pitch);
  const double columns = part * table.columns;
  const int column = std::min(static_cast<int>(columns), table.columns - 1);
  const std::size_t line = line_index.below(table.lines, v);
  const std::size_t stride = static_cast<std::size_t>(table.columns) + 1;
  const SurfaceNode* below = &table.nodes[line * stride + static_cast<std::size_t>(column)];
  cells.cell = { below,
                 below + stride,
                 columns - column,
                 (v - table.lines[line]) * per_height[line],
                 static_cast<double>(table.columns),
                 per_height[line] };
  cells.deviation = {};
  if (!deviations.pitches.empty())
  {
    locateDeviation(pitch - deviations.shift, part, v, cells);
  }
}

/// Finds the cell of the deviations. `part`: position within the pitch, 0 ... 1 [-].
void ResponseSurface::Tables::locateDeviation(std::int64_t pitch, double part, double v, Cells& cells) const noexcept
{
  const auto count = static_cast<std::int64_t>(deviations.pitches.size());
  const std::int64_t turns = pitch / count - (pitch % count < 0 ? 1 : 0);
  const auto within = static_cast<std::size_t>(pitch - turns * count);
  const DeviationTable::Pitch& of_pitch = deviations.pitches[within];
  if (of_pitch.lines.empty())
  {
    return;
  }
  const double columns = part * of_pitch.columns;
  const int column = std::min(static_cast<int>(columns), of_pitch.columns - 1);
  const std::size_t line = deviation_index[within].below(of_pitch.lines, v);
  const std::size_t stride = static_cast<std::size_t>(of_pitch.columns) + 1;
  const double per_line = 1.0 / (of_pitch.lines[line + 1] - of_pitch.lines[line]);
  const SurfaceNode* below = &of_pitch.nodes[line * stride + static_cast<std::size_t>(column)];
  cells.deviation = { below,
                      below + stride,
                      columns - column,
                      (v - of_pitch.lines[line]) * per_line,
                      static_cast<double>(of_pitch.columns),
                      per_line };
  cells.lobes_swapped = deviations.swaps_lobes && turns % 2 != 0;
}

std::array<double, 2> ResponseSurface::Cells::lobeForces() const noexcept
{
  std::array<double, 2> forces{ cell.value(SurfaceNode::LOBE_FORCE), cell.value(SurfaceNode::LOBE_FORCE + 1) };
  if (!deviation.empty())
  {
    forces[lobes_swapped ? 1 : 0] += deviation.value(SurfaceNode::LOBE_FORCE);
    forces[lobes_swapped ? 0 : 1] += deviation.value(SurfaceNode::LOBE_FORCE + 1);
  }
  return forces;
}

std::array<double, 2> ResponseSurface::lobeForces(const Place& place) noexcept
{
  std::array<double, 2> forces = place.Cells::lobeForces();
  for (double& force : forces)
  {
    force *= place.weight;
  }
  for (std::size_t i = 0; i < place.other_count; ++i)
  {
    const std::array<double, 2> share = place.others[i].lobeForces();
    forces[0] += place.others[i].weight * share[0];
    forces[1] += place.others[i].weight * share[1];
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
  if (place.other_count > 0)
  {
    addOthers(place, energy, response);
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
  // The torque on the housing is minus the sum of the torques on wave generator and output:
  // (1 - 1/ratio) dU/dv + dU/du, with u here in rad.
  const double by_output = (1.0 - inverse_ratio_) * energy.by_vv + k_uv;
  housing_stiffness[0] = (1.0 - inverse_ratio_) * k_uv + k_uu - inverse_ratio_ * by_output;
  housing_stiffness[1] = by_output;
  return response;
}

/// Multiplies the values of the first share by its weight and adds the weighted values of the other shares.
void ResponseSurface::addOthers(const Place& place, SurfaceEnergy& energy, RingResponse& response) const noexcept
{
  energy *= place.weight;
  response.velocity_ratio *= place.weight;
  response.output_stiffness *= place.weight;
  for (std::size_t i = 0; i < place.other_count; ++i)
  {
    const Cells& cells = place.others[i];
    SurfaceEnergy share = cells.cell.energy();
    if (!cells.deviation.empty())
    {
      share += cells.deviation.energy();
    }
    share *= cells.weight;
    energy += share;
    response.velocity_ratio += cells.weight * cells.value(SurfaceNode::VELOCITY_RATIO);
    response.output_stiffness += cells.weight * cells.value(SurfaceNode::OUTPUT_STIFFNESS);
  }
}

/// Changes output stiffness and velocity ratio by the curvature of the energy `change`. The velocity ratio is minus the
/// stiffness between motor and output over the stiffness at the output.
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

HJT_VECTOR_CLONES void ResponseSurface::friction(const Place& place, RingFrictionResponse& friction) const noexcept
{
  using Value = SurfaceNode::Value;
  constexpr int GROUPS = RingFrictionResponse::FLANK_GROUPS;
  constexpr int COUNT = Value::LOBE_FORCE - Value::BILINEAR;  // reads more values than needed, to fill vectors
  constexpr int VISCOUS = Value::VISCOUS - Value::BILINEAR;
  constexpr int FLANKS = Value::FLANKS - Value::BILINEAR;
  Eigen::Array<float, COUNT, 1> x = place.cell.values<COUNT>();
  if (!place.deviation.empty())
  {
    x += place.deviation.values<COUNT>();
  }
  if (place.other_count > 0)
  {
    x *= static_cast<float>(place.weight);
    for (std::size_t i = 0; i < place.other_count; ++i)
    {
      const Cells& cells = place.others[i];
      const auto weight = static_cast<float>(cells.weight);
      x += weight * cells.cell.values<COUNT>();
      if (!cells.deviation.empty())
      {
        x += weight * cells.deviation.values<COUNT>();
      }
    }
  }
  friction.contact_force = x[Value::CONTACT_FORCE - Value::BILINEAR];
  friction.ring_torque = x[Value::RING_TORQUE - Value::BILINEAR];
  friction.viscous << x[VISCOUS], x[VISCOUS + 1], x[VISCOUS + 2];
#pragma omp simd
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
