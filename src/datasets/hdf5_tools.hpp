// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mutex>
#include <string>
#include <vector>

#include <hdf5.h>

namespace hjt
{
/// An object of the HDF5 library, closed at the end.
class Hdf5Handle
{
public:
  using Close = herr_t (*)(hid_t);

  Hdf5Handle() = default;
  Hdf5Handle(hid_t id, Close close) : id_(id), close_(close) {}
  Hdf5Handle(Hdf5Handle&& other) noexcept : id_(other.id_), close_(other.close_) { other.id_ = -1; }
  Hdf5Handle& operator=(Hdf5Handle&& other) noexcept;
  ~Hdf5Handle();

  hid_t get() const { return id_; }
  bool valid() const { return id_ >= 0; }

private:
  hid_t id_{ -1 };
  Close close_{};
};

/// The library may serve one thread at a time: every use of it, the closing of a handle too, holds this lock.
std::unique_lock<std::mutex> lockLibrary();

/// Creation properties without times.
Hdf5Handle withoutTimes(hid_t kind);

Hdf5Handle textType(std::size_t length);

/// Writes an attribute of variable length: readers give it as text, one of fixed length as bytes.
void writeText(hid_t object, const char* name, const std::string& text);

void writeNumber(hid_t object, const char* name, double value);

/// A text as a data set of its own: an attribute may hold 64 kB at most, and object headers are no place for long ones.
bool writeTextDataset(hid_t file, const char* name, const std::string& text);

/// Numbers as a data set. @returns its success as the library does.
herr_t writeRows(hid_t group, const char* name, const char* unit, const std::vector<double>& rows);
}  // namespace hjt
