// term.h: arithmetic that is recorded instead of computed. An expression (brdf/operations.h) of terms is
// a graph of operations, which code.h prints and onnx_model.cc turns into a model.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "pbnbrdf/brdf/operations.h"

namespace pbnbrdf {

class Term {
 public:
  // Operations, in the order of the tables in code.h and onnx_model.cc, then the leaves.
  enum class Kind {
    kAdd,
    kSubtract,
    kMultiply,
    kDivide,
    kMax,
    kMin,
    kAngle,  // AngleOf, the cosine not negative
    kSqrt,
    kLog,
    kFloor,
    kTanh,
    kExpm1,  // of 0 to 30
    kIfGreater,
    kConstant,
    kVariable,
  };

  // What all copies of a term share. name: of a variable; or what printed code calls the value, where
  // that isn't left to the printer.
  struct Node {
    Kind kind;
    std::vector<Term> operands;
    double constant = 0.0;
    std::string name = "";
  };

  Term(double constant) : Term(Node{Kind::kConstant, {}, constant}) {}
  Term(Kind kind, std::vector<Term> operands) : Term(Node{kind, std::move(operands)}) {}
  static Term Variable(std::string name) {
    return Term(Node{Kind::kVariable, {}, 0.0, std::move(name)});
  }

  void SetName(std::string name) { node_->name = std::move(name); }
  const Node& node() const { return *node_; }

 private:
  explicit Term(Node node) : node_(std::make_shared<Node>(std::move(node))) {}

  std::shared_ptr<Node> node_;
};

inline Term operator+(const Term& a, const Term& b) { return {Term::Kind::kAdd, {a, b}}; }
inline Term operator-(const Term& a, const Term& b) { return {Term::Kind::kSubtract, {a, b}}; }
inline Term operator*(const Term& a, const Term& b) { return {Term::Kind::kMultiply, {a, b}}; }
inline Term operator/(const Term& a, const Term& b) { return {Term::Kind::kDivide, {a, b}}; }
inline Term Max(const Term& a, const Term& b) { return {Term::Kind::kMax, {a, b}}; }
inline Term Min(const Term& a, const Term& b) { return {Term::Kind::kMin, {a, b}}; }
inline Term AngleOf(const Term& y, const Term& x) { return {Term::Kind::kAngle, {y, x}}; }
inline Term sqrt(const Term& x) { return {Term::Kind::kSqrt, {x}}; }
inline Term log(const Term& x) { return {Term::Kind::kLog, {x}}; }
inline Term floor(const Term& x) { return {Term::Kind::kFloor, {x}}; }
inline Term tanh(const Term& x) { return {Term::Kind::kTanh, {x}}; }
inline Term expm1(const Term& x) { return {Term::Kind::kExpm1, {x}}; }
inline Term IfGreater(const Term& a, const Term& b, const Term& yes, const Term& no) {
  return {Term::Kind::kIfGreater, {a, b, yes, no}};
}

// Never divides by 0: in Python that is an error even where the result isn't selected.
inline Roots<Term> ToRoots(const Term& x) {
  constexpr double kTiny = 1e-18;  // its square is still a normal number of single precision
  const Term root = sqrt(x);
  return {root, IfGreater(root, kTiny, 1.0 / Max(root, kTiny), 0.0)};
}

inline Polar<Term> ToPolar(const Term& x, const Term& y, const Term& scale) {
  const auto [length, inverse] = ToRoots(x * x + y * y);
  return {length * scale, IfGreater(inverse, 0.0, x * inverse, 1.0), y * inverse};
}

}  // namespace pbnbrdf
