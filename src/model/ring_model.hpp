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
/// All conservative elements of the ring, in the order of summation. An element is a class with
///
///   constructor (const Parameters&, const ToothRing& rest)
///   struct Scratch { explicit Scratch(int teeth); void setZero() noexcept; void repeat() noexcept; }
///   void addForces(const RingShape&, const DrivePosition&, Scratch&, ForceSum&) const noexcept
///   void addTangent(const RingShape&, const Scratch&, RingTangent&) const noexcept: for the forces' shape
///   bool repeats() const noexcept: whether its state repeats after half a turn, so that it adds for the solved teeth
///                                  only. Otherwise the whole ring is solved. `repeat` computes the other half.
///
/// The scratch carries results of the forces to tangent, friction and outputs. docs/extending.md describes how to add
/// an element.
using RingElements = std::tuple<RimTension, RimBending, WaveGeneratorContact, CupTorsion, ToothMesh>;

/// Sum over the elements, with the intermediate results of each.
struct RingForces : ForceSum
{
  explicit RingForces(int count) : ForceSum(count), scratch_(Scratches<RingElements>::make(count)) {}

  void setZero(int solved) noexcept
  {
    ForceSum::setZero(solved);
    std::apply([](auto&... scratch) { (scratch.setZero(), ...); }, scratch_);
  }

  /// Extends the forces of the first half of the ring to the whole.
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

  /// Stores a hash of the shape of these forces, in builds with assertions.
  void stamp([[maybe_unused]] const RingShape& shape) noexcept
  {
#ifndef NDEBUG
    stamp_ = hash(shape);
#endif
  }
  /// Whether the forces belong to this shape; always true in builds without assertions.
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

  /// FNV-1a hash of the tooth points' bits.
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

/// A number that differs after every change of a model and after every assignment to it.
class ModelVersion
{
public:
  ModelVersion() = default;
  ModelVersion(const ModelVersion&) = default;
  ModelVersion& operator=(const ModelVersion&) noexcept  // self-assignment is a change too
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

/// Sum of all conservative elements of the ring.
///
/// Assignment, `edit` and `setMeshed` change the model and its version. Solvers compare versions to discard results of
/// an earlier model.
class RingModel
{
public:
  /// @throws ParameterError if a table of pitch errors is invalid.
  explicit RingModel(const Parameters& parameters);

  /// Forces and stored energy, without the teeth while the circular spline is absent. The shape's geometry must be up
  /// to date.
  void forces(const RingShape& shape, const DrivePosition& position, RingForces& forces,
              bool circular_spline_in = true) const noexcept;

  /// Hessian of the stored energy by the solved teeth; `forces` must be of the same shape.
  void tangent(const RingShape& shape, const RingForces& forces, RingTangent& tangent) const noexcept;

  /// Number of teeth to solve: N/2 if the drive repeats after half a turn, else N.
  int solvedTeeth() const noexcept;

  /// The ring at rest, where every tooth faces its nearest space.
  RingShape restShape(const DrivePosition& position) const;

  template <class Element>
  const Element& of() const noexcept
  {
    return std::get<Element>(elements_);
  }

  /// An element to be changed; the reference is valid until the next solve.
  template <class Element>
  Element& edit() noexcept
  {
    version_.next();
    return std::get<Element>(elements_);
  }

  /// Whether the circular spline is present.
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

/// Torques and stiffness of the ring in equilibrium at the two angles of the joint, without friction.
struct RingResponse
{
  double energy{};                 ///< stored energy [J]
  double wave_generator_torque{};  ///< torque on the wave generator [N.m]
  double output_torque{};          ///< torque on the circular spline [N.m]
  double velocity_ratio{};         ///< output speed over motor speed at constant load [-]
  double output_stiffness{};       ///< stiffness of the output with the wave generator held [N.m/rad]
  double motor_stiffness{};        ///< stiffness of the wave generator with the output held [N.m/rad]
};

/// Friction of the ring in equilibrium, with respect to the two speeds of the joint.
struct RingFrictionResponse
{
  /// Groups of loaded flanks with similar sliding: sum_i |F_i| |slip_i . (motor, output speed)|, exact if all flanks of
  /// a group slide in the same direction.
  static constexpr int FLANK_GROUPS = 6;
  using Groups = Eigen::Array<double, FLANK_GROUPS, 1>;

  double contact_force{};     ///< load of the wave generator's bearing: sum over all teeth [N]
  double ring_torque{};       ///< torque at the motor shaft of outer race and flexing rim [N.m]
  Eigen::Vector3d viscous;    ///< damping of the dashpots: motor-motor, motor-output, output-output [N.m.s/rad]
  Groups flank_by_motor;      ///< sum of force times slip per motor speed [N.m]
  Groups flank_by_output;     ///< sum of force times slip per output speed [N.m]
  Groups rms_slip_by_motor;   ///< root mean square slip per motor speed [m/rad]
  Groups rms_slip_by_output;  ///< root mean square slip per output speed [m/rad]
};
}  // namespace hjt
