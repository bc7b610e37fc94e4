// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstring>
#include <tuple>

#include "elements/cup_torsion.hpp"
#include "elements/force_sum.hpp"
#include "elements/rim_bending.hpp"
#include "elements/rim_tension.hpp"
#include "elements/tooth_mesh.hpp"
#include "elements/wave_generator_contact.hpp"
#include "gear/ring_shape.hpp"

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
}  // namespace hjt
