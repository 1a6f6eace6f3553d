#pragma once
// Joints beyond their `limits`, which exert no force, and points beyond the ends of open slots,
// which go on straight: told, once each, with the time of the first sample beyond.

#include <momenta/dae/assembly/assembly.h>

#include <memory>
#include <string>
#include <vector>

namespace momenta::program {

class PassedLimits {
 public:
  explicit PassedLimits(const Mechanism& mechanism);

  /// Takes a sample: q (nq) at t [s]. O(joints with limits); with open slots an evaluation
  void look(double t, const double* q);
  /// "the point in slot 's', 2 m long, is beyond its end …", "joint 'k' is beyond its limits [-1,
  /// 2] rad from t = 0.3 s on: 2.1 rad", one each, the first four; and how many more.
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
  /// An open slot: its curve is between 0 and `length` [m, along the chords].
  struct Slot {
    std::string name;
    std::size_t loop;
    double length;
    bool passed = false;
    double at = 0, value = 0;
  };
  std::vector<Limited> joints_;
  std::vector<Slot> slots_;
  std::unique_ptr<Evaluation<double>> e_;  ///< where there are such slots
  std::vector<double> places_;             ///< by loop
};

}  // namespace momenta::program
