// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "output/report.hpp"
#include "recordings/trend.hpp"

namespace hjt
{
constexpr const char* TREND_FILE = "trend.json";

/// By which a slope is multiplied for people: 1000 h, or without dates from one recording to the next.
double trendUnit(const Trend& trend);
const char* trendUnitText(const Trend& trend);  ///< "per 1000 h"

Json documentOf(const Trend& trend);

/// A row for each recording, texts in quotes, nothing where a number is not known.
std::string csvOf(const Trend& trend);

/// A row for each recording, a column for each joint.
Table recordingsOf(const Trend& trend);

/// A row for each joint.
Table jointsOf(const Trend& trend);
}  // namespace hjt
