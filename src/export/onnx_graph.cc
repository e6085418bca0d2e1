#include "export/onnx_graph.h"

#include <bit>

namespace pbnbrdf {
namespace {

static_assert(std::endian::native == std::endian::little, "ONNX's raw data are little-endian");

constexpr std::uint64_t kIrVersion = 8, kOpset = 17;

// Field numbers and enumerators of onnx.proto.
namespace model {
enum { kIr = 1, kProducer = 2, kDoc = 6, kGraph = 7, kOpsetImport = 8 };
}
namespace graph {
enum { kNode = 1, kName = 2, kInitializer = 5, kInput = 11, kOutput = 12 };
}
namespace node {
enum { kInput = 1, kOutput = 2, kType = 4, kAttribute = 5 };
}
namespace attribute {
enum { kName = 1, kInteger = 3, kType = 20, kTypeInteger = 2 };
}
namespace tensor {
enum { kDims = 1, kDataType = 2, kName = 8, kRaw = 9, kFloat = 1, kInt64 = 7 };
}

template <typename T>
ProtobufMessage TensorMessage(const std::string& name, std::uint64_t type,
                              const std::vector<std::uint64_t>& shape,
                              const std::vector<T>& values) {
  ProtobufMessage message;
  for (std::uint64_t extent : shape) message.Add(tensor::kDims, extent);
  message.Add(tensor::kDataType, type);
  message.Add(tensor::kName, name);
  message.Add(tensor::kRaw,
              {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)});
  return message;
}

// ValueInfoProto of a float32 value of shape N x 3.
ProtobufMessage ValueInfo(const std::string& name) {
  ProtobufMessage rows, columns, shape, tensor_type, type, info;
  rows.Add(2, "N");
  columns.Add(1, std::uint64_t{3});
  shape.Add(1, rows);
  shape.Add(1, columns);
  tensor_type.Add(1, std::uint64_t{tensor::kFloat});
  tensor_type.Add(2, shape);
  type.Add(1, tensor_type);
  info.Add(1, name);
  info.Add(2, type);
  return info;
}

}  // namespace

void OnnxGraph::AddNode(const std::string& type, const Names& inputs, const Names& outputs,
                        const Attributes& attributes) {
  ProtobufMessage message;
  for (const std::string& input : inputs) message.Add(node::kInput, input);
  for (const std::string& output : outputs) message.Add(node::kOutput, output);
  message.Add(node::kType, type);
  for (const auto& [name, value] : attributes) {
    ProtobufMessage entry;
    entry.Add(attribute::kName, name);
    entry.Add(attribute::kInteger, value);
    entry.Add(attribute::kType, std::uint64_t{attribute::kTypeInteger});
    message.Add(node::kAttribute, entry);
  }
  nodes_.Add(graph::kNode, message);
}

std::string OnnxGraph::Node(const std::string& type, const Names& inputs,
                            const Attributes& attributes) {
  const std::string output = NewName();
  AddNode(type, inputs, {output}, attributes);
  return output;
}

OnnxGraph::Names OnnxGraph::Columns(const std::string& value) {
  const std::string sizes = NewName();
  initializers_.Add(graph::kInitializer,
                    TensorMessage<std::int64_t>(sizes, tensor::kInt64, {3}, {1, 1, 1}));
  const Names columns = {NewName(), NewName(), NewName()};
  AddNode("Split", {value, sizes}, columns, {{"axis", 1}});
  return columns;
}

std::string OnnxGraph::Scalar(float value) { return Floats({}, {value}); }

std::string OnnxGraph::Floats(const std::vector<std::uint64_t>& shape,
                              const std::vector<float>& values) {
  const std::string name = NewName();
  initializers_.Add(graph::kInitializer, TensorMessage(name, tensor::kFloat, shape, values));
  return name;
}

std::string OnnxGraph::Model(const Names& inputs, const std::string& output,
                             const std::string& about) const {
  ProtobufMessage name_and_values;
  name_and_values.Add(graph::kName, "pbnbrdf");
  for (const std::string& input : inputs) name_and_values.Add(graph::kInput, ValueInfo(input));
  name_and_values.Add(graph::kOutput, ValueInfo(output));
  std::string bytes(nodes_.bytes());
  bytes += initializers_.bytes();
  bytes += name_and_values.bytes();
  ProtobufMessage opset, result;
  opset.Add(2, kOpset);
  result.Add(model::kIr, kIrVersion);
  result.Add(model::kProducer, "pbnbrdf");
  result.Add(model::kDoc, about);
  result.Add(model::kGraph, bytes);
  result.Add(model::kOpsetImport, opset);
  return std::string(result.bytes());
}

}  // namespace pbnbrdf
