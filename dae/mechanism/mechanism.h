#pragma once
// A mechanism, made from a scene: its tree, its loops, and the plan that says what every evaluation
// computes. Immutable; every form, solver and measure takes it by const reference.

#include <momenta/core/kernel/plan.h>
#include <momenta/core/scalar/local_dual.h>
#include <momenta/core/scalar/power_series.h>
#include <momenta/dae/mechanism/evaluation.h>
#include <momenta/dae/mechanism/kkt_pattern.h>
#include <momenta/dae/mechanism/loop/row_name.h>

#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace momenta {

struct LagrangianModel;  // core/scene/lagrangian/lagrangian_model.h
template <class Space>
struct ModelData;    // dae/mechanism/model_data.h
class SolverChoice;  // dae/kkt/solver_choice.h

/// How (7) is solved: by sweeps that carry the loops, or by an assembled matrix.
enum class KktChoice {
  automatic,  ///< sweeps where they can, else by size
  sweeps,     ///< by sweeps that carry the loops, no matrix
  sparse,     ///< a sparse matrix
  dense       ///< a dense matrix
};
/// The name that `--kkt` takes.
const char* name_of(KktChoice choice);

/// The mechanism that runs integrate (dae/topology/cut/integrated_scene.h).
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
  /// How (7) is solved where there are loops, chosen at the first call. @throws SceneError where
  /// the options ask for a way that does not solve it
  const SolverChoice& solver() const;
  /// LoopWeights::spread
  double mass_spread() const { return mass_spread_; }
  /// LoopWeights::apart
  double masses_apart() const { return masses_apart_; }
  /// LoopWeights::light
  const std::string& furthest_apart() const { return furthest_apart_; }
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

  /// Calls f with the ModelData of the plan's algebra; without bodies where there is a Lagrangian.
  /// Defined in dae/mechanism/model_data.h.
  template <class F>
  decltype(auto) visit(F&& f) const;

 private:
  struct Models;
  void take_bodies();
  void take_lagrangian();
  void take_weights();
  template <class Space, class S>
  class SweepRows;
  template <class Space>
  class SweepEvaluation;

  Scene scene_;
  MechanismOptions options_;
  Tree tree_;
  Plan plan_;
  std::unique_ptr<Models> models_;  ///< dae/mechanism/model_data.h
  int rows_ = 0;
  double mass_spread_ = 1, masses_apart_ = 1;
  std::string furthest_apart_;
  mutable std::shared_ptr<const SolverChoice> solver_;
  mutable std::once_flag solver_known_;
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
