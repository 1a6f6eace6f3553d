#pragma once
// The processes of one `mpirun -n K momenta …`, which share the cases of a study. Rank 0 hands out
// the numbers of cases and keeps the results, on a thread beside its own work; the other ranks ask
// for a number, make the case and send the result. Without MPI there is one rank.

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace momenta::program {

class Ranks {
 public:
  /// Joins the other processes where a launcher of MPI started this one; else it is alone.
  Ranks();
  ~Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  int rank() const { return rank_; }
  int count() const { return count_; }

  /// Tells the other ranks whether rank 0 has a study for them; what they return is what it said.
  /// Called once by all.
  bool agreed(bool ready);

  /// Calls make(number) once for each of `wanted`, on any rank, and keep(number, record) for each
  /// on rank 0, from several threads there. The same `make` on all ranks, `wanted` and `keep` on
  /// rank 0 alone. `threads` on rank 0 and on each other. Stops handing out once going_on() is
  /// false. What make throws ends the study and is thrown on the rank where it was.
  void share(const std::vector<std::size_t>& wanted, int threads,
             const std::function<std::string(std::size_t)>& make,
             const std::function<void(std::size_t, const std::string&)>& keep,
             const std::function<bool()>& going_on);

 private:
  int rank_ = 0, count_ = 1;
};

}  // namespace momenta::program
