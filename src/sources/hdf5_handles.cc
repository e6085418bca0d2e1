#include "sources/hdf5_handles.h"

namespace pbnbrdf {
namespace {

std::mutex one_at_a_time;

}  // namespace

Hdf5Turn::Hdf5Turn() : lock_(one_at_a_time) {
  // Otherwise HDF5 may report, at the end of the program, that it couldn't close a damaged file.
  H5dont_atexit();
  H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Hdf5Turn::~Hdf5Turn() { H5Eset_auto2(H5E_DEFAULT, function_, data_); }

std::string Hdf5Reason() {
  std::string reason;
  const auto take_first = [](unsigned n, const H5E_error2_t* error, void* text) -> herr_t {
    if (n == 0 && error->desc != nullptr) *static_cast<std::string*>(text) = error->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take_first, &reason);
  return reason.empty() ? "no reason given" : reason;
}

}  // namespace pbnbrdf
