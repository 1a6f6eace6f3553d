#pragma once
// Linear models by differences of the nonlinear equations in quadruple precision: the slow twin.
//
//   [ẋ; y] = F(x, w),   columns (F(+h) − F(−h)) / 2h, h = 2⁻³³: errors near 10⁻²⁰
//
// F closes the loops by Newton's steps on the dependent coordinates, takes dependent rates from
// Φ̇ = 0 and accelerations and λ from the whole matrix ( M Φ_qᵀ; Φ_q 0 ), whose columns are
// differences of the rows for unit vectors, which are linear. No derivative of M, Φ_q or of forces
// is asked for. For mechanisms with u = q̇ whose free coordinates are x.

#include <momenta/core/expression/functions_quad.h>
#include <momenta/core/scalar/quad.h>
#include <momenta/dae/analysis/linear/independent_coordinates.h>
#include <momenta/dae/mechanism/marker_motion.h>

#include <Eigen/Core>
#include <cmath>
#include <utility>
#include <vector>

namespace momenta::equations {

class QuadLinearTwin {
 public:
  using Numbers = std::vector<Quad>;

  QuadLinearTwin(const OperatingPoint& at, const IndependentCoordinates& chosen)
      : at_(at), c_(chosen), m_(*at.freed), e_(m_.evaluation<Quad>()) {
    if (!m_.scene().markers.empty()) markers_ = make_marker_motion<Quad>(m_);
  }

  /// [ẋ; y] at the state itself.
  std::vector<double> at_state() {
    const Numbers all = values(Numbers(columns(), Quad(0)));
    std::vector<double> some;
    for (const Quad& x : all) some.push_back(value_of(x));
    return some;
  }

  /// [ẋ; y] by columns of x, then of w without drives of loops, both as linear_model() has them.
  Eigen::MatrixXd differences() {
    const double h = std::ldexp(1.0, -33);
    Eigen::MatrixXd all;
    for (std::size_t j = 0; j < columns(); ++j) {
      Numbers ahead(columns(), Quad(0)), behind = ahead;
      ahead[j] = h;
      behind[j] = -h;
      const Numbers a = values(ahead), b = values(behind);
      if (all.size() == 0) all.resize(static_cast<long>(a.size()), static_cast<long>(columns()));
      for (std::size_t i = 0; i < a.size(); ++i)
        all(static_cast<long>(i), static_cast<long>(j)) =
            value_of((a[i] - b[i]) / (Quad(2) * Quad(h)));
    }
    return all;
  }

 private:
  using Matrix = std::vector<Numbers>;

  std::size_t columns() const {
    return c_.free_positions.size() + c_.free_rates.size() + at_.free.size() +
           3 * at_.driven.size();
  }

  static Numbers solve(Matrix a, Numbers b) {
    const std::size_t n = b.size();
    for (std::size_t k = 0; k < n; ++k) {
      std::size_t best = k;
      for (std::size_t i = k; i < n; ++i)
        if (abs(a[i][k]) > abs(a[best][k])) best = i;
      std::swap(a[k], a[best]);
      std::swap(b[k], b[best]);
      for (std::size_t i = k + 1; i < n; ++i) {
        const Quad factor = a[i][k] / a[k][k];
        for (std::size_t j = k; j < n; ++j) a[i][j] -= factor * a[k][j];
        b[i] -= factor * b[k];
      }
    }
    for (std::size_t k = n; k-- > 0;) {
      for (std::size_t j = k + 1; j < n; ++j) b[k] -= a[k][j] * b[j];
      b[k] /= a[k][k];
    }
    return b;
  }

  static std::size_t of(int i) { return static_cast<std::size_t>(i); }

  /// Rows of Φ_q where the evaluation is placed, columns of these rates.
  Matrix jacobian(const std::vector<int>& rows, const std::vector<int>& rates) {
    const auto m = of(m_.m());
    Numbers still(m), moved(m), u(of(m_.nv()), Quad(0));
    e_->move(u.data());
    e_->velocities(still.data());
    Matrix a(rows.size(), Numbers(rates.size()));
    for (std::size_t j = 0; j < rates.size(); ++j) {
      u[of(rates[j])] = 1;
      e_->move(u.data());
      e_->velocities(moved.data());
      u[of(rates[j])] = 0;
      for (std::size_t i = 0; i < rows.size(); ++i)
        a[i][j] = moved[of(rows[i])] - still[of(rows[i])];
    }
    return a;
  }
  static Numbers picked(const Numbers& x, const std::vector<int>& places) {
    Numbers some;
    for (const int i : places) some.push_back(x[of(i)]);
    return some;
  }

  Numbers values(const Numbers& x) {
    const auto nv = of(m_.nv()), m = of(m_.m());
    Numbers q(at_.q.begin(), at_.q.end()), u(at_.u.begin(), at_.u.end()), udot(nv, Quad(0));
    std::size_t next = 0;
    for (const int i : c_.free_positions) q[of(i)] += x[next++];
    for (const int i : c_.free_rates) u[of(i)] += x[next++];
    Numbers tau(nv, Quad(0));
    for (const int i : at_.free) tau[of(i)] = x[next++];
    for (std::size_t k = 0; k < at_.driven.size(); ++k) {
      const std::size_t i = of(at_.driven[k]);
      q[i] += x[next++];
      u[i] += x[next++];
      udot[i] = Quad(at_.driven_accelerations[static_cast<long>(k)]) + x[next++];
    }
    Numbers rows(m);
    const std::vector<int> dependent(
        c_.dependent.begin(), c_.dependent.begin() + static_cast<long>(c_.position_rows.size()));
    for (int k = 0; k < 4 && !dependent.empty(); ++k) {
      e_->place(at_.t, q.data());
      e_->positions(rows.data());
      const Numbers step =
          solve(jacobian(c_.position_rows, dependent), picked(rows, c_.position_rows));
      for (std::size_t i = 0; i < dependent.size(); ++i) q[of(dependent[i])] -= step[i];
    }
    e_->place(at_.t, q.data());
    if (!c_.dependent.empty()) {
      const Matrix a = jacobian(c_.rows, c_.dependent);
      e_->move(u.data());
      e_->velocities(rows.data());
      const Numbers step = solve(a, picked(rows, c_.rows));
      for (std::size_t i = 0; i < c_.dependent.size(); ++i) u[of(c_.dependent[i])] -= step[i];
    }
    return accelerated(q, u, udot, tau);
  }

  Numbers accelerated(const Numbers& q, const Numbers& u, Numbers udot, const Numbers& tau) {
    const auto nv = of(m_.nv()), m = of(m_.m());
    const std::size_t n = at_.free.size(), r = c_.rows.size();
    Numbers lambda(m, Quad(0)), r0(nv), s0(m), r1(nv), s1(m);
    const auto rows = [&](Numbers& forces, Numbers& second) {
      e_->place(at_.t, q.data());
      e_->move(u.data());
      e_->joint_forces(q.data(), u.data(), udot.data(), lambda.data(), forces.data());
      e_->accelerations(second.data());
      for (std::size_t i = 0; i < nv; ++i) forces[i] -= tau[i];
    };
    rows(r0, s0);
    Matrix a(n + r, Numbers(n + r));
    Numbers b(n + r);
    for (std::size_t i = 0; i < n; ++i) b[i] = -r0[of(at_.free[i])];
    for (std::size_t i = 0; i < r; ++i) b[n + i] = -s0[of(c_.rows[i])];
    for (std::size_t j = 0; j < n + r; ++j) {
      Quad& one = j < n ? udot[of(at_.free[j])] : lambda[of(c_.rows[j - n])];
      one += Quad(1);
      rows(r1, s1);
      one -= Quad(1);
      for (std::size_t i = 0; i < n; ++i) a[i][j] = r1[of(at_.free[i])] - r0[of(at_.free[i])];
      for (std::size_t i = 0; i < r; ++i) a[n + i][j] = s1[of(c_.rows[i])] - s0[of(c_.rows[i])];
    }
    const Numbers found = solve(a, b);
    for (std::size_t i = 0; i < n; ++i) udot[of(at_.free[i])] += found[i];
    for (std::size_t i = 0; i < r; ++i) lambda[of(c_.rows[i])] += found[n + i];
    rows(r1, s1);
    Numbers markers(6 * m_.scene().markers.size());
    if (!markers.empty()) markers_->at(at_.t, q.data(), u.data(), markers.data());

    Numbers all = picked(u, c_.free_positions);
    const auto add = [&](const Numbers& more) { all.insert(all.end(), more.begin(), more.end()); };
    add(picked(udot, c_.free_rates));
    add(picked(q, at_.free));
    add(picked(u, at_.free));
    add(picked(udot, at_.free));
    add(markers);
    add(picked(r1, at_.driven));
    for (std::size_t i = 0; i < m; ++i)
      if (c_.unique[i]) all.push_back(lambda[i]);
    return all;
  }

  const OperatingPoint& at_;
  const IndependentCoordinates& c_;
  const Mechanism& m_;
  std::unique_ptr<Evaluation<Quad>> e_;
  std::unique_ptr<MarkerMotion<Quad>> markers_;
};

}  // namespace momenta::equations
