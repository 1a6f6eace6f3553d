// Large systems: L D Lᵀ of the matrix of (7), every pivot of σ filtered as in the dense form and in
// the sweeps, on a pattern analysed once.

#include <momenta/dae/kkt/kkt.h>
#include <momenta/dae/kkt/saddle_point_factor.h>

#include <algorithm>
#include <cmath>

namespace momenta {
namespace {

class SparseKkt final : public Kkt {
 public:
  SparseKkt(const Mechanism& mechanism, std::unique_ptr<SaddlePointFactor> matrix)
      : pattern_(mechanism.constraint_pattern()),
        matrix_(std::move(matrix)),
        n_(static_cast<std::size_t>(mechanism.nv())),
        m_(static_cast<std::size_t>(mechanism.m())),
        x_(n_ + m_) {
    faded_rows_.reserve(m_);
  }

  bool factor(Evaluation<double>& e, double t, const double* q, double fade) override {
    ++factorizations_;
    e.place(t, q);
    const bool ok = matrix_->factor(e, t, q, compliance_, fade);
    singular_joint_ = matrix_->singular_joint();
    if (!ok) return false;
    const std::vector<double>& tau = matrix_->fading();
    faded_rows_.clear();
    weakest_ = 1;
    for (std::size_t i = 0; i < m_; ++i) {
      const double w = matrix_->pivots()[i];
      if (!(w > 10 * tau[i]))
        faded_rows_.push_back(static_cast<int>(i));
      else if (tau[i] > 0)
        weakest_ = std::min(weakest_, w * fade / tau[i]);
    }
    return true;
  }

  bool solve(const double* r, const double* g, const double* centre, double* u,
             double* sigma) override {
    std::copy_n(r, n_, x_.begin());
    std::copy_n(g, m_, x_.begin() + static_cast<std::ptrdiff_t>(n_));
    if (centre)
      for (std::size_t i = 0; i < pattern_.size(); ++i)
        x_[static_cast<std::size_t>(pattern_[i].column)] -=
            matrix_->constraint()[i] * centre[pattern_[i].row];
    matrix_->solve(x_.data());
    bool finite = true;
    for (const double x : x_) finite = finite && std::isfinite(x);
    std::copy_n(x_.begin(), n_, u);
    for (std::size_t i = 0; i < m_; ++i) sigma[i] = x_[n_ + i] + (centre ? centre[i] : 0.0);
    return finite;
  }

 private:
  const std::vector<KktPattern::Entry>& pattern_;  ///< pattern of Φ_q
  std::unique_ptr<SaddlePointFactor> matrix_;
  std::size_t n_, m_;
  std::vector<double> x_;
};

}  // namespace

std::unique_ptr<Kkt> make_sparse_kkt(const Mechanism& mechanism) {
  return std::make_unique<SparseKkt>(mechanism, joint_matrix(mechanism));
}

std::unique_ptr<Kkt> make_front_kkt(const Mechanism& mechanism) {
  return std::make_unique<SparseKkt>(mechanism, front_matrix(mechanism));
}

}  // namespace momenta
