#pragma once
// The derivative of a run in quadruple precision, the slow way: form `momentum` by classical
// Runge-Kutta steps, (7) by Gauss' elimination of its whole matrix, started at the scene's start
// with the number in question at seven values; the derivative by differences of sixth order. No
// tangents, no dual numbers, no recursion.

#include <momenta/core/expression/functions_quad.h>
#include <momenta/core/scalar/quad.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <cmath>
#include <functional>
#include <vector>

namespace momenta::equations {

class QuadRun {
 public:
  /// `reset`: σ = 0 after each step; `leak` κ otherwise [1/s]; `dependent`: pivots below are those
  /// of rows that follow from others.
  QuadRun(const Mechanism& mechanism, bool reset, double leak, double dependent)
      : e_(mechanism.evaluation<Quad>()),
        reset_(reset),
        leak_(leak),
        dependent_(dependent),
        nq_(at(mechanism.nq())),
        nv_(at(mechanism.nv())),
        m_(at(mechanism.m())) {}

  /// q, then u, after so many steps of h [s] from rest at q.
  std::vector<Quad> operator()(const Eigen::VectorXd& q, double h, int steps) {
    std::vector<Quad> y(q.begin(), q.end());
    y.resize(nq_ + nv_);
    close(y);
    for (int k = 0; k < steps; ++k) {
      const double t = k * h;
      const auto k1 = rates(t, y), k2 = rates(t + h / 2, sum(y, h / 2, k1)),
                 k3 = rates(t + h / 2, sum(y, h / 2, k2)), k4 = rates(t + h, sum(y, h, k3));
      for (std::size_t i = 0; i < y.size(); ++i)
        y[i] += Quad(h) / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
      if (!reset_ || m_ == 0) continue;
      solve(t + h, y);
      e_->place(t + h, y.data());
      e_->move(u_.data());
      e_->momenta(nullptr, y.data() + nq_);
    }
    solve(steps * h, y);
    std::copy(u_.begin(), u_.end(), y.begin() + static_cast<long>(nq_));
    return y;
  }

 private:
  using Vector = std::vector<Quad>;
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  static Vector sum(Vector y, double h, const Vector& k) {
    for (std::size_t i = 0; i < y.size(); ++i) y[i] += Quad(h) * k[i];
    return y;
  }
  /// Of the square system A x = b, columns first, rows dependent on others left out.
  Vector eliminated(std::vector<Vector> a, Vector b) const {
    const std::size_t n = b.size();
    std::vector<std::size_t> column(n, n);
    std::vector<bool> done(n, false);
    for (std::size_t step = 0; step < n; ++step) {
      std::size_t row = n, pivot = n;
      Quad most = dependent_;
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; !done[i] && j < n; ++j)
          if (abs(a[i][j]) > most) most = abs(a[i][j]), row = i, pivot = j;
      if (row == n) break;
      done[row] = true;
      column[row] = pivot;
      for (std::size_t i = 0; i < n; ++i) {
        if (i == row || !(abs(a[i][pivot]) > Quad(0))) continue;
        const Quad part = a[i][pivot] / a[row][pivot];
        for (std::size_t j = 0; j < n; ++j) a[i][j] -= part * a[row][j];
        b[i] -= part * b[row];
        a[i][pivot] = 0;
      }
    }
    Vector x(n, Quad(0));
    for (std::size_t i = 0; i < n; ++i)
      if (column[i] < n) x[column[i]] = b[i] / a[i][column[i]];
    return x;
  }
  /// The matrix of (7) at the last place().
  std::vector<Vector> matrix() {
    const std::size_t n = nv_ + m_;
    std::vector<Vector> a(n, Vector(n, Quad(0)));
    Vector still(nv_), of_loops(m_), p(nv_), rate(m_);
    e_->move(nullptr);
    e_->momenta(nullptr, still.data());
    e_->velocities(of_loops.data());
    for (std::size_t j = 0; j < nv_; ++j) {
      Vector unit(nv_, Quad(0));
      unit[j] = 1;
      e_->move(unit.data());
      e_->momenta(nullptr, p.data());
      e_->velocities(rate.data());
      for (std::size_t i = 0; i < nv_; ++i) a[i][j] = p[i] - still[i];
      for (std::size_t i = 0; i < m_; ++i) a[nv_ + i][j] = a[j][nv_ + i] = rate[i] - of_loops[i];
    }
    return a;
  }
  /// u_ and sigma_ of (7).
  void solve(double t, const Vector& y) {
    e_->place(t, y.data());
    const auto a = matrix();
    Vector still(nv_), right(nv_ + m_);
    e_->move(nullptr);
    e_->momenta(nullptr, still.data());
    e_->velocities(right.data() + nv_);
    for (std::size_t i = 0; i < nv_; ++i) right[i] = y[nq_ + i] - still[i];
    for (std::size_t i = 0; i < m_; ++i) right[nv_ + i] = -right[nv_ + i];
    const Vector x = eliminated(a, right);
    u_.assign(x.begin(), x.begin() + static_cast<long>(nv_));
    sigma_.assign(x.begin() + static_cast<long>(nv_), x.end());
  }
  Vector rates(double t, const Vector& y) {
    solve(t, y);
    Vector f(y.size());
    e_->place(t, y.data());
    e_->move(u_.data());
    const Quad* sigma = m_ > 0 ? sigma_.data() : nullptr;
    e_->momenta(sigma, f.data() + nq_);
    e_->momentum_rates(y.data(), u_.data(), sigma, leak_, f.data() + nq_);
    e_->coordinate_rates(y.data(), u_.data(), f.data());
    return f;
  }
  /// Positions of the start from 1e-12 to the rounding of quadruple precision, by the shortest way
  /// in the mass metric: how it is measured matters in the square of 1e-12 alone.
  void close(Vector& y) {
    for (int pass = 0; m_ > 0 && pass < 2; ++pass) {
      e_->place(0, y.data());
      Vector right(nv_ + m_, Quad(0)), step(nq_);
      e_->positions(right.data() + nv_);
      for (Quad& x : right) x = -x;
      const Vector x = eliminated(matrix(), right);
      e_->place(0, y.data());
      e_->coordinate_rates(y.data(), x.data(), step.data());
      for (std::size_t i = 0; i < nq_; ++i) y[i] += step[i];
    }
  }

  std::unique_ptr<Evaluation<Quad>> e_;
  bool reset_;
  double leak_, dependent_;
  std::size_t nq_, nv_, m_;
  Vector u_, sigma_;
};

/// f'(θ) of what f gives as many numbers for; h of θ.
inline Eigen::VectorXd differenced(const std::function<Eigen::VectorXd(double)>& f, double at,
                                   double h) {
  const auto pair = [&](double k) -> Eigen::VectorXd { return f(at + k * h) - f(at - k * h); };
  return (45 * pair(1) - 9 * pair(2) + pair(3)) / (60 * h);
}

}  // namespace momenta::equations
