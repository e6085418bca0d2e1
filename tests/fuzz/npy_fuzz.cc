// Any file as an array of NumPy.
#include "fuzz_input.h"
#include "sources/npy.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const pbnbrdf::FuzzFile file(data, size);
  pbnbrdf::MayRefuse([&] { pbnbrdf::ReadNpy(file.path()); });
  return 0;
}
