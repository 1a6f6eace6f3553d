#pragma once
// --cpu-limit of verbs that have no runs: after so much CPU time the program ends with a sentence,
// and status 1, before anything is written.

namespace momenta::program {

class CpuLimit {
 public:
  /// [s]; 0: none. One at a time.
  explicit CpuLimit(double seconds);
  ~CpuLimit() { lift(); }
  CpuLimit(const CpuLimit&) = delete;
  CpuLimit& operator=(const CpuLimit&) = delete;
  /// From now on there is none: write_results() calls it.
  static void lift();
};

}  // namespace momenta::program
