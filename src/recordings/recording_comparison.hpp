// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gear/angle.hpp"
#include "output/report.hpp"
#include "recordings/compare.hpp"

namespace hjt
{
/// Keeps every nth row of a stream. Of a long stream, n is such that MAX_ROWS / 2 to MAX_ROWS rows remain.
template <class Row>
class Decimated
{
public:
  static constexpr std::size_t MAX_ROWS = 16000;

  void add(const Row& row)
  {
    if (seen_++ % stride_ == 0)
    {
      rows_.push_back(row);
      if (rows_.size() == MAX_ROWS)
      {
        halve();
      }
    }
  }

  const std::vector<Row>& rows() const { return rows_; }

private:
  void halve()
  {
    for (std::size_t i = 0; i < MAX_ROWS / 2; ++i)
    {
      rows_[i] = rows_[2 * i];
    }
    rows_.resize(MAX_ROWS / 2);
    stride_ *= 2;
  }

  std::vector<Row> rows_;
  std::uint64_t seen_{};
  std::uint64_t stride_{ 1 };
};

/// Amplitudes of one order, for motion forward and backward.
struct SpectrumLine
{
  double order{};  ///< cycles per turn of the motor [-]
  double forward{};
  double backward{};
};

/// Spectrum of the part of a residual that repeats with the joint's angle, over orders of the motor's turn.
///
/// The residual is averaged in narrow bins of the joint's angle, for each direction of motion. Therefore memory does
/// not grow, rows may come at uneven times, and parts that do not repeat with the angle average out. The amplitude at
/// order o is |2 / n sum r exp(-i o theta)| over the n visited bins, with r the mean residual and theta the angle of a
/// bin. If the visited bins do not fill a turn of the joint, neighbouring orders leak into each other.
class ResidualSpectrum
{
public:
  static constexpr double MAX_ORDER = 16.0;

  explicit ResidualSpectrum(double ratio) : ratio_(ratio)
  {
    bins_.fill(std::vector<Bin>(static_cast<std::size_t>(BINS_PER_MOTOR_TURN * std::ceil(ratio))));
  }

  /// Adds a residual at an angle [rad] and a speed [rad/s] of the joint.
  void add(double angle, double speed, double residual)
  {
    std::vector<Bin>& bins = bins_[speed < 0.0 ? 0 : 1];
    const double turns = angle / TWO_PI;
    const double part = turns - std::floor(turns);
    Bin& bin = bins[static_cast<std::size_t>(part * static_cast<double>(bins.size())) % bins.size()];
    bin.sum += residual;
    bin.rows += 1.0;
  }

  /// Lines at every whole order of the joint's turn. Amplitudes have the unit of the residual. Empty if the joint moved
  /// less than one turn of the motor.
  std::vector<SpectrumLine> lines() const
  {
    const int highest = static_cast<int>(MAX_ORDER * ratio_);
    std::array<std::vector<double>, 2> found;
    bool any = false;
    for (std::size_t way = 0; way < 2; ++way)
    {
      const std::vector<Bin>& bins = bins_[way];
      std::vector<Place> places;
      double mean = 0.0;
      for (std::size_t i = 0; i < bins.size(); ++i)
      {
        if (bins[i].rows > 0.0)
        {
          const double angle = TWO_PI * (static_cast<double>(i) + 0.5) / static_cast<double>(bins.size());
          places.push_back({ angle, bins[i].sum / bins[i].rows });
          mean += places.back().residual;
        }
      }
      for (Place& place : places)
      {
        place.residual -= mean / static_cast<double>(places.size());
      }
      if (places.size() < BINS_PER_MOTOR_TURN)
      {
        places.clear();
      }
      any = any || !places.empty();
      found[way] = amplitudes(places, highest);
    }
    std::vector<SpectrumLine> lines;
    for (int order = 1; any && order <= highest; ++order)
    {
      const auto i = static_cast<std::size_t>(order - 1);
      lines.push_back({ order / ratio_, found[1][i], found[0][i] });
    }
    return lines;
  }

private:
  /// Mean residual at one angle of the joint.
  struct Place
  {
    double angle;
    double residual;
  };

  /// Amplitudes of the orders 1 to `highest` of the joint's turn. From order to order, each phasor turns by its angle.
  static std::vector<double> amplitudes(const std::vector<Place>& places, int highest)
  {
    using Phasor = std::complex<double>;
    std::vector<Phasor> phasors;
    std::vector<Phasor> steps;
    for (const Place& place : places)
    {
      phasors.emplace_back(place.residual);
      steps.push_back(std::polar(1.0, -place.angle));
    }
    std::vector<double> result;
    for (int order = 1; order <= highest; ++order)
    {
      Phasor sum;
      for (std::size_t i = 0; i < phasors.size(); ++i)
      {
        phasors[i] *= steps[i];
        sum += phasors[i];
      }
      result.push_back(phasors.empty() ? 0.0 : 2.0 * std::abs(sum) / static_cast<double>(phasors.size()));
    }
    return result;
  }

  static constexpr int BINS_PER_MOTOR_TURN = 128;
  struct Bin
  {
    double sum{};
    double rows{};
  };

  double ratio_;
  std::array<std::vector<Bin>, 2> bins_;  // bins over one turn of the joint: backward, forward
};

/// Measured and predicted values of one row.
struct ComparedRow
{
  MotionSample measured;
  MotionPrediction predicted;

  double residual() const { return measured.current - predicted.current; }  ///< measured less predicted current [A]
};

/// A recorded joint and the twin that makes the same motion, with the data for the verdict and for the page. Memory
/// does not grow with the rows.
class RecordingComparison : public AssessedJoint
{
public:
  /// `recording` must live as long as this object. `directory`: directory of the joint's report; empty: no file is
  /// written. `sound` comes from earlier reports. @throws ParameterError if the ring has no equilibrium under load,
  /// InputError.
  RecordingComparison(const ArmRecording& recording, std::size_t joint, const std::string& directory, SoundJoint sound);

  JointEvidence::Row update(const MotionSample& sample) override;

  /// Judges the joint, and writes COMPARISON_FILE, BASELINE_FILE and CSV tables: course, friction, friction_twin,
  /// spectrum, teeth and health; if the recording has the data, also torsion, torsion_twin and twin_states. Solves the
  /// ring under the loads of the recording. @throws InputError if a file cannot be written.
  ComparedJoint write(const MotionFindings& found, const JointContext& context);

private:
  void writeData(const MotionFindings& found) const;
  void writeFriction() const;
  void writeTorsion() const;
  void writeTeeth() const;
  void writeTwinStates(double start) const;
  Json documentOf(const MotionFindings& found, const ComparedJoint& compared) const;

  const Parameters& parameters() const { return recording_.parameters(joint_); }
  std::string file(const char* name) const { return directory_ + "/" + name; }

  const ArmRecording& recording_;
  const std::size_t joint_;
  const std::string directory_;
  const std::string twin_topic_;                    // topic of a twin that ran beside the robot
  std::optional<TableFile<JudgedWindow>> windows_;  // table of the signals' windows; none without a report
  Decimated<ComparedRow> course_;
  ResidualSpectrum spectrum_;
};

/// The fields of Verdict.msg as JSON, with level and reason as names.
Json verdictFields(const Verdict& verdict);

constexpr const char* MADE_WITH = "joint_twin " HJT_VERSION;
}  // namespace hjt
