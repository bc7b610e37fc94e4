// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>

#include "base/number_text.hpp"
#include "tracking/motion_differentiator.hpp"

namespace hjt
{
/// A contact on a joint's side of the arm.
struct Contact
{
  double since{};    ///< when it was first seen [s]
  double lasted{};   ///< without pauses shorter than ContactWatch::HOLD [s]
  double largest{};  ///< torque at the joint beyond the usual, magnitude [N.m]
};

/// Something that touches the arm: a torque that the joint's motion does not usually take, while it moves, for a short
/// time. What stays becomes the usual, and what comes more often than a fifth of the time is no contact: friction, gain
/// and payload.
///
/// The mean residual over MEAN must differ from the usual one of that direction by more than half of the friction, 5 %
/// of the load and 2 % of the largest load together, for LASTING, longer by what rates of rows that come rarely smear a
/// jolt over. Fixed memory; nothing allocates or throws.
class ContactWatch
{
public:
  static constexpr double MEMORY = 10.0;  ///< of motion one way, in which the usual follows [s]
  static constexpr double HOLD = 10.0;    ///< after a contact, in which nothing is judged [s]

  explicit ContactWatch(double largest_load) : largest_load_(largest_load) {}  ///< [N.m]

  void reset() noexcept { *this = ContactWatch(largest_load_); }

  /// `residual_torque`: measured less predicted, at the joint [N.m]. `is_held`: by stiction.
  void update(const MotionSample& sample, double residual_torque, double friction_torque, bool is_held) noexcept
  {
    constexpr double MOVING = 0.02;  // beyond the noise of a slope [rad/s]
    constexpr double MEAN = 0.1;     // [s]
    constexpr double SETTLED = 0.3;  // of motion one way: then presliding and the start are over [s]
    constexpr double LASTING = 0.1;  // [s]
    constexpr double KNOWN = 2.0;    // motion in one direction before a mean is known [s]
    constexpr double OF_FRICTION = 0.5;
    constexpr double OF_LOAD = 0.05;
    constexpr double OF_LARGEST = 0.02;
    const double step = sample.after_gap ? 0.0 : std::max(0.0, sample.time - time_);
    time_ = sample.time;
    const int way = std::abs(sample.velocity) > MOVING && !is_held ? (sample.velocity > 0.0 ? 1 : -1) : 0;
    if (way == 0 || way != way_ || step <= 0.0 || step > SETTLED)
    {
      way_ = way;
      moved_ = beyond_ = mean_ = 0.0;
      return;
    }
    constexpr double ROWS = 4.0;  // fewest rows in the window of the rates
    const double smeared = std::max(0.0, ROWS * step - 2.0 * MotionDifferentiator::HALF_WIDTH);
    Usual& usual = usual_[way > 0 ? 1 : 0];
    const double bound =
        OF_FRICTION * std::abs(friction_torque) + OF_LOAD * std::abs(sample.load) + OF_LARGEST * largest_load_;
    const double difference = residual_torque - usual.torque;
    moved_ += step;
    mean_ += (moved_ > step ? 1.0 - std::exp(-step / MEAN) : 1.0) * (difference - mean_);
    usual.time += step;
    const bool is_known = usual.time > KNOWN;
    usual.torque += std::min(1.0, step / std::min(MEMORY, usual.time)) *
                    (is_known ? std::clamp(difference, -bound, bound) : difference);
    beyond_ = std::abs(mean_) > bound && moved_ > SETTLED + smeared && is_known ? beyond_ + step : 0.0;
    if (beyond_ > LASTING + smeared)
    {
      if (!isRecent())
      {
        contact_ = { sample.time - beyond_, 0.0, 0.0 };
      }
      contact_.lasted += step;
      contact_.largest = std::max(contact_.largest, std::abs(mean_));
      largest_ = contact_.largest >= largest_.largest ? contact_ : largest_;
      touched_ += step;
      last_ = sample.time;
    }
  }

  bool hasSeen() const noexcept
  {
    constexpr double OFTEN = 0.2;  // share of the motion
    return touched_ > 0.0 && touched_ < OFTEN * (usual_[0].time + usual_[1].time);
  }
  bool isTouching() const noexcept { return hasSeen() && time_ == last_; }  ///< now
  /// Now, or less than HOLD ago.
  bool isRecent() const noexcept { return hasSeen() && time_ - last_ < HOLD; }
  const Contact& last() const noexcept { return contact_; }     ///< the last one
  const Contact& largest() const noexcept { return largest_; }  ///< that with the largest torque

private:
  struct Usual
  {
    double torque{};  // residual [N.m]
    double time{};    // of motion [s]
  };

  double largest_load_;
  double time_{};
  int way_{};                                                // +1, -1; 0: at rest
  double moved_{};                                           // that way [s]
  double mean_{};                                            // of the difference [N.m]
  double beyond_{};                                          // how long [s]
  std::array<Usual, 2> usual_{};                             // by direction
  double last_{ -std::numeric_limits<double>::infinity() };  // when something touched it [s]
  double touched_{};                                         // in all [s]
  Contact contact_;
  Contact largest_;
};

/// A clause for people.
inline std::string contactText(const Contact& contact)
{
  return "something touched the arm, or its payload changed: at " + roundedText(contact.since, 3) + " s and " +
         roundedText(contact.lasted, 2) + " s long, up to " + roundedText(contact.largest, 2) +
         " N.m beyond what this motion usually takes";
}
}  // namespace hjt
