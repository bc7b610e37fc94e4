// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace hjt
{
/// Stored energy of the ring on its table [J], and its derivatives by u [pitches] and v [rad].
struct SurfaceEnergy
{
  double value{}, by_u{}, by_v{}, by_uu{}, by_uv{}, by_vv{};

  SurfaceEnergy& operator+=(const SurfaceEnergy& other) noexcept
  {
    value += other.value;
    by_u += other.by_u;
    by_v += other.by_v;
    by_uu += other.by_uu;
    by_uv += other.by_uv;
    by_vv += other.by_vv;
    return *this;
  }
  SurfaceEnergy& operator*=(double factor) noexcept
  {
    value *= factor;
    by_u *= factor;
    by_v *= factor;
    by_uu *= factor;
    by_uv *= factor;
    by_vv *= factor;
    return *this;
  }
};
}  // namespace hjt
