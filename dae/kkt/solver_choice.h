#pragma once
// How (7) is solved for a mechanism with loops: by sweeps that carry them, or by an assembled
// matrix where the sweeps do not. A joint may have no inertia until a loop closes above it, and
// next to masses far apart eliminating joints before loops loses digits: so solutions at the start
// and near it are tried, and their error measured (saddle_point_factor.h).

#include <momenta/dae/kkt/sweeps/levels/looped_sweeps.h>
#include <momenta/dae/mechanism/mechanism.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace momenta {

/// How (7) is solved for one mechanism, which must outlive it.
class SolverChoice {
 public:
  /// One solution of (7), up to some thirty where masses are far apart. @throws SceneError where
  /// the options of the mechanism ask for a way that does not solve (7)
  explicit SolverChoice(const Mechanism& mechanism);
  ~SolverChoice();
  SolverChoice(const SolverChoice&) = delete;
  SolverChoice& operator=(const SolverChoice&) = delete;

  /// Where there are loops; never `automatic`.
  KktChoice kkt() const { return kkt_; }
  /// Whether an assembled matrix is dense, where one is needed.
  bool dense() const { return dense_; }
  /// Whether the sweeps solve it, and no matrix is assembled.
  bool by_sweeps() const { return kkt_ == KktChoice::sweeps && !dense_; }
  /// Whether every joint can be eliminated before the loops that hold it close: each has inertia at
  /// that point, and a solution so made is right to most_elimination_error.
  bool leaves_first() const { return light_.empty(); }
  /// Whether the sweeps, or else the matrix of make_kkt(), have a pivot for each row of Φ, which
  /// can fade and be reported: KLU has none. Sweeps are chosen only where leaves_first().
  bool filters_pivots() const { return dense_ || leaves_first(); }

  /// The sweeps that carry the loops, for one instruction level; 0: the machine's best.
  /// `branches_side_by_side`: for one state, spatial sweeps take folded branches of one shape in
  /// the lanes of a register. @throws std::logic_error where there are no loops, or more loop
  /// equations are open at once than there are slots
  std::unique_ptr<LoopedSweeps> sweeps(int level = 0, bool branches_side_by_side = true) const;
  /// The same with the loops between the pairs of bodies that the scene gives.
  std::unique_ptr<LoopedSweeps> sweeps_as_given() const;
  /// Whether loops that meet in one point are tied between other pairs of bodies than in the scene.
  bool pairs_anew() const;
  /// How (7) is solved, for people.
  std::string in_words() const;

 private:
  struct Plans;
  template <class F>
  decltype(auto) visit(F&& f) const;
  std::string plan_sweeps();
  void expect_sweeps() const;
  std::string joint_without_inertia() const;
  std::string loops_missed() const;

  const Mechanism& mechanism_;
  std::unique_ptr<Plans> plans_;  ///< without loops or bodies: none
  bool dense_;
  KktChoice kkt_ = KktChoice::dense;
  std::string reason_;  ///< why the sweeps do not carry the loops; empty where they do
  std::string light_;   ///< which joint has too little inertia before its loops close, or empty
};

/// Whether the sparse matrix is that of the bodies' equations: the joints' equations cost more
/// where bodies are on average more than 40 joints from the ground. O(bodies)
bool solved_by_bodies(const Mechanism& mechanism);

/// Lines of the plan, of core and of the loops: what each is about, and how it is computed. Cost
/// and errors of Mechanism::solver().
std::vector<std::pair<std::string, std::string>> plan_lines(const Mechanism& mechanism);

}  // namespace momenta
