// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <tuple>

#include "elements/ring_tangent.hpp"
#include "gear/ring_shape.hpp"
#include "gear/tooth_ring.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"
#include "model/ring_forces.hpp"

namespace hjt
{
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
}  // namespace hjt
