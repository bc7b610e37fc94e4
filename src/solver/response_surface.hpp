// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "model/ring_model.hpp"
#include "solver/surface_tables.hpp"

namespace hjt
{
/// Values of the ring in equilibrium at a node of its table. The energy U and its derivatives have double precision.
/// All other values are interpolated bilinearly and have single precision, which halves the memory traffic of a step.
class SurfaceNode
{
public:
  /// Indices of a node's values.
  enum Value : std::uint8_t
  {
    ENERGY,                    // U [J]
    ENERGY_BY_U,               // dU/du, u in pitches [J]
    ENERGY_BY_V,               // dU/dv [J/rad]
    ENERGY_BY_UV,              // second derivative of U by u and v [J/rad]
    BILINEAR,                  // index of the first bilinear value
    CONTACT_FORCE = BILINEAR,  // sum of the wave generator's forces on all teeth [N]
    RING_TORQUE,               // friction torque of outer race and flexing rim at the motor [N.m]
    VISCOUS,                   // viscous matrix: motor-motor, motor-output, output-output [N.m.s/rad]
    FLANKS = VISCOUS + 3,      // torque (2 values [N.m]) and rms slip (2 values [m/rad]) of each group of flanks
    VELOCITY_RATIO = FLANKS + 4 * RingFrictionResponse::FLANK_GROUPS,  // output over motor speed at constant load [-]
    OUTPUT_STIFFNESS,                                                  // stiffness of the output, motor held [N.m/rad]
    TEETH_LOADED,                                                      // number of teeth that carry mesh force [-]
    LOBE_FORCE,                                                        // mesh force of each lobe [N]
    VALUES = LOBE_FORCE + 2
  };
  using Energies = std::array<double, BILINEAR>;
  using Bilinear = std::array<float, VALUES - BILINEAR>;

  SurfaceNode() = default;
  explicit SurfaceNode(const std::array<double, VALUES>& values) noexcept
  {
    for (int i = 0; i < VALUES; ++i)
    {
      set(i, values[static_cast<std::size_t>(i)]);
    }
  }

  double operator[](int which) const noexcept
  {
    return which < BILINEAR ? energies_[static_cast<std::size_t>(which)] :
                              static_cast<double>(bilinear_[static_cast<std::size_t>(which - BILINEAR)]);
  }
  void set(int which, double value) noexcept
  {
    if (which < BILINEAR)
    {
      energies_[static_cast<std::size_t>(which)] = value;
    }
    else
    {
      bilinear_[static_cast<std::size_t>(which - BILINEAR)] = static_cast<float>(value);
    }
  }

  const Energies& energies() const noexcept { return energies_; }
  const Bilinear& bilinear() const noexcept { return bilinear_; }

  friend bool operator==(const SurfaceNode& a, const SurfaceNode& b) noexcept
  {
    return a.energies_ == b.energies_ && a.bilinear_ == b.bilinear_;
  }

private:
  Energies energies_{};
  Bilinear bilinear_{};
};

using SurfaceNodes = SharedValues<SurfaceNode>;

/// Table of the ring in equilibrium over  u = wave generator angle within a tooth pitch  and  v = output angle - wave
/// generator angle / ratio. The table is plain data, which the cache stores and reads.
struct SurfaceTable
{
  double pitch{};             ///< tooth pitch of the flexspline [rad]
  double ratio{};             ///< nominal ratio [-]
  int columns{};              ///< number of equal intervals of u in a pitch
  std::vector<double> lines;  ///< v of the lines, ascending [rad]
  SurfaceNodes nodes;         ///< columns + 1 nodes for each line (for each v); the last equals the first
  ToothResponse teeth;        ///< table of the forces of the teeth over the same range, with lines of its own
  GridChecks checks{};
};

/// Values of a gear with unequal teeth minus those of the gear with equal teeth at the same angles. There is one table
/// for each tooth pitch of a period of the gear. At the edge between two pitches the two tables are the same function
/// of v, so that energy and torques are continuous.
struct DeviationTable
{
  struct Pitch
  {
    int columns{};              ///< number of equal intervals of u
    std::vector<double> lines;  ///< v of the lines, ascending [rad]; empty: no deviation
    SurfaceNodes nodes;         ///< columns + 1 nodes for each line
  };
  std::vector<Pitch> pitches;  ///< tables of the pitches; empty: no deviations
  bool swaps_lobes{};          ///< whether the lobes have exchanged their places at the end of a period
  int shift{};                 ///< number of teeth by which the gear is shifted against the table, >= 0
  GridChecks checks{};
};

/// Finds the line of a table (nodes of equal v) below a position v, in constant time.
class LineIndex
{
public:
  /// `lines`: no line, or at least two lines.
  explicit LineIndex(const std::vector<double>& lines);

  /// Index of the line at or below `v`, but never that of the last line. `v` must be within the first and last line.
  std::size_t below(const std::vector<double>& lines, double v) const noexcept
  {
    // A bin is narrower than any interval between lines, so that it contains at most one line.
    const std::size_t line = line_[static_cast<std::size_t>((v - lines.front()) * bins_per_unit_)];
    return line + (line + 2 < lines.size() && v >= lines[line + 1] ? 1 : 0);
  }

private:
  double bins_per_unit_{};
  std::vector<std::uint32_t> line_;  // index of the line below the lower edge of each bin
};

/// Cell of a table between two columns and two lines.
class SurfaceCell
{
public:
  SurfaceCell() = default;

  /// `below`: node at the lower u on the lower line, which the node at the higher u follows in memory. `above`: node at
  /// the lower u on the upper line. `u`, `v`: position within the cell, 0 ... 1. `per_width`: inverse of the cell's
  /// width in u [1/pitch]. `per_height`: inverse of the cell's height in v [1/rad].
  SurfaceCell(const SurfaceNode* below, const SurfaceNode* above, double u, double v, double per_width,
              double per_height) noexcept
    : below_(below), above_(above), u_(u), v_(v), per_width_(per_width), per_height_(per_height)
  {
  }

  bool empty() const noexcept { return below_ == nullptr; }

  /// Energy and its derivatives by bicubic Hermite interpolation.
  SurfaceEnergy energy() const noexcept;

  /// Value with the index `which` >= BILINEAR, by bilinear interpolation.
  double value(int which) const noexcept
  {
    const double low = (1.0 - u_) * below_[0][which] + u_ * below_[1][which];
    const double high = (1.0 - u_) * above_[0][which] + u_ * above_[1][which];
    return (1.0 - v_) * low + v_ * high;
  }

  /// First COUNT of the values that are interpolated bilinearly.
  template <int COUNT>
  inline __attribute__((always_inline)) Eigen::Array<float, COUNT, 1> values() const noexcept
  {
    using Values = Eigen::Array<float, COUNT, 1>;
    const auto at = [](const SurfaceNode& node) { return Eigen::Map<const Values>(node.bilinear().data()); };
    const auto u = static_cast<float>(u_);
    const auto v = static_cast<float>(v_);
    const float w11 = u * v;
    const float w10 = v - w11;
    const float w01 = u - w11;
    const float w00 = 1.0f - u - w10;
    return w00 * at(below_[0]) + w01 * at(below_[1]) + w10 * at(above_[0]) + w11 * at(above_[1]);
  }

private:
  const SurfaceNode* below_{};
  const SurfaceNode* above_{};
  double u_{};
  double v_{};
  double per_width_{};
  double per_height_{};
};

/// The ring in equilibrium as a table over the two angles of the joint. The table of a gear with equal teeth repeats
/// after one tooth pitch. A DeviationTable describes a gear with unequal teeth, which repeats after more pitches.
/// BallDrops describes a faulty bearing. Shares describe a gear whose parameters lie between those of other surfaces.
///
/// The stored energy is interpolated by a piecewise bicubic Hermite function from its values, slopes and mixed
/// derivative at the nodes. The torques on motor and output are derivatives of this function, so that energy is
/// conserved. The data of friction are interpolated bilinearly.
class ResponseSurface
{
public:
  /// `table`: at least two lines. `deviations`: the lines of each pitch span those of the table. `balls`: changes of
  /// the ring by dropping balls, if the bearing is faulty.
  explicit ResponseSurface(SurfaceTable table, DeviationTable deviations = {}, std::optional<BallDrops> balls = {});

  static constexpr std::size_t MAX_SHARES = 4;

  /// Share of one surface in a surface that is interpolated between several surfaces.
  struct Share
  {
    std::shared_ptr<const ResponseSurface> surface;  ///< surface without shares and balls
    double weight{};                                 ///< weight of this surface in the sum [-]
  };

  /// `shares`: one to MAX_SHARES surfaces of gears with equal numbers of teeth, with weights whose sum is 1. The range
  /// of the surface is the common part of their ranges.
  explicit ResponseSurface(std::vector<Share> shares);

  /// Position on the table and on its deviations.
  struct Cells
  {
    SurfaceCell cell;
    SurfaceCell deviation;  ///< cell of the deviations; empty: no deviation at this position
    bool lobes_swapped{};   ///< whether the lobes are exchanged compared with those of the solved deviations
    double weight{ 1.0 };   ///< weight of these values in the sum of the shares

    double value(int which) const noexcept
    {
      return cell.value(which) + (deviation.empty() ? 0.0 : deviation.value(which));
    }
    std::array<double, 2> lobeForces() const noexcept;  ///< mesh forces of both lobes [N]
  };

  struct Place : Cells
  {
    double at{};  ///< v at the place, see SurfaceTable [rad]
    BallDrops::Change balls;
    std::array<Cells, MAX_SHARES - 1> others;  ///< positions on all shares except the first
    std::size_t other_count{};
  };

  /// Finds the place of two angles [rad] in the table. @returns false and does nothing outside the table or for NaN.
  bool locate(double motor_angle, double output_angle, Place& place) const noexcept;

  /// Whether the distance of a position from an end of the range of v is less than `share` times the range.
  bool nearEdge(const Place& place, double share) const noexcept
  {
    return place.at < lowest() + share * (highest() - lowest()) ||
           place.at > highest() - share * (highest() - lowest());
  }

  /// Response at a place. `housing_stiffness`: derivatives of the torque on the housing by both angles [N.m/rad].
  RingResponse response(const Place& place, Eigen::Vector2d& housing_stiffness) const noexcept;
  RingResponse response(const Place& place) const noexcept
  {
    Eigen::Vector2d unused;
    return response(place, unused);
  }

  void friction(const Place& place, RingFrictionResponse& friction) const noexcept;

  /// Value with the index `which` >= SurfaceNode::BILINEAR, by bilinear interpolation.
  static double value(const Place& place, int which) noexcept
  {
    double sum = place.weight * place.Cells::value(which);
    for (std::size_t i = 0; i < place.other_count; ++i)
    {
      sum += place.others[i].weight * place.others[i].value(which);
    }
    return sum + (which == SurfaceNode::CONTACT_FORCE ? place.balls.contact_force : 0.0);
  }

  static SurfaceNode bilinear(const Place& place) noexcept
  {
    SurfaceNode node;
    for (int i = SurfaceNode::BILINEAR; i < SurfaceNode::VALUES; ++i)
    {
      node.set(i, value(place, i));
    }
    return node;
  }

  static std::array<double, 2> lobeForces(const Place& place) noexcept;

  /// Table of the surface or, with several shares, of the first share.
  const SurfaceTable& table() const noexcept { return tables_->table; }
  const DeviationTable& deviations() const noexcept { return tables_->deviations; }
  /// Whether the surface has a table of the forces of the teeth that is valid, because neither single teeth nor balls
  /// differ from those of the sound nominal gear.
  bool hasTeeth() const noexcept
  {
    return shares_.empty() && !balls_ && tables_->deviations.pitches.empty() && !tables_->table.teeth.lines.empty();
  }
  const std::optional<BallDrops>& balls() const noexcept { return balls_; }
  const std::vector<Share>& shares() const noexcept { return shares_; }  ///< empty: the surface has its own tables
  double lowest() const noexcept { return lowest_; }    ///< least v of the range, see SurfaceTable [rad]
  double highest() const noexcept { return highest_; }  ///< largest v of the range, see SurfaceTable [rad]

private:
  /// Tables with their indices, which several surfaces share and which do not change.
  struct Tables
  {
    Tables(SurfaceTable of_gear, DeviationTable of_teeth);
    void locate(double pitches, double v, Cells& cells) const noexcept;
    void locateDeviation(std::int64_t pitch, double part, double v, Cells& cells) const noexcept;

    SurfaceTable table;
    DeviationTable deviations;
    LineIndex line_index;
    std::vector<double> per_height;          // inverse of each interval between lines [1/rad]
    std::vector<LineIndex> deviation_index;  // one index for each pitch
  };

  void addOthers(const Place& place, SurfaceEnergy& energy, RingResponse& response) const noexcept;
  void stiffen(const SurfaceEnergy& change, RingResponse& response) const noexcept;

  std::shared_ptr<const Tables> tables_;
  std::optional<BallDrops> balls_;
  std::vector<Share> shares_;
  double pitches_per_radian_;
  double inverse_ratio_;
  double lowest_;
  double highest_;
};
}  // namespace hjt
