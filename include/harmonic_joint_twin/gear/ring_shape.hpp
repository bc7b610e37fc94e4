// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

namespace hjt
{
/// Where the rigid parts stand: what the ring's shape is a function of.
struct DrivePosition
{
  double wave_generator_angle{};  ///< [rad]
  double output_angle{};          ///< circular spline [rad]
  double wave_amplitude{};        ///< w, grows from 0 to w0 during the insertion [m]
};

/// Deformed ring: the tooth points, what follows from them for every element, and the space each tooth is paired with.
struct RingShape
{
  explicit RingShape(int teeth)
    : points(2 * teeth), directions(2 * teeth), lengths(teeth), normals(2 * teeth), chords(teeth), space(teeth, 0)
  {
  }

  int teeth() const noexcept { return static_cast<int>(lengths.size()); }
  int next(int i) const noexcept { return i + 1 == teeth() ? 0 : i + 1; }
  int previous(int i) const noexcept { return i == 0 ? teeth() - 1 : i - 1; }

  /// Brings directions, lengths, normals and chords up to date with the points.
  void updateGeometry() noexcept;

  Eigen::VectorXd points;      ///< 2 N, tooth points on the inner rim [m]
  Eigen::VectorXd directions;  ///< 2 N, unit vectors from tooth i to i+1 [-]
  Eigen::VectorXd lengths;     ///< N, distance from tooth i to i+1 [m]
  Eigen::VectorXd normals;     ///< 2 N, outward unit normals of the chord from tooth i-1 to i+1 [-]
  Eigen::VectorXd chords;      ///< N, its length [m]
  std::vector<int> space;      ///< N, circular-spline space each tooth is paired with [-]
};
}  // namespace hjt
