// SPDX-License-Identifier: BSD-3-Clause
#include "life/read_wear.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "health/signature_terms.hpp"

namespace hjt
{
namespace
{
/// Change of an indicator by one kind of wear as a function of the severity. The function is 0 at severity 0, has the
/// changes of the signatures at the severities of the signatures, and is linear between and beyond these severities.
class Response
{
public:
  /// `scale`: factor on the signatures' changes for the drive of the window.
  Response(const SignatureSet& set, const OperatingPoint& point, FaultKind kind, ScalarIndicator indicator,
           double scale) noexcept
  {
    std::array<double, MAX_NODES> weights{};
    for (const Signature& signature : set.signatures)
    {
      const bool counts = signature.cause == causeOf(kind) && signature.severity > 0.0 &&
                          // a change of 0 means that the motion does not determine the indicator
                          signature.change[indexOf(indicator)] != 0.0;
      const std::size_t node = counts ? nodeOf(signature.severity, weights) : MAX_NODES;
      if (node == MAX_NODES)
      {
        continue;
      }
      OperatingPoint to_and_fro = point;  // the direction does not matter for wear, which needs loads of both signs
      to_and_fro.direction = signature.motion.direction;
      const double alike = likeness(signature.motion, to_and_fro);
      const double weight = OTHER_MOTION * OTHER_MOTION + alike;
      alike_ = std::max(alike_, alike);
      weights[node] += weight;
      change_[node] += weight * scale * signature.change[indexOf(indicator)];
    }
    for (std::size_t node = 1; node < nodes_; ++node)
    {
      change_[node] /= weights[node];
    }
  }

  bool isKnown() const noexcept { return nodes_ > 2; }
  double alike() const noexcept { return alike_; }  ///< similarity of the most similar motion of a signature [-]
  double lastSlope() const noexcept { return slope(nodes_ - 2); }

  double at(double severity) const noexcept
  {
    std::size_t stretch = 0;
    while (stretch + 2 < nodes_ && severity > severity_[stretch + 1])
    {
      ++stretch;
    }
    return change_[stretch] + slope(stretch) * (severity - severity_[stretch]);
  }

private:
  static constexpr std::size_t MAX_NODES = 32;

  /// Index of the node of a severity. The function adds a missing node, and returns MAX_NODES if no place is left.
  std::size_t nodeOf(double severity, std::array<double, MAX_NODES>& weights) noexcept
  {
    std::size_t node = 1;
    while (node < nodes_ && severity_[node] < severity)
    {
      ++node;
    }
    if (node < nodes_ && severity_[node] == severity)
    {
      return node;
    }
    if (nodes_ == MAX_NODES)
    {
      return MAX_NODES;
    }
    for (std::size_t i = nodes_; i > node; --i)
    {
      severity_[i] = severity_[i - 1];
      change_[i] = change_[i - 1];
      weights[i] = weights[i - 1];
    }
    ++nodes_;
    severity_[node] = severity;
    change_[node] = 0.0;
    weights[node] = 0.0;
    return node;
  }

  double slope(std::size_t stretch) const noexcept
  {
    return (change_[stretch + 1] - change_[stretch]) / (severity_[stretch + 1] - severity_[stretch]);
  }

  std::size_t nodes_{ 1 };
  double alike_{};
  std::array<double, MAX_NODES> severity_{};  // ascending
  std::array<double, MAX_NODES> change_{};
};

/// Argument in -farthest ... farthest at which a monotone function has the value `value`, by bisection.
template <class Of>
double whereIs(double value, double farthest, Of&& of) noexcept
{
  double low = -farthest;
  double high = farthest;
  const bool rises = of(high) > of(low);
  for (int i = 0; i < 50; ++i)
  {
    const double middle = 0.5 * (low + high);
    ((of(middle) < value) == rises ? low : high) = middle;
  }
  return 0.5 * (low + high);
}
}  // namespace

WearReading readWear(const WindowResidual& residual, const OperatingPoint& point, const SignatureSet& set) noexcept
{
  constexpr double FARTHEST = 3.0;  // largest severity that a reading can have [-]
  constexpr std::array STIFFNESSES{ ScalarIndicator::TORSIONAL_STIFFNESS, ScalarIndicator::SECOND_STIFFNESS };
  constexpr std::size_t PLAY = indexOf(ScalarIndicator::LOST_MOTION);
  WearReading reading;
  const double sound = residual.sound[PLAY];
  const Response play(set, point, FaultKind::TOOTH_WEAR, ScalarIndicator::LOST_MOTION, sound);
  if (!play.isKnown() || residual.own[PLAY] <= 0.0)
  {
    return reading;
  }
  reading.flank = whereIs(residual.difference[PLAY], FARTHEST, [&](double severity) { return play.at(severity); });
  reading.alike = play.alike();
  reading.lost_motion = sound + residual.difference[PLAY];
  reading.lost_motion_slope = play.lastSlope();
  std::array<Response, STIFFNESSES.size()> by_interface{
    Response(set, point, FaultKind::INTERFACE_WEAR, STIFFNESSES[0], 1.0),
    Response(set, point, FaultKind::INTERFACE_WEAR, STIFFNESSES[1], 1.0)
  };
  double left = 0.0;
  for (std::size_t i = 0; i < STIFFNESSES.size(); ++i)
  {
    const std::size_t k = indexOf(STIFFNESSES[i]);
    const Response by_flank(set, point, FaultKind::TOOTH_WEAR, STIFFNESSES[i], 1.0);
    if (!by_interface[i].isKnown() || !by_flank.isKnown() || residual.own[k] <= 0.0 || residual.sound[k] <= 0.0)
    {
      return reading;
    }
    left += residual.difference[k] / residual.sound[k] - by_flank.at(std::max(reading.flank, 0.0));
  }
  reading.interface = whereIs(
      left, FARTHEST, [&](double severity) { return by_interface[0].at(severity) + by_interface[1].at(severity); });
  reading.is_read = std::isfinite(reading.flank) && std::isfinite(reading.interface) && reading.lost_motion_slope > 0.0;
  return reading;
}
}  // namespace hjt
