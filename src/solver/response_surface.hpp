// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "model/ring_response.hpp"

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
    VELOCITY_RATIO,        // [-]
    OUTPUT_STIFFNESS,      // [N.m/rad]
    CONTACT_FORCE,         // [N]
    RING_TORQUE,           // of outer race and flexing rim at the motor [N.m]
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

/// Difference between a gear with unequal teeth and the ideal gear at the same angles, over one period of the pattern:
/// one table per tooth pitch. At the edge between two pitches both tables
/// are the same function of v, so that energy and torques are continuous.
struct DeviationTable
{
  struct Pitch
  {
    int columns{};                          ///< intervals of u, equal
    std::vector<double> lines;              ///< v of the lines, ascending [rad]; none: nothing departs
    std::vector<SurfaceTable::Node> nodes;  ///< (columns + 1) a line
  };
  std::vector<Pitch> pitches;  ///< none: there are no deviations
  bool swaps_lobes{};          ///< the gear is the same again with its lobes having changed places
};

/// Which of ascending values lies below a given one, in constant time.
class LineIndex
{
public:
  /// `lines`: none, or at least two.
  explicit LineIndex(const std::vector<double>& lines);

  /// `v` between the first and the last line. Never the last line itself.
  std::size_t below(const std::vector<double>& lines, double v) const noexcept
  {
    // Bins are narrower than the intervals between lines, so at most one line lies within a bin.
    const std::size_t line = line_[static_cast<std::size_t>((v - lines.front()) * bins_per_unit_)];
    return line + (line + 2 < lines.size() && v >= lines[line + 1] ? 1 : 0);
  }

private:
  double bins_per_unit_{};
  std::vector<std::uint32_t> line_;  // line below the lower edge of each bin
};

/// The part of a table between two columns and two lines.
struct SurfaceCell
{
  using Node = SurfaceTable::Node;

  const Node* below{};  ///< node at its lower u on the line below; the next in memory is at the higher u
  const Node* above{};
  double u{};       ///< of a place within the cell, 0 ... 1
  double v{};       ///< likewise
  double width{};   ///< in u [pitches]
  double height{};  ///< in v [rad]

  /// Energy and its derivatives by u [pitches] and v [rad]: bicubic after Hermite.
  struct Energy
  {
    double value, by_u, by_v, by_uu, by_uv, by_vv;
  };
  Energy energy() const noexcept;

  /// Bilinear, of any value but the energy's.
  double value(int which) const noexcept
  {
    const double low = (1.0 - u) * below[0][which] + u * below[1][which];
    const double high = (1.0 - u) * above[0][which] + u * above[1][which];
    return (1.0 - v) * low + v * high;
  }
};

/// The ring in equilibrium as a table over the two angles of the joint: for a gear of equal teeth, which is the same
/// again after one tooth pitch; with deviations, for one that is the same again after more.
///
/// The stored energy is one function, piecewise bicubic after Hermite, from its values, slopes and mixed derivative at
/// the nodes; both torques are its derivatives, so what goes in comes out again. What friction needs is bilinear.
class ResponseSurface
{
public:
  /// `table`: at least two lines. The lines of a pitch of `deviations` span those of the table.
  explicit ResponseSurface(SurfaceTable table, DeviationTable deviations = {});

  /// A place on the surface.
  struct Place
  {
    SurfaceCell cell;
    SurfaceCell deviation;  ///< without nodes where nothing departs
    bool lobes_swapped{};   ///< against how the deviations were measured
    double at{};            ///< v [rad]
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
  static double value(const Place& place, int which) noexcept
  {
    return place.cell.value(which) + (place.deviation.below != nullptr ? place.deviation.value(which) : 0.0);
  }

  /// Mesh force of both lobes [N].
  static std::array<double, 2> lobeForces(const Place& place) noexcept;

  const SurfaceTable& table() const noexcept { return table_; }
  const DeviationTable& deviations() const noexcept { return deviations_; }
  double lowest() const noexcept { return table_.lines.front(); }  ///< of v [rad]
  double highest() const noexcept { return table_.lines.back(); }  ///< [rad]

private:
  void locateDeviation(std::int64_t pitch, double part, Place& place) const noexcept;

  SurfaceTable table_;
  DeviationTable deviations_;
  double pitches_per_radian_;
  double inverse_ratio_;
  LineIndex line_index_;
  std::vector<double> inverse_height_;
  std::vector<LineIndex> deviation_index_;  // one a pitch
};
}  // namespace hjt
