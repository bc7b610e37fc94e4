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
/// Dry friction that opposes a slip. Its power is strength * |slip . (motor speed, output speed)| [W].
struct FrictionTerm
{
  double strength;       ///< force or torque of the friction, >= 0 [N] or [N.m]
  Eigen::Vector2d slip;  ///< slip speed per motor and output speed [m/rad] or [-]
};

/// Dry frictions in storage of fixed size, one array for each quantity. Zeros fill the last pack of PACK terms.
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
  /// Adds several terms. A term without slip has no effect.
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

  /// Sets the strength of an existing term [N] or [N.m].
  void setStrength(int i, double strength) noexcept { values_(i, 0) = strength; }

  int size() const noexcept { return size_; }
  int packedSize() const noexcept { return packed(size_); }  ///< size() rounded up to a multiple of PACK
  FrictionTerm operator[](int i) const noexcept { return { values_(i, 0), { values_(i, 1), values_(i, 2) } }; }
  const double* strength() const noexcept { return values_.col(0).data(); }
  const double* byMotor() const noexcept { return values_.col(1).data(); }
  const double* byOutput() const noexcept { return values_.col(2).data(); }

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

/// Friction of the joint with respect to motor and output angle, as dry terms and a viscous matrix.
///
/// The ring is in equilibrium at these two angles, so each slip in the ring is a linear combination of the speeds of
/// motor and output. The principle of virtual power gives the torques of friction on motor and output. The effect of
/// friction on the shape of the ring, of the order of the friction coefficient, is neglected.
struct JointFriction
{
  /// Allocates the terms: one for each tooth, and three for motor shaft, cup and output.
  explicit JointFriction(int teeth) : terms(teeth + 3), running(2 * teeth), flank_load(teeth) {}

  void setZero() noexcept
  {
    terms.clear();
    viscous.setZero();
  }

  /// Power that the dry terms dissipate at the `speeds` of motor and output [rad/s] [W].
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
  double presliding{};  ///< dry friction at the motor shaft that builds up over an angle; not in `terms` [N.m]
  Eigen::Matrix2d viscous{ Eigen::Matrix2d::Zero() };  ///< torques per speeds, positive semi-definite [N.m.s/rad]
  /// derivatives of x and y of each tooth point by the motor angle, at constant load [m/rad]
  Eigen::VectorXd running;
  // The strengths of the terms of shaft and flanks follow from these data of the full ring, for any speeds.
  double contact_force{};      ///< sum of the wave generator's forces on all teeth [N]
  double ring_torque{};        ///< torque of JointModel::ringTorque [N.m]
  int flanks{};                ///< number of terms of flanks, which follow the term of the shaft
  Eigen::VectorXd flank_load;  ///< normal force of each term of a flank [N]
};

/// A dry friction with more than this share of its full torque counts as sliding [-].
constexpr double SLIDING_SHARE = 0.95;

/// Share s of its full torque that a dry friction has after a further turn, -1 ... 1 [-], exactly by Dahl's model:
///
///   ds/dx = (1 - s sgn(dx)) / angle
/// `share`: s before the turn; `turn`: further turn dx [rad]; `angle`: turn over which friction builds up, > 0 [rad].
inline double mobilised(double share, double turn, double angle) noexcept
{
  const double end = std::copysign(1.0, turn);
  return end + (share - end) * std::exp(-std::abs(turn) / angle);
}

/// Friction of the wave generator's ball bearing by Palmgren (thesis eq. 7.31-7.33), the sum of the torques T0 and T1:
///
///   T0 = f0 (nu n)^(2/3) d_m^3 1e-7   for nu n >= 2000,   f0 160 d_m^3 1e-7  below   [N.mm]
///   T1 = f1 (F + F_race) d_m                                                         [N.mm]
/// where f0  bearing.lubricant_factor, f1 bearing.load_factor [-]
///       d_m bearing.pitch_diameter, here in mm
///       n   motor speed [rpm]
///       F   sum of the contact forces between wave generator and flexspline [N]
///       F_race  bearing.race_preload: forces of the outer race on the balls, because it is bent to the ellipse [N]
///       nu  effective viscosity of the speed-dependent friction [mm^2/s]
///
/// The viscosity nu depends on the temperature T [K] of the oil in the grease:
///
///   nu^(2/3) = nu(T_0)^(2/3) (c + (1 - c) r^(2/3)),   r = nu_oil(T) / nu_oil(T_0)
/// where T_0 is bearing.viscosity_temperature and c is bearing.constant_share, which does not depend on the
/// temperature. Walther's law (ASTM D341) gives the viscosity nu_oil of the oil, with m = bearing.viscosity_slope:
///
///   lg lg(nu_oil + 0.7) = lg lg(nu_oil(T_0) + 0.7) - m lg(T / T_0)
class BearingFriction
{
public:
  explicit BearingFriction(const BearingParameters& parameters)
    : parameters_(parameters), preload_(parameters.race_preload)
  {
  }

  /// Multiplies the viscosity of the grease at all temperatures by `factor` [-].
  void scaleViscosity(double factor) noexcept { viscosity_factor_ *= factor; }
  /// Reduces the preload of the race by `loss` [N], at most down to `least` [N]. A preload below `least` stays.
  void reducePreload(double loss, double least) noexcept
  {
    preload_ = std::max(preload_ - loss, std::min(least, preload_));
  }

  /// Magnitude of the friction torque, >= 0 [N.m]. `speed`: motor speed [rad/s]; `load`: F [N]; `temperature`: [degC].
  double torque(double speed, double load, double temperature) const noexcept
  {
    return torqueAtViscosity(speed, load, viscosity(temperature));
  }

  /// Magnitude of the friction torque for a known viscosity [m^2/s]. The computation of the viscosity is expensive, so
  /// a caller can keep the viscosity while the temperature hardly changes.
  double torqueAtViscosity(double speed, double load, double viscosity) const noexcept
  {
    constexpr double LOW_SPEED = 2000.0;  // nu n above which T0 depends on the speed [mm^2/s rpm]
    const double product = 1e6 * viscosity * std::abs(speed) * 60.0 / TWO_PI;
    const double diameter = 1e3 * parameters_.pitch_diameter;
    const double rolling = product < LOW_SPEED ? 160.0 : twoThirdsPower(product);
    const double speed_part = parameters_.lubricant_factor * rolling * diameter * diameter * diameter * 1e-7;
    const double load_part = parameters_.load_factor * (load + preload_) * diameter;
    return 1e-3 * (speed_part + load_part);
  }

  /// Effective kinematic viscosity of the speed-dependent friction [m^2/s] at a temperature [degC].
  double viscosity(double temperature) const noexcept
  {
    constexpr double ZERO_CELSIUS = 273.15;  // K
    constexpr double OFFSET = 0.7;           // added to viscosities in Walther's law [mm^2/s]; DIN 51563 has 0.8
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
    const double friction = constant + (1.0 - constant) * root * root;  // (nu / nu(T_0))^(2/3) of sound grease [-]
    return parameters_.viscosity * friction * std::sqrt(friction);
  }

  /// x^(2/3) for finite x > 0 with a relative error of 1e-14, as x times its reciprocal cube root. The root starts with
  /// a third of the exponent (error 4 %). Two steps of the series of (1 - e)^(-1/3) reduce the error to rounding.
  static double twoThirdsPower(double x) noexcept
  {
    constexpr std::uint64_t ONE = 0x553ef0ff289dd796;  // with this constant the first guess for x = 1 is 1
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
  double preload_;  // F_race, less the loss by wear [N]
  double viscosity_factor_{ 1.0 };
};

/// Dry friction parallel to the cup's spring, by microscopic slip at the clamping to the housing and in the steel. It
/// acts on the mean rotation Phi of the rim, so that it dissipates nothing at constant load. It causes the hysteresis
/// of the torsion and damps the output when the motor is at rest.
///
/// For cup.friction_angle = 0 the friction is one rigid-plastic element, a dry term of cup.friction_torque F. For a
/// larger angle it consists of ELEMENTS parallel springs, each in series with a slider (Maxwell slip, Masing's model):
///
///   torque   sum_j k z_j,   z_j' = Phi' while |z_j| < w_j or Phi' reduces |z_j|, else 0
///   energy   stored: sum_j k z_j^2 / 2; dissipated by each element that slips: k w_j per rad
/// where      z_j  twist of spring j [rad], z_j', Phi'  rates; w_j = (a / 2) 3^-j, j = 0 ... 5  its largest twist
///            a  cup.friction_angle [rad], k = F / sum_j w_j  stiffness of each spring [N.m/rad]
///
/// Because the springs are equal and w_j has the ratio 3, the loss is about the same share of the stored energy at all
/// amplitudes from w_5 to w_0 (1 to 243), as in structural damping. The friction does not depend on the rate. All
/// elements slip when the rim has turned by a after a reversal.
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

  /// Whether the friction consists of springs with sliders, which have a state, and not of one dry term.
  bool hasState() const noexcept { return torque_ > 0.0 && width_ > 0.0; }

  /// State of springs and sliders at a rotation of the rim.
  struct State
  {
    std::array<double, ELEMENTS> twist{};  ///< twist z_j of each spring [rad]
    double rotation{};                     ///< mean rotation Phi of the rim [rad]
    double torque{};                       ///< torque of the friction; > 0 against positive rotation [N.m]
    double stiffness{};                    ///< stiffness of the elements that do not slip [N.m/rad]
    double energy{};                       ///< stored energy [J]
    double slipped{};                      ///< dissipated energy since the preceding state [J]
  };

  /// State with zero torque at `rotation` [rad].
  State relaxed(double rotation) const noexcept
  {
    State state;
    state.rotation = rotation;
    state.stiffness = stiffness();
    return state;
  }

  /// State after the rim has turned in one direction from the state `from` to `rotation` [rad].
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

  /// Stiffness of all elements when none slips, which is the largest stiffness [N.m/rad].
  double stiffness() const noexcept { return stiffness_; }

  /// Adds the dry term of the rigid-plastic element to `friction`. `rates`: derivatives of the mean rotation by motor
  /// and output angle [-]. Adds nothing without friction or if the friction has a state.
  void addTerm(const Eigen::Vector2d& rates, JointFriction& friction) const noexcept
  {
    if (isTerm())
    {
      friction.terms.push_back({ torque_, rates });
    }
  }
  bool isTerm() const noexcept { return torque_ > 0.0 && !hasState(); }

private:
  static constexpr double RATIO = 3.0;  // largest twist of an element over that of the next element
  // Largest twist of each element over that of the first element.
  static constexpr std::array<double, ELEMENTS> SHARES{
    1.0, 1.0 / 3.0, 1.0 / 9.0, 1.0 / 27.0, 1.0 / 81.0, 1.0 / 243.0
  };

  double torque_;  // torque at which all elements slip [N.m]
  double width_;   // largest twist of the first element [rad]
  double stiffness_{};
};
}  // namespace hjt
