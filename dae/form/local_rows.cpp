#include <momenta/core/scene/formula.h>
#include <momenta/dae/form/dae_form.h>
#include <momenta/dae/form/local_rows.h>
#include <momenta/dae/integrator/system.h>

#include <algorithm>
#include <cmath>

namespace momenta {

void LocalRows::take(const std::vector<LocalDual>& r, const Cuts& cuts) {
  end_.clear();
  at_.clear();
  term_.clear();
  for (const LocalDual& x : r) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(x.terms); ++k) {
      at_.push_back(x.at[k]);
      term_.push_back(x.b[k]);
    }
    end_.push_back(at_.size());
  }
  for (int i = 0; i < cuts.size(); ++i) {
    for (std::size_t k = cuts.first(i); k < cuts.last(i); ++k) {
      at_.push_back(cuts.columns()[k]);
      term_.push_back(-cuts.values()[k]);
    }
    end_.push_back(at_.size());
  }
  if (version_ == 0 || end_ != end_before_ || at_ != at_before_) {
    size_ = static_cast<int>(end_.size());
    diagonal_.assign(static_cast<std::size_t>(cuts.size()), 0);
    analyse();
    end_before_ = end_;
    at_before_ = at_;
    ++version_;
  }
  for (std::size_t k = 0; k < term_.size(); ++k) values_[place_[k]] = term_[k];
  for (const std::size_t k : diagonal_) values_[k] = 1;
}

void LocalRows::analyse() {
  const auto n = static_cast<std::size_t>(size_);
  const std::size_t residuals = n - diagonal_.size();
  std::vector<long>& start = pattern_.column_start;
  start.assign(n + 1, 0);
  for (const int column : at_) ++start[static_cast<std::size_t>(column) + 1];
  for (std::size_t i = residuals; i < n; ++i) ++start[i + 1];
  for (std::size_t j = 0; j < n; ++j) start[j + 1] += start[j];
  pattern_.row.resize(static_cast<std::size_t>(start[n]));
  values_.assign(pattern_.row.size(), 0.0);
  place_.resize(at_.size());
  std::vector<long> next(start.begin(), start.end() - 1);
  const auto put = [&](std::size_t row, std::size_t column) {
    const auto at = static_cast<std::size_t>(next[column]++);
    pattern_.row[at] = static_cast<long>(row);
    return at;
  };
  for (std::size_t row = 0, k = 0; row < n; ++row) {
    for (; k < end_[row]; ++k) place_[k] = put(row, static_cast<std::size_t>(at_[k]));
    if (row >= residuals) diagonal_[row - residuals] = put(row, row);
  }
}

JacobianPattern LocalRows::eliminated(int n) const {
  const auto size = static_cast<std::size_t>(n);
  std::vector<std::vector<int>> rows_of(size);  // per column
  std::vector<int> seen(static_cast<std::size_t>(size_), -1), open;
  for (int row = 0; row < n; ++row) {
    open.assign(1, row);
    bool is_residual = true;
    while (!open.empty()) {
      const int unknown = open.back();
      const auto i = static_cast<std::size_t>(unknown);
      open.pop_back();
      if (!is_residual && unknown < n) {
        rows_of[i].push_back(row);
        continue;
      }
      is_residual = false;
      for (std::size_t k = i == 0 ? 0 : end_[i - 1]; k < end_[i]; ++k)
        if (int& by = seen[static_cast<std::size_t>(at_[k])]; by != row) {
          by = row;
          open.push_back(at_[k]);
        }
    }
  }
  JacobianPattern pattern;
  pattern.column_start.push_back(0);
  for (const auto& rows : rows_of) {
    pattern.row.insert(pattern.row.end(), rows.begin(), rows.end());
    pattern.column_start.push_back(static_cast<long>(pattern.row.size()));
  }
  return pattern;
}

std::vector<std::vector<int>> apart_columns(const JacobianPattern& pattern) {
  const std::size_t n = pattern.column_start.size() - 1;
  const auto rows = [&](std::size_t column) {
    return std::pair{pattern.row.begin() + pattern.column_start[column],
                     pattern.row.begin() + pattern.column_start[column + 1]};
  };
  std::vector<std::vector<int>> columns_of(n), groups;
  for (std::size_t j = 0; j < n; ++j)
    for (auto [row, end] = rows(j); row != end; ++row)
      columns_of[static_cast<std::size_t>(*row)].push_back(static_cast<int>(j));
  std::vector<int> group_of(n, -1);
  std::vector<std::size_t> taken_by;  // per group: the last column it was refused to
  for (std::size_t j = 0; j < n; ++j) {
    for (auto [row, end] = rows(j); row != end; ++row)
      for (const int other : columns_of[static_cast<std::size_t>(*row)])
        if (const int group = group_of[static_cast<std::size_t>(other)]; group >= 0)
          taken_by[static_cast<std::size_t>(group)] = j;
    std::size_t group = 0;
    while (group < groups.size() && taken_by[group] == j) ++group;
    if (group == groups.size()) {
      groups.emplace_back();
      taken_by.push_back(n);
    }
    groups[group].push_back(static_cast<int>(j));
    group_of[j] = static_cast<int>(group);
  }
  return groups;
}

// Newton matrices of the DAE forms and their patterns: up to dense_limit unknowns a dense J; up to
// local_limit a sparse J, whose columns without a common row share one direction of the dual
// numbers; above it a local matrix in place of J.

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
