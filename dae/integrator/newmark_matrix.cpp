// The Newton matrix of Newmark's family: its layout, derivatives, scales and solutions.

#include <momenta/dae/integrator/local_newton.h>
#include <momenta/dae/integrator/multistep_run.h>
#include <momenta/dae/integrator/newmark.h>

#include <algorithm>

namespace momenta {

const JacobianPattern& Newmark::given() const {
  return local_ != nullptr ? local_->pattern() : system_.pattern();
}

/// Lays out the given pattern, with the diagonal of λ where there is a penalty.
void Newmark::lay_out_matrix() {
  const JacobianPattern& given = this->given();
  pattern_ = given;
  diagonal_.clear();
  place_of_.clear();
  const std::size_t first = nq_ + nv_;
  if (given.column_start.empty()) {
    for (std::size_t i = first; i < n_; ++i) diagonal_.push_back(i * n_ + i);
    return;
  }
  if (!rule_.augmented) return;
  pattern_ = {};
  pattern_.column_start.push_back(0);
  for (std::size_t column = 0; column + 1 < given.column_start.size(); ++column) {
    bool has_diagonal = column < first || column >= n_;
    for (auto k = given.column_start[column]; k < given.column_start[column + 1]; ++k) {
      const long row = given.row[static_cast<std::size_t>(k)];
      if (!has_diagonal && row >= static_cast<long>(column)) {
        diagonal_.push_back(pattern_.row.size());
        if (row > static_cast<long>(column)) pattern_.row.push_back(static_cast<long>(column));
        has_diagonal = true;
      }
      place_of_.push_back(pattern_.row.size());
      pattern_.row.push_back(row);
    }
    if (!has_diagonal) {
      diagonal_.push_back(pattern_.row.size());
      pattern_.row.push_back(static_cast<long>(column));
    }
    pattern_.column_start.push_back(static_cast<long>(pattern_.row.size()));
  }
}

/// Makes the scaled matrix at the present guess.
bool Newmark::differentiate(double t, double h, State& next, Factored& matrix, Counters& counters) {
  place(h, next);
  ++counters.jacobians;
  ++counters.factorizations;
  const double c_q = rule_.gamma / (rule_.beta * h), c_v = 1 / (h * rule_.gamma * rule_.kappa());
  if (local_ != nullptr) {
    if (!take_local(t + h, next, c_q, c_v, matrix)) return evaluation_failed();
  } else if (!system_.jacobian(t + h, next.y.data(), next.ydot.data(), 0, by_y_.data()) ||
             !system_.jacobian(t + h, next.y.data(), next.ydot.data(), c_v, by_rate_.data())) {
    return evaluation_failed();
  }
  const JacobianPattern& given = this->given();
  const std::size_t columns = given.column_start.empty() ? n_ : given.column_start.size() - 1;
  double* values = matrix.matrix->values();
  for (const std::size_t at : diagonal_) values[at] = 0;
  for (std::size_t column = 0, k = 0; column < columns; ++column) {
    // by_rate_ = J_0 + c_v J_1.
    const double c = column < nq_ ? c_q / c_v : 1;
    const std::size_t end = given.column_start.empty()
                                ? (column + 1) * n_
                                : static_cast<std::size_t>(given.column_start[column + 1]);
    for (; k < end; ++k) {
      const std::size_t row =
          given.column_start.empty() ? k - column * n_ : static_cast<std::size_t>(given.row[k]);
      const double value =
          local_ != nullptr ? local_->values()[k] : by_y_[k] + c * (by_rate_[k] - by_y_[k]);
      values[place_of_.empty() ? k : place_of_[k]] =
          row_scale(row, h) * value / column_scale(column, h);
    }
  }
  if (rule_.augmented) {
    const std::vector<double>& compliance = order_.compliance();
    for (std::size_t i = 0; i < diagonal_.size(); ++i)
      values[diagonal_[i]] -= rule_.beta * compliance[i];
  }
  matrix.step = matrix.matrix->factor() ? h : 0;
  if (matrix.step == 0) cause_ = "the Newton matrix is singular";
  return matrix.step != 0;
}

/// Makes the local matrix at `next`, in local_, and a place for it in `matrix`.
bool Newmark::take_local(double t, const State& next, double c_q, double c_v, Factored& matrix) {
  std::fill_n(rate_factors_.begin(), nq_, c_q);
  std::fill_n(rate_factors_.data() + nq_, nv_, c_v);
  if (!local_->evaluate(t, next.y.data(), next.ydot.data(), rate_factors_.data())) return false;
  if (version_ != local_->version()) {
    version_ = local_->version();
    lay_out_matrix();
    padded_.assign(pattern_.column_start.size() - 1, 0.0);
  }
  if (!matrix.matrix || matrix.version != version_) {
    matrix.matrix = make_local_matrix(pattern_);
    matrix.version = version_;
  }
  return true;
}

void Newmark::solve_with(NewtonMatrix<double>& matrix, double* b) {
  if (local_ == nullptr) return matrix.solve(b);
  std::copy_n(b, n_, padded_.begin());
  std::fill(padded_.data() + n_, padded_.data() + padded_.size(), 0.0);
  matrix.solve(padded_.data());
  std::copy_n(padded_.begin(), n_, b);
}

}  // namespace momenta
