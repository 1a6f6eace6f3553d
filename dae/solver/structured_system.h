#pragma once
// Structure of a DaeSystem: a mixin.

namespace momenta {

class StructuredSystem {
 public:
  virtual ~StructuredSystem() = default;
  /// The differentiation index.
  virtual int index() const = 0;
  /// Whether the highest derivatives, each equation differentiated as often as the Σ-method says,
  /// are determined. J(c) is then regular as c grows, but for powers of c by rows and columns, in
  /// which changes of ∂F/∂y and ∂F/∂y' of order 1/c are of that order: simplified Newton iterations
  /// contract as steps shrink.
  virtual bool is_regular() const = 0;
};

}  // namespace momenta
