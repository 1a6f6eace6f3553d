#pragma once
// Joints beyond their `limits`, which exert no force: told, once a joint, with the time of the
// first sample at which it is beyond.

#include <momenta/dae/assembly/assembly.h>

#include <string>
#include <vector>

namespace momenta::program {

class PassedLimits {
 public:
  explicit PassedLimits(const Mechanism& mechanism);

  /// Takes a sample: q (nq) at t [s]. O(joints with limits)
  void look(double t, const double* q);
  /// "joint 'k' is beyond its limits [-1, 2] rad from t = 0.3 s on: 2.1 rad", one each, the first
  /// four; and how many more.
  std::vector<std::string> sentences() const;

 private:
  struct Limited {
    std::string name;
    double least, largest;
    int q;
    bool slides;
    bool passed = false;
    double at = 0, value = 0;  ///< of the first sample beyond
  };
  std::vector<Limited> joints_;
};

}  // namespace momenta::program
