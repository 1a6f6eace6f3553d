#pragma once
// Formulas at eight points side by side, by steps and by hand. A file of its own, which is compiled
// for this machine's registers.

#include <momenta/core/expression/expression.h>

#include <memory>
#include <vector>

namespace momenta::by_hand {

class InPacks {
 public:
  /// Formula k of all(), at points x one after the other.
  InPacks(std::size_t k, const Expression& formula, const std::vector<double>& x);
  ~InPacks();
  InPacks(const InPacks&) = delete;
  InPacks& operator=(const InPacks&) = delete;
  /// All points once.
  void tape() const;
  void hand() const;
  double points() const;

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace momenta::by_hand
