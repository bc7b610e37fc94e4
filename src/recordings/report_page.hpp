// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace hjt
{
constexpr const char* REPORT_PAGE = "report.html";

/// Runs the script that makes page and pictures of the data in a directory. @throws InputError if it does not end well.
void makePage(const std::string& directory);
}  // namespace hjt
