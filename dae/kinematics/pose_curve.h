#pragma once
// The poses of a mechanism with one freedom left, as a curve that is followed. With s how far the
// swept coordinates c have come, and coordinates h that are held,
//
//   F(q, s) = ( D⁻¹ Φ(q) )
//             ( c(q) − c₀ − a s )  = 0,       J = ( D⁻¹ Φ_q C   0 )
//             ( h(q) − h₀ )                       ( E_c        −a )
//                                                 ( E_h         0 )
//
// n equations that are independent, for n + 1 unknowns (δ, s), δ = C⁻¹ u in units of the scene. τ
// is the unit vector along the curve, J τ = 0, and every step solves
//
//   B = ( J ) ,   r = τ: a step across, B regular wherever J has full rank,
//       ( r )     r = e_s: s given.
//
// At a dead point of c, τ_s = 0: e_s makes B singular, τ does not, and s turns there. At a change
// point J loses rank, and curves cross: the smallest pivot of B(τ) goes through zero as the curve
// is followed straight across. By Cramer's rule det B(e_s) = τ_s det B(τ): its sign is the branch
// of assembly, and changes at these two kinds of points alone.
//
// Rows of J that follow from others are left out; that they hold is looked at after every step, up
// to what they contradict the others by at the start (contradiction.h). Where the rows chosen
// depend on each other and others do not, they are chosen anew.
// Source: Allgower, Georg, Introduction to Numerical Continuation Methods, ch. 2, 6, 8.

#include <momenta/dae/assembly/contradiction.h>
#include <momenta/dae/kinematics/held_coordinate.h>

#include <Eigen/LU>
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace momenta {

/// A coordinate that is swept: its place in q and u, and how far it goes while s grows by one [rad
/// or m]; for the first a unit of the scene.
struct SweptCoordinate {
  int q = 0, u = 0;
  double amount = 1;
};

/// A point of the curve.
struct CurvePoint {
  Eigen::VectorXd q;        ///< nq
  double s = 0;             ///< how far c has come
  Eigen::VectorXd tangent;  ///< τ (nv + 1), δ and s; of unit length
  int orientation = 0;      ///< sign of det B with r = τ; 0 at a change point
  double pivot = 0;         ///< smallest pivot of that B, over the largest; 0 at a change point
  /// +1 or −1: the sign of det B with r = e_s; 0 at a dead point.
  int branch() const { return orientation * (s_rate() > 0 ? 1 : s_rate() < 0 ? -1 : 0); }
  double s_rate() const { return tangent[tangent.size() - 1]; }  ///< τ_s
};

class PoseCurve {
 public:
  /// Drives stand at t [s]. The mechanism must outlive it.
  PoseCurve(const Mechanism& mechanism, double t, std::vector<SweptCoordinate> swept,
            std::vector<HeldCoordinate> held);

  /// Holds one more, before the start; the last of them no longer.
  void hold(HeldCoordinate held);
  void release();
  const std::vector<HeldCoordinate>& held() const { return held_; }

  /// The point at the pose q, s = 0, with τ_s ≥ 0. False where not one freedom is left:
  /// freedoms() tells how many.
  bool start(const Eigen::VectorXd& q, CurvePoint& point);
  /// Freedoms at the start, s among them: nv + 1 − rank J.
  int freedoms() const { return freedoms_; }
  /// Rates u (nv) that may be chosen at the start beside s, so many that holding their coordinates
  /// leaves one freedom.
  const std::vector<int>& free_rates() const { return free_rates_; }

  /// The point at a distance h along τ. False where Newton's method does not come to it, or the
  /// curve bends by more than a quarter of a radian on the way.
  bool step(const CurvePoint& from, double h, CurvePoint& to);
  /// The point with that s nearest along the curve, from a point near it. False as above.
  bool step_to(const CurvePoint& from, double s, CurvePoint& to);

  /// u = dq/ds and u̇ (nv) [rad or m], s in units. False at a dead point.
  bool derivatives(const CurvePoint& at, Eigen::VectorXd& u, Eigen::VectorXd& udot);
  /// The n-th singular value of J, of all its rows, over the first: zero at a change point.
  double reciprocal_condition(const Eigen::VectorXd& q);
  /// The part of J's first singular value below which ranks are lost: that of numbers that agree,
  /// or more where they contradict each other.
  double lost(double agreed) const { return std::max(agreed, contradiction_.pivot); }
  /// Chooses rows that are independent at q. `known`, a point where the old ones are as well, keeps
  /// its orientation. False where J has lost rank.
  bool choose_rows(const Eigen::VectorXd& q, CurvePoint& known);

  /// Whether F has more rows than are independent.
  bool has_spare_rows() const { return all_.size() > n_; }
  /// The orientation of a point by the rows chosen now.
  bool orient(CurvePoint& point);

  /// F and J of the rows chosen; |F|∞ of all, of spare ones what is beyond the contradiction.
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
  /// |F|∞ as linearise(); F of `rows_` alone into residual_.
  double take_residual(const Eigen::VectorXd& q, double s);
  bool correct(CurvePoint& point, const Eigen::VectorXd& row);
  bool take_tangent(const Eigen::VectorXd& along, CurvePoint& point);

  ScaledLoops loops_;
  double t_, tolerance_;
  Contradiction contradiction_;  ///< at the start
  int n_, m_;                    ///< nv; rows of Φ
  std::vector<SweptCoordinate> swept_;
  std::vector<HeldCoordinate> held_;
  Eigen::VectorXd start_;        ///< q where s = 0
  int freedoms_ = 0, sign_ = 1;  ///< of orientations, by the choice of rows
  std::vector<int> free_rates_;
  std::vector<int> rows_;                ///< independent rows of F, n
  Eigen::VectorXd all_;                  ///< F
  Eigen::MatrixXd jacobian_, bordered_;  ///< of all rows; B
  Eigen::VectorXd residual_, along_;
  Eigen::PartialPivLU<Eigen::MatrixXd> lu_;
};

}  // namespace momenta
