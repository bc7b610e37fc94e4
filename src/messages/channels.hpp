// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <tuple>
#include <utility>

#include "base/publish_period.hpp"
#include "messages/conversions.hpp"
#include "messages/time.hpp"
#include "messages/topics.hpp"

namespace hjt
{
/// One topic that the twin puts out at a fixed rate. The node, the recorder and the diagnostics go over CHANNELS: a new
/// topic needs a row there and its fill function.
template <class MessageType>
struct Channel
{
  using Message = MessageType;

  const char* name;                    ///< of the topic; the diagnostics count under it
  double PublishParameters::*rate;     ///< [Hz]; divides solver.rate
  std::size_t slots;                   ///< messages that may wait for the publisher's thread
  Message (*make)(const Parameters&);  ///< with names and arrays in place
  /// Fills the message at the twin's current instant. No allocation, no throw. False: there is nothing to publish.
  bool (*fill)(Twin&, const SinceMessage&, Message&);
  bool of_signals{};  ///< filled only while the twin watches its signals
  bool summarises{};  ///< `fill` gets the spans of the signals since the last message
};

/// Slots for messages of a few numbers: seconds of joint states at 1 kHz.
constexpr std::size_t SMALL_MESSAGE_SLOTS = 4096;
/// Slots for messages with arrays.
constexpr std::size_t LARGE_MESSAGE_SLOTS = 256;

/// All channels, in the order in which the messages of one instant go out.
inline constexpr auto CHANNELS = std::make_tuple(
    Channel<sensor_msgs::JointState>{ topics::JOINT_STATES, &PublishParameters::joint_states_rate, SMALL_MESSAGE_SLOTS,
                                      makeJointStates, fillJointStates },
    Channel<harmonic_joint_twin::Encoders>{ topics::ENCODERS, &PublishParameters::encoders_rate, SMALL_MESSAGE_SLOTS,
                                            makeMessage<harmonic_joint_twin::Encoders>, fillEncoders },
    Channel<harmonic_joint_twin::ContactForces>{ topics::CONTACT_FORCES, &PublishParameters::contact_forces_rate,
                                                 LARGE_MESSAGE_SLOTS, makeContactForces, fillContactForces },
    Channel<harmonic_joint_twin::Health>{ topics::HEALTH, &PublishParameters::health_rate, SMALL_MESSAGE_SLOTS,
                                          makeMessage<harmonic_joint_twin::Health>, fillHealth, false, true },
    Channel<harmonic_joint_twin::Stress>{ topics::STRESS, &PublishParameters::stress_rate, LARGE_MESSAGE_SLOTS,
                                          makeStress, fillStress },
    Channel<harmonic_joint_twin::Indicators>{ topics::INDICATORS, &PublishParameters::indicators_rate,
                                              LARGE_MESSAGE_SLOTS, makeIndicators, fillIndicators, true },
    Channel<harmonic_joint_twin::Assessment>{ topics::ASSESSMENT, &PublishParameters::indicators_rate,
                                              LARGE_MESSAGE_SLOTS, makeAssessment, fillAssessment, true });

constexpr std::size_t CHANNEL_COUNT = std::tuple_size_v<decltype(CHANNELS)>;

/// All channels of one twin, each with a `Sink<Message>` that its messages go to. A topic is due when the instant is a
/// whole multiple of its publishPeriod, counted from the epoch and not from the start: the same input gives messages at
/// the same instants however it was cut, live, replayed or offline.
///
/// A sink is constructed from (context, channel, first message) and has `bool isWanted()` and `write(fill)`, which
/// calls `bool fill(Message&)` with the message to be filled and drops it if that returns false.
template <template <class> class Sink>
class Outputs
{
public:
  template <class Context>
  Outputs(const Context& context, const Parameters& parameters)
    : outputs_(std::apply(
          [&](const auto&... channel) {
            return Tuple(Setup<Context, std::decay_t<decltype(channel)>>{ context, parameters, channel }...);
          },
          CHANNELS))
  {
  }

  /// To be called after every step of the twin: fills the messages that are due and wanted.
  void offer(Twin& twin)
  {
    forEach(
        [&twin](auto& output)
        {
          const auto& channel = output.channel;
          if (!output.sink.isWanted())
          {
            if (channel.summarises)
            {
              output.since = { output.since.stamp };
            }
            return;
          }
          if (channel.summarises)
          {
            output.since.add(twin);
          }
          if (twin.stamp() % output.period == 0 && (!channel.of_signals || twin.watchesSignals()))
          {
            output.sink.write(
                [&](auto& message)
                {
                  const SinceMessage since = std::exchange(output.since, SinceMessage(twin.stamp()));
                  return channel.fill(twin, since, message);
                });
          }
        });
  }

  /// The next instant after this one at which a message is due and wanted [ns].
  Stamp nextDue(Stamp instant) const noexcept
  {
    Stamp next = std::numeric_limits<Stamp>::max() / 2;
    const auto look = [&](const auto& output)
    { next = output.sink.isWanted() ? std::min(next, (instant / output.period + 1) * output.period) : next; };
    std::apply([&](const auto&... output) { (look(output), ...); }, outputs_);
    return next;
  }

  template <class Visit>
  void forEachSink(Visit&& visit)
  {
    forEach([&visit](auto& output) { visit(output.sink); });
  }

  /// Results of `get` for each channel and its sink.
  template <class Get>
  auto collect(Get&& get) const
  {
    return std::apply([&get](const auto&... output) { return std::array{ get(output.channel, output.sink)... }; },
                      outputs_);
  }

private:
  template <class Context, class Row>
  struct Setup
  {
    const Context& context;
    const Parameters& parameters;
    const Row& channel;
  };

  template <class Row>
  struct Output
  {
    template <class Context>
    explicit Output(const Setup<Context, Row>& setup)
      : channel(setup.channel)
      , period(publishPeriod(setup.parameters.publish.*setup.channel.rate, setup.parameters.solver.rate))
      , sink(setup.context, setup.channel, setup.channel.make(setup.parameters))
    {
    }

    Row channel;
    Stamp period;  // [ns]
    SinceMessage since;
    Sink<typename Row::Message> sink;
  };

  template <class Rows>
  struct TupleOf;
  template <class... Row>
  struct TupleOf<const std::tuple<Row...>>
  {
    using Type = std::tuple<Output<Row>...>;
  };
  using Tuple = typename TupleOf<decltype(CHANNELS)>::Type;

  template <class Visit>
  void forEach(Visit&& visit)
  {
    std::apply([&visit](auto&... output) { (visit(output), ...); }, outputs_);
  }

  Tuple outputs_;
};
}  // namespace hjt
