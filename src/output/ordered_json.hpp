// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <initializer_list>
#include <iterator>
#include <list>
#include <stdexcept>
#include <utility>

#include <nlohmann/json.hpp>

namespace hjt
{
/// Members of a JSON object in the order of insertion. The JSON library has an ordered map from version 3.9 on, but
/// Ubuntu 20.04 has version 3.7 of the library.
template <class Key, class Value, class, class Allocator>
class OrderedMembers : public std::list<std::pair<const Key, Value>, Allocator>
{
public:
  // Names that the JSON library prescribes.
  // NOLINTBEGIN(readability-identifier-naming)
  using List = std::list<std::pair<const Key, Value>, Allocator>;
  using key_type = Key;
  using mapped_type = Value;
  using key_compare = std::equal_to<Key>;  // comparison of keys
  using iterator = typename List::iterator;
  using const_iterator = typename List::const_iterator;
  // NOLINTEND(readability-identifier-naming)
  using List::erase;

  OrderedMembers() = default;

  template <class Iterator>
  OrderedMembers(Iterator first, Iterator last)
  {
    insert(first, last);
  }

  OrderedMembers(std::initializer_list<std::pair<const Key, Value>> members)
    : OrderedMembers(members.begin(), members.end())
  {
  }

  iterator find(const Key& key)
  {
    return std::find_if(this->begin(), this->end(), [&key](const auto& member) { return member.first == key; });
  }

  const_iterator find(const Key& key) const
  {
    return std::find_if(this->begin(), this->end(), [&key](const auto& member) { return member.first == key; });
  }

  std::size_t count(const Key& key) const { return find(key) == this->end() ? 0 : 1; }

  Value& operator[](const Key& key) { return emplace(key, Value{}).first->second; }

  Value& at(const Key& key) { return const_cast<Value&>(std::as_const(*this).at(key)); }

  const Value& at(const Key& key) const
  {
    const const_iterator found = find(key);
    if (found == this->end())
    {
      throw std::out_of_range("no such member");
    }
    return found->second;
  }

  template <class NewKey, class NewValue>
  std::pair<iterator, bool> emplace(NewKey&& key, NewValue&& value)
  {
    const iterator found = find(key);
    if (found != this->end())
    {
      return { found, false };
    }
    this->emplace_back(std::forward<NewKey>(key), std::forward<NewValue>(value));
    return { std::prev(this->end()), true };
  }

  std::pair<iterator, bool> insert(const typename List::value_type& member)
  {
    return emplace(member.first, member.second);
  }

  template <class Iterator>
  void insert(Iterator first, Iterator last)
  {
    for (; first != last; ++first)
    {
      emplace(first->first, first->second);
    }
  }

  std::size_t erase(const Key& key)
  {
    const const_iterator found = find(key);
    if (found == this->end())
    {
      return 0;
    }
    this->erase(found);
    return 1;
  }
};

using OrderedJson = nlohmann::basic_json<OrderedMembers>;
}  // namespace hjt
