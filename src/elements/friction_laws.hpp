// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

#include <Eigen/Core>

#include "gear/angle.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"

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

/// Share of a dry friction from which on what it holds is taken to slide [-].
constexpr double SLIDING_SHARE = 0.95;

/// Share of a dry friction that is mobilised, between -1 and 1, after a further turn (Dahl, exact):
///
///   ds/dx = (1 - s sgn(dx)) / angle
/// `turn` dx and `angle` in rad, angle > 0.
inline double mobilised(double share, double turn, double angle) noexcept
{
  const double end = std::copysign(1.0, turn);
  return end + (share - end) * std::exp(-std::abs(turn) / angle);
}

/// Friction of the wave generator's ball bearing after Palmgren (thesis eq. 7.31-7.33; both parts oppose the speed).
///
///   T0 = f0 (nu n)^(2/3) d_m^3 1e-7   for nu n >= 2000,   f0 160 d_m^3 1e-7  below   [N.mm]
///   T1 = f1 (F + F_race) d_m                                                         [N.mm]
/// where nu  viscosity that the friction by speed acts with [mm^2/s]: nu^(2/3) = nu(T_0)^(2/3) (c + (1 - c) r^(2/3)),
///           c the share that no temperature changes, of what is no grease, and r = nu_oil(T) / nu_oil(T_0);
///           the oil's after Walther (ASTM D341), T in kelvin:
///           lg lg(nu_oil + 0.7) = lg lg(nu_oil(T_0) + 0.7) - m lg(T / T_0)
///       n   in rpm, d_m in mm
///       F   sum of the contact forces between wave generator and flexspline [N]
///       F_race  ball forces of the bearing's own outer race, bent to the ellipse [N]
class BearingFriction
{
public:
  explicit BearingFriction(const BearingParameters& parameters)
    : parameters_(parameters), preload_(parameters.race_preload)
  {
  }

  /// Grease of another viscosity, by this factor at any temperature [-].
  void scaleViscosity(double factor) noexcept { viscosity_factor_ *= factor; }
  /// Reduces the preload of the race by `loss`, not below min(`least`, present preload) [N].
  void reducePreload(double loss, double least) noexcept
  {
    preload_ = std::max(preload_ - loss, std::min(least, preload_));
  }

  /// Size of the friction torque, >= 0 [N.m], at motor speed [rad/s], load [N] and temperature [degC].
  double torque(double speed, double load, double temperature) const noexcept
  {
    return torqueAtViscosity(speed, load, viscosity(temperature));
  }

  /// The same where the viscosity [m^2/s] is known: it is the costly part, and the temperature hardly changes.
  double torqueAtViscosity(double speed, double load, double viscosity) const noexcept
  {
    constexpr double LOW_SPEED = 2000.0;  // mm^2/s rpm
    const double product = 1e6 * viscosity * std::abs(speed) * 60.0 / TWO_PI;
    const double diameter = 1e3 * parameters_.pitch_diameter;
    const double rolling = product < LOW_SPEED ? 160.0 : twoThirdsPower(product);
    const double speed_part = parameters_.lubricant_factor * rolling * diameter * diameter * diameter * 1e-7;
    const double load_part = parameters_.load_factor * (load + preload_) * diameter;
    return 1e-3 * (speed_part + load_part);
  }

  /// Kinematic viscosity that the friction by speed acts with [m^2/s] at a temperature [degC].
  double viscosity(double temperature) const noexcept
  {
    constexpr double ZERO_CELSIUS = 273.15;  // K
    constexpr double OFFSET = 0.7;           // mm^2/s; DIN 51563 has 0.8
    const double known = std::log10(1e6 * parameters_.oil_viscosity + OFFSET);
    const double ratio = (temperature + ZERO_CELSIUS) / (parameters_.viscosity_temperature + ZERO_CELSIUS);
    const double oil = 1e-6 * (std::pow(10.0, known * std::pow(ratio, -parameters_.viscosity_slope)) - OFFSET);
    const double grease = viscosity_factor_ * parameters_.viscosity / parameters_.oil_viscosity * oil;
    const double constant = parameters_.constant_share;
    if (constant == 0.0)
    {
      return grease;
    }
    const double root = std::cbrt(grease / parameters_.viscosity);
    const double friction = constant + (1.0 - constant) * root * root;  // over that of the sound grease at T_0
    return parameters_.viscosity * friction * std::sqrt(friction);
  }

  /// x^(2/3), x > 0 and finite, within 1e-14 of it: x times its reciprocal cube root, which begins with a third of the
  /// exponent, 4 % off, and by the series of (1 - e)^(-1/3) comes to 2e-6 and to rounding.
  static double twoThirdsPower(double x) noexcept
  {
    constexpr std::uint64_t ONE = 0x553ef0ff289dd796;  // offset with which a third of the bits of 1 are those of 1
    std::uint64_t bits{};
    std::memcpy(&bits, &x, sizeof(bits));
    bits = ONE - bits / 3;
    double root{};
    std::memcpy(&root, &bits, sizeof(root));
    for (int i = 0; i < 2; ++i)
    {
      const double e = 1.0 - x * root * root * root;
      root += root * e * (1.0 / 3.0 + e * (2.0 / 9.0 + e * (14.0 / 81.0 + e * (35.0 / 243.0))));
    }
    return x * root;
  }

private:
  BearingParameters parameters_;
  double preload_;  // [N]
  double viscosity_factor_{ 1.0 };
};

/// Dry friction beside the cup's spring: microscopic slip where the cup is clamped to the housing, and in its steel. It
/// acts on the mean rotation Phi of the rim, so it costs nothing while the drive runs at constant load; it opens the
/// torsion loop and damps the output when the motor stands.
///
/// cup.friction_angle 0: one rigid-plastic element, a dry term of cup.friction_torque F.
/// Above: ELEMENTS springs side by side, each with a slider in series (Maxwell slip, Masing's model)
///
///   torque   sum_j k z_j,   z_j' = Phi' while |z_j| < w_j or Phi' leads back, else 0
///   stored   sum_j k z_j^2 / 2;   dissipated where an element slips: k w_j per rad
/// where      w_j = (a / 2) 3^-j, j = 0 ... 5; a the friction angle [rad]; k = F / sum_j w_j [N.m/rad]
///
/// Equal springs over widths that treble lose about the same share of the stored energy at amplitudes from w_5 to w_0,
/// a range of 1 to 243, as structural damping does. Rate-independent. After a reversal all of it has turned round when
/// the rim has turned by a.
class CupFriction
{
public:
  static constexpr int ELEMENTS = 6;

  explicit CupFriction(const CupParameters& parameters)
    : torque_(parameters.friction_torque), width_(0.5 * parameters.friction_angle)
  {
    scale(1.0);
  }

  void scale(double factor) noexcept
  {
    torque_ *= factor;
    double widths = 0.0;
    for (int j = 0; j < ELEMENTS; ++j)
    {
      widths = widths / RATIO + width_;
    }
    stiffness_ = hasState() ? ELEMENTS * torque_ / widths : 0.0;
  }

  /// Springs with sliders, which have a state; else one dry term.
  bool hasState() const noexcept { return torque_ > 0.0 && width_ > 0.0; }

  /// State of springs and sliders, and the torque that follows from it at `rotation`.
  struct State
  {
    std::array<double, ELEMENTS> twist{};  ///< z [rad]
    double rotation{};                     ///< Phi [rad]
    double torque{};                       ///< against positive rotation [N.m]
    double stiffness{};                    ///< of the elements that do not slip [N.m/rad]
    double energy{};                       ///< stored [J]
    double slipped{};                      ///< energy dissipated on the way to `rotation` from the state before [J]
  };

  /// The state without torque at a rotation [rad].
  State relaxed(double rotation) const noexcept
  {
    State state;
    state.rotation = rotation;
    state.stiffness = stiffness();
    return state;
  }

  /// After a monotone turn to `rotation` [rad]. `from`: its twist and rotation count.
  inline __attribute__((always_inline)) State turned(const State& from, double rotation) const noexcept
  {
    using Elements = Eigen::Array<double, ELEMENTS, 1>;
    const double spring = stiffness() / ELEMENTS;
    const Elements width = width_ * Eigen::Map<const Elements>(SHARES.data());
    const Elements free = Eigen::Map<const Elements>(from.twist.data()) + (rotation - from.rotation);
    const Elements twist = free.min(width).max(-width);
    State state;
    state.rotation = rotation;
    Eigen::Map<Elements>(state.twist.data()) = twist;
    state.torque = spring * twist.sum();
    state.energy = 0.5 * spring * twist.square().sum();
    state.slipped = spring * (width * (free - twist).abs()).sum();
    state.stiffness = spring * static_cast<double>((free == twist).count());
    return state;
  }

  /// Of all elements together, before any slips: the largest [N.m/rad].
  double stiffness() const noexcept { return stiffness_; }

  /// The rigid-plastic element's term, by the mean rotation's rates by motor and output angle [-]; none where there is
  /// no friction or it has a state.
  void addTerm(const Eigen::Vector2d& rates, JointFriction& friction) const noexcept
  {
    if (isTerm())
    {
      friction.terms.push_back({ torque_, rates });
    }
  }
  bool isTerm() const noexcept { return torque_ > 0.0 && !hasState(); }

private:
  static constexpr double RATIO = 3.0;  // width of an element over that of the next
  // Of an element's width to the widest.
  static constexpr std::array<double, ELEMENTS> SHARES{
    1.0, 1.0 / 3.0, 1.0 / 9.0, 1.0 / 27.0, 1.0 / 81.0, 1.0 / 243.0
  };

  double torque_;  // sum of what the elements slip at [N.m]
  double width_;   // of the widest element [rad]
  double stiffness_{};
};
}  // namespace hjt
