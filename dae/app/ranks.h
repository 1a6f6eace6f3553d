#pragma once
// The processes of one `mpirun -n K momenta …`, which share the cases of a study. Rank 0 hands out
// numbers of cases and keeps results, on a thread beside its own work; the other ranks ask for a
// number, make the case and send the result. Without MPI there is one rank.

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace momenta::program {

class Ranks {
 public:
  /// Joins the other processes if started by MPI; else the only rank.
  Ranks();
  ~Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  int rank() const { return rank_; }
  int count() const { return count_; }

  /// Whether rank 0 has a study (its `ready`), told to all. Called once by each.
  bool agreed(bool ready);

  /// Calls make(number) once for each of `wanted`, on any rank, and keep(number, record) for each
  /// on rank 0, from several threads. All ranks need the same `make`, rank 0 alone `wanted` and
  /// `keep`. `threads` on rank 0 and on each other rank. Hands out none once going_on() is false.
  /// An exception of make ends the study and is rethrown on its rank.
  void share(const std::vector<std::size_t>& wanted, int threads,
             const std::function<std::string(std::size_t)>& make,
             const std::function<void(std::size_t, const std::string&)>& keep,
             const std::function<bool()>& going_on);

 private:
  int rank_ = 0, count_ = 1;
};

}  // namespace momenta::program
