// Any text as a problem file: it is refused, or written and read again it is the same problem.
#include "fuzz_input.h"
#include "pbnbrdf/solve/problem_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const pbnbrdf::FuzzFile file(data, size);
  pbnbrdf::MayRefuse([&] {
    const std::string text = pbnbrdf::ProblemText(pbnbrdf::ReadProblem(file.path()));
    const pbnbrdf::FuzzFile again(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
    pbnbrdf::Expect(pbnbrdf::ProblemText(pbnbrdf::ReadProblem(again.path())) == text,
                    "a problem that was written reads as the same");
  });
  return 0;
}
