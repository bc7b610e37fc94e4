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
/// A topic that the twin publishes at a fixed rate. Node, recorder and diagnostics iterate over CHANNELS. So a new
/// topic needs only a row in CHANNELS and a fill function.
template <class MessageType>
struct Channel
{
  using Message = MessageType;

  const char* name;                    ///< name of the topic in ROS and in the diagnostics
  double PublishParameters::*rate;     ///< rate of the messages [Hz]; divides solver.rate
  std::size_t slots;                   ///< number of messages that can wait for the thread that publishes them
  Message (*make)(const Parameters&);  ///< makes a message with its names and arrays
  /// Fills the message at the twin's present instant, without allocation or exception. @returns false if there is
  /// nothing to publish.
  bool (*fill)(Twin&, const SinceMessage&, Message&);
  bool of_signals{};  ///< whether the twin must watch its signals for this topic
  bool summarises{};  ///< whether `fill` gets the ranges of the signals since the last message
};

/// Slots for messages with a few numbers: enough for four seconds of joint states at 1 kHz.
constexpr std::size_t SMALL_MESSAGE_SLOTS = 4096;
/// Slots for messages with arrays, which take more memory than other messages.
constexpr std::size_t LARGE_MESSAGE_SLOTS = 256;

/// All channels. The messages of an instant are published in this order.
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

/// All channels of one twin, each with a `Sink<Message>` for its messages. A topic is due if the instant, counted from
/// the epoch, is a multiple of its publishPeriod. So equal inputs give messages at equal instants, live, replayed or
/// offline, whenever the program was started.
///
/// A sink is constructed from (context, channel, first message). Its members are `bool isWanted()` and `write(fill)`.
/// `write` calls `bool fill(Message&)` and drops the message if `fill` returns false.
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

  /// The caller calls this function after every step of the twin. It fills the messages that are due and wanted.
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

  /// First instant after `instant` at which a wanted message is due [ns].
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

  /// Calls `get` for each channel with its sink, and returns the results in an array.
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
    Stamp period;  // period of the messages [ns]
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
