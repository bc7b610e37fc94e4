// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <Eigen/Core>

namespace hjt
{
/// One dry friction: a force against a slip. Power = strength * |slip . (motor speed, output speed)|.
struct FrictionTerm
{
  double strength;       ///< >= 0 [N] or [N.m]
  Eigen::Vector2d slip;  ///< slip speed by motor and output speed [m/rad] or [-]
};

/// Dry frictions in fixed room, quantity by quantity for loops that vectorise. Behind the last one zeros fill a PACK.
class FrictionTerms
{
public:
  static constexpr int PACK = 4;

  explicit FrictionTerms(int room) : values_(Values::Zero(packed(room), 3)) {}

  void clear() noexcept { size_ = 0; }
  void push_back(const FrictionTerm& term) noexcept
  {
    using One = Eigen::Array<double, 1, 1>;
    add(One(term.strength), One(term.slip[0]), One(term.slip[1]));
  }
  /// Several at once; one that nothing slips does nothing.
  template <class Numbers>
  void add(const Numbers& strength, const Numbers& by_motor, const Numbers& by_output) noexcept
  {
    constexpr int COUNT = Numbers::SizeAtCompileTime;
    for (int first = packed(size_); first < packed(size_ + COUNT); first += PACK)
    {
      values_.middleRows<PACK>(first).setZero();
    }
    values_.col(0).template segment<COUNT>(size_) = strength;
    values_.col(1).template segment<COUNT>(size_) = by_motor;
    values_.col(2).template segment<COUNT>(size_) = by_output;
    size_ += COUNT;
  }

  /// Of a term that is there [N] or [N.m].
  void setStrength(int i, double strength) noexcept { values_(i, 0) = strength; }

  int size() const noexcept { return size_; }
  int packedSize() const noexcept { return packed(size_); }  ///< with the zeros
  FrictionTerm operator[](int i) const noexcept { return { values_(i, 0), { values_(i, 1), values_(i, 2) } }; }
  const double* strength() const noexcept { return values_.col(0).data(); }
  const double* byMotor() const noexcept { return values_.col(1).data(); }
  const double* byOutput() const noexcept { return values_.col(2).data(); }

  /// For loops over the terms.
  struct Iterator
  {
    const FrictionTerms& terms;
    int at;
    FrictionTerm operator*() const noexcept { return terms[at]; }
    Iterator& operator++() noexcept
    {
      ++at;
      return *this;
    }
    bool operator!=(const Iterator& other) const noexcept { return at != other.at; }
  };
  Iterator begin() const noexcept { return { *this, 0 }; }
  Iterator end() const noexcept { return { *this, size_ }; }

private:
  using Values = Eigen::Array<double, Eigen::Dynamic, 3>;

  static constexpr int packed(int size) noexcept { return (size + PACK - 1) & -PACK; }

  Values values_;
  int size_{};
};

/// All friction of the joint, seen through its two coordinates: dry terms and a viscous matrix.
///
/// The ring follows the two angles in equilibrium, so every slip in it is a combination of the two speeds, and friction
/// acts on the angles by virtual power. Its feedback on the shape of the ring, of the order of the friction
/// coefficient, is left out.
struct JointFriction
{
  /// Room for one term a tooth, the motor shaft's, the cup's and the output's.
  explicit JointFriction(int teeth) : terms(teeth + 3), running(2 * teeth), flank_load(teeth) {}

  void setZero() noexcept
  {
    terms.clear();
    viscous.setZero();
  }

  /// Power that the dry terms take at these speeds of motor and output [W], or torque by unit speed.
  double dryPower(const Eigen::Vector2d& speeds) const noexcept
  {
    double power = 0.0;
    for (const FrictionTerm term : terms)
    {
      power += term.strength * std::abs(term.slip.dot(speeds));
    }
    return power;
  }

  FrictionTerms terms;
  double presliding{};  ///< dry friction at the motor shaft that is no term: it builds up over an angle [N.m]
  Eigen::Matrix2d viscous{ Eigen::Matrix2d::Zero() };  ///< torque by speed, positive semi-definite [N.m.s/rad]
  Eigen::VectorXd running;  ///< 2 N, rates of the ring's points by motor angle while the output follows [m/rad]
  // Of the full ring, for other speeds at the same ring: what the strengths of the first terms, of shaft and flanks,
  // are made of.
  double contact_force{};      ///< of the wave generator, summed [N]
  double ring_torque{};        ///< JointModel::ringTorque [N.m]
  int flanks{};                ///< terms of flanks, behind the shaft's
  Eigen::VectorXd flank_load;  ///< N, of these [N]
};
}  // namespace hjt
