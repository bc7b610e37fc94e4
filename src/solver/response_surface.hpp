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
/// Values of the ring in equilibrium at a node of its table. Energy and torques in double precision, which their
/// derivatives need; what is bilinear in single precision, which halves what a step reads.
class SurfaceNode
{
public:
  /// Values of a node, in this order.
  enum Value : std::uint8_t
  {
    ENERGY,                    // U [J]
    ENERGY_BY_U,               // dU/du, u in pitches [J]
    ENERGY_BY_V,               // dU/dv [J/rad]
    ENERGY_BY_UV,              // [J/rad]
    BILINEAR,                  // the first of these
    CONTACT_FORCE = BILINEAR,  // [N]
    RING_TORQUE,               // of outer race and flexing rim at the motor [N.m]
    VISCOUS,                   // motor-motor, motor-output, output-output [N.m.s/rad]
    FLANKS = VISCOUS + 3,      // slip (2) and rms slip (2) a group [N.m], [m/rad]
    VELOCITY_RATIO = FLANKS + 4 * RingFrictionResponse::FLANK_GROUPS,  // [-]
    OUTPUT_STIFFNESS,                                                  // [N.m/rad]
    TEETH_LOADED,                                                      // [-]
    LOBE_FORCE,                                                        // of both lobes [N]
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

/// Values of the ring in equilibrium over  u = wave generator angle within a tooth pitch  and  v = output angle - wave
/// generator angle / ratio. Plain data: what is built, cached and read.
struct SurfaceTable
{
  double pitch{};             ///< of the flexspline's teeth [rad]
  double ratio{};             ///< nominal: v stays the same when the drive has turned by a tooth pitch [-]
  int columns{};              ///< intervals of u over a pitch, equal
  std::vector<double> lines;  ///< v of the lines, ascending [rad]
  SurfaceNodes nodes;         ///< (columns + 1) a line; the last is the first again
  ToothResponse teeth;        ///< over the same range, on lines of its own
  GridChecks checks{};
};

/// Difference between a gear with unequal teeth and the ideal gear at the same angles, over one period of the pattern:
/// one table per tooth pitch. At the edge between two pitches both tables
/// are the same function of v, so that energy and torques are continuous.
struct DeviationTable
{
  struct Pitch
  {
    int columns{};              ///< intervals of u, equal
    std::vector<double> lines;  ///< v of the lines, ascending [rad]; empty: no deviation
    SurfaceNodes nodes;         ///< (columns + 1) a line
  };
  std::vector<Pitch> pitches;  ///< empty: no deviations
  bool swaps_lobes{};          ///< the gear is the same again with its lobes having changed places
  int shift{};                 ///< of the pattern against that of the table [teeth]; >= 0
  GridChecks checks{};
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
class SurfaceCell
{
public:
  /// Of no table.
  SurfaceCell() = default;

  /// `below`: node at its lower u on the line below; the next in memory is at the higher u. `above`: likewise.
  /// `u`, `v`: of a place within the cell, 0 ... 1. `per_width`, `per_height`: over its width in u [pitches] and its
  /// height in v [rad].
  SurfaceCell(const SurfaceNode* below, const SurfaceNode* above, double u, double v, double per_width,
              double per_height) noexcept
    : below_(below), above_(above), u_(u), v_(v), per_width_(per_width), per_height_(per_height)
  {
  }

  bool empty() const noexcept { return below_ == nullptr; }

  /// Bicubic after Hermite.
  SurfaceEnergy energy() const noexcept;

  /// Bilinear, of any value but the energy's.
  double value(int which) const noexcept
  {
    const double low = (1.0 - u_) * below_[0][which] + u_ * below_[1][which];
    const double high = (1.0 - u_) * above_[0][which] + u_ * above_[1][which];
    return (1.0 - v_) * low + v_ * high;
  }

  /// The first COUNT of them at once.
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

/// The ring in equilibrium as a table over the two angles of the joint: for a gear of equal teeth, which is the same
/// again after one tooth pitch; with deviations, for one that is the same again after more; with drops of balls, for
/// one whose bearing is faulty; as a sum of shares, for one between those of other surfaces.
///
/// The stored energy is one function, piecewise bicubic after Hermite, from its values, slopes and mixed derivative at
/// the nodes; both torques are its derivatives, so what goes in comes out again. What friction needs is bilinear.
class ResponseSurface
{
public:
  /// `table`: at least two lines. The lines of a pitch of `deviations` span those of the table. `balls`: of the same
  /// gear, if its bearing is faulty.
  explicit ResponseSurface(SurfaceTable table, DeviationTable deviations = {}, std::optional<BallDrops> balls = {});

  static constexpr std::size_t MAX_SHARES = 4;

  /// Of another surface in one that lies between several.
  struct Share
  {
    std::shared_ptr<const ResponseSurface> surface;  ///< without shares and balls
    double weight{};                                 ///< [-]
  };

  /// One to MAX_SHARES of them, of gears with the same teeth; their weights sum up to 1. It is where all of them are.
  explicit ResponseSurface(std::vector<Share> shares);

  /// On the table and its deviations.
  struct Cells
  {
    SurfaceCell cell;
    SurfaceCell deviation;  ///< empty: no deviation here
    bool lobes_swapped{};   ///< against how the deviations were measured
    double weight{ 1.0 };   ///< of the values here in those of the surface

    double value(int which) const noexcept
    {
      return cell.value(which) + (deviation.empty() ? 0.0 : deviation.value(which));
    }
    std::array<double, 2> lobeForces() const noexcept;  ///< mesh force of both lobes [N]
  };

  /// A place on the surface.
  struct Place : Cells
  {
    double at{};  ///< v [rad]
    BallDrops::Change balls;
    std::array<Cells, MAX_SHARES - 1> others;  ///< of the shares but the first
    std::size_t other_count{};
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
    double sum = place.weight * place.Cells::value(which);
    for (std::size_t i = 0; i < place.other_count; ++i)
    {
      sum += place.others[i].weight * place.others[i].value(which);
    }
    return sum + (which == SurfaceNode::CONTACT_FORCE ? place.balls.contact_force : 0.0);
  }

  /// All of these, without those of the energy.
  static SurfaceNode bilinear(const Place& place) noexcept
  {
    SurfaceNode node;
    for (int i = SurfaceNode::BILINEAR; i < SurfaceNode::VALUES; ++i)
    {
      node.set(i, value(place, i));
    }
    return node;
  }

  /// Mesh force of both lobes [N].
  static std::array<double, 2> lobeForces(const Place& place) noexcept;

  /// Of the first share, where there are several.
  const SurfaceTable& table() const noexcept { return tables_->table; }
  const DeviationTable& deviations() const noexcept { return tables_->deviations; }
  /// The table has forces of teeth, and no fault or error of single teeth or balls changes them.
  bool hasTeeth() const noexcept
  {
    return shares_.empty() && !balls_ && tables_->deviations.pitches.empty() && !tables_->table.teeth.lines.empty();
  }
  const std::optional<BallDrops>& balls() const noexcept { return balls_; }
  const std::vector<Share>& shares() const noexcept { return shares_; }  ///< none: the tables are its own
  double lowest() const noexcept { return lowest_; }                     ///< of v [rad]
  double highest() const noexcept { return highest_; }                   ///< [rad]

private:
  /// Tables and how to find places in them; never changed.
  struct Tables
  {
    Tables(SurfaceTable of_gear, DeviationTable of_teeth);
    void locate(double pitches, double v, Cells& cells) const noexcept;
    void locateDeviation(std::int64_t pitch, double part, double v, Cells& cells) const noexcept;

    SurfaceTable table;
    DeviationTable deviations;
    LineIndex line_index;
    std::vector<double> per_height;          // of the intervals between lines [1/rad]
    std::vector<LineIndex> deviation_index;  // one a pitch
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
