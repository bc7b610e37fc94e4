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
/// Vectors of all tooth points have x of tooth i at the index 2i and y at 2i+1.
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
  double pitchAngle() const noexcept { return pitch_angle_; }         ///< tooth pitch [rad]
  double segmentLength() const noexcept { return segment_length_; }   ///< distance from tooth i to tooth i+1 [m]
  const Eigen::VectorXd& points() const noexcept { return points_; }  ///< tooth points at rest [m]
  /// unit vector from the centre to each tooth [-]
  const Eigen::VectorXd& radial() const noexcept { return radial_; }
  /// unit vector from each tooth i to tooth i+1 [-]
  const Eigen::VectorXd& segments() const noexcept { return segments_; }

private:
  double pitch_angle_;
  double segment_length_;
  Eigen::VectorXd points_;
  Eigen::VectorXd radial_;
  Eigen::VectorXd segments_;
};

/// Position of the drive: angles of wave generator and circular spline, and amplitude of the wave generator.
struct DrivePosition
{
  double wave_generator_angle{};  ///< angle of the wave generator [rad]
  double output_angle{};          ///< angle of the circular spline [rad]
  double wave_amplitude{};        ///< amplitude w, which grows from 0 to gear.wave_amplitude during the insertion [m]

  bool operator==(const DrivePosition& other) const noexcept
  {
    return wave_generator_angle == other.wave_generator_angle && output_angle == other.output_angle &&
           wave_amplitude == other.wave_amplitude;
  }
};

/// Chord from the preceding tooth to the next tooth. The outward normal of the chord is the direction of the tooth.
struct Chord
{
  Eigen::Vector2d normal;  ///< outward unit normal [-]
  double length;           ///< length of the chord [m]
};

template <class Values>
void repeatHalf(Values& values) noexcept
{
  const auto half = static_cast<std::ptrdiff_t>(values.size() / 2);
  std::copy(values.data(), values.data() + half, values.data() + half);
}

inline bool halvesAgree(const Eigen::VectorXd& values) noexcept
{
  const Eigen::Index half = values.size() / 2;
  return values.size() == 2 * half && values.head(half) == values.tail(half);
}

/// Copies x and y of the first half of the teeth to the second half, with opposite sign.
inline void repeatHalfTurned(Eigen::VectorXd& vectors) noexcept
{
  const Eigen::Index half = vectors.size() / 2;
  vectors.tail(half) = -vectors.head(half);
}

/// Deformed ring: tooth points, segments between them, and the space of the circular spline that each tooth faces.
///
/// If the model repeats after half a turn, `solved` is half the number of teeth, and all elements compute the first
/// half of the teeth only. The points of the other half have the opposite sign.
struct RingShape
{
  explicit RingShape(int teeth)
    : points(2 * teeth), directions(2 * teeth), lengths(teeth), space(teeth, 0), solved(teeth)
  {
  }

  int teeth() const noexcept { return static_cast<int>(lengths.size()); }
  int copies() const noexcept { return solved < teeth() ? 2 : 1; }  ///< 2 if half of the teeth are solved, else 1
  /// Copy of the shape in which all teeth count as solved.
  RingShape whole() const
  {
    RingShape shape = *this;
    shape.solved = teeth();
    return shape;
  }
  int next(int i) const noexcept { return i + 1 == teeth() ? 0 : i + 1; }
  int previous(int i) const noexcept { return i == 0 ? teeth() - 1 : i - 1; }

  /// Computes directions and lengths from the points of the solved teeth, and all values of the other teeth.
  void updateGeometry() noexcept;

  /// Computes the spaces of the teeth that are not solved. `spaces`: number of spaces of the circular spline.
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

  Eigen::VectorXd points;      ///< x and y of each tooth point, on the inner rim [m]
  Eigen::VectorXd directions;  ///< unit vector from each tooth i to tooth i+1 [-]
  Eigen::VectorXd lengths;     ///< distance from each tooth i to tooth i+1 [m]
  std::vector<int> space;      ///< number of the space of the circular spline that each tooth faces
  int solved;                  ///< number of solved teeth: all teeth or half of them
};
}  // namespace hjt
