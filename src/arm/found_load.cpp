// SPDX-License-Identifier: BSD-3-Clause
#include "arm/found_load.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "base/number_text.hpp"
#include "gear/angle.hpp"
#include "tracking/verdict.hpp"

namespace hjt
{
namespace
{
/// Sets found.configured to the value of the arm's file. Returns none if the found value agrees with the value of the
/// file. `counts`: the present payload or mounting.
template <class Found>
std::optional<Found> named(Found found, const std::optional<Found>& counts)
{
  found.configured = counts ? counts->configured : found.configured;
  return found.differs() ? std::make_optional(found) : std::nullopt;
}

/// Whether a wrong load can cause all misfits of the joints with a measured current.
bool mayBeOther(const JudgedJoints& joints)
{
  for (std::size_t i = 0; i < joints.misfits.size(); ++i)
  {
    const Misfit& misfit = joints.misfits[i];
    const bool is_of_load = misfit.reason == Reason::LOAD_WRONG || misfit.reason == Reason::LESS_THAN_FAULTS ||
                            misfit.reason == Reason::COMMON_FRICTION;
    if (joints.measured[i] && misfit.exists() && !is_of_load)
    {
      return false;
    }
  }
  return true;
}

/// Whether no joint with a measured current has a misfit.
bool explains(const JudgedJoints& joints)
{
  for (std::size_t i = 0; i < joints.misfits.size(); ++i)
  {
    const MeasuredFriction& friction = joints.frictions[i];
    if (joints.measured[i] && (joints.misfits[i].exists() || friction.is_below_faults || friction.is_load_wrong))
    {
      return false;
    }
  }
  return true;
}

std::string massText(const IdentifiedPayload& found)
{
  return fixedText(std::max(found.mass, 0.0), 1) + " +- " + fixedText(found.mass_half_width, 1) + " kg";
}
}  // namespace

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
    return "the currents show no payload at the flange (" + fixedText(std::max(mass, 0.0), 1) + " +- " +
           fixedText(mass_half_width, 1) + " kg, 95 %), but " + roundedText(configured.mass, 3) +
           " kg is configured. Set payload in the arm's file";
  }
  return "the currents show a payload of " + fixedText(found.mass, 1) + " +- " + fixedText(mass_half_width, 1) +
         " kg (95 %) at the flange with its centre at " + fixedText(found.centre[0], 2) + ", " +
         fixedText(found.centre[1], 2) + ", " + fixedText(found.centre[2], 2) + " m, but " +
         roundedText(configured.mass, 3) + " kg is configured. Set payload in the arm's file";
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
  constexpr double LEAST = 4.0 * DEGREE;  // least tilt that counts; errors of the links' masses cause less [rad]
  constexpr double KNOWN = 3.0;           // least tilt over its half width; a hand on the arm causes less [-]
  constexpr double SIZE = 1.35;           // largest found over configured gravity by a payload or wrong gains [-]
  return tilt() > LEAST && tilt() > KNOWN * half_width && size > 1.0 / SIZE && size < SIZE;
}

std::string IdentifiedMounting::text() const
{
  constexpr double LEAST = 1.0;  // least half width in the text [deg]
  const auto part = [](double value) { return fixedText(std::abs(value) < 0.05 ? 0.0 : value, 1); };  // no "-0.0"
  return "the mounting differs from the configured one: gravity is tilted by " + fixedText(tilt() / DEGREE, 0) +
         " +- " + fixedText(std::max(half_width / DEGREE, LEAST), 0) + " deg (95 %). Set gravity: [" +
         part(gravity[0]) + ", " + part(gravity[1]) + ", " + part(gravity[2]) + "] in the arm's file";
}

bool FoundDrag::exists() const
{
  constexpr double LEAST = 3.0;  // least force that counts as a drag [N]
  return force - half_width > LEAST;
}

std::string FoundDrag::text() const
{
  return "the currents show a force of " + fixedText(force, 0) + " +- " + fixedText(half_width, 0) +
         " N (95 %) on the tool against its motion, for example by a cable, a hose, or a tool that rubs";
}

Misfit FoundLoad::misfit() const
{
  constexpr double NOTEWORTHY = 0.2;  // least deviation of the gain that counts; gains of one type deviate by less [-]
  if (std::abs(gain) - gain_half_width < NOTEWORTHY)
  {
    return {};
  }
  return { Reason::EFFORT_UNIT, "the currents of all joints are " + fixedText(1.0 + gain, 2) + " +- " +
                                    fixedText(gain_half_width, 2) +
                                    " times the currents that load and friction need (95 %). The gain "
                                    "(telemetry.torque_per_current) or the unit is not as configured" };
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

std::string AssumedLoad::text() const
{
  std::string text = mounting ? sentence(mounting->text()) + " " : std::string();
  text += drag ? sentence(drag->text()) + " " : std::string();
  if (!changes.empty() && payload)
  {
    const auto parts = std::count_if(changes.begin(), changes.end(), [](const auto& part) { return part.is_found; });
    text += "The payload changes: in " + std::to_string(parts) + " of " + std::to_string(changes.size()) +
            " parts of the time the currents show " + massText(*payload) + ", in the other parts " +
            (otherwise ? massText(*otherwise) : "the configured " + roundedText(payload->configured.mass, 3) + " kg") +
            ". ";
  }
  else if (payload)
  {
    text += sentence(payload->text()) + " ";
  }
  return text + (isConfigured() ? "" : "The joints are judged with this load. ");
}

void AssumedLoad::configure(ArmDescription& arm) const
{
  arm.payload = payload ? payload->payload() : arm.payload;
  arm.gravity = mounting ? mounting->gravity : arm.gravity;
  arm.drag = drag ? drag->force : arm.drag;
}

PayloadCourse AssumedLoad::course(const Payload& configured) const
{
  PayloadCourse course;
  for (const PayloadChange& change : changes)
  {
    course.push_back({ change.time, change.is_found && payload ? payload->payload() :
                                    otherwise                  ? otherwise->payload() :
                                                                 configured });
  }
  return course;
}

JudgedJoints::JudgedJoints(const RecordingFit& fit, std::vector<Misfit> of_rows, std::vector<MeasuredFriction> of_each,
                           double tolerance)
  : misfits(std::move(of_rows))
  , frictions(std::move(of_each))
  , measured(fit.measured())
  , common(commonFriction(frictions, tolerance))
{
  for (Misfit& misfit : misfits)
  {
    misfit = misfitOf(misfit, common.misfit);
  }
}

void addMisfit(const Misfit& misfit, std::vector<Misfit>& misfits)
{
  if (misfit.exists())
  {
    std::replace_if(
        misfits.begin(), misfits.end(), [](const Misfit& other) { return !other.exists(); }, misfit);
  }
}

bool LoadLaw::take(const FoundLoad& found, const JudgedJoints& joints)
{
  if (is_trying_)
  {
    is_trying_ = false;
    const bool stands = explains(joints);
    (stands ? stands_ : counts_) = stands ? counts_ : stands_;
    return !stands;
  }
  const std::optional<AssumedLoad> next = other(found, joints);
  if (!next)
  {
    return false;
  }
  counts_ = *next;
  is_trying_ = !counts_.isConfigured();
  stands_ = is_trying_ ? stands_ : counts_;
  return true;
}

/// The load to try in place of the present load; none if the present load stays.
std::optional<AssumedLoad> LoadLaw::other(const FoundLoad& found, const JudgedJoints& joints) const
{
  const bool is_mounted = found.mounting.differs();
  // A mass below zero is no payload. A smaller mass than that of a payload found before means that it was put down.
  const bool is_put_down = counts_.payload && counts_.payload->isCarried();
  const bool changes = !found.changes.empty() || !std::isinf(found.since);
  const bool is_carried = changes || (found.payload.differs() && (found.payload.isOther() || is_put_down));
  const bool takes_payload = is_carried && mayBeOther(joints);
  if (!is_mounted && !found.drag.exists() && !takes_payload)
  {
    return std::nullopt;
  }
  AssumedLoad next = counts_;
  if (is_mounted)
  {
    next.mounting = named(found.mounting, counts_.mounting);
  }
  if (found.drag.exists())
  {
    next.drag = { found.drag.force + (counts_.drag ? counts_.drag->force : 0.0), found.drag.half_width };
  }
  if (takes_payload)
  {
    next.payload = named(found.payload, counts_.payload);
    next.otherwise = found.changes.empty() ? std::nullopt : named(found.otherwise, counts_.payload);
    next.changes = found.changes;
    next.since = found.since;
  }
  return next;
}
}  // namespace hjt
