#pragma once
// --cpu-limit of what is no run: after so much CPU time the program ends with a sentence, and
// status 1, before anything is written.

namespace momenta::program {

class CpuLimit {
 public:
  /// [s] from now on, after `spent` before; 0: none. The last one made is in force.
  explicit CpuLimit(double seconds, double spent = 0);
  ~CpuLimit() { lift(); }
  CpuLimit(const CpuLimit&) = delete;
  CpuLimit& operator=(const CpuLimit&) = delete;
  /// From now on there is none: write_results() calls it.
  static void lift();
};

}  // namespace momenta::program
