#include <momenta/dae/kkt/symmetric_matrix.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace momenta {

SymmetricMatrix::SymmetricMatrix(int size, const std::vector<KktPattern::Entry>& entries)
    : scale_(static_cast<std::size_t>(size)), largest_(scale_.size()), diagonal_(scale_.size()) {
  struct Triplet {
    int column, row;
    bool operator<(const Triplet& b) const {
      return column != b.column ? column < b.column : row < b.row;
    }
    bool operator==(const Triplet&) const = default;
  };
  std::vector<Triplet> all;
  all.reserve(2 * entries.size() + scale_.size());
  for (const auto& e : entries) {
    all.push_back({e.column, e.row});
    all.push_back({e.row, e.column});
  }
  for (int i = 0; i < size; ++i) all.push_back({i, i});
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  start.assign(static_cast<std::size_t>(size) + 1, 0);
  for (const Triplet& t : all) {
    row.push_back(t.row);
    ++start[static_cast<std::size_t>(t.column) + 1];
  }
  for (std::size_t j = 1; j < start.size(); ++j) start[j] += start[j - 1];
  value_.assign(row.size(), 0.0);
  const auto place = [&](int i, int j) {
    const auto begin = row.begin() + start[static_cast<std::size_t>(j)],
               end = row.begin() + start[static_cast<std::size_t>(j) + 1];
    return static_cast<std::size_t>(std::lower_bound(begin, end, i) - row.begin());
  };
  place_.reserve(entries.size());
  for (const auto& e : entries) place_.push_back({place(e.row, e.column), place(e.column, e.row)});
  for (int i = 0; i < size; ++i) diagonal_[static_cast<std::size_t>(i)] = place(i, i);
}

bool SymmetricMatrix::finite() const {
  return std::all_of(value_.begin(), value_.end(), [](double x) { return std::isfinite(x); });
}

double SymmetricMatrix::residual(const double* b, const double* x, double* r) {
  const std::size_t n = scale_.size();
  std::fill(scale_.begin(), scale_.end(), 0.0);
  std::fill(largest_.begin(), largest_.end(), 0.0);
  double size_of_x = 0;
  std::copy(b, b + n, r);
  for (std::size_t j = 0; j < n; ++j) {
    size_of_x = std::max(size_of_x, std::abs(x[j]));
    for (int k = start[j]; k < start[j + 1]; ++k) {
      const auto at = static_cast<std::size_t>(k), i = static_cast<std::size_t>(row[at]);
      const double term = value_[at] * x[j];
      r[i] -= term;
      scale_[i] += std::abs(term);
      largest_[i] = std::max(largest_[i], std::abs(value_[at]));
    }
  }
  const double dust = 1e3 * static_cast<double>(n) * std::numeric_limits<double>::epsilon();
  double largest = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (!std::isfinite(r[i])) return HUGE_VAL;
    const double reach = largest_[i] * size_of_x;
    double scale = scale_[i] += std::abs(b[i]);
    if (!(scale > dust * reach)) scale += reach;
    if (scale > 0) largest = std::max(largest, std::abs(r[i]) / scale);
  }
  return largest;
}

}  // namespace momenta
