#include <momenta/dae/algebra/dense/decompositions.h>
#include <momenta/dae/analysis/kinematics/pose_curve.h>

#include <algorithm>
#include <cmath>

namespace momenta {
namespace {

constexpr double independent = 1e-9;  // relative pivots of J
constexpr double most_bend = 0.25;    // [rad] between two tangents
constexpr int corrections = 8;
constexpr double closed = 1e-12;  // |F|∞ in units, at least

}  // namespace

PoseCurve::PoseCurve(const Mechanism& mechanism, double t, std::vector<SweptCoordinate> swept,
                     std::vector<HeldCoordinate> held)
    : loops_(mechanism),
      t_(t),
      tolerance_(std::max(closed, loops_.units().rounding)),
      n_(mechanism.nv()),
      m_(mechanism.m()),
      swept_(std::move(swept)),
      held_(std::move(held)),
      bordered_(n_ + 1, n_ + 1),
      residual_(n_ + 1),
      along_(n_ + 1),
      lu_(n_ + 1) {
  size_rows();
}

void PoseCurve::hold(HeldCoordinate held) {
  held_.push_back(std::move(held));
  size_rows();
}

void PoseCurve::release() {
  held_.pop_back();
  size_rows();
}

void PoseCurve::size_rows() {
  all_.resize(m_ + static_cast<int>(swept_.size() + held_.size()));
  jacobian_.setZero(all_.size(), n_ + 1);
  int row = m_;
  for (const SweptCoordinate& c : swept_) {
    jacobian_(row, c.u) = 1;
    jacobian_(row++, n_) = -c.amount / loops_.units().rates[c.u];
  }
}

void PoseCurve::take_jacobian(const Eigen::VectorXd& q) {
  loops_.gap(t_, q);  // places the loops at q
  jacobian_.topRows(m_).setZero();
  const std::vector<double> entries = loops_.jacobian();
  for (std::size_t k = 0; k < entries.size(); ++k)
    jacobian_(loops_.pattern()[k].row, loops_.pattern()[k].column) = entries[k];
  const Eigen::VectorXd& units = loops_.units().rates;
  int row = m_ + static_cast<int>(swept_.size());
  for (const HeldCoordinate& held : held_) {
    jacobian_.row(row).head(n_) =
        held.row(loops_.evaluation(), q, n_).cwiseProduct(units.transpose()) /
        units[held.rates.front()];
    ++row;
  }
}

double PoseCurve::take_residual(const Eigen::VectorXd& q, double s) {
  all_.head(m_) = loops_.gap(t_, q) - contradiction_.open;
  int row = m_;
  for (const SweptCoordinate& c : swept_)
    all_[row++] = (q[c.q] - start_[c.q] - c.amount * s) / loops_.units().rates[c.u];
  for (const HeldCoordinate& held : held_)
    all_[row++] = (held.value(q) - held.value(start_)) / loops_.units().rates[held.rates.front()];
  for (int i = 0; i < n_; ++i) residual_[i] = all_[rows_[static_cast<std::size_t>(i)]];
  residual_[n_] = 0;
  const double open = all_.size() > 0 ? all_.cwiseAbs().maxCoeff() : 0;
  return std::max(open - contradiction_.left, residual_.cwiseAbs().maxCoeff());
}

/// Chooses up to `most` rows: along the curve no more than n are independent, but for
/// contradictions.
bool PoseCurve::choose_rows(const Eigen::VectorXd& q, int most) {
  take_jacobian(q);
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(jacobian_.transpose());
  qr.setThreshold(contradiction_.pivot);
  const int rank = std::min(static_cast<int>(qr.rank()), most);
  freedoms_ = n_ + 1 - rank;
  free_rates_.clear();
  if (freedoms_ > 1) {
    // Pivots of J's columns, s the last to be free; columns without a pivot may be chosen.
    Eigen::MatrixXd ordered(jacobian_.rows(), n_);
    for (int i = 0; i < n_; ++i) ordered.col(i) = jacobian_.col(i);
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> columns(ordered);
    columns.setThreshold(contradiction_.pivot);
    for (auto i = columns.rank(); i < n_ && static_cast<int>(free_rates_.size()) < freedoms_ - 1;
         ++i)
      free_rates_.push_back(static_cast<int>(columns.colsPermutation().indices()[i]));
  }
  if (freedoms_ != 1) return false;
  rows_.resize(static_cast<std::size_t>(n_));
  for (int i = 0; i < n_; ++i)
    rows_[static_cast<std::size_t>(i)] = static_cast<int>(qr.colsPermutation().indices()[i]);
  std::sort(rows_.begin(), rows_.end());  // so that the sign of det B does not depend on the order
  return true;
}

bool PoseCurve::start(const Eigen::VectorXd& q, CurvePoint& point) {
  start_ = q;
  contradiction_ = contradiction(loops_, t_, q, independent);
  if (!choose_rows(q, n_ + 1)) return false;
  point.q = q;
  point.s = 0;
  // The null space of J, of full rank, is τ.
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(jacobian_, Eigen::ComputeFullV);
  Eigen::VectorXd way = svd.matrixV().col(n_);
  if (way[n_] < 0) way = -way;
  return take_tangent(way, point);
}

/// Takes τ with τ·along > 0, and det B for r = τ, from B with the last row `along`.
bool PoseCurve::take_tangent(const Eigen::VectorXd& along, CurvePoint& point) {
  for (int i = 0; i < n_; ++i) bordered_.row(i) = jacobian_.row(rows_[static_cast<std::size_t>(i)]);
  bordered_.row(n_) = along;
  lu_.compute(bordered_);
  Eigen::VectorXd way = lu_.solve(Eigen::VectorXd::Unit(n_ + 1, n_));
  const double length = way.norm();
  if (!std::isfinite(length)) return false;
  point.tangent = way / length;
  // det B(τ) = det B(along) |way| has the same sign, as along·way = 1.
  const auto pivots = lu_.matrixLU().diagonal();
  int sign = sign_ * static_cast<int>(lu_.permutationP().determinant());
  for (const double pivot : pivots) sign = pivot < 0 ? -sign : sign;
  point.orientation = sign;
  point.pivot = pivots.cwiseAbs().minCoeff() / pivots.cwiseAbs().maxCoeff();
  return true;
}

/// Newton's method across `row`: row·(δ, s) is constant.
bool PoseCurve::correct(CurvePoint& point, const Eigen::VectorXd& row) {
  double last = INFINITY;
  for (int k = 0; k <= corrections; ++k) {
    const double open = take_residual(point.q, point.s);
    if (!std::isfinite(open)) return false;
    if (open <= tolerance_) return true;
    if (k > 1 && !(open < 0.5 * last)) return false;
    last = open;
    take_jacobian(point.q);
    for (int i = 0; i < n_; ++i)
      bordered_.row(i) = jacobian_.row(rows_[static_cast<std::size_t>(i)]);
    bordered_.row(n_) = row;
    lu_.compute(bordered_);
    along_ = lu_.solve(-residual_);
    if (!along_.allFinite()) return false;
    point.q = loops_.moved(point.q, along_.head(n_));
    point.s += along_[n_];
  }
  return false;
}

/// Chooses the most independent rows anew: a pose is off by the contradiction of numbers over the
/// pivots of the chosen rows.
void PoseCurve::renew_rows(const CurvePoint& from) {
  if (contradiction_.left == 0 || from.orientation == 0) return;
  CurvePoint known = from;
  choose_rows(from.q, known);
}

bool PoseCurve::step(const CurvePoint& from, double h, CurvePoint& to) {
  renew_rows(from);
  to.q = loops_.moved(from.q, h * from.tangent.head(n_));
  to.s = from.s + h * from.s_rate();
  if (!correct(to, from.tangent)) return false;
  take_jacobian(to.q);
  return take_tangent(from.tangent, to) && to.tangent.dot(from.tangent) > std::cos(most_bend);
}

bool PoseCurve::step_to(const CurvePoint& from, double s, CurvePoint& to) {
  const double h = (s - from.s) / from.s_rate();
  if (!std::isfinite(h)) return false;
  renew_rows(from);
  to.q = loops_.moved(from.q, h * from.tangent.head(n_));
  to.s = s;
  if (!correct(to, Eigen::VectorXd::Unit(n_ + 1, n_))) return false;
  take_jacobian(to.q);
  return take_tangent(from.tangent, to) && to.tangent.dot(from.tangent) > std::cos(most_bend);
}

bool PoseCurve::derivatives(const CurvePoint& at, Eigen::VectorXd& u, Eigen::VectorXd& udot) {
  constexpr double dead = 1e-9;
  if (std::abs(at.s_rate()) < dead) return false;
  const Eigen::VectorXd& unit = loops_.units().rates;
  u = at.tangent.head(n_).cwiseProduct(unit) / at.s_rate();
  // Φ̈ = 0, from u̇ = 0: J_R u̇ = −Φ̈; swept and held coordinates are not accelerated.
  Evaluation<double>& e = loops_.evaluation();
  take_jacobian(at.q);
  Eigen::VectorXd tau(n_), rate(m_);
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(n_);
  e.place(t_, at.q.data());
  e.move(u.data());
  e.joint_forces(at.q.data(), u.data(), none.data(), nullptr, tau.data());
  e.accelerations(rate.data());
  all_.setZero();
  all_.head(m_) = loops_.in_units(rate);
  for (int i = 0; i < n_; ++i) {
    const int row = rows_[static_cast<std::size_t>(i)];
    bordered_.row(i) = jacobian_.row(row);
    residual_[i] = -all_[row];
  }
  bordered_.row(n_) = Eigen::VectorXd::Unit(n_ + 1, n_);
  residual_[n_] = 0;
  lu_.compute(bordered_);
  along_ = lu_.solve(residual_);
  udot = along_.head(n_).cwiseProduct(unit);
  return udot.allFinite();
}

double PoseCurve::reciprocal_condition(const Eigen::VectorXd& q) {
  take_jacobian(q);
  const Eigen::VectorXd values = jacobian_.jacobiSvd().singularValues();
  return values.size() < n_ ? 0 : values[n_ - 1] / values[0];
}

bool PoseCurve::choose_rows(const Eigen::VectorXd& q, CurvePoint& known) {
  if (!choose_rows(q, n_)) return false;
  const int before = known.orientation;
  if (!orient(known)) return false;
  if (known.orientation != before) sign_ = -sign_;
  known.orientation = before;
  return true;
}

bool PoseCurve::orient(CurvePoint& point) {
  take_jacobian(point.q);
  return take_tangent(Eigen::VectorXd(point.tangent), point);
}

double PoseCurve::linearise(const CurvePoint& at, Eigen::VectorXd& residual,
                            Eigen::MatrixXd& jacobian) {
  const double open = take_residual(at.q, at.s);
  take_jacobian(at.q);
  residual = residual_.head(n_);
  jacobian.resize(n_, n_ + 1);
  for (int i = 0; i < n_; ++i) jacobian.row(i) = jacobian_.row(rows_[static_cast<std::size_t>(i)]);
  return open;
}

CurvePoint PoseCurve::moved(const CurvePoint& from, const Eigen::VectorXd& step) {
  CurvePoint to;
  to.q = loops_.moved(from.q, step.head(n_));
  to.s = from.s + step[n_];
  return to;
}

Eigen::VectorXd PoseCurve::way(const CurvePoint& from, const CurvePoint& to) {
  Eigen::VectorXd step(n_ + 1), rates(n_), qdot = to.q - from.q;
  Evaluation<double>& e = loops_.evaluation();
  e.place(t_, from.q.data());
  e.joint_rates(from.q.data(), qdot.data(), rates.data());
  step.head(n_) = rates.cwiseQuotient(loops_.units().rates);
  step[n_] = to.s - from.s;
  return step;
}

}  // namespace momenta
