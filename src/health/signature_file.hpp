// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "harmonic_joint_twin/health/fault_signatures.hpp"

namespace hjt
{
/// Number of the format of signature files that this software reads and writes.
constexpr int SIGNATURE_FORMAT = 3;

/// A number in the section `errors` of a signature file.
struct SignatureErrorRow
{
  const char* key;
  double SignatureSet::*value;
};
constexpr std::array<SignatureErrorRow, 7> SIGNATURE_ERRORS{ { { "number", &SignatureSet::number_error },
                                                               { "motion", &SignatureSet::motion_error },
                                                               { "line", &SignatureSet::line_error },
                                                               { "weight", &SignatureSet::evidence_weight },
                                                               { "misfit", &SignatureSet::misfit_weight },
                                                               { "severity", &SignatureSet::severity_error },
                                                               { "severity_misfit",
                                                                 &SignatureSet::severity_misfit } } };

/// Index of the indicator for each value of a signature.
std::array<std::size_t, SIGNATURE_SIZE> indicatorsOfNumbers();

/// The signatures of a file; an empty set for NO_FILE. `name`: value of indicators.signatures, an absolute path or a
/// path in the default configuration. All calls for a file return one shared set. The function allocates and reads
/// files, so it is not for the real-time loop.
/// @throws ParameterError with file, line and key if the file is damaged, has another format, or has an indicator or
/// unit that this software does not have.
std::shared_ptr<const SignatureSet> loadSignatures(const std::string& name);

/// Signatures in the text of a file (format: config/signatures/size_25.yaml). `path`: only for messages.
/// @throws ParameterError as loadSignatures.
SignatureSet parseSignatures(const std::string& text, const std::string& path);

/// The text of a signature file, with three digits of each change. `motions`: name of each signature's motion.
std::string signatureText(const SignatureSet& set, const std::vector<std::string>& motions);

/// The text of a signature file, with the rows of the text `added`. `path`: path of the first file, only for messages.
/// @throws ParameterError if a file is damaged or the files have different indicators.
std::string withRowsOf(const std::string& text, const std::string& path, const std::string& added);
}  // namespace hjt
