// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <mutex>
#include <string>
#include <utility>
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

  Hdf5Handle& operator=(Hdf5Handle&& other) noexcept
  {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }

  ~Hdf5Handle()
  {
    if (id_ >= 0)
    {
      close_(id_);
    }
  }

  hid_t get() const { return id_; }
  bool valid() const { return id_ >= 0; }

private:
  hid_t id_{ -1 };
  Close close_{};
};

/// The library may serve one thread at a time: every use of it, the closing of a handle too, holds this lock.
inline std::unique_lock<std::mutex> lockLibrary()
{
  static std::mutex mutex;
  std::unique_lock<std::mutex> lock(mutex);
  // The library's own end of the process closes what a full disk left open, and crashes there; we close what we opened.
  [[maybe_unused]] static const herr_t ENDS_BY_ITSELF = H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors are reported by exceptions
  return lock;
}

/// Creation properties without times.
inline Hdf5Handle withoutTimes(hid_t kind)
{
  Hdf5Handle properties(H5Pcreate(kind), H5Pclose);
  H5Pset_obj_track_times(properties.get(), false);
  return properties;
}

inline Hdf5Handle textType(std::size_t length)
{
  Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.get(), std::max<std::size_t>(length, 1));
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  H5Tset_strpad(type.get(), H5T_STR_NULLPAD);
  return type;
}

/// Writes an attribute of variable length: readers give it as text, one of fixed length as bytes.
inline void writeText(hid_t object, const char* name, const std::string& text)
{
  const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.get(), H5T_VARIABLE);
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Hdf5Handle attribute(H5Acreate2(object, name, type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  const char* const content = text.c_str();
  H5Awrite(attribute.get(), type.get(), &content);
}

inline void writeNumber(hid_t object, const char* name, double value)
{
  const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Hdf5Handle attribute(H5Acreate2(object, name, H5T_IEEE_F64LE, space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  H5Awrite(attribute.get(), H5T_NATIVE_DOUBLE, &value);
}

/// A text as a data set of its own: an attribute may hold 64 kB at most, and object headers are no place for long ones.
inline bool writeTextDataset(hid_t file, const char* name, const std::string& text)
{
  const Hdf5Handle type = textType(text.size());
  const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Hdf5Handle properties = withoutTimes(H5P_DATASET_CREATE);
  const Hdf5Handle dataset(H5Dcreate2(file, name, type.get(), space.get(), H5P_DEFAULT, properties.get(), H5P_DEFAULT),
                           H5Dclose);
  return H5Dwrite(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()) >= 0;
}

/// Numbers as a data set. @returns its success as the library does.
inline herr_t writeRows(hid_t group, const char* name, const char* unit, const std::vector<double>& rows)
{
  const hsize_t count = rows.size();
  const Hdf5Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose);
  const Hdf5Handle properties = withoutTimes(H5P_DATASET_CREATE);
  const Hdf5Handle dataset(
      H5Dcreate2(group, name, H5T_IEEE_F64LE, space.get(), H5P_DEFAULT, properties.get(), H5P_DEFAULT), H5Dclose);
  if (!dataset.valid())
  {
    return -1;
  }
  writeText(dataset.get(), "unit", unit);
  return rows.empty() ? 0 : H5Dwrite(dataset.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data());
}
}  // namespace hjt
