#include <momenta/dae/algebra/dense/singular_values.h>

#ifdef __SSE2__
#include <xmmintrin.h>
#endif

template class Eigen::BDCSVD<Eigen::MatrixXd>;
template class Eigen::JacobiSVD<Eigen::MatrixXd>;

namespace momenta {
namespace {

#ifdef __SSE2__
constexpr bool can_flush = true;
/// While it lives, numbers below the least normal one are zero.
class Flushed {
 public:
  Flushed() : before_(_mm_getcsr()) {
    constexpr unsigned results = 0x8000, operands = 0x0040;
    _mm_setcsr(before_ | results | operands);
  }
  ~Flushed() { _mm_setcsr(before_); }
  Flushed(const Flushed&) = delete;
  Flushed& operator=(const Flushed&) = delete;

 private:
  unsigned before_;
};
#else
constexpr bool can_flush = false;
struct Flushed {};
#endif

}  // namespace

SingularValues::SingularValues(const Eigen::MatrixXd& a, unsigned options) {
  const auto take = [&](const auto& svd) {
    constexpr double rounding = 1e-10;
    values = svd.singularValues();
    u = svd.matrixU();
    v = svd.matrixV();
    const Eigen::MatrixXd product =
        u.leftCols(values.size()) * values.asDiagonal() * v.leftCols(values.size()).transpose();
    return (product - a).norm() <= rounding * a.norm() && u.isUnitary(rounding) &&
           v.isUnitary(rounding);
  };
  if constexpr (can_flush) {
    [[maybe_unused]] const Flushed flushed{};
    if (take(Eigen::BDCSVD<Eigen::MatrixXd>(a, options))) return;
  }
  take(Eigen::JacobiSVD<Eigen::MatrixXd>(a, options));
}

Eigen::Index SingularValues::rank(double part) const {
  return values.size() > 0 ? (values.array() > part * values[0]).count() : 0;
}

Eigen::VectorXd SingularValues::solve(const Eigen::VectorXd& b, Eigen::Index rank) const {
  return v.leftCols(rank) * (u.leftCols(rank).transpose() * b).cwiseQuotient(values.head(rank));
}

}  // namespace momenta
