// Any text as a scene.
#include "fuzz_input.h"
#include "pbnbrdf/render/scene.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  pbnbrdf::MayRefuse([&] {
    const std::string text(reinterpret_cast<const char*>(data), size);
    pbnbrdf::ParseScene(text, "/nonexistent");
  });
  return 0;
}
