// hdf5_handles.h: shared by the reader and the writer of HDF5 files: identifiers that close themselves,
// a lock, and error texts.
#pragma once

#include <hdf5.h>

#include <mutex>
#include <string>
#include <utility>

namespace pbnbrdf {

// An HDF5 identifier, closed when it goes; negative if opening failed.
class Hdf5Handle {
 public:
  Hdf5Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Hdf5Handle() {
    if (id_ >= 0) close_(id_);
  }
  Hdf5Handle(Hdf5Handle&& other) : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Hdf5Handle& operator=(Hdf5Handle&&) = delete;

  hid_t get() const { return id_; }
  explicit operator bool() const { return id_ >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

// While it lives, no other thread uses HDF5, which isn't thread-safe, and HDF5 doesn't print its
// errors.
class Hdf5Turn {
 public:
  Hdf5Turn();
  ~Hdf5Turn();
  Hdf5Turn(const Hdf5Turn&) = delete;
  Hdf5Turn& operator=(const Hdf5Turn&) = delete;

 private:
  const std::lock_guard<std::mutex> lock_;
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

// What HDF5 says about its last failure, the cause rather than its consequences.
std::string Hdf5Reason();

}  // namespace pbnbrdf
