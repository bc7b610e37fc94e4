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
///   void addTangent(const RingShape&, const Scratch&, RingTangent&) const noexcept: for the last shape of addForces
///   bool repeats() const noexcept: whether the element repeats after half a turn. If all elements repeat, each adds
///                                  the forces of half of the teeth, and Scratch::repeat computes the other half.
///
/// Scratch keeps results of addForces for tangent, friction and outputs. docs/extending.md describes how to add an
/// element.
using RingElements = std::tuple<RimTension, RimBending, WaveGeneratorContact, CupTorsion, ToothMesh>;

/// Sum of the forces of all elements, with the intermediate results of each element.
struct RingForces : ForceSum
{
  explicit RingForces(int count) : ForceSum(count), scratch_(Scratches<RingElements>::make(count)) {}

  void setZero(int solved) noexcept
  {
    ForceSum::setZero(solved);
    std::apply([](auto&... scratch) { (scratch.setZero(), ...); }, scratch_);
  }

  /// Extends the forces of the first half of the ring to the whole ring.
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

  /// In builds with assertions, stores a hash of the shape that these forces belong to.
  void stamp([[maybe_unused]] const RingShape& shape) noexcept
  {
#ifndef NDEBUG
    stamp_ = hash(shape);
#endif
  }
  /// Whether these forces belong to `shape`; always true in builds without assertions.
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

/// Version of a model: a number that changes with every change of the model and with every assignment to the model.
class ModelVersion
{
public:
  ModelVersion() = default;
  ModelVersion(const ModelVersion&) = default;
  ModelVersion& operator=(const ModelVersion&) noexcept  // a self-assignment is a change too
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

/// Model of the ring: the sum of all its conservative elements.
///
/// Assignment, `edit` and `setMeshed` change the model and its version. Solvers compare versions.
class RingModel
{
public:
  /// @throws ParameterError if a table of pitch errors is invalid.
  explicit RingModel(const Parameters& parameters);

  /// Computes forces and stored energy, without those of the mesh if the circular spline is absent. The caller must
  /// have called `shape.updateGeometry`.
  void forces(const RingShape& shape, const DrivePosition& position, RingForces& forces,
              bool circular_spline_in = true) const noexcept;

  /// Computes the Hessian of the stored energy. `forces`: result of `forces` for `shape`.
  void tangent(const RingShape& shape, const RingForces& forces, RingTangent& tangent) const noexcept;

  /// Number of teeth to solve: half of all teeth if the model repeats after half a turn, else all teeth.
  int solvedTeeth() const noexcept;

  /// Shape of the ring at rest, in which every tooth faces its nearest space.
  RingShape restShape(const DrivePosition& position) const;

  template <class Element>
  const Element& of() const noexcept
  {
    return std::get<Element>(elements_);
  }

  /// Element that the caller may change until the next solve.
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

/// Torques and stiffness of the ring in equilibrium at given motor and output angles, without friction.
struct RingResponse
{
  double energy{};                 ///< energy stored in the ring [J]
  double wave_generator_torque{};  ///< torque on the wave generator [N.m]
  double output_torque{};          ///< torque on the circular spline [N.m]
  double velocity_ratio{};         ///< output speed over motor speed at constant load [-]
  double output_stiffness{};       ///< stiffness of the output with the wave generator held [N.m/rad]
  double motor_stiffness{};        ///< stiffness of the wave generator with the output held [N.m/rad]
};

/// Quantities of the ring in equilibrium that give its friction at any speeds of motor and output.
struct RingFrictionResponse
{
  /// number of groups of loaded flanks with similar sliding. The friction power of a group, sum_i |F_i| |slip_i .
  /// (motor speed, output speed)| over its flanks i with the forces F_i, is exact if all of them slide in one direction
  static constexpr int FLANK_GROUPS = 6;
  using Groups = Eigen::Array<double, FLANK_GROUPS, 1>;

  double contact_force{};     ///< load of the wave generator's bearing: sum of its forces on all teeth [N]
  double ring_torque{};       ///< friction torque of outer race and flexing rim at the motor shaft [N.m]
  Eigen::Vector3d viscous;    ///< viscous matrix: motor-motor, motor-output, output-output [N.m.s/rad]
  Groups flank_by_motor;      ///< for each group the sum of normal force times slip per motor speed [N.m]
  Groups flank_by_output;     ///< for each group the sum of normal force times slip per output speed [N.m]
  Groups rms_slip_by_motor;   ///< for each group the root mean square slip per motor speed [m/rad]
  Groups rms_slip_by_output;  ///< for each group the root mean square slip per output speed [m/rad]
};
}  // namespace hjt
