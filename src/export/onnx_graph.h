// onnx_graph.h: builds an ONNX graph. Values are float32 tensors known by their names.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "export/protobuf.h"

namespace pbnbrdf {

class OnnxGraph {
 public:
  using Names = std::vector<std::string>;
  using Attributes = std::vector<std::pair<std::string, std::uint64_t>>;  // integers

  // Adds an operator; returns the name of its output.
  std::string Node(const std::string& type, const Names& inputs, const Attributes& attributes = {});

  // The same value under a name of the caller's.
  std::string Rename(const std::string& value, const std::string& name) {
    AddNode("Identity", {value}, {name}, {});
    return name;
  }

  // The three columns of an N x 3 value, each N x 1.
  Names Columns(const std::string& value);

  // Constants; return their names.
  std::string Scalar(float value);
  std::string Floats(const std::vector<std::uint64_t>& shape, const std::vector<float>& values);

  // The bytes of a whole model. inputs and output: names of N x 3 values.
  std::string Model(const Names& inputs, const std::string& output, const std::string& about) const;

 private:
  std::string NewName() { return "v" + std::to_string(names_++); }
  void AddNode(const std::string& type, const Names& inputs, const Names& outputs,
               const Attributes& attributes);

  ProtobufMessage nodes_, initializers_;  // fields of the graph
  int names_ = 0;
};

}  // namespace pbnbrdf
