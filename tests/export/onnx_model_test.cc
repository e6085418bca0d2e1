// What doesn't need ONNX's own packages; tests/interop/onnx_test.py runs the models.
#include "export/formats.h"

#include "export/networks.h"
#include "export/protobuf.h"

namespace pbnbrdf {
namespace {

using testing::HasSubstr;

// The examples of protobuf's own description of its encoding.
TEST(ProtobufMessage, WritesTheDocumentedBytes) {
  ProtobufMessage number, text, outer;
  number.Add(1, std::uint64_t{150});
  EXPECT_EQ(number.bytes(), std::string("\x08\x96\x01"));
  text.Add(2, "testing");
  EXPECT_EQ(text.bytes(), std::string("\x12\x07testing"));
  outer.Add(3, number);
  EXPECT_EQ(outer.bytes(), std::string("\x1a\x03\x08\x96\x01"));
}

TEST(ProtobufMessage, LongFieldsAndNumbersTakeMoreBytes) {
  ProtobufMessage message;
  message.Add(20, std::uint64_t{0});  // 20 << 3 = 160 = 0xa0 0x01
  EXPECT_EQ(message.bytes(), std::string("\xa0\x01\x00", 3));
  ProtobufMessage largest;
  largest.Add(1, ~std::uint64_t{0});
  EXPECT_EQ(largest.bytes(), StrCat("\x08", std::string(9, '\xff'), "\x01"));
  ProtobufMessage text;
  text.Add(1, std::string(300, 'x'));
  EXPECT_EQ(text.bytes(), StrCat("\x0a\xac\x02", std::string(300, 'x')));
}

TEST(OnnxModel, WeightsBeyondFloatAreRefused) {
  const NeuralBrdf network = RandomNetwork(Encoding::kMerl, Activation::kTanh, {2}, 1);
  std::vector<double> weights = network.weights();
  weights[3] = 1e39;
  EXPECT_THAT(ErrorOf([&] { OnnxModel(NeuralBrdf(network.shape(), weights)); }),
              HasSubstr("weight 1e+39 is beyond single precision"));
}

}  // namespace
}  // namespace pbnbrdf
