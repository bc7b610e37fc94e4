// SPDX-License-Identifier: BSD-3-Clause
#include "solver/tooth_response.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace hjt
{
namespace
{
/// Four nodes around a place, and what each counts there [-].
struct Corners
{
  std::array<const float*, 4> node;
  std::array<float, 4> weight;
};

/// Blends `count` stored teeth from `first` on.
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

  // Stored tooth i is tooth i + turned now; of its copy half a turn on the places have the opposite sign.
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
      const std::size_t from = turned < count ? 0 : count;  // of those from the edge on
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
}  // namespace hjt
