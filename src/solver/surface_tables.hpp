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
/// Values one after the other, which nobody changes any more: those of a vector, or what lies in a file in memory.
/// Copies share them.
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

/// How a table was tried against the ring, up to the torque limit, where its grid was not refined any further: half way
/// between columns, and half way between lines. A miss is the largest difference over its tolerance [-]. Plain data.
struct GridChecks
{
  int made{};      ///< checks
  int missed{};    ///< of these with a miss above 1: the grid is as fine there as it may be
  double worst{};  ///< largest miss

  void add(double miss) noexcept
  {
    ++made;
    missed += miss > 1.0 ? 1 : 0;
    worst = miss > worst ? miss : worst;
  }
};

/// Forces and places of all teeth of the ring in equilibrium, for a gear of equal teeth: over u and v, as SurfaceTable.
/// A pitch further on, each tooth is as the one before it was. Plain data: what is built, cached and read.
struct ToothResponse
{
  /// What is stored of each tooth, in the order of storage.
  enum Quantity : unsigned char
  {
    WAVE_GENERATOR_FORCE,  ///< [N]
    RIM_TENSION,           ///< to the next tooth [N]
    BENDING_FORCE,         ///< of the segment to the next tooth [N]
    MESH_FORCE,            ///< > 0 leading, < 0 trailing flank [N]
    X,                     ///< of the tooth point, with the wave generator within the first pitch [m]
    Y,                     ///< [m]
    QUANTITIES
  };

  int teeth{};                 ///< of the flexspline
  int stored{};                ///< of these; half, if half a turn changes nothing but the sign of the places
  int columns{};               ///< intervals of u over a pitch, equal
  double pitch{};              ///< [rad]
  double ratio{};              ///< nominal [-]
  std::vector<double> lines;   ///< v of the lines, ascending [rad]; empty: there is no table
  SharedValues<float> values;  ///< a quantity's stored teeth, a node's quantities, columns + 1 nodes a line
  GridChecks checks{};

  std::size_t nodeSize() const noexcept { return static_cast<std::size_t>(QUANTITIES) * static_cast<unsigned>(stored); }

  /// `out`: by quantity, as long as there are teeth. False, and nothing done, outside the table.
  bool at(double motor_angle, double output_angle, double* const* out) const noexcept;
};

/// By how much the ring in equilibrium changes where one ball of the wave generator's bearing drops by h, as a table
/// over
///
///   u    wave generator angle [tooth pitches], period 1
///   v    output angle - wave generator angle / ratio [rad]
///   chi  place of the ball less the wave generator's angle [rad]
///
/// Each value is a polynomial in x = h / deepest without a constant, its coefficients cubic B-splines of u, chi and
/// w = asinh(v / scale) on even grids.
struct BallTable
{
  enum Value
  {
    ENERGY,             // of x, x^2, x^3, x^4 [J]
    CONTACT_FORCE = 4,  // of x, x^2 [N]
    FLANKS = 6,         // of x, x^2: friction of the flanks as the drive runs, to that of the sound gear [-]
    VALUES = 8
  };
  using Coefficients = Eigen::Array<double, VALUES, 1>;

  double pitch{};    ///< of the flexspline's teeth [rad]
  double ratio{};    ///< nominal [-]
  double deepest{};  ///< drop up to which it holds [m]
  double turn{};     ///< period of chi [rad]
  double scale{};    ///< of v [rad]
  double lowest{};   ///< w of the first line [-]
  double step{};     ///< of w between lines [-]
  int lines{};       ///< intervals of w; there are lines + 3 coefficients
  int columns{};     ///< intervals of u over a pitch
  int places{};      ///< intervals of chi over a turn
  /// Coefficients of line i (-1 ... lines + 1), column j, place k have the index ((i + 1) columns + j) places + k.
  std::vector<Coefficients> coefficients;
};

/// A gear's table with the faults of its bearing.
class BallDrops
{
public:
  /// `bearing`: of a gear with the table; its balls drop no deeper than that says, and one at a time.
  BallDrops(std::shared_ptr<const BallTable> table, const RaceDeflection& bearing)
    : table_(std::move(table)), bearing_(bearing)
  {
  }

  const std::shared_ptr<const BallTable>& table() const noexcept { return table_; }

  /// Change of the gear by the ball that has dropped. The wave generator takes the balls along: derivatives by u are
  /// at the same v. The friction of the outer race, a hundredth of the flanks', is left as it is.
  struct Change
  {
    SurfaceEnergy energy;
    double contact_force{};  ///< [N]
    double flanks{};         ///< part of their friction [-]
  };
  /// `v` on the table.
  Change at(double motor_angle, double v) const noexcept;

private:
  Change ofBall(double motor_angle, double v, double place, const RaceDeflection::Drop& drop) const noexcept;

  std::shared_ptr<const BallTable> table_;
  RaceDeflection bearing_;
};
}  // namespace hjt
