// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "gear/angle.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Tooth points of the flexspline on its inner rim at rest: a regular polygon of radius r0 with tooth 0 on the x axis.
/// All vectors of the ring are interleaved: x of tooth i at index 2i, y at 2i+1.
class ToothRing
{
public:
  explicit ToothRing(const GearParameters& gear)
    : pitch_angle_(TWO_PI / gear.teeth_flexspline)
    , segment_length_(2.0 * gear.flexspline_inner_radius * std::sin(0.5 * pitch_angle_))
    , points_(2 * gear.teeth_flexspline)
    , radial_(2 * gear.teeth_flexspline)
    , segments_(2 * gear.teeth_flexspline)
  {
    for (int i = 0; i < gear.teeth_flexspline; ++i)
    {
      const double angle = i * pitch_angle_;
      const double middle = angle + 0.5 * pitch_angle_;
      radial_.segment<2>(2 * i) << std::cos(angle), std::sin(angle);
      segments_.segment<2>(2 * i) << -std::sin(middle), std::cos(middle);
    }
    points_ = gear.flexspline_inner_radius * radial_;
  }

  int teeth() const noexcept { return static_cast<int>(points_.size()) / 2; }
  double pitchAngle() const noexcept { return pitch_angle_; }         ///< angle between neighbouring teeth [rad]
  double segmentLength() const noexcept { return segment_length_; }   ///< distance from tooth i to tooth i+1 [m]
  const Eigen::VectorXd& points() const noexcept { return points_; }  ///< 2 N, tooth points [m]
  /// 2 N, unit vectors from the centre to each tooth [-]
  const Eigen::VectorXd& radial() const noexcept { return radial_; }
  /// 2 N, unit vectors from tooth i to tooth i+1 [-]
  const Eigen::VectorXd& segments() const noexcept { return segments_; }

private:
  double pitch_angle_;
  double segment_length_;
  Eigen::VectorXd points_;
  Eigen::VectorXd radial_;
  Eigen::VectorXd segments_;
};

/// Arguments of the ring's shape: angles of wave generator and circular spline, and amplitude of the wave.
struct DrivePosition
{
  double wave_generator_angle{};  ///< angle of the wave generator [rad]
  double output_angle{};          ///< angle of the circular spline [rad]
  double wave_amplitude{};        ///< amplitude w, which grows from 0 to w0 during the insertion [m]

  bool operator==(const DrivePosition& other) const noexcept
  {
    return wave_generator_angle == other.wave_generator_angle && output_angle == other.output_angle &&
           wave_amplitude == other.wave_amplitude;
  }
};

/// Chord from the preceding to the next tooth. Its outward unit normal is the direction of the tooth.
struct Chord
{
  Eigen::Vector2d normal;  ///< outward unit normal [-]
  double length;           ///< [m]
};

/// Copies the values of the first half of the teeth to the second.
template <class Values>
void repeatHalf(Values& values) noexcept
{
  const auto half = static_cast<std::ptrdiff_t>(values.size() / 2);
  std::copy(values.data(), values.data() + half, values.data() + half);
}

/// Whether both halves of the values are equal.
inline bool halvesAgree(const Eigen::VectorXd& values) noexcept
{
  const Eigen::Index half = values.size() / 2;
  return values.size() == 2 * half && values.head(half) == values.tail(half);
}

/// Copies the first half of planar vectors (x and y of each tooth) to the second half, with opposite sign.
inline void repeatHalfTurned(Eigen::VectorXd& vectors) noexcept
{
  const Eigen::Index half = vectors.size() / 2;
  vectors.tail(half) = -vectors.head(half);
}

/// Deformed ring: the tooth points, the segments between them, and the space of the circular spline that each tooth
/// faces.
///
/// If the drive has the same state after half a turn, so has the ring. Then `solved` is N/2, and all elements compute
/// the first half of the teeth only. The points of the other half have the opposite sign.
struct RingShape
{
  explicit RingShape(int teeth)
    : points(2 * teeth), directions(2 * teeth), lengths(teeth), space(teeth, 0), solved(teeth)
  {
  }

  int teeth() const noexcept { return static_cast<int>(lengths.size()); }
  int copies() const noexcept { return solved < teeth() ? 2 : 1; }  ///< copies of the solved teeth in the ring
  /// The ring with all of its teeth solved.
  RingShape whole() const
  {
    RingShape shape = *this;
    shape.solved = teeth();
    return shape;
  }
  int next(int i) const noexcept { return i + 1 == teeth() ? 0 : i + 1; }
  int previous(int i) const noexcept { return i == 0 ? teeth() - 1 : i - 1; }

  /// Computes directions and lengths from the points of the solved teeth, and the other half by symmetry.
  void updateGeometry() noexcept;

  /// Computes the spaces of the other half from those of the solved teeth; `spaces`: number of the circular spline's
  /// spaces.
  void repeatSpaces(int spaces) noexcept;

  Chord chord(int i) const noexcept
  {
    const int j = next(i);
    const int h = previous(i);
    const double dx = points[2 * j] - points[2 * h];
    const double dy = points[2 * j + 1] - points[2 * h + 1];
    const double length = std::sqrt(dx * dx + dy * dy);
    const double inverse = 1.0 / length;
    return { { dy * inverse, -dx * inverse }, length };
  }

  Eigen::VectorXd points;      ///< 2 N, tooth points on the inner rim [m]
  Eigen::VectorXd directions;  ///< 2 N, unit vectors from tooth i to i+1 [-]
  Eigen::VectorXd lengths;     ///< N, distance from tooth i to i+1 [m]
  std::vector<int> space;      ///< N, space of the circular spline that each tooth faces [-]
  int solved;                  ///< number of solved teeth, N or N/2 [-]
};
}  // namespace hjt
