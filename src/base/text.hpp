// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

namespace hjt
{
/// Joins `text(item)` of all items with `separator` between them.
template <class Items, class Text>
std::string joined(const Items& items, const char* separator, const Text& text)
{
  std::string all;
  const char* before = "";
  for (const auto& item : items)
  {
    all.append(before).append(text(item));
    before = separator;
  }
  return all;
}

/// Joins the texts with `separator` between them.
template <class Texts>
std::string joined(const Texts& texts, const char* separator = ", ")
{
  return joined(texts, separator, [](const std::string& text) { return text; });
}

inline bool holds(const std::vector<std::string>& texts, const std::string& text)
{
  return std::find(texts.begin(), texts.end(), text) != texts.end();
}

/// Least number of edits (insert, delete or replace a character) from one text to the other (Levenshtein distance).
inline std::size_t editDistance(const std::string& from, const std::string& to)
{
  std::vector<std::size_t> row(to.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{ 0 });
  for (std::size_t i = 1; i <= from.size(); ++i)
  {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= to.size(); ++j)
    {
      const std::size_t replaced = diagonal + (from[i - 1] == to[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({ replaced, row[j] + 1, row[j - 1] + 1 });
    }
  }
  return row.back();
}

/// Known name that is most similar to an unknown name; empty if no known name is similar.
inline std::string nearestName(const std::string& unknown, const std::vector<std::string>& known)
{
  std::string nearest;
  std::size_t distance = std::max<std::size_t>(2, unknown.size() / 3) + 1;
  for (const std::string& name : known)
  {
    if (const std::size_t edits = editDistance(unknown, name); edits < distance)
    {
      distance = edits;
      nearest = name;
    }
  }
  return nearest;
}

/// Suggestion with the most similar known name, for example " (did you mean speed?)"; empty if no name is similar.
inline std::string didYouMean(const std::string& unknown, const std::vector<std::string>& known)
{
  const std::string nearest = nearestName(unknown, known);
  return nearest.empty() ? "" : " (did you mean " + nearest + "?)";
}

/// Makes a text safe for one line of a log. A '?' replaces each control character, and "..." replaces all that follows
/// after `longest` bytes.
inline std::string printable(std::string text, std::size_t longest = 60)
{
  if (text.size() > longest)
  {
    text.resize(longest);
    text += "...";
  }
  const auto is_control = [](unsigned char character) { return character < ' ' || character == 0x7f; };
  std::replace_if(text.begin(), text.end(), is_control, '?');
  return text;
}

/// Text with the special characters replaced, for an element or attribute of XML.
inline std::string xmlText(const std::string& text)
{
  std::string escaped;
  for (const char letter : text)
  {
    switch (letter)
    {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += letter;
    }
  }
  return escaped;
}
}  // namespace hjt
