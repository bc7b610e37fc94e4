// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "harmonic_joint_twin/health/baseline.hpp"
#include "harmonic_joint_twin/health/fault_signatures.hpp"

namespace hjt
{
/// Level of the drive's health, with the values of diagnostic_msgs/DiagnosticStatus.
enum class HealthLevel : std::uint8_t
{
  OK = 0,
  WARN = 1,
  ERROR = 2
};

const char* levelName(HealthLevel level) noexcept;  ///< name of a level, for example "WARN"

/// One indicator that departs from its reference.
struct Evidence
{
  std::size_t indicator{};
  double value{};     ///< value of the indicator in its unit
  double expected{};  ///< mean of a sound drive at this operating point, in the indicator's unit
  double score{};     ///< normal score of the deviation from `expected` [-]
};

/// Another cause that would have a similar effect.
struct Alternative
{
  Cause cause{};
  double confidence{};          ///< probability of the cause [-]
  double severity{};            ///< mean severity of the fault, if this is the cause; 0 with NONE [-]
  double severity_deviation{};  ///< standard deviation of that severity [-]
};

/// State of the drive according to its indicators.
struct Assessment
{
  static constexpr std::size_t MAX_EVIDENCE = 3;
  static constexpr std::size_t MAX_ALTERNATIVES = 3;
  static constexpr double SET = 0.9;  ///< least probability of cause and alternatives together [-]

  std::int64_t stamp{};     ///< end of the last window [ns]
  std::uint64_t windows{};  ///< number of completed windows
  AssessmentState state{};
  int windows_here{};    ///< windows at the last operating point: those compared, or those in the reference
  int windows_needed{};  ///< windows that a reference or a verdict takes
  HealthLevel level{};
  Cause cause{};                ///< the most likely; NONE at level OK, or if no known fault explains the departure
  bool shows_play{};            ///< the lost motion of the last window was compared: its load had both signs
  Cause pattern{};              ///< cause with the pattern of the largest score; NONE: an indicator has a larger score
  double confidence{};          ///< probability of the cause, 0 at level OK [-]
  double severity{};            ///< mean severity of the fault, if this is the cause; 0 with NONE [-]
  double severity_deviation{};  ///< standard deviation of that [-]
  double largest_score{};       ///< largest score of the last windows' mean, over the threshold; > 1: alarm [-]
  std::size_t alternative_count{};
  /// most likely first; with the cause they reach the probability SET
  std::array<Alternative, MAX_ALTERNATIVES> alternatives;
  std::size_t evidence_count{};
  /// indicators beyond the threshold, strongest first; at least one in an alarm
  std::array<Evidence, MAX_EVIDENCE> evidence;
};

/// Reason why the last window has no verdict, as a clause; empty if it has a verdict.
std::string whyNotJudged(const Assessment& assessment);

/// Makes one verdict of the windows: level, most likely cause and evidence. Memory is fixed.
///
/// The assessor judges the mean of the last windows of an operating point (Baseline). WARN: an indicator or a cause's
/// pattern is beyond the baseline's threshold. ERROR: it is beyond indicators.error_factor times the threshold. The
/// level rises after three such means in a row, each of three windows at least, that show the higher level. It falls
/// after three means that show a lower level at the operating point that last showed the level. If
/// indicators.evidence_windows is below three, that number takes the place of three. Until so many means could have
/// shown another level, OK is no verdict. The last verdict stands while the operating point has no reference, or none
/// with the payload.
class Assessor
{
public:
  /// @throws ParameterError if the file of indicators.signatures is invalid (loadSignatures).
  explicit Assessor(const Parameters& parameters);

  void reset() noexcept;
  void setReference(std::vector<ReferenceBin> bins, bool carried = false)
  {
    baseline_.setReference(std::move(bins), carried);
  }

  /// Takes a complete window. `model`: indicators of a model that were subtracted from it.
  const Assessment& update(const SignalIndicators& indicators, const SignalIndicators* model = nullptr) noexcept;

  /// The function update in parts, for a loop: after `begin`, each call of `advance` goes through so many signatures
  /// more in search of the cause. Once all are done, the assessment is that of the new window.
  void begin(const SignalIndicators& indicators, const SignalIndicators* model = nullptr) noexcept;
  void advance(std::size_t signatures) noexcept
  {
    if (is_searching_)
    {
      search(signatures);
    }
  }

  const Assessment& assessment() const noexcept { return settled_; }
  const Baseline& baseline() const noexcept { return baseline_; }
  const SignatureSet& signatures() const noexcept { return *signatures_; }
  /// Number of steps of a search, for `advance`.
  std::size_t searchLength() const noexcept { return cause_search_.signatures(); }
  const Deviations& deviations() const noexcept { return deviations_; }  ///< deviations of the last window

private:
  void judge(const SignalIndicators& indicators, const SignalIndicators* model) noexcept;
  void search(std::size_t signatures) noexcept;
  void setState(AssessmentState state) noexcept;
  HealthLevel levelOf(const FeatureScores& scores, const OperatingPoint& point) noexcept;
  void updateLevel(HealthLevel level) noexcept;
  void explain(const CausePosterior& posterior) noexcept;
  void listEvidence(const SignalIndicators& indicators, const FeatureScores& scores) noexcept;

  std::shared_ptr<const SignatureSet> signatures_;
  const int least_windows_;
  const double error_factor_;
  Baseline baseline_;
  Deviations deviations_;
  Assessment assessment_;  // of the last window; its cause is missing during the search
  Assessment settled_;     // of the last window, with its cause
  CausePatterns patterns_;
  CauseSearch cause_search_;
  OperatingPoint point_;  // operating point of the window whose cause is being searched
  bool is_searching_{};
  OperatingBin shown_in_;  // class that the level was last seen in
  int worse_{};            // windows in a row that show more than the level
  int better_{};           // windows in a row that show less than the level
  HealthLevel least_worse_{};
  HealthLevel most_better_{};
};
}  // namespace hjt
