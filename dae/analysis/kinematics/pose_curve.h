#pragma once
// The poses of a mechanism with one freedom left, as a curve. With s the way of the swept
// coordinates c, and h the held coordinates,
//
//   F(q, s) = ( D⁻¹ Φ(q) )
//             ( c(q) − c₀ − a s )  = 0,       J = ( D⁻¹ Φ_q C   0 )
//             ( h(q) − h₀ )                       ( E_c        −a )
//                                                 ( E_h         0 )
//
// n independent equations for n + 1 unknowns (δ, s), δ = C⁻¹ u in units of the scene. τ is the unit
// vector along the curve, J τ = 0, and every step solves
//
//   B = ( J ) ,   r = τ: a step across, B regular wherever J has full rank,
//       ( r )     r = e_s: s given.
//
// At a dead point of c, τ_s = 0: e_s makes B singular, τ does not, and s turns there. At a change
// point J loses rank, and curves cross: the smallest pivot of B(τ) goes through zero as the curve
// is followed straight across. By Cramer's rule det B(e_s) = τ_s det B(τ): its sign is the branch
// of assembly, and changes only at dead and change points.
//
// Dependent rows of J are left out and checked after every step, up to their contradiction of the
// others at the start (contradiction.h). Rows that come to depend on each other are chosen anew.
// Source: Allgower, Georg, Introduction to Numerical Continuation Methods, ch. 2, 6, 8.

#include <momenta/dae/analysis/kinematics/held_coordinate.h>
#include <momenta/dae/topology/assembly/contradiction.h>

#include <Eigen/LU>
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace momenta {

/// A swept coordinate: place in q and u, and its way while s grows by one [rad or m]; for the first
/// a unit of the scene.
struct SweptCoordinate {
  int q = 0, u = 0;
  double amount = 1;
};

struct CurvePoint {
  Eigen::VectorXd q;        ///< nq
  double s = 0;             ///< way of c
  Eigen::VectorXd tangent;  ///< τ (nv + 1), δ and s; of unit length
  int orientation = 0;      ///< sign of det B with r = τ; 0 at a change point
  double pivot = 0;         ///< smallest pivot of that B, over the largest; 0 at a change point
  /// The sign of det B with r = e_s, ±1; 0 at a dead point.
  int branch() const { return orientation * (s_rate() > 0 ? 1 : s_rate() < 0 ? -1 : 0); }
  double s_rate() const { return tangent[tangent.size() - 1]; }  ///< τ_s
};

class PoseCurve {
 public:
  /// Drives stand at t [s]. The mechanism must outlive it.
  PoseCurve(const Mechanism& mechanism, double t, std::vector<SweptCoordinate> swept,
            std::vector<HeldCoordinate> held);

  /// Holds one more coordinate, before the start; release() frees the last.
  void hold(HeldCoordinate held);
  void release();
  const std::vector<HeldCoordinate>& held() const { return held_; }

  /// The point at the pose q, s = 0, with τ_s ≥ 0. False where not exactly one freedom is left:
  /// freedoms().
  bool start(const Eigen::VectorXd& q, CurvePoint& point);
  /// Freedoms at the start, s among them: nv + 1 − rank J.
  int freedoms() const { return freedoms_; }
  /// Rates u (nv) beside s that can be held at the start so that one freedom is left.
  const std::vector<int>& free_rates() const { return free_rates_; }

  /// The point at a distance h along τ. False where Newton's method fails, or the curve bends by
  /// more than a quarter of a radian.
  bool step(const CurvePoint& from, double h, CurvePoint& to);
  /// The point with this s nearest along the curve, from a point near it. False as in step().
  bool step_to(const CurvePoint& from, double s, CurvePoint& to);

  /// u = dq/ds and u̇ (nv) [rad or m], s in units. False at a dead point.
  bool derivatives(const CurvePoint& at, Eigen::VectorXd& u, Eigen::VectorXd& udot);
  /// The n-th singular value of J, all rows, over the first: zero at a change point.
  double reciprocal_condition(const Eigen::VectorXd& q);
  /// Relative singular value of J below which ranks are lost: `agreed`, or more where numbers
  /// contradict each other.
  double lost(double agreed) const { return std::max(agreed, contradiction_.pivot); }
  /// Chooses rows that are independent at q. `known`, a point where the old rows are independent
  /// too, keeps its orientation. False where J has lost rank.
  bool choose_rows(const Eigen::VectorXd& q, CurvePoint& known);

  /// Whether F has dependent rows.
  bool has_spare_rows() const { return all_.size() > n_; }
  /// The orientation of a point by the chosen rows.
  bool orient(CurvePoint& point);

  /// F and J of the chosen rows; returns |F|∞ of all rows, less the contradiction of spare ones.
  double linearise(const CurvePoint& at, Eigen::VectorXd& residual, Eigen::MatrixXd& jacobian);
  /// The pose and s after a step (nv + 1), on the curve or not.
  CurvePoint moved(const CurvePoint& from, const Eigen::VectorXd& step);
  /// The step (nv + 1) from one point to another near it.
  Eigen::VectorXd way(const CurvePoint& from, const CurvePoint& to);

  ScaledLoops& loops() { return loops_; }

 private:
  void size_rows();
  bool choose_rows(const Eigen::VectorXd& q, int most);
  void renew_rows(const CurvePoint& from);
  void take_jacobian(const Eigen::VectorXd& q);
  /// |F|∞ as in linearise(); F of `rows_` alone in residual_.
  double take_residual(const Eigen::VectorXd& q, double s);
  bool correct(CurvePoint& point, const Eigen::VectorXd& row);
  bool take_tangent(const Eigen::VectorXd& along, CurvePoint& point);

  ScaledLoops loops_;
  double t_, tolerance_;
  Contradiction contradiction_;  ///< the start's
  int n_, m_;                    ///< nv; rows of Φ
  std::vector<SweptCoordinate> swept_;
  std::vector<HeldCoordinate> held_;
  Eigen::VectorXd start_;        ///< q where s = 0
  int freedoms_ = 0, sign_ = 1;  ///< sign_ of orientations, by the choice of rows
  std::vector<int> free_rates_;
  std::vector<int> rows_;                ///< independent rows of F, n
  Eigen::VectorXd all_;                  ///< F
  Eigen::MatrixXd jacobian_, bordered_;  ///< J of all rows; B
  Eigen::VectorXd residual_, along_;
  Eigen::PartialPivLU<Eigen::MatrixXd> lu_;
};

}  // namespace momenta
