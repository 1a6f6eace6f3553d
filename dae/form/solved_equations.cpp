#include <momenta/dae/form/solved_equations.h>

#include <algorithm>

namespace momenta {

void SolvedEquations::make() const {
  form_.reset(&dynamic_cast<DaeForm&>(*make_().release()));
  y_.resize(static_cast<std::size_t>(form_->size()));
  ydot_.resize(y_.size());
}

const JacobianPattern& SolvedEquations::pattern() const {
  if (!form_) {
    make();
    form_->start(0, y_.data(), ydot_.data());
    form_->local_jacobian().evaluate(0, y_.data(), ydot_.data(), 1);
  }
  return form_->local_jacobian().pattern();
}

bool SolvedEquations::evaluate(double t, const double* y, const double* f, double c) {
  if (!form_) make();
  const auto own = static_cast<std::ptrdiff_t>(y_.size() - multipliers_.size());
  std::copy(multipliers_.begin(), multipliers_.end(), std::copy_n(y, own, y_.begin()));
  std::copy_n(f, own, ydot_.begin());
  return form_->local_jacobian().evaluate(t, y_.data(), ydot_.data(), c);
}

}  // namespace momenta
