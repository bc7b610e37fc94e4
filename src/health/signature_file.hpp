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
/// Format number of the files that this software reads and writes.
constexpr int SIGNATURE_FORMAT = 3;

/// A number of the section `errors` of a file.
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

/// Index of the indicator for each number of a signature.
std::array<std::size_t, SIGNATURE_SIZE> indicatorsOfNumbers();

/// The signatures of the file that parameter indicators.signatures names, by its path or beside the default
/// configuration; NO_FILE: none. A file is read once, and all users share it. The function allocates and reads files:
/// it is not for the real-time loop.
/// @throws ParameterError naming file, line and key of what is wrong: damaged, of another format, with an indicator or
/// unit that this software has not.
std::shared_ptr<const SignatureSet> loadSignatures(const std::string& name);

/// Contents of a file (format: config/signatures/size_25.yaml). `path`: for the messages alone. @throws as above.
SignatureSet parseSignatures(const std::string& text, const std::string& path);

/// The text of a file. Reading it gives the same set, except that changes have three digits. `motions`: a name for
/// people of each signature's motion.
std::string signatureText(const SignatureSet& set, const std::vector<std::string>& motions);

/// The text of a file with the rows of another file added. `path`: of the first file, for messages alone.
/// @throws ParameterError if one is damaged or they speak of different indicators.
std::string withRowsOf(const std::string& text, const std::string& path, const std::string& added);
}  // namespace hjt
