// SPDX-License-Identifier: BSD-3-Clause
#include "model/ring_model.hpp"

#include <cassert>
#include <type_traits>

namespace hjt
{
namespace
{
template <class... Elements>
std::tuple<Elements...> makeElements(const Parameters& parameters, const ToothRing& rest, std::tuple<Elements...>*)
{
  return std::tuple<Elements...>(Elements(parameters, rest)...);
}

/// Calls `add` with each element of the ring, but not with ToothMesh if `with_mesh` is false.
template <class Add>
void forEach(const RingElements& elements, bool with_mesh, const Add& add) noexcept
{
  const auto add_one = [&](const auto& element)
  {
    if (with_mesh || !std::is_same_v<std::decay_t<decltype(element)>, ToothMesh>)
    {
      add(element);
    }
  };
  std::apply([&](const auto&... element) { (add_one(element), ...); }, elements);
}
}  // namespace

RingModel::RingModel(const Parameters& parameters)
  : gear(parameters.gear)
  , rest(parameters.gear)
  , elements_(makeElements(parameters, rest, static_cast<RingElements*>(nullptr)))
{
}

void RingModel::forces(const RingShape& shape, const DrivePosition& position, RingForces& forces,
                       bool circular_spline_in) const noexcept
{
  forces.setZero(shape.solved);
  forces.stamp(shape);
  forEach(elements_, meshed_ && circular_spline_in,
          [&](const auto& element)
          {
            using Element = std::decay_t<decltype(element)>;
            element.addForces(shape, position, forces.of<Element>(), forces);
          });
  if (shape.copies() > 1)
  {
    forces.repeat();
  }
}

void RingModel::tangent(const RingShape& shape, const RingForces& forces, RingTangent& tangent) const noexcept
{
  assert(forces.areOf(shape) && "the forces are those of another shape");
  tangent.setZero(shape.solved);
  forEach(elements_, meshed_,
          [&](const auto& element)
          {
            using Element = std::decay_t<decltype(element)>;
            element.addTangent(shape, forces.of<Element>(), tangent);
          });
  if (shape.copies() > 1)
  {
    tangent.closeHalf();
  }
}

int RingModel::solvedTeeth() const noexcept
{
  constexpr int FEWEST = 16;  // least number of teeth of a ring whose half a CyclicSolver can solve
  const bool repeats = std::apply([](const auto&... element) { return (element.repeats() && ...); }, elements_) &&
                       rest.teeth() >= FEWEST;
  return repeats ? rest.teeth() / 2 : rest.teeth();
}

RingShape RingModel::restShape(const DrivePosition& position) const
{
  RingShape shape(rest.teeth());
  shape.points = rest.points();
  shape.updateGeometry();
  of<ToothMesh>().pairAtRest(position, shape);
  return shape;
}
}  // namespace hjt
