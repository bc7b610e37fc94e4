// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "datasets/run_file.hpp"

namespace hjt
{
/// See makeRunFile. These throw InputError where hasHdf5() is false.
std::unique_ptr<RunFile> makeHdf5RunFile(const Recording& recording, const RunSpec& spec, const Twin* twin,
                                         const std::string& path);
/// The data set of this name; empty if there is none.
std::string readHdf5Text(const std::string& path, const char* name);
/// See readRunColumns.
Columns readHdf5Columns(const std::string& path, const std::vector<std::string>& holding);
}  // namespace hjt
