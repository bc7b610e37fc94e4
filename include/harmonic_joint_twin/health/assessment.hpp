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

/// One indicator that deviates from its reference.
struct Evidence
{
  std::size_t indicator{};
  double value{};     ///< value of the indicator in the window, in the indicator's unit
  double expected{};  ///< mean of the indicator for a sound drive at the window's operating point, in its unit
  double score{};     ///< deviation of `value` from `expected` as a score, that is, as a normal deviate [-]
};

/// Possible cause of an alarm, less probable than Assessment::cause.
struct Alternative
{
  Cause cause{};
  double confidence{};          ///< probability of the cause [-]
  double severity{};            ///< mean severity of the fault, if this fault is the cause; 0 for NONE [-]
  double severity_deviation{};  ///< standard deviation of the severity [-]
};

/// State of the drive according to its indicators.
struct Assessment
{
  static constexpr std::size_t MAX_EVIDENCE = 3;
  static constexpr std::size_t MAX_ALTERNATIVES = 3;
  static constexpr double SET = 0.9;  ///< sum of the causes' probabilities at which the list of alternatives ends [-]

  std::int64_t stamp{};     ///< end of the last window [ns]
  std::uint64_t windows{};  ///< number of windows completed since the start or the last reset
  AssessmentState state{};
  int windows_here{};    ///< windows compared at the last operating point or, if none was, windows of its reference
  int windows_needed{};  ///< windows that a verdict needs or, in LEARNING and NO_REFERENCE, that the reference needs
  HealthLevel level{};
  Cause cause{};                ///< most likely cause; NONE at level OK, or if no known fault explains the deviation
  bool shows_play{};            ///< whether the lost motion was compared, which needs loads of both signs
  Cause pattern{};              ///< cause with the largest pattern score; NONE if an indicator's score is larger
  double confidence{};          ///< probability of `cause`; 0 at level OK [-]
  double severity{};            ///< mean severity of the fault `cause`; 0 if `cause` is NONE [-]
  double severity_deviation{};  ///< standard deviation of `severity` [-]
  double largest_score{};       ///< largest score of the last windows' mean, divided by its threshold; > 1: alarm [-]
  std::size_t alternative_count{};
  /// next most likely causes, most likely first, until their probabilities and that of `cause` add up to SET
  std::array<Alternative, MAX_ALTERNATIVES> alternatives;
  std::size_t evidence_count{};
  /// indicators beyond the threshold, largest score first; in an alarm at least the indicator with the largest score
  std::array<Evidence, MAX_EVIDENCE> evidence;
};

/// Reason why the last window has no verdict, as a clause; empty if the window has a verdict.
std::string whyNotJudged(const Assessment& assessment);

/// Derives a verdict from windows: level, most likely cause and evidence. Only the constructor allocates.
///
/// The assessor judges the mean of the last windows of an operating point (Baseline). The mean shows WARN if the score
/// of an indicator or of a cause's pattern is beyond the baseline's threshold. The mean shows ERROR if a deviation is
/// more than indicators.error_factor times the deviation at the threshold. The level rises after three means in a row
/// with a higher level, each of at least three windows. The level falls after three means in a row with a lower level,
/// at the operating point that last showed the level. The level OK is a verdict only after three means. If
/// indicators.evidence_windows is below three, it replaces three in these rules. The last verdict stands while the
/// operating point has no reference, or no reference with a similar payload.
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

  /// Judges a complete window. `model`: indicators of the twin that were subtracted from the window; null: none.
  const Assessment& update(const SignalIndicators& indicators, const SignalIndicators* model = nullptr) noexcept;

  /// `begin` and `advance` do the work of `update` in parts, for a real-time loop. `begin` judges a window. Each call
  /// of `advance` searches up to `signatures` signatures for the cause. After the last one `assessment` is complete.
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
  /// Number of signatures that `advance` must search for one window.
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
  Assessment assessment_;  // assessment of the last window, without a cause during the search
  Assessment settled_;     // assessment of the last window whose search is finished
  CausePatterns patterns_;
  CauseSearch cause_search_;
  OperatingPoint point_;  // operating point of the window whose cause is being searched
  bool is_searching_{};
  OperatingBin shown_in_;  // class of operating points that showed the present level last
  int worse_{};            // number of means in a row that show a higher level than the present level
  int better_{};           // number of means in a row that show a lower level than the present level
  HealthLevel least_worse_{};
  HealthLevel most_better_{};
};
}  // namespace hjt
