#include <momenta/dae/mechanism/tree_factor.h>

#include <algorithm>
#include <limits>
#include <numeric>

namespace momenta {

TreeFactor::TreeFactor(const KktPattern& pattern, int nv)
    : start_(static_cast<std::size_t>(nv) + 1, 0),
      row_(pattern.mass.size()),
      value_(row_.size()),
      place_(row_.size()),
      inverse_(static_cast<std::size_t>(nv)),
      diagonal_(inverse_.size()) {
  // Column by column, rows descending. The ancestors of an ancestor are then the tail of the list.
  std::vector<std::size_t> order(row_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const auto &x = pattern.mass[a], &y = pattern.mass[b];
    return x.column != y.column ? x.column < y.column : x.row > y.row;
  });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const auto& entry = pattern.mass[order[i]];
    place_[order[i]] = i;
    row_[i] = static_cast<std::size_t>(entry.row);
    ++start_[static_cast<std::size_t>(entry.column) + 1];
  }
  std::partial_sum(start_.begin(), start_.end(), start_.begin());
}

int TreeFactor::factor(const std::vector<double>& mass) {
  // A pivot below this part of M_kk is rounding in place of zero.
  constexpr double rounding = 64 * std::numeric_limits<double>::epsilon();
  for (std::size_t i = 0; i < mass.size(); ++i) value_[place_[i]] = mass[i];
  for (std::size_t k = 0; k < diagonal_.size(); ++k) diagonal_[k] = value_[start_[k]];
  for (std::size_t k = inverse_.size(); k-- > 0;) {
    const std::size_t first = start_[k], last = start_[k + 1];
    const double pivot = value_[first];
    if (!(pivot > rounding * diagonal_[k])) return static_cast<int>(k);
    inverse_[k] = 1 / pivot;
    for (std::size_t i = first + 1; i < last; ++i) {
      const double l = value_[i] * inverse_[k];
      double* ancestor = &value_[start_[row_[i]]];
      for (std::size_t j = i; j < last; ++j) ancestor[j - i] -= l * value_[j];
      value_[i] = l;
    }
  }
  return -1;
}

}  // namespace momenta
