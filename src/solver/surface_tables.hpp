// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "elements/race_deflection.hpp"

namespace hjt
{
/// Constant values, from a vector or from a file mapped into memory. Copies share the memory.
template <class T>
class SharedValues
{
public:
  SharedValues() = default;
  explicit SharedValues(std::vector<T> values)
  {
    const auto own = std::make_shared<const std::vector<T>>(std::move(values));
    *this = SharedValues(own, own->data(), own->size());
  }
  SharedValues(std::shared_ptr<const void> owner, const T* first, std::size_t size) noexcept
    : owner_(std::move(owner)), first_(first), size_(size)
  {
  }

  const T& operator[](std::size_t i) const noexcept { return first_[i]; }
  const T* begin() const noexcept { return first_; }
  const T* end() const noexcept { return first_ + size_; }
  const T* data() const noexcept { return first_; }
  std::size_t size() const noexcept { return size_; }
  bool empty() const noexcept { return size_ == 0; }

  friend bool operator==(const SharedValues& a, const SharedValues& b)
  {
    return std::equal(a.begin(), a.end(), b.begin(), b.end());
  }

private:
  std::shared_ptr<const void> owner_;
  const T* first_{};
  std::size_t size_{};
};

/// Stored energy of the ring in its table [J], with derivatives by u [pitches] and v [rad].
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

/// Comparisons of a table with the full ring up to the torque limit, halfway between columns, and halfway between lines
/// where the grid was not refined further. A miss is the largest difference over the tolerance [-].
struct GridChecks
{
  int made{};      ///< number of checks
  int missed{};    ///< number of checks with a miss above 1, which remain where the grid has its finest interval
  double worst{};  ///< largest miss

  void add(double miss) noexcept
  {
    ++made;
    missed += miss > 1.0 ? 1 : 0;
    worst = miss > worst ? miss : worst;
  }
};

/// Forces and positions of all teeth of the ring in equilibrium, for a gear with equal teeth, over u and v as in
/// SurfaceTable. One tooth pitch further, each tooth has the values of the preceding one. The table is plain data.
struct ToothResponse
{
  /// Quantities of each tooth, in the order of storage.
  enum Quantity : unsigned char
  {
    WAVE_GENERATOR_FORCE,  ///< force of the wave generator on the tooth [N]
    RIM_TENSION,           ///< tension to the next tooth [N]
    BENDING_FORCE,         ///< force of the segment to the next tooth [N]
    MESH_FORCE,            ///< force on the flank; > 0 leading flank, < 0 trailing flank [N]
    X,                     ///< x of the tooth point, with the wave generator within the first pitch [m]
    Y,                     ///< y of the tooth point [m]
    QUANTITIES
  };

  int teeth{};                ///< number of teeth of the flexspline
  int stored{};               ///< number of stored teeth: half of all if half a turn changes only signs of positions
  int columns{};              ///< number of equal intervals of u in a pitch
  double pitch{};             ///< tooth pitch of the flexspline [rad]
  double ratio{};             ///< nominal ratio [-]
  std::vector<double> lines;  ///< v of the lines (nodes of equal v), ascending [rad]; empty: there is no table
  /// for each line columns + 1 nodes, for each node all quantities, for each quantity the stored teeth
  SharedValues<float> values;
  GridChecks checks{};

  std::size_t nodeSize() const noexcept { return static_cast<std::size_t>(QUANTITIES) * static_cast<unsigned>(stored); }

  /// Interpolates the table. `out`: for each quantity an array of all teeth. @returns false and does nothing if the
  /// angles are outside the table.
  bool at(double motor_angle, double output_angle, double* const* out) const noexcept;
};

/// Table of the change of the ring in equilibrium by one ball of the wave generator's bearing that drops by h, over
///
///   u    wave generator angle [tooth pitches], period 1
///   v    output angle - wave generator angle / ratio [rad]
///   chi  angle of the ball minus the wave generator's angle [rad]
///
/// Each value is a polynomial in x = h / deepest without a constant term. Its coefficients are cubic B-splines of u,
/// chi and w = asinh(v / scale) on even grids.
struct BallTable
{
  enum Value
  {
    ENERGY,             // stored energy: coefficients of x, x^2, x^3, x^4 [J]
    CONTACT_FORCE = 4,  // sum of the wave generator's forces: coefficients of x, x^2 [N]
    FLANKS = 6,         // relative change of the flank friction in a running drive: coefficients of x, x^2 [-]
    VALUES = 8
  };
  using Coefficients = Eigen::Array<double, VALUES, 1>;

  double pitch{};    ///< tooth pitch of the flexspline [rad]
  double ratio{};    ///< nominal ratio [-]
  double deepest{};  ///< largest drop of the table [m]
  double turn{};     ///< period of chi [rad]
  double scale{};    ///< scale of v [rad]
  double lowest{};   ///< w of the first line [-]
  double step{};     ///< difference of w between lines [-]
  int lines{};       ///< number of intervals of w, with lines + 3 coefficients
  int columns{};     ///< number of intervals of u in a pitch
  int places{};      ///< number of intervals of chi in a turn
  /// Coefficients of line i (-1 ... lines + 1), column j and place k have the index ((i + 1) columns + j) places + k.
  std::vector<Coefficients> coefficients;
};

/// The BallTable of a gear with the faults of its bearing.
class BallDrops
{
public:
  /// `bearing`: bearing of the table's gear. One ball at a time drops, by at most BallTable::deepest.
  BallDrops(std::shared_ptr<const BallTable> table, const RaceDeflection& bearing)
    : table_(std::move(table)), bearing_(bearing)
  {
  }

  const std::shared_ptr<const BallTable>& table() const noexcept { return table_; }

  /// Change of the gear by the ball that has dropped. Derivatives by u are at constant v and include the motion of the
  /// balls with the wave generator. The change of the outer race's friction, 1 % of that of the flanks, is neglected.
  struct Change
  {
    SurfaceEnergy energy;
    double contact_force{};  ///< change of the sum of the wave generator's forces on all teeth [N]
    double flanks{};         ///< relative change of the flank friction [-]
  };
  /// `v` must be in the range of the table.
  Change at(double motor_angle, double v) const noexcept;

private:
  Change ofBall(double motor_angle, double v, double place, const RaceDeflection::Drop& drop) const noexcept;

  std::shared_ptr<const BallTable> table_;
  RaceDeflection bearing_;
};
}  // namespace hjt
