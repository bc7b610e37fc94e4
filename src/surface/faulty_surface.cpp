// SPDX-License-Identifier: BSD-3-Clause
#include "surface/faulty_surface.hpp"

#include <string>

#include "base/number_text.hpp"
#include "model/faults/joint_faults.hpp"
#include "params/variants.hpp"

namespace hjt
{
namespace
{
/// Text of the faults for the key of a table in the cache; empty without faults.
std::string keyOf(const FaultList& faults)
{
  TextStream text;
  for (const ActiveFault& active : faults)
  {
    text << describe(active.fault.kind).name << ' ' << numberText(active.fault.severity) << ' ' << active.fault.place
         << '\n';
  }
  return text.str();
}

/// The fault if there is one fault, at a tooth or segment of the flexspline, and the other teeth are equal; else null.
const Fault* singleFaultOfATooth(const Parameters& parameters, const FaultList& faults)
{
  Parameters without = parameters;
  without.faults.clear();
  const Fault* fault = faults.size() == 1 ? &faults.begin()->fault : nullptr;
  const bool local =
      fault != nullptr && fault->place >= 0 &&
      (describe(fault->kind).place == FaultPlace::TOOTH || describe(fault->kind).place == FaultPlace::SEGMENT);
  return local && teethAreAlike(without) ? fault : nullptr;
}

/// Surface of a fault at any tooth, which is that of the fault at tooth 0, shifted by a number of pitches.
SurfacePool::Surface shiftedSurface(const Parameters& parameters, Fault fault, const SurfaceSource& source)
{
  const int place = fault.place;
  fault.place = 0;
  FaultList first;
  first.set(fault, 0);
  const SurfacePool::Surface surface =
      sharedSurface(parameters, JointFaults(parameters, first).model(), keyOf(first), source);
  if (!surface)
  {
    return nullptr;
  }
  DeviationTable deviations = surface->deviations();
  deviations.shift = place;
  return std::make_shared<const ResponseSurface>(surface->table(), std::move(deviations));
}

SurfacePool::Surface none(const std::string& why, const SurfaceSource& source)
{
  if (source.notice)
  {
    source.notice("no response surface " + why + "; the twin solves the full ring at every step");
  }
  return nullptr;
}
}  // namespace

bool isOfTheBalls(const Fault& fault) noexcept
{
  return fault.kind == FaultKind::BEARING_INNER_RACE || fault.kind == FaultKind::BEARING_OUTER_RACE ||
         fault.kind == FaultKind::BEARING_BALL || fault.kind == FaultKind::BEARING_CAGE;
}

SurfacePool::Surface surfaceWithFaults(const Parameters& parameters, const FaultList& faults,
                                       const SurfaceSource& source)
{
  if (parameters.contact.support == SupportKind::SINGLE_BALLS)
  {
    return none("for single balls", source);
  }
  FaultList of_the_balls;
  FaultList others;
  for (const ActiveFault& active : faults)
  {
    (isOfTheBalls(active.fault) ? of_the_balls : others).set(active.fault, active.since);
  }
  const Fault* of_a_tooth = singleFaultOfATooth(parameters, others);
  const auto surface_of_others = [&]
  {
    return of_a_tooth != nullptr ?
               shiftedSurface(parameters, *of_a_tooth, source) :
               sharedSurface(parameters, JointFaults(parameters, others).model(), keyOf(others), source);
  };
  if (of_the_balls.empty())
  {
    return surface_of_others();
  }
  const RaceDeflection bearing =
      JointFaults(parameters, of_the_balls).model().ring.of<WaveGeneratorContact>().bearing();
  if (!bearing.dropsOneBall())
  {
    return none("for more than one fault of the bearing, or for a spall longer than the distance of two balls", source);
  }
  // A fault of a single tooth hardly changes the effect of a dropping ball, so that their effects add up.
  const bool adds_up = of_a_tooth != nullptr && describe(of_a_tooth->kind).place == FaultPlace::TOOTH;
  const FaultList felt_by_balls = adds_up ? FaultList() : others;
  const SurfacePool::Surface balls =
      sharedBallSurface(parameters, JointFaults(parameters, felt_by_balls).model(), keyOf(felt_by_balls), source);
  const SurfacePool::Surface surface = balls && adds_up ? surface_of_others() : balls;
  return surface ? std::make_shared<const ResponseSurface>(surface->table(), surface->deviations(),
                                                           BallDrops(balls->balls()->table(), bearing)) :
                   nullptr;
}
}  // namespace hjt
