// Any file as an image: it is refused, or has a value for each pixel and channel (which may be infinite).
#include "fuzz_input.h"
#include "pbnbrdf/image/image.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using pbnbrdf::Expect;
  const pbnbrdf::FuzzFile file(data, size);
  pbnbrdf::MayRefuse([&] {
    const pbnbrdf::Image image = pbnbrdf::OpenImage(file.path());
    Expect(image.rgb.size() == 3 * std::size_t(image.width) * std::size_t(image.height),
           "there are three values for each pixel");
  });
  return 0;
}
