// SPDX-License-Identifier: BSD-3-Clause
#include "arm/load_law.hpp"

#include <cstddef>
#include <utility>

#include "tracking/verdict.hpp"

namespace hjt
{
namespace
{
/// As it is named, beside the configured one; none: it is that.
template <class Found>
std::optional<Found> named(Found found, const std::optional<Found>& counts)
{
  found.configured = counts ? counts->configured : found.configured;
  return found.differs() ? std::make_optional(found) : std::nullopt;
}

/// Nothing but the load stands against any joint.
bool mayBeOther(const JudgedJoints& joints)
{
  for (std::size_t i = 0; i < joints.misfits.size(); ++i)
  {
    const Misfit& misfit = joints.misfits[i];
    if (joints.measured[i] && misfit.exists() && misfit.reason != Reason::LOAD_WRONG)
    {
      return false;
    }
  }
  return true;
}
}  // namespace

std::string AssumedLoad::text() const
{
  std::string text = mounting ? sentence(mounting->text()) + " " : std::string();
  text += payload ? sentence(payload->text()) + " " : std::string();
  text += isConfigured() ? "" : "The joints are judged with it. ";
  return text + (part.isAll() ? "" : "The payload changes: the joints are judged by the rows " + part.text() + ". ");
}

void AssumedLoad::configure(ArmDescription& arm) const
{
  arm.payload = payload ? payload->payload() : arm.payload;
  arm.gravity = mounting ? mounting->gravity : arm.gravity;
}

JudgedJoints::JudgedJoints(const RecordingFit& fit, std::vector<Misfit> of_rows, std::vector<MeasuredFriction> of_each,
                           double tolerance)
  : misfits(std::move(of_rows)), frictions(std::move(of_each)), common(commonFriction(frictions, tolerance))
{
  for (std::size_t i = 0; i < misfits.size(); ++i)
  {
    misfits[i] = misfitOf(misfits[i], common.misfit);
    measured.push_back(fit.isMeasured(i));
  }
}

bool LoadLaw::take(const FoundLoad& found, const JudgedJoints& joints)
{
  tried_mounting_ = is_trying_ && tried_mounting_;
  tried_payload_ = is_trying_ && tried_payload_;
  if (is_trying_ && explains(joints))
  {
    stands_ = counts_;
    is_trying_ = false;
  }
  if (const std::optional<AssumedLoad> next = other(found, joints))
  {
    counts_ = *next;
    is_trying_ = !counts_.isConfigured();
    stands_ = is_trying_ ? stands_ : counts_;
    return true;
  }
  const bool is_taken_back = is_trying_;
  counts_ = stands_;
  is_trying_ = false;
  return is_taken_back;
}

/// None: it stays as it is.
std::optional<AssumedLoad> LoadLaw::other(const FoundLoad& found, const JudgedJoints& joints)
{
  AssumedLoad next = counts_;
  if (found.showsMounting() && !tried_mounting_)
  {
    tried_mounting_ = true;
    next.mounting = named(found.mounting, counts_.mounting);
    return next;
  }
  // A mass below zero is no other payload; less than was found is that it was put down.
  const bool is_put_down = counts_.payload && counts_.payload->isCarried();
  const bool is_other = found.showsPayload() && (found.payload.isOther() || is_put_down);
  if ((is_other || !found.part.isAll()) && !tried_payload_ && mayBeOther(joints))
  {
    tried_payload_ = true;
    next.part = found.part;
    next.payload = is_other ? named(found.payload, counts_.payload) : counts_.payload;
    return next;
  }
  return std::nullopt;
}

/// Where the friction of the whole arm is another with a payload, one multiple of all currents must be no better a
/// reason.
bool LoadLaw::explains(const JudgedJoints& joints) const
{
  for (std::size_t i = 0; i < joints.misfits.size(); ++i)
  {
    const MeasuredFriction& friction = joints.frictions[i];
    if (joints.measured[i] && (joints.misfits[i].exists() || friction.is_below_faults || friction.is_load_wrong))
    {
      return false;
    }
  }
  const std::optional<IdentifiedPayload>& payload = counts_.payload;
  return joints.common.median == 1.0 || !payload || payload->residual_share < payload->share_of_gain;
}
}  // namespace hjt
