// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "harmonic_joint_twin/health/fault_signatures.hpp"

namespace hjt
{
/// The signatures of parameter indicators.signatures: of a file as named, else beside the default configuration;
/// NO_FILE: none. A file is read once: those who use it share it. Allocates and reads: not for the real-time loop.
/// @throws ParameterError naming file, line and key of what is wrong: damaged, of another format, with an indicator or
/// unit that this software has not.
std::shared_ptr<const SignatureSet> loadSignatures(const std::string& name);

/// What a file says (config/signatures/size_25.yaml has the format). `path`: for the messages alone. @throws as above.
SignatureSet parseSignatures(const std::string& text, const std::string& path);
}  // namespace hjt
