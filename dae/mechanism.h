#pragma once
// A mechanism, made from a scene: its tree, its loops, and the plan that says what every evaluation
// computes. Immutable; every form, solver and measure takes it by const reference.

#include <momenta/core/plan.h>
#include <momenta/core/scalar/local_dual.h>
#include <momenta/core/scalar/power_series.h>
#include <momenta/dae/evaluation.h>
#include <momenta/dae/factor/kkt_pattern.h>
#include <momenta/dae/loop/row_name.h>
#include <momenta/dae/sweeps/levels/looped_sweeps.h>

#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace momenta {

class AxisScale;         // dae/factor/axis_scale.h
struct LagrangianModel;  // core/lagrangian/lagrangian_model.h

/// How (7) is solved: by sweeps that carry the loops, or by an assembled matrix.
enum class KktChoice {
  automatic,  ///< sweeps where they can, else by size
  sweeps,     ///< by sweeps that carry the loops, no matrix
  sparse,     ///< a sparse matrix
  dense       ///< a dense matrix
};
/// The name that `--kkt` takes.
const char* name_of(KktChoice choice);

/// The mechanism that runs integrate (dae/cut/integrated_scene.h).
enum class CutChoice {
  automatic,  ///< bodies folded and joints cut for the least work found
  scene       ///< the scene as it is written
};

/// Options that a scene does not contain.
struct MechanismOptions {
  Algebra algebra = Algebra::automatic;  ///< which kernel
  KktChoice kkt = KktChoice::automatic;  ///< how (7) is solved
  CutChoice cut = CutChoice::automatic;  ///< what runs integrate
};

/// A column of trajectory.csv.
struct Column {
  std::string name;  ///< "O.q"
  std::string unit;  ///< "rad"
  /// "O.q [rad]".
  std::string label() const { return name + " [" + unit + "]"; }
};

/// A mechanism, loops included; of a scene with a Lagrangian its formulas: no bodies, its
/// coordinates for joints, its constraints for loops. Immutable, so threads may share it; it must
/// outlive everything made from it.
class Mechanism {
 public:
  /// @throws SceneError
  explicit Mechanism(Scene scene, MechanismOptions options = {});
  ~Mechanism();
  Mechanism(const Mechanism&) = delete;
  Mechanism& operator=(const Mechanism&) = delete;

  const Scene& scene() const { return scene_; }                 ///< as given
  const MechanismOptions& options() const { return options_; }  ///< as given
  const Tree& tree() const { return tree_; }  ///< bodies in the order of the sweeps
  /// The tapes of the scene's Lagrangian. @pre it has one
  const LagrangianModel& lagrangian() const;
  const Plan& plan() const { return plan_; }  ///< what evaluations compute and leave out
  int nq() const { return tree_.nq; }         ///< coordinates
  int nv() const { return tree_.nv; }         ///< rates, momenta
  int m() const { return rows_; }             ///< loop equations
  /// How (7) is solved where there are loops; never `automatic`.
  KktChoice kkt() const { return kkt_; }
  /// Whether an assembled matrix is dense, where one is needed.
  bool dense_kkt() const { return dense_; }
  /// Whether every joint can be eliminated before the loops that hold it close: each has inertia at
  /// that point, and a solution so made is right to most_leaves_first_error (leaves_first.h).
  bool leaves_first() const { return light_.empty(); }
  /// Whether the sparse matrix is that of the bodies' equations: the joints' equations cost more
  /// where bodies are on average more than 40 joints from the ground. O(bodies)
  bool solved_by_bodies() const;
  /// LoopWeights::spread
  double mass_spread() const { return mass_spread_; }
  /// LoopWeights::apart
  double masses_apart() const { return masses_apart_; }
  /// The sweeps that carry the loops, for one instruction level; 0: the machine's best.
  /// `branches_side_by_side`: for one state, spatial sweeps take folded branches of one shape in
  /// the lanes of a register. @throws std::logic_error where there are no loops, or more loop
  /// equations are open at once than there are slots
  std::unique_ptr<LoopedSweeps> looped_sweeps(int level = 0,
                                              bool branches_side_by_side = true) const;
  /// The same with the loops between the pairs of bodies that the scene gives.
  std::unique_ptr<LoopedSweeps> looped_sweeps_as_given() const;
  /// Whether loops that meet in one point are tied between other pairs of bodies than in the scene.
  bool pairs_anew() const;
  bool has_body_forces() const;   ///< springs, bushings, wrenches or formulas
  bool has_forces_apart() const;  ///< among them coordinate springs or formulas
  bool has_joint_forces() const;  ///< springs, dampers, friction or torques of joints
  /// Nonzeros of M and Φ_q in (7), computed at the first call. O(Σ depth)
  const KktPattern& kkt_pattern() const;
  /// Nonzeros of Φ_q alone. O(length of all loops)
  const std::vector<KktPattern::Entry>& constraint_pattern() const;
  /// The name of each row of Φ (m).
  const std::vector<RowName>& rows() const { return row_names_; }
  /// Group index of each row: rows of one loop and one kind (points, axes, distance or coupling)
  /// share a unit and so a scale.
  const std::vector<int>& row_groups() const { return row_groups_; }

  /// Whether each row (m) is one of velocities, A(q) u = b, without a row of positions behind it:
  /// its Φ is 0, its Φ_q is A, its Φ̇ is A u − b.
  const std::vector<bool>& nonholonomic() const { return nonholonomic_; }
  /// Whether some row is nonholonomic.
  bool has_nonholonomic() const;
  /// Whether each row is an angle [rad]: rows of axes, couplers of angles alone. Others are lengths
  /// [m].
  const std::vector<bool>& angle_rows() const { return angle_rows_; }
  /// Whether there are rows of lengths.
  bool has_lengths() const;
  /// Whether there are rows of angles.
  bool has_angles() const;

  /// LoopWeights::least_scales by row (m) [1/kg]: size of a row of Φ_q M⁻¹ Φ_qᵀ below which it is
  /// rounding alone, as are four of the five rows of a slide along the axis of a cylindrical joint.
  /// Zero for rows of axes, whose natural size is known, and for couplers.
  const std::vector<double>& least_scales() const { return least_scales_; }
  /// The scales by which rows are measured.
  AxisScale axis_scale() const;

  /// A workspace for one thread; S is double, Dual8, LocalDual or Jet.
  template <class S>
  std::unique_ptr<Evaluation<S>> evaluation() const;

  /// Names and units of the columns of q (nq), u (nv), markers' positions and velocities, λ (m) by
  /// row of Φ, and efforts of joints' drives in the order of Tree::drives.
  std::vector<Column> coordinate_columns() const;
  /// Columns of u (nv).
  std::vector<Column> rate_columns() const;
  /// Columns of positions and velocities of markers.
  std::vector<Column> marker_columns() const;
  /// Columns of λ (m), by row of Φ.
  std::vector<Column> multiplier_columns() const;
  /// Columns of efforts of driven joints, in the order of Tree::drives.
  std::vector<Column> effort_columns() const;

  /// Lines of the plan, of core and of the loops.
  std::vector<std::pair<std::string, std::string>> plan_lines() const;

  /// Why a solution failed at (t, q): one sentence naming the joints that neither inertia nor a
  /// loop holds (unheld_joints.h). `rate`: the place in u at which it failed; −1: not known.
  std::string no_inertia(int rate, double t, const double* q) const;

 private:
  /// Branches that the sweeps take side by side; empty: none.
  std::string looped_branches_in_words() const;
  std::vector<std::pair<std::string, std::string>> lagrangian_lines() const;
  template <class Space>
  struct Cast;
  struct Casts;
  template <class F>
  decltype(auto) visit(F&& f) const;
  void expect_sweeps() const;
  void take_bodies();
  void take_lagrangian();
  void choose_kkt(KktChoice asked);
  void take_weights();
  std::string joint_without_inertia(bool swept) const;
  std::string loops_missed(bool swept) const;
  std::string light_before_loops(int rate) const;
  template <class Space, class S>
  class SweepRows;
  template <class Space>
  class SweepEvaluation;

  Scene scene_;
  MechanismOptions options_;
  Tree tree_;
  Plan plan_;
  std::unique_ptr<Casts> casts_;  ///< mechanism_inside.h
  int rows_ = 0;
  bool dense_ = true;
  KktChoice kkt_ = KktChoice::dense;
  std::string kkt_reason_;  ///< why the sweeps do not carry the loops; empty when they do
  double mass_spread_ = 1, masses_apart_ = 1;
  std::string furthest_apart_;  ///< LoopWeights::light
  std::string light_;  ///< which joint has too little inertia before its loops close, or empty
  mutable KktPattern pattern_;
  mutable std::once_flag mass_pattern_known_, constraint_pattern_known_;
  std::vector<RowName> row_names_;
  std::vector<int> row_groups_;
  std::vector<bool> nonholonomic_;
  std::vector<bool> angle_rows_;
  std::vector<double> least_scales_;
};

/// Word of messages for a constraint.
inline const char* loop_word(const Mechanism& mechanism) {
  return mechanism.scene().lagrangian ? "constraint" : "loop";
}

/// The evaluation in doubles.
template <>
std::unique_ptr<Evaluation<double>> Mechanism::evaluation<double>() const;
extern template std::unique_ptr<Evaluation<Dual8>> Mechanism::evaluation<Dual8>() const;
extern template std::unique_ptr<Evaluation<LocalDual>> Mechanism::evaluation<LocalDual>() const;
extern template std::unique_ptr<Evaluation<Jet>> Mechanism::evaluation<Jet>() const;

}  // namespace momenta
