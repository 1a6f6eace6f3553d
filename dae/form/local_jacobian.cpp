// Newton matrices of the DAE forms and their patterns: up to dense_limit unknowns a dense J; up to
// local_limit a sparse J, whose columns without a common row share one direction of the dual
// numbers; above it a local matrix in place of J.

#include <momenta/core/scene/formula.h>
#include <momenta/dae/form/dae_form.h>
#include <momenta/dae/solver/second_order.h>

#include <algorithm>
#include <cmath>

namespace momenta {
namespace {

constexpr int dense_limit =
    60;  // unknowns below which a dense Newton matrix is faster than KLU's bookkeeping
constexpr int local_limit = 500;  // above which J itself is not formed

}  // namespace

class DaeForm::Local final : public LocalOfSecondOrder {
 public:
  explicit Local(DaeForm& form)
      : form_(form),
        in_time_(form.mechanism_.plan().drives || has_formulas(form.mechanism_.scene())),
        s_(form.mechanism_, form.size()) {}

  bool evaluate(double t, const double* y, const double* ydot, double c) override {
    return fill(t, y, ydot, [c](std::size_t) { return c; });
  }
  bool evaluate(double t, const double* y, const double* ydot, const double* c) override {
    return fill(t, y, ydot, [c](std::size_t i) { return c[i]; });
  }
  const JacobianPattern& pattern() const override { return rows_.pattern(); }
  const std::vector<double>& values() const override { return rows_.values(); }
  int version() const override { return rows_.version(); }
  JacobianPattern eliminated() const { return rows_.eliminated(form_.size()); }

 private:
  template <class Factor>
  bool fill(double t, const double* y, const double* ydot, Factor c) {
    cuts_.begin(form_.size(), !in_time_);
    for (int i = 0; i < form_.size(); ++i) {
      const auto at = static_cast<std::size_t>(i);
      s_.y[at] = LocalDual::variable(y[i], i);
      s_.ydot[at] = LocalDual::variable(ydot[i], i, c(at));
    }
    form_.equations(s_, t, s_.y.data(), s_.ydot.data(), s_.r.data());
    form_.regularise(s_.y.data(), s_.r.data());
    cuts_.stop();
    rows_.take(s_.r, cuts_);
    for (const double x : rows_.values())
      if (!std::isfinite(x)) return form_.fail("the Jacobian is not finite");
    return true;
  }
  static bool has_formulas(const Scene& scene) {
    return std::any_of(scene.forces.begin(), scene.forces.end(), has_formula);
  }

  DaeForm& form_;
  bool in_time_;  ///< whether a zero may become nonzero in time
  DaeScratch<LocalDual> s_;
  Cuts cuts_;
  LocalRows rows_;
};

LocalJacobian* DaeForm::local() {
  return size() > local_limit ? &local_jacobian() : nullptr;
}

LocalJacobian& DaeForm::local_jacobian() {
  if (!local_) local_ = std::make_unique<Local>(*this);
  return *local_;
}

const JacobianPattern& DaeForm::pattern() const {
  if (batches_.empty()) const_cast<DaeForm*>(this)->analyse_pattern();
  return pattern_;
}

/// The pattern follows from how residuals are built, at any state: that of the local matrix at the
/// start.
void DaeForm::analyse_pattern() {
  const int n = size();
  pattern_ = {};
  std::vector<std::vector<int>> groups;
  if (n <= dense_limit) {
    for (int i = 0; i < n; ++i) groups.push_back({i});
  } else {
    std::vector<double> y(static_cast<std::size_t>(n), 1.0), ydot(y.size(), 1.0);
    std::copy(start_.q.begin(), start_.q.end(), y.begin());
    Local local(*this);
    local.evaluate(start_.t, y.data(), ydot.data(), 1);
    pattern_ = local.eliminated();
    groups = apart_columns(pattern_);
  }
  batches_.clear();
  groups_.clear();
  for (std::size_t first = 0; first < groups.size(); first += 8) {
    std::vector<int> direction_of(static_cast<std::size_t>(n), -1);
    std::vector<std::vector<int>> batch;
    for (std::size_t k = first; k < std::min(first + 8, groups.size()); ++k) {
      for (const int column : groups[k])
        direction_of[static_cast<std::size_t>(column)] = static_cast<int>(k - first);
      batch.push_back(groups[k]);
    }
    batches_.push_back(std::move(direction_of));
    groups_.push_back(std::move(batch));
  }
}

}  // namespace momenta
