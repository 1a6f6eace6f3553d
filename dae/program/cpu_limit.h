#pragma once
// --cpu-limit of verbs without runs: at the limit the program ends with a sentence and status 1,
// before it writes anything.

namespace momenta::program {

class CpuLimit {
 public:
  /// Limit [s] from now, after `spent`; 0: none. The last object counts.
  explicit CpuLimit(double seconds, double spent = 0);
  ~CpuLimit() { lift(); }
  CpuLimit(const CpuLimit&) = delete;
  CpuLimit& operator=(const CpuLimit&) = delete;
  /// Ends the limit, for write_results().
  static void lift();
};

}  // namespace momenta::program
