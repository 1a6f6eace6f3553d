#include <momenta/dae/kkt/split_kkt.h>

#include <algorithm>
#include <set>
#include <utility>

namespace momenta {
namespace {

constexpr std::size_t dense_unknowns = 60;  ///< as in the DAE forms

}  // namespace

SplitKkt::SplitKkt(const Mechanism& mechanism, std::vector<double> compliance)
    : entries_(mechanism.kkt_pattern()),
      nv_(static_cast<std::size_t>(mechanism.nv())),
      m_(static_cast<std::size_t>(mechanism.m())),
      compliance_(std::move(compliance)),
      mass_(entries_.mass.size()),
      constraint_(entries_.constraint.size()),
      right_(nv_ + m_) {
  const std::size_t n = nv_ + m_;
  using Place = std::pair<std::size_t, std::size_t>;  // column, row
  const auto at = [](int i) { return static_cast<std::size_t>(i); };
  std::set<Place> places;
  if (n > dense_unknowns) {
    for (const auto& [row, column] : entries_.mass)
      places.insert({{at(row), at(column)}, {at(column), at(row)}});
    for (const auto& [row, column] : entries_.constraint)
      places.insert({{nv_ + at(row), at(column)}, {at(column), nv_ + at(row)}});
    if (!compliance_.empty())
      for (std::size_t i = nv_; i < n; ++i) places.insert({i, i});
    pattern_.column_start.assign(n + 1, 0);
    for (const auto& [column, row] : places) {
      pattern_.row.push_back(static_cast<long>(row));
      ++pattern_.column_start[column + 1];
    }
    for (std::size_t i = 0; i < n; ++i) pattern_.column_start[i + 1] += pattern_.column_start[i];
  }
  const std::vector<Place> sorted(places.begin(), places.end());
  const auto place = [&](std::size_t row, std::size_t column) {
    if (sorted.empty()) return column * n + row;
    const auto found = std::lower_bound(sorted.begin(), sorted.end(), Place{column, row});
    return static_cast<std::size_t>(found - sorted.begin());
  };
  for (const auto& [row, column] : entries_.mass)
    mass_at_.push_back({place(at(row), at(column)), place(at(column), at(row))});
  for (const auto& [row, column] : entries_.constraint)
    constraint_at_.push_back({place(nv_ + at(row), at(column)), place(at(column), nv_ + at(row))});
  for (std::size_t i = 0; i < compliance_.size(); ++i)
    compliance_at_.push_back(place(nv_ + i, nv_ + i));
  matrix_ = make_newton_matrix<double>(static_cast<int>(n), pattern_);
  std::fill_n(matrix_->values(), entry_count(static_cast<int>(n), pattern_), 0.0);
}

void SplitKkt::act_at(Evaluation<double>& e) {
  double* values = matrix_->values();
  e.mass_entries(mass_.data());
  for (std::size_t k = 0; k < mass_.size(); ++k)
    for (const std::size_t at : mass_at_[k]) values[at] = mass_[k];
  e.constraint_entries(constraint_.data());
  for (std::size_t k = 0; k < constraint_.size(); ++k)
    values[constraint_at_[k][1]] = constraint_[k];
}

void SplitKkt::meet_at(Evaluation<double>& e) {
  double* values = matrix_->values();
  e.constraint_entries(constraint_.data());
  for (std::size_t k = 0; k < constraint_.size(); ++k)
    values[constraint_at_[k][0]] = constraint_[k];
}

void SplitKkt::rates(const double* x, double* result) const {
  std::fill_n(result, m_, 0.0);
  for (std::size_t k = 0; k < constraint_.size(); ++k)
    result[entries_.constraint[k].row] += constraint_[k] * x[entries_.constraint[k].column];
}

bool SplitKkt::factor() {
  double* values = matrix_->values();
  for (std::size_t i = 0; i < compliance_.size(); ++i) values[compliance_at_[i]] = -compliance_[i];
  return matrix_->factor();
}

void SplitKkt::solve(const double* r, const double* g, double* x, double* s) {
  if (r)
    std::copy_n(r, nv_, right_.begin());
  else
    std::fill_n(right_.begin(), nv_, 0.0);
  std::copy_n(g, m_, right_.data() + nv_);
  matrix_->solve(right_.data());
  std::copy_n(right_.data(), nv_, x);
  std::copy_n(right_.data() + nv_, m_, s);
}

void SplitKkt::add_compliance(double factor, const double* s, double* g) const {
  for (std::size_t i = 0; i < compliance_.size(); ++i) g[i] += factor * compliance_[i] * s[i];
}

}  // namespace momenta
