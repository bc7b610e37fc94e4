// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstring>
#include <tuple>

#include <Eigen/Core>

#include "elements/cup_torsion.hpp"
#include "elements/rim_elasticity.hpp"
#include "elements/ring_sums.hpp"
#include "elements/tooth_mesh.hpp"
#include "elements/wave_generator_contact.hpp"
#include "gear/ring_shape.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// All conservative elements of the ring, in the order in which they are summed. One is a class that has
///
///   constructor (const Parameters&, const ToothRing& rest)
///   struct Scratch { explicit Scratch(int teeth); void setZero() noexcept; void repeat() noexcept; }
///   void addForces(const RingShape&, const DrivePosition&, Scratch&, ForceSum&) const noexcept
///   void addTangent(const RingShape&, const Scratch&, RingTangent&) const noexcept: for the forces' shape
///   bool repeats() const noexcept: it is the same again after half a turn, and adds what the solved teeth alone do;
///                                  one that does not has the whole ring solved. `repeat` fills in the other half.
///
/// where the scratch carries what the forces found over to the tangent, to friction and to outputs. docs/extending.md
/// adds one.
using RingElements = std::tuple<RimTension, RimBending, WaveGeneratorContact, CupTorsion, ToothMesh>;

/// Sum over the elements, with the scratch of each.
struct RingForces : ForceSum
{
  explicit RingForces(int count) : ForceSum(count), scratch_(Scratches<RingElements>::make(count)) {}

  void setZero(int solved) noexcept
  {
    ForceSum::setZero(solved);
    std::apply([](auto&... scratch) { (scratch.setZero(), ...); }, scratch_);
  }

  /// The whole ring's from those of its first half.
  void repeat() noexcept
  {
    ForceSum::repeat();
    std::apply([](auto&... scratch) { (scratch.repeat(), ...); }, scratch_);
  }

  /// Intermediate results of an element.
  template <class Element>
  const typename Element::Scratch& of() const noexcept
  {
    return std::get<typename Element::Scratch>(scratch_);
  }
  template <class Element>
  typename Element::Scratch& of() noexcept
  {
    return std::get<typename Element::Scratch>(scratch_);
  }

  /// Notes the shape that the forces are of; only in builds with assertions.
  void stamp([[maybe_unused]] const RingShape& shape) noexcept
  {
#ifndef NDEBUG
    stamp_ = hash(shape);
#endif
  }
  /// Whether they are of this shape; always true in builds without assertions.
  bool areOf([[maybe_unused]] const RingShape& shape) const noexcept
  {
#ifndef NDEBUG
    return stamp_ == hash(shape);
#else
    return true;
#endif
  }

private:
  template <class Elements>
  struct Scratches;
  template <class... Elements>
  struct Scratches<std::tuple<Elements...>>
  {
    using Type = std::tuple<typename Elements::Scratch...>;
    static Type make(int teeth) { return Type(typename Elements::Scratch(teeth)...); }
  };

  /// FNV-1a of the tooth points, bit by bit.
  static std::uint64_t hash(const RingShape& shape) noexcept
  {
    std::uint64_t hash = 14695981039346656037U;
    for (Eigen::Index k = 0; k < shape.points.size(); ++k)
    {
      std::uint64_t bits = 0;
      std::memcpy(&bits, &shape.points[k], sizeof(bits));
      hash = (hash ^ bits) * 1099511628211U;
    }
    return hash;
  }

  Scratches<RingElements>::Type scratch_;
  std::uint64_t stamp_{};
};

/// Another number after every change of a model, and after every assignment to it.
class ModelVersion
{
public:
  ModelVersion() = default;
  ModelVersion(const ModelVersion&) = default;
  ModelVersion& operator=(const ModelVersion&) noexcept  // NOLINT(cert-oop54-cpp): to itself is a change too
  {
    next();
    return *this;
  }
  ~ModelVersion() = default;

  void next() noexcept { ++number_; }
  bool operator!=(const ModelVersion& other) const noexcept { return number_ != other.number_; }
  std::uint64_t number() const noexcept { return number_; }

private:
  std::uint64_t number_{};
};

/// All conservative elements on the ring.
///
/// Assignment, `edit` and `setMeshed` change the model, and each change gives it another version. Solvers compare
/// versions to drop results of the model before.
class RingModel
{
public:
  /// @throws ParameterError on a bad table of pitch errors.
  explicit RingModel(const Parameters& parameters);

  /// Forces and stored energy; of the teeth too unless the circular spline is not in yet. The shape's geometry must be
  /// up to date.
  void forces(const RingShape& shape, const DrivePosition& position, RingForces& forces,
              bool circular_spline_in = true) const noexcept;

  /// Hessian of the stored energy, over the solved teeth; `forces` of the same shape.
  void tangent(const RingShape& shape, const RingForces& forces, RingTangent& tangent) const noexcept;

  /// Teeth after which the drive repeats, turned by half a turn: N/2; or all N where it does not.
  int solvedTeeth() const noexcept;

  /// The ring at rest, every tooth paired with its nearest space.
  RingShape restShape(const DrivePosition& position) const;

  template <class Element>
  const Element& of() const noexcept
  {
    return std::get<Element>(elements_);
  }

  /// An element, to change it now: the reference is good until the model is solved.
  template <class Element>
  Element& edit() noexcept
  {
    version_.next();
    return std::get<Element>(elements_);
  }

  /// Whether the circular spline is there at all.
  bool meshed() const noexcept { return meshed_; }
  void setMeshed(bool meshed) noexcept
  {
    version_.next();
    meshed_ = meshed;
  }

  std::uint64_t version() const noexcept { return version_.number(); }

  GearParameters gear;
  ToothRing rest;

private:
  RingElements elements_;
  bool meshed_{ true };
  ModelVersion version_;
};

/// Torques and stiffness of the ring in equilibrium at the joint's two angles, without friction.
struct RingResponse
{
  double energy{};                 ///< stored [J]
  double wave_generator_torque{};  ///< on the wave generator [N.m]
  double output_torque{};          ///< on the circular spline [N.m]
  double velocity_ratio{};         ///< output speed over motor speed at constant load [-]
  double output_stiffness{};       ///< of the output, the wave generator held [N.m/rad]
  double motor_stiffness{};        ///< of the wave generator, the output held [N.m/rad]
};

/// Friction of the ring in equilibrium, as it acts on the joint's two speeds.
struct RingFrictionResponse
{
  /// Loaded flanks that slide alike, taken together: sum_i |F_i| |slip_i . (motor, output speed)|, exact while all
  /// flanks of a group slide the same way.
  static constexpr int FLANK_GROUPS = 6;
  using Groups = Eigen::Array<double, FLANK_GROUPS, 1>;

  double contact_force{};     ///< sum over all teeth: load of the wave generator's bearing [N]
  double ring_torque{};       ///< at the motor shaft: outer race in the rim, flexing rim [N.m]
  Eigen::Vector3d viscous;    ///< dashpots: motor-motor, motor-output, output-output [N.m.s/rad]
  Groups flank_by_motor;      ///< sum of force times slip by motor angle [N.m]
  Groups flank_by_output;     ///< by output angle
  Groups rms_slip_by_motor;   ///< root mean square slip by motor angle [m/rad]
  Groups rms_slip_by_output;  ///< by output angle
};
}  // namespace hjt
