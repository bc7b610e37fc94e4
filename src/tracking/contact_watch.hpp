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
/// What touched a joint's side of the arm.
struct Contact
{
  double since{};    ///< when it was first seen [s]
  double lasted{};   ///< without pauses shorter than ContactWatch::HOLD [s]
  double largest{};  ///< torque at the joint beyond the usual, magnitude [N.m]
};

/// Something that touches the arm: a torque that the joint's motion does not usually take, for a short time. What stays
/// becomes the usual, and what comes more often than a fifth of the time is no contact: friction, gain and payload.
///
/// While it moves: the mean residual over MEAN must differ from the usual one of that direction by more than half of
/// the friction, 5 % of the load and 2 % of the largest load together, for 0.1 s. At rest: it must be beyond what
/// stiction can hold either way by more than the friction, 5 % of the load and 2 % of the largest load together, for
/// 0.5 s, since a start that has not broken away takes up to 0.3 s. Fixed memory; nothing allocates or throws.
class ContactWatch
{
public:
  static constexpr double MEMORY = 10.0;  ///< of motion one way, in which the usual follows [s]
  static constexpr double HOLD = 10.0;    ///< after a contact, in which nothing is judged [s]

  explicit ContactWatch(double largest_load) : largest_load_(largest_load) {}  ///< [N.m]

  void reset() noexcept { *this = ContactWatch(largest_load_); }

  /// `residual_torque`: measured less predicted, at the joint [N.m]; `held_torque`: by which stiction may change it, 0:
  /// it slides [N.m]; `friction_limit`: the most that it could be [N.m].
  void update(const MotionSample& sample, double residual_torque, double friction_torque, double held_torque,
              double friction_limit) noexcept
  {
    constexpr double MOVING = 0.02;  // beyond the noise of a slope [rad/s]
    constexpr double MEAN = 0.1;     // [s]
    constexpr double SETTLED = 0.3;  // of motion one way: presliding and the controller's start are over [s]
    constexpr double KNOWN = 2.0;    // of motion one way, before which nothing is usual [s]
    constexpr double OF_FRICTION = 0.5;
    constexpr double OF_LOAD = 0.05;
    constexpr double OF_LARGEST = 0.02;
    constexpr double LASTING = 0.1;          // [s]
    constexpr double LASTING_AT_REST = 0.5;  // [s]
    const double step = sample.after_gap ? 0.0 : std::max(0.0, sample.time - time_);
    time_ = sample.time;
    const bool is_held = held_torque > 0.0;
    const int way = std::abs(sample.velocity) > MOVING && !is_held ? (sample.velocity > 0.0 ? 1 : -1) : 0;
    const double share = OF_LOAD * std::abs(sample.load) + OF_LARGEST * largest_load_;
    if (way != way_ || step <= 0.0 || step > SETTLED)
    {
      way_ = way;
      moved_ = beyond_ = mean_ = 0.0;
      return;
    }
    moved_ += step;
    const double follow = moved_ > step ? 1.0 - std::exp(-step / MEAN) : 1.0;
    if (way == 0)
    {
      mean_ += follow * (residual_torque - mean_);
      resting_.time += step;
      see(sample.time, step, std::abs(mean_) > held_torque + friction_limit + share && moved_ > SETTLED,
          LASTING_AT_REST, resting_);
      return;
    }
    Usual& usual = usual_[way > 0 ? 1 : 0];
    const double bound = OF_FRICTION * std::abs(friction_torque) + share;
    const double difference = residual_torque - usual.torque;
    mean_ += follow * (difference - mean_);
    usual.time += step;
    moving_.time += step;
    const bool is_known = usual.time > KNOWN;
    usual.torque += std::min(1.0, step / std::min(MEMORY, usual.time)) *
                    (is_known ? std::clamp(difference, -bound, bound) : difference);
    see(sample.time, step, std::abs(mean_) > bound && moved_ > SETTLED && is_known, LASTING, moving_);
  }

  bool hasSeen() const noexcept { return moving_.hasSeen() || resting_.hasSeen(); }
  /// Now, or less than HOLD ago.
  bool isRecent() const noexcept
  {
    return (moving_.hasSeen() && time_ - moving_.last < HOLD) || (resting_.hasSeen() && time_ - resting_.last < HOLD);
  }
  const Contact& last() const noexcept { return contact_; }     ///< the last one
  const Contact& largest() const noexcept { return largest_; }  ///< that with the largest torque

private:
  struct Usual
  {
    double torque{};  // residual [N.m]
    double time{};    // of motion [s]
  };

  /// In motion or at rest.
  struct Seen
  {
    double time{};                                            // so far [s]
    double touched{};                                         // of it [s]
    double last{ -std::numeric_limits<double>::infinity() };  // when something touched it [s]

    bool hasSeen() const noexcept
    {
      constexpr double OFTEN = 0.2;  // share of the time
      return touched > 0.0 && touched < OFTEN * time;
    }
  };

  void see(double time, double step, bool is_beyond, double lasting, Seen& seen) noexcept
  {
    beyond_ = is_beyond ? beyond_ + step : 0.0;
    if (beyond_ > lasting)
    {
      if (!isRecent())
      {
        contact_ = { time - beyond_, 0.0, 0.0 };
      }
      contact_.lasted += step;
      contact_.largest = std::max(contact_.largest, std::abs(mean_));
      largest_ = contact_.largest >= largest_.largest ? contact_ : largest_;
      seen.touched += step;
      seen.last = time;
    }
  }

  double largest_load_;
  double time_{};
  int way_{};                     // +1, -1; 0: at rest
  double moved_{};                // that way [s]
  double mean_{};                 // of the difference [N.m]
  double beyond_{};               // how long [s]
  std::array<Usual, 2> usual_{};  // by direction
  Seen moving_;
  Seen resting_;
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
