// SPDX-License-Identifier: BSD-3-Clause
#include "arm/found_load.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/number_text.hpp"
#include "gear/angle.hpp"

namespace hjt
{
bool IdentifiedPayload::differs() const
{
  return std::abs(mass - configured.mass) > std::max(mass_half_width, least_claim);
}

bool IdentifiedPayload::isOther() const
{
  const bool is_none = configured.mass > 0.0 && mass > -std::max(mass_half_width, least_claim);
  return differs() && (isCarried() || is_none);
}

Payload IdentifiedPayload::payload() const
{
  Payload payload;
  payload.mass = isCarried() ? mass : 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    payload.centre[axis] = payload.mass > 0.0 ? moment[axis] / payload.mass : 0.0;
  }
  return payload;
}

std::string IdentifiedPayload::text() const
{
  const Payload found = payload();
  if (!isCarried())
  {
    return "the currents look like no payload, " + fixedText(std::max(mass, 0.0), 1) + " +- " +
           fixedText(mass_half_width, 1) + " kg at the flange, in place of the configured " +
           roundedText(configured.mass, 3) + " kg: set payload in the arm's file";
  }
  return "the currents look like a payload of " + fixedText(found.mass, 1) + " +- " + fixedText(mass_half_width, 1) +
         " kg at the flange in place of the configured " + roundedText(configured.mass, 3) + " kg, its centre at " +
         fixedText(found.centre[0], 2) + ", " + fixedText(found.centre[1], 2) + ", " + fixedText(found.centre[2], 2) +
         " m: set payload in the arm's file";
}

double IdentifiedMounting::tilt() const
{
  double product = 0.0;
  double of_configured = 0.0;
  double of_found = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    product += configured[axis] * gravity[axis];
    of_configured += configured[axis] * configured[axis];
    of_found += gravity[axis] * gravity[axis];
  }
  const double size = std::sqrt(of_configured * of_found);
  return size > 0.0 ? std::acos(std::clamp(product / size, -1.0, 1.0)) : 0.0;
}

bool IdentifiedMounting::differs() const
{
  constexpr double LEAST = 4.0 * DEGREE;  // errors of the links' masses tilt it too
  constexpr double KNOWN = 3.0;           // half widths, at least: a hand on the arm tilts it too
  constexpr double SIZE = 1.35;           // a payload, or errors of gains, beside
  return tilt() > LEAST && tilt() > KNOWN * half_width && size > 1.0 / SIZE && size < SIZE;
}

std::string IdentifiedMounting::text() const
{
  constexpr double LEAST = 1.0;  // least half width that is printed [deg]
  const auto part = [](double value) { return fixedText(std::abs(value) < 0.05 ? 0.0 : value, 1); };  // no "-0.0"
  return "another mounting than configured: gravity looks tilted by " + fixedText(tilt() / DEGREE, 0) + " +- " +
         fixedText(std::max(half_width / DEGREE, LEAST), 0) + " deg: set gravity: [" + part(gravity[0]) + ", " +
         part(gravity[1]) + ", " + part(gravity[2]) + "] in the arm's file";
}

bool FoundDrag::exists() const
{
  constexpr double LEAST = 3.0;  // [N]
  return force - half_width > LEAST;
}

std::string FoundDrag::text() const
{
  return "the currents look like a force of " + fixedText(force, 0) + " +- " + fixedText(half_width, 0) +
         " N on the tool against its motion: a cable, a hose, or a tool that rubs";
}

Misfit FoundLoad::misfit() const
{
  constexpr double NOTEWORTHY = 0.2;  // gains of one type differ by less
  if (std::abs(gain) - gain_half_width < NOTEWORTHY)
  {
    return {};
  }
  return { Reason::EFFORT_UNIT, "the currents of all joints are " + fixedText(1.0 + gain, 2) + " +- " +
                                    fixedText(gain_half_width, 2) +
                                    " times what load and friction take: another gain (telemetry.torque_per_current) "
                                    "or unit than configured" };
}

FoundLoad FoundLoad::last() const
{
  if (changes.empty())
  {
    return *this;
  }
  FoundLoad found = *this;
  found.payload = changes.back().is_found ? payload : otherwise;
  found.changes.clear();
  found.since = changes.back().time;
  return found;
}
}  // namespace hjt
