// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <boost/random/mersenne_twister.hpp>

#include "life/ageing_laws.hpp"
#include "life/drive_age.hpp"

namespace hjt
{
/// Fatigue strengths at which the fatigue by a use is known, evenly spaced in their logarithm; linear between them.
constexpr std::size_t STRENGTHS = 33;
constexpr double STRENGTH_REACH = 4.0;  // standard deviations below and above the median

/// Of entry i, over the median's.
inline double strengthAt(const LifeParameters& parameters, std::size_t i)
{
  return std::exp(parameters.fatigue_spread * STRENGTH_REACH *
                  (2.0 * static_cast<double>(i) / static_cast<double>(STRENGTHS - 1) - 1.0));
}

/// How much a drive has been used: what the nominal drive would have aged by it.
struct Usage
{
  double flank_wear{};      ///< of the nominal drive [m]
  double interface_wear{};  ///< of the nominal drive [m]
  double bearing_turns{};   ///< [turns at rated torque]
  /// Miner's sums by strength and place: fatigue does not grow in proportion to the nominal drive's.
  std::array<std::array<double, STRESS_PLACES>, STRENGTHS> fatigue{};

  Usage operator-(const Usage& other) const noexcept
  {
    Usage rest{ flank_wear - other.flank_wear, interface_wear - other.interface_wear,
                bearing_turns - other.bearing_turns, fatigue };
    rest.addFatigue(other, -1.0);
    return rest;
  }

  void addFatigue(const Usage& other, double times) noexcept
  {
    for (std::size_t i = 0; i < STRENGTHS; ++i)
    {
      for (std::size_t place = 0; place < STRESS_PLACES; ++place)
      {
        fatigue[i][place] += times * other.fatigue[i][place];
      }
    }
  }
};

/// The use ahead, from now on: entry i after i times `step` hours. The last stretch goes on for ever.
struct FutureLoad
{
  double step{};             ///< [h]
  std::vector<Usage> usage;  ///< from now on, ascending, the first 0; two or more
};

/// What the indicators say of a drive's wear.
struct WearReading
{
  double flank_wear{};        ///< depth, from the lost motion [m]
  double flank_wear_error{};  ///< its standard deviation, > 0 [m]
  double spall{};             ///< size of the bearing's spall, from the lines of the bearing [-]
  double spall_error{};       ///< its standard deviation, > 0 [-]
};

/// Hours of use that are left.
struct RemainingHours
{
  static constexpr std::array<double, 5> SHARES{ 0.05, 0.1, 0.5, 0.9, 0.95 };
  std::array<double, SHARES.size()> quantile{};  ///< by which these shares of the particles have ended [h]
  double ended{};                                ///< share of the particles that has ended already [-]
  /// Shares that end by flank wear, interface wear, bearing, fatigue of tooth space, transition, flange [-]
  std::array<double, 3 + STRESS_PLACES> by_cause{};
};

/// The remaining life as a distribution: a particle filter on what cannot be seen of one drive, its variation.
///
/// A particle is a drive with factors of wear, a life of its bearing and a fatigue strength of its own, drawn from what
/// the literature and the catalogue leave open (log-normal; the Weibull distribution of the bearing's life). Use ages
/// every particle by the same laws; a reading weighs it by how likely it makes what was read. Where few particles carry
/// the weight they are redrawn, with a kernel that keeps mean and variance of the variations (Liu and West 2001).
class RemainingLife
{
public:
  RemainingLife(const LifeParameters& parameters, int particles, std::uint32_t seed);

  /// Ages all particles. Allocates nothing.
  void use(const Usage& usage) noexcept;

  /// Weighs all particles. Allocates nothing.
  void read(const WearReading& reading) noexcept;

  /// The drive is known to be in use still: particles at their end lose their weight, unless all are. Allocates
  /// nothing.
  void survive() noexcept;

  /// The hours until each particle's end, with this use ahead. Allocates nothing.
  RemainingHours remaining(const FutureLoad& future_load) noexcept;

private:
  struct Particle
  {
    std::array<double, 5>
        variation;  // logarithms: flank factor, interface factor, bearing life, spall growth, strength
    double flank_wear;
    double interface_wear;
  };
  static constexpr double MAX_SPALL = 3.0;  // beyond the end of use one is as bad as the other
  bool hasEnded(const Particle& particle) const noexcept;
  static UnitVariation variationOf(const Particle& particle) noexcept;
  double fatigueBy(const Usage& usage, double log_strength, std::size_t place) const noexcept;
  void resample() noexcept;

  LifeParameters parameters_;
  boost::random::mt19937 random_;
  double bearing_turns_{};
  Usage fatigue_;  // so far; its other entries are unused
  std::vector<Particle> particles_;
  std::vector<double> weights_;  // sum 1
  std::vector<Particle> drawn_;  // scratch
  struct End
  {
    double hours;
    double weight;
  };
  std::vector<End> ends_;  // scratch
};
}  // namespace hjt
