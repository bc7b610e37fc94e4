// SPDX-License-Identifier: BSD-3-Clause
// Stiffness and lost motion from a joint's own signals do not depend on how the joint moves.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include <gmock/gmock.h>

#include "gear/angle.hpp"
#include "gear/ratio.hpp"
#include "harmonic_joint_twin/statics/torsion_loop.hpp"
#include "harmonic_joint_twin/twin/twin.hpp"
#include "test/support/seeded_random.hpp"
#include "test_parameters.hpp"

namespace hjt
{
namespace
{
constexpr double WINDOW = 20.0;           // [s]
constexpr double SLOPE = 300.0 * DEGREE;  // of a trapezoid [rad/s^2]

/// Angle, speed and acceleration of the joint [rad], [rad/s], [rad/s^2].
using State = std::array<double, 3>;
using Motion = std::function<State(double time)>;

/// From one angle to another and a pause.
struct Move
{
  double start;     // [s]
  double duration;  // [s]
  double from;      // [rad]
  double to;        // [rad]
};

State quintic(const Move& move, double time)
{
  const double s = std::clamp((time - move.start) / move.duration, 0.0, 1.0);
  const double way = move.to - move.from;
  return { move.from + way * s * s * s * (10.0 - 15.0 * s + 6.0 * s * s),
           way / move.duration * 30.0 * s * s * (1.0 - s) * (1.0 - s),
           way / (move.duration * move.duration) * 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s) };
}

State trapezoid(const Move& move, double time)
{
  const double way = std::abs(move.to - move.from);
  const double sign = std::copysign(1.0, move.to - move.from);
  const double root = SLOPE * SLOPE * move.duration * move.duration - 4.0 * SLOPE * way;
  const double peak = 0.5 * (SLOPE * move.duration - std::sqrt(root));
  const double rise = peak / SLOPE;
  const double t = std::clamp(time - move.start, 0.0, move.duration);
  const double left = move.duration - t;
  if (t < rise)
  {
    return { move.from + sign * 0.5 * SLOPE * t * t, sign * SLOPE * t, time < move.start ? 0.0 : sign * SLOPE };
  }
  if (left < rise)
  {
    return { move.to - sign * 0.5 * SLOPE * left * left, sign * SLOPE * left,
             time > move.start + move.duration ? 0.0 : -sign * SLOPE };
  }
  return { move.from + sign * peak * (t - 0.5 * rise), sign * peak, 0.0 };
}

/// `next`: angle to go to [rad]; mean speed [rad/s] of each move, pause after it [s].
template <typename Next>
Motion moves(State (*profile)(const Move&, double), double speed, double pause, Next next)
{
  std::vector<Move> list;
  for (double time = 0.5, from = 0.0; time < 3.0 * WINDOW; time += list.back().duration + pause)
  {
    const double to = next(list.size());
    const double way = std::abs(to - from);
    list.push_back({ time, std::max({ way / speed, 2.1 * std::sqrt(way / SLOPE), 0.4 }), from, to });
    from = to;
  }
  return [=](double time)
  {
    const auto after = std::find_if(list.begin() + 1, list.end(), [&](const Move& move) { return move.start > time; });
    return profile(*(after - 1), time);
  };
}

Motion slow()
{
  return moves(trapezoid, 12.0 * DEGREE, 0.2, [](std::size_t i) { return (i % 2 == 0 ? 30.0 : -30.0) * DEGREE; });
}

/// Three places, a pause at each.
Motion handling(State (*profile)(const Move&, double))
{
  return moves(profile, 55.0 * DEGREE, 0.3,
               [](std::size_t i) {
                 return std::array{ -50.0, 35.0, -20.0 }[i % 3] * DEGREE;
               });
}

Motion randomPoints(State (*profile)(const Move&, double), unsigned seed)
{
  SeededRandom random(seed);
  return moves(profile, 45.0 * DEGREE, 0.0,
               [&](std::size_t i)
               {
                 const double size = 10.0 + 45.0 * static_cast<double>(random() % 1000) / 1000.0;
                 return (i % 2 == 0 ? size : -size) * DEGREE;
               });
}

Motion sine()
{
  return [](double time)
  {
    constexpr double RATE = TWO_PI * 0.22;
    constexpr double SIZE = 40.0 * DEGREE;
    const double begun = 1.0 - std::exp(-time * time / 2.0);
    const double growth = time * std::exp(-time * time / 2.0);
    const double curve = (1.0 - time * time) * std::exp(-time * time / 2.0);
    const double angle = SIZE * std::sin(RATE * time);
    const double speed = SIZE * RATE * std::cos(RATE * time);
    return State{ begun * angle, begun * speed + growth * angle,
                  -RATE * RATE * begun * angle + 2.0 * growth * speed + curve * angle };
  };
}

struct Torsion
{
  double first;        // K1 [N.m/rad]
  double second;       // K2 [N.m/rad]
  double lost_motion;  // [rad]
  double hysteresis;   // [rad]
};

/// Of the second window of a UR5's shoulder, moved by a drive's control on the motor encoder.
Torsion measured(const Motion& motion, std::vector<std::string> edits = {}, bool real_sensors = false)
{
  edits.insert(edits.end(), { "solver.scene=auto", "indicators.window_turns=100000.0",
                              "indicators.window_time=" + std::to_string(WINDOW) });
  std::vector<std::string> overlays{ "joints/shoulder" };
  if (real_sensors)
  {
    overlays.emplace_back("real_sensors");
  }
  Twin twin(shippedParameters(edits, overlays));
  const Parameters& p = twin.parameters();
  const double ratio = nominalRatio(p.gear);
  const double motor = p.motor.rotor_inertia + p.motor.wave_generator_inertia;
  const double inertia = motor + (p.output.circular_spline_inertia + p.output.load_inertia) / (ratio * ratio);
  constexpr double RATE = TWO_PI * 8.0;
  twin.watchSignals(true);
  while (twin.signalIndicators().windows < 2)
  {
    const auto& [angle, speed, acceleration] = motion(1e-9 * static_cast<double>(twin.stamp()));
    const EncoderReadings read = twin.encoders();
    const Stamp next = twin.stamp() + twin.stepLength();
    twin.commandMotorTorque(
        next, inertia * ratio * acceleration + motor * (2.0 * RATE * (ratio * speed - read.motor_velocity) +
                                                        RATE * RATE * (ratio * angle - read.motor_angle)));
    twin.step(next);
  }
  const SignalIndicators& found = twin.signalIndicators();
  return { found[ScalarIndicator::TORSIONAL_STIFFNESS], found[ScalarIndicator::SECOND_STIFFNESS],
           found[ScalarIndicator::LOST_MOTION], found[ScalarIndicator::HYSTERESIS] };
}

struct Kind
{
  std::string name;
  Motion motion;
};

std::ostream& operator<<(std::ostream& stream, const Kind& kind)
{
  return stream << kind.name;
}

using TorsionIn = testing::TestWithParam<Kind>;

/// What is wanted of the indicators: K1 within 3 %, lost motion within 15 % of what the slow motion gives.
TEST_P(TorsionIn, IsThatOfTheSlowMotion)
{
  static const Torsion OF_SLOW = measured(slow());
  const Torsion found = measured(GetParam().motion);
  EXPECT_NEAR(found.first, OF_SLOW.first, 0.03 * OF_SLOW.first);
  EXPECT_NEAR(found.second, OF_SLOW.second, 0.05 * OF_SLOW.second);
  EXPECT_NEAR(found.lost_motion, OF_SLOW.lost_motion, 0.15 * OF_SLOW.lost_motion);
  EXPECT_GT(found.hysteresis, 0.5 * OF_SLOW.hysteresis);
  EXPECT_LT(found.hysteresis, 1.5 * OF_SLOW.hysteresis);
  if (GetParam().name != "sine")
  {
    // Inertia tells the stiffness from the output encoder's eccentricity, which is a fifth of the torsion.
    EXPECT_NEAR(measured(GetParam().motion, {}, true).first, OF_SLOW.first, 0.05 * OF_SLOW.first);
  }
}

INSTANTIATE_TEST_SUITE_P(Motions, TorsionIn,
                         testing::Values(Kind{ "trapezoid", handling(trapezoid) }, Kind{ "quintic", handling(quintic) },
                                         Kind{ "via_points", randomPoints(quintic, 3) },
                                         Kind{ "via_points_again", randomPoints(quintic, 4) }, Kind{ "sine", sine() }),
                         [](const auto& kind) { return kind.param.name; });

/// Weight and eccentricity go alike there, so that K1 has both. The difference of two compliances has neither.
TEST(Torsion, OfASlowMotionSoftensByAsMuchWithAnEccentricEncoder)
{
  const std::vector<std::string> soft{ "cup.torsion_stiffness=[29.9e+3, 50.5e+3, 58.7e+3]" };
  const Torsion ideal = measured(slow());
  const Torsion ideal_soft = measured(slow(), soft);
  const Torsion real = measured(slow(), {}, true);
  const Torsion real_soft = measured(slow(), soft, true);
  ASSERT_LT(real.first, 0.9 * ideal.first);
  const double first = 1.0 / ideal_soft.first - 1.0 / ideal.first;
  const double second = 1.0 / ideal_soft.second - 1.0 / ideal.second;
  EXPECT_NEAR(1.0 / real_soft.first - 1.0 / real.first, first, 0.1 * first);
  EXPECT_NEAR(1.0 / real_soft.second - 1.0 / real.second, second, 0.1 * second);
}

/// With flanks worn by 1 and 11 um.
TEST(Torsion, OfWornTeethIsTheCataloguesLostMotion)
{
  const Torsion sound = measured(slow());
  for (const char* clearance : { "mesh.flank_clearance=0.0", "mesh.flank_clearance=10.0e-6" })
  {
    const Torsion found = measured(slow(), { clearance });
    const Parameters parameters = shippedParameters({ clearance }, { "joints/shoulder" });
    const double load = parameters.indicators.lost_motion_torque;
    const TorsionLoop loop = analyseTorsionLoop(parameters, parameters.life.rated_torque, load, 200);
    EXPECT_NEAR(found.lost_motion, loop.lost_motion, 0.15 * loop.lost_motion) << clearance;
    EXPECT_GT(found.lost_motion, 1.2 * sound.lost_motion) << clearance;
    EXPECT_NEAR(found.second, sound.second, 0.05 * sound.second) << clearance;
  }
}
}  // namespace
}  // namespace hjt
