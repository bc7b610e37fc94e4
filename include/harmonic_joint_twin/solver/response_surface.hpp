// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "harmonic_joint_twin/model/ring_response.hpp"

namespace hjt
{
/// Values of the ring in equilibrium over  u = wave generator angle within a tooth pitch  and  v = output angle - wave
/// generator angle / ratio. Plain data: what is built, cached and read.
struct SurfaceTable
{
  /// What is kept at every node, in this order.
  enum Value : std::uint8_t
  {
    ENERGY,                // U [J]
    ENERGY_BY_U,           // dU/du, u in pitches [J]
    ENERGY_BY_V,           // dU/dv [J/rad]
    ENERGY_BY_UV,          // [J/rad]
    FOLLOW,                // [-]
    OUTPUT_STIFFNESS,      // [N.m/rad]
    CONTACT_FORCE,         // [N]
    INTERFACE_TORQUE,      // [N.m]
    VISCOUS,               // motor-motor, motor-output, output-output [N.m.s/rad]
    FLANKS = VISCOUS + 3,  // slip (2) and rms slip (2) a group [N.m], [m/rad]
    TEETH_LOADED = FLANKS + 4 * RingFrictionResponse::FLANK_GROUPS,  // [-]
    LOBE_FORCE,                                                      // of both lobes [N]
    VALUES = LOBE_FORCE + 2
  };
  using Node = std::array<double, VALUES>;

  double pitch{};             ///< of the flexspline's teeth [rad]
  double ratio{};             ///< nominal: v stays the same when the drive has turned by a tooth pitch [-]
  int columns{};              ///< intervals of u over a pitch, equal
  std::vector<double> lines;  ///< v of the lines, ascending [rad]
  std::vector<Node> nodes;    ///< (columns + 1) a line; the last is the first again
};

/// The ring in equilibrium as a table over the two angles of the joint: for a gear of equal teeth, which is the same again
/// after one tooth pitch.
///
/// The stored energy is one function, piecewise bicubic after Hermite, from its values, slopes and mixed derivative at
/// the nodes; both torques are its derivatives, so what goes in comes out again. What friction needs is bilinear.
class ResponseSurface
{
public:
  /// `table`: at least two lines.
  explicit ResponseSurface(SurfaceTable table);

  /// A place on the surface.
  struct Place
  {
    const SurfaceTable::Node* below;  ///< node at its lower u on the line below; the next in memory is at the higher u
    const SurfaceTable::Node* above;
    double u;       ///< within the interval, 0 ... 1
    double v;       ///< likewise
    double height;  ///< of the interval in v [rad]
    double at;      ///< v [rad]
  };

  /// False, and nothing done, outside the table or at angles that are no numbers.
  bool locate(double motor_angle, double output_angle, Place& place) const noexcept;

  /// Whether a place lies within a share of the range from its ends.
  bool nearEdge(const Place& place, double share) const noexcept
  {
    return place.at < lowest() + share * (highest() - lowest()) ||
           place.at > highest() - share * (highest() - lowest());
  }

  /// `housing_stiffness`: derivatives of the torque between ring and housing by motor and output angle [N.m/rad].
  RingResponse response(const Place& place, Eigen::Vector2d& housing_stiffness) const noexcept;
  RingResponse response(const Place& place) const noexcept
  {
    Eigen::Vector2d unused;
    return response(place, unused);
  }

  void friction(const Place& place, RingFrictionResponse& friction) const noexcept;

  /// Bilinear, of any value but the energy's.
  static double value(const Place& place, int value) noexcept
  {
    const double below = (1.0 - place.u) * place.below[0][value] + place.u * place.below[1][value];
    const double above = (1.0 - place.u) * place.above[0][value] + place.u * place.above[1][value];
    return (1.0 - place.v) * below + place.v * above;
  }

  const SurfaceTable& table() const noexcept { return table_; }
  double lowest() const noexcept { return table_.lines.front(); }  ///< of v [rad]
  double highest() const noexcept { return table_.lines.back(); }  ///< [rad]

private:
  SurfaceTable table_;
  double pitches_per_radian_;
  double inverse_ratio_;
  double bins_per_radian_;           // bins of equal width over v, narrower than any interval between lines
  std::vector<std::uint32_t> line_;  // line below the lower edge of each bin
  std::vector<double> inverse_height_;
};
}  // namespace hjt
