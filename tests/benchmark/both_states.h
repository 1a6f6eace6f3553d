#pragma once
// The motion of a chain of revolute joints in its two states, x = (q, p) and x = (q, u), each by
// its own recursion: ẋ, the way through a second in fixed steps, and how fast ẋ changes with x.

#include <momenta/core/kernel/acceleration_sweeps.h>
#include <momenta/core/kernel/momentum_sweeps.h>
#include <momenta/core/scalar/dual.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "equations/decompositions.h"

namespace momenta::stability {

using Doubles = std::vector<double>;

template <class S>
class MotionOfMomenta {
 public:
  explicit MotionOfMomenta(const LinkTree& links) : sweeps_(links), n_(links.links.size()) {}
  bool operator()(const S* x, S* rate) { return sweeps_(S(0.0), x, x + n_, rate, rate + n_); }

 private:
  MomentumSweeps<Spatial, S> sweeps_;
  std::size_t n_;
};

template <class S>
class MotionOfVelocities {
 public:
  explicit MotionOfVelocities(const LinkTree& links)
      : sweeps_(links), n_(links.links.size()), no_force_(n_) {}
  bool operator()(const S* x, S* rate) {
    std::copy(x + n_, x + 2 * n_, rate);
    return sweeps_(S(0.0), x, x + n_, no_force_.data(), rate + n_);
  }

 private:
  AccelerationSweeps<Spatial, S> sweeps_;
  std::size_t n_;
  std::vector<S> no_force_;
};

/// Angles after 1 s in steps of RK4; empty when a joint lost its inertia on the way.
template <template <class> class Motion, class S>
std::vector<S> angles_after_1_s(const LinkTree& links, int steps, const Doubles& start) {
  Motion<S> rates(links);
  const double h = 1.0 / steps;
  std::vector<S> x(start.begin(), start.end());
  std::vector<S> at(x.size()), slope(x.size()), sum(x.size());
  for (int step = 0; step < steps; ++step) {
    at = x;
    std::fill(sum.begin(), sum.end(), S(0.0));
    for (const auto& [ahead, weight] : {std::pair{0.5, 1.0}, {0.5, 2.0}, {1.0, 2.0}, {0.0, 1.0}}) {
      if (!rates(at.data(), slope.data())) return {};
      for (std::size_t i = 0; i < x.size(); ++i) {
        at[i] = x[i] + ahead * h * slope[i];
        sum[i] += weight * slope[i];
      }
    }
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += sum[i] * (h / 6);
  }
  x.resize(x.size() / 2);
  return x;
}

/// Largest |eigenvalue| of ∂ẋ/∂x [1/s]: times the step it must stay below about 2.8 for RK4.
template <template <class> class Motion>
double fastest_rate(const LinkTree& links, const Doubles& start) {
  Motion<Dual8> rates(links);
  const std::size_t size = start.size();
  Eigen::MatrixXd jacobian(size, size);
  std::vector<Dual8> x(start.begin(), start.end()), slope(size);
  for (std::size_t first = 0; first < size; first += 8) {
    const std::size_t count = std::min<std::size_t>(8, size - first);
    for (std::size_t j = 0; j < count; ++j)
      x[first + j] = Dual8::variable(start[first + j], static_cast<int>(j));
    rates(x.data(), slope.data());
    for (std::size_t j = 0; j < count; ++j) {
      x[first + j] = start[first + j];
      for (std::size_t i = 0; i < size; ++i)
        jacobian(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(first + j)) =
            slope[i].b[j];
    }
  }
  return Eigen::EigenSolver<Eigen::MatrixXd>(jacobian, false).eigenvalues().cwiseAbs().maxCoeff();
}

}  // namespace momenta::stability
