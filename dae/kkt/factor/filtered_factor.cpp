#include <momenta/dae/kkt/factor/faded_pivot.h>
#include <momenta/dae/kkt/factor/filtered_factor.h>
#include <suitesparse/amd.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

namespace momenta {
FilteredFactor::FilteredFactor(const KktPattern& pattern, int nv, const std::vector<int>& groups)
    : pattern_(pattern), n_(nv), m_(static_cast<int>(groups.size())) {
  order(groups);
  analyse();
}

/// Blocks in the order of elimination: by depth of the joint, deepest first, a loop after the
/// topmost joints it hangs on.
void FilteredFactor::order(const std::vector<int>& groups) {
  const auto at = [](int i) { return static_cast<std::size_t>(i); };
  std::vector<int> depth(at(n_), 0);  // coordinates from the ground down to it
  for (const auto& e : pattern_.mass) ++depth[at(e.column)];
  // Loops, and of each its rows and topmost columns.
  std::vector<int> loop_of(at(m_)), first_row;
  for (int i = 0; i < m_; ++i) {
    if (i == 0 || groups[at(i)] / 2 != groups[at(i - 1)] / 2)  // points and axes of one loop
      first_row.push_back(i);
    loop_of[at(i)] = static_cast<int>(first_row.size()) - 1;
  }
  const int loops = static_cast<int>(first_row.size());
  first_row.push_back(m_);
  std::vector<int> top(at(loops), n_ + 1);
  for (const auto& e : pattern_.constraint) {
    int& least = top[at(loop_of[at(e.row)])];
    least = std::min(least, depth[at(e.column)]);
  }
  // Loops that share a topmost joint fill each other: AMD on that graph, joints as stars.
  std::set<std::pair<int, int>> edges;  // loop, loops + joint
  for (const auto& e : pattern_.constraint) {
    const int loop = loop_of[at(e.row)];
    if (depth[at(e.column)] == top[at(loop)]) edges.insert({loop, loops + e.column});
  }
  const int nodes = loops + n_;
  std::vector<std::vector<int>> beside(at(nodes));
  for (const auto& [a, b] : edges) {
    beside[at(a)].push_back(b);
    beside[at(b)].push_back(a);
  }
  std::vector<int> start{0}, list, amd(at(nodes)), rank(at(nodes));
  for (const auto& b : beside) {
    list.insert(list.end(), b.begin(), b.end());
    start.push_back(static_cast<int>(list.size()));
  }
  std::iota(amd.begin(), amd.end(), 0);
  if (nodes > 0) amd_order(nodes, start.data(), list.data(), amd.data(), nullptr, nullptr);
  for (int i = 0; i < nodes; ++i) rank[at(amd[at(i)])] = i;

  struct Place {
    int depth, kind, rank, index;  // kind 0: a coordinate; 1: a loop
  };
  std::vector<Place> turns;
  for (int j = 0; j < n_; ++j) turns.push_back({depth[at(j)], 0, -j, j});
  for (int l = 0; l < loops; ++l) turns.push_back({top[at(l)], 1, rank[at(l)], l});
  std::sort(turns.begin(), turns.end(), [](const Place& a, const Place& b) {
    if (a.depth != b.depth) return a.depth > b.depth;
    return a.kind != b.kind ? a.kind < b.kind : a.rank < b.rank;
  });
  place_.resize(at(n_ + m_));
  for (const Place& t : turns) {
    Block block;
    block.first = static_cast<int>(unknown_.size());
    block.loop = t.kind == 1;
    if (block.loop)
      for (int i = first_row[at(t.index)]; i < first_row[at(t.index + 1)]; ++i)
        unknown_.push_back(n_ + i);
    else
      unknown_.push_back(t.index);
    block.last = static_cast<int>(unknown_.size());
    for (int c = block.first; c < block.last; ++c) {
      place_[at(unknown_[at(c)])] = c;
      block_of_.push_back(static_cast<int>(blocks_.size()));
    }
    blocks_.push_back(block);
  }
}

void FilteredFactor::analyse() {
  const auto at = [](int i) { return static_cast<std::size_t>(i); };
  const std::size_t unknowns = place_.size();
  // Rows below each block in A, then by the blocks whose first row below falls into it.
  std::vector<std::vector<int>> below(blocks_.size()), children(blocks_.size());
  const auto tie = [&](int a, int b) {
    const int i = place_[at(a)], j = place_[at(b)];
    const int low = std::min(i, j), high = std::max(i, j);
    if (block_of_[at(low)] != block_of_[at(high)]) below[at(block_of_[at(low)])].push_back(high);
  };
  for (const auto& e : pattern_.mass) tie(e.row, e.column);
  for (const auto& e : pattern_.constraint) tie(n_ + e.row, e.column);
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    Block& block = blocks_[k];
    std::vector<int>& rows = below[k];
    for (const int child : children[k])
      for (std::size_t i = blocks_[at(child)].row; i < blocks_[at(child)].end; ++i)
        if (row_[i] >= block.last) rows.push_back(row_[i]);
    // A loop's rows go together, or not at all: blocks share their rows.
    for (std::size_t i = 0, given = rows.size(); i < given; ++i)
      if (const Block& b = blocks_[at(block_of_[at(rows[i])])]; b.size() > 1)
        for (int c = b.first; c < b.last; ++c) rows.push_back(c);
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    block.row = row_.size();
    for (int c = block.first; c < block.last; ++c) row_.push_back(c);
    row_.insert(row_.end(), rows.begin(), rows.end());
    block.end = row_.size();
    block.value =
        k == 0 ? 0 : blocks_[k - 1].value + blocks_[k - 1].height() * at(blocks_[k - 1].size());
    if (!rows.empty()) children[at(block_of_[at(rows.front())])].push_back(static_cast<int>(k));
    rows = {};
  }
  if (!blocks_.empty())
    value_.resize(blocks_.back().value + blocks_.back().height() * at(blocks_.back().size()));
  const auto entry = [&](int a, int b) {
    const int i = place_[at(a)], j = place_[at(b)];
    const int low = std::min(i, j), high = std::max(i, j);
    const Block& block = blocks_[at(block_of_[at(low)])];
    const auto begin = row_.begin() + static_cast<std::ptrdiff_t>(block.row),
               end = row_.begin() + static_cast<std::ptrdiff_t>(block.end);
    return block.value + at(low - block.first) * block.height() +
           static_cast<std::size_t>(std::lower_bound(begin, end, high) - begin);
  };
  for (const auto& e : pattern_.mass) mass_at_.push_back(entry(e.row, e.column));
  for (const auto& e : pattern_.constraint) constraint_at_.push_back(entry(n_ + e.row, e.column));
  for (int i = 0; i < m_; ++i) diagonal_at_.push_back(entry(n_ + i, n_ + i));
  inverse_.resize(unknowns);
  turn_.resize(unknowns);
  where_.resize(unknowns);
  head_.resize(blocks_.size());
  next_.resize(blocks_.size());
  reached_.resize(blocks_.size());
  pivot_.resize(at(m_));
  work_.resize(unknowns);
}

bool FilteredFactor::factor(const std::vector<double>& mass, const std::vector<double>& constraint,
                            const double* compliance, const double* tau) {
  std::fill(value_.begin(), value_.end(), 0.0);
  for (std::size_t i = 0; i < mass.size(); ++i) value_[mass_at_[i]] = mass[i];
  for (std::size_t i = 0; i < constraint.size(); ++i) value_[constraint_at_[i]] = constraint[i];
  if (compliance)
    for (std::size_t i = 0; i < diagonal_at_.size(); ++i) value_[diagonal_at_[i]] = -compliance[i];
  std::fill(head_.begin(), head_.end(), -1);
  singular_joint_ = -1;
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    const Block& block = blocks_[k];
    for (std::size_t i = block.row; i < block.end; ++i)
      where_[static_cast<std::size_t>(row_[i])] = static_cast<int>(i - block.row);
    for (int from = head_[k]; from >= 0;) {
      const auto f = static_cast<std::size_t>(from);
      const int following = next_[f];
      update(blocks_[f], reached_[f], block);
      while (reached_[f] < blocks_[f].end && row_[reached_[f]] < block.last) ++reached_[f];
      if (reached_[f] < blocks_[f].end) {
        const auto to =
            static_cast<std::size_t>(block_of_[static_cast<std::size_t>(row_[reached_[f]])]);
        next_[f] = head_[to];
        head_[to] = from;
      }
      from = following;
    }
    if (!eliminate(block, tau)) return false;
    reached_[k] = block.row + static_cast<std::size_t>(block.size());
    if (reached_[k] < block.end) {
      const auto to =
          static_cast<std::size_t>(block_of_[static_cast<std::size_t>(row_[reached_[k]])]);
      next_[k] = head_[to];
      head_[to] = static_cast<int>(k);
    }
  }
  return true;
}

/// Subtracts the columns of `from` from those of `to`, rows from `at` on.
void FilteredFactor::update(const Block& from, std::size_t at, const Block& to) {
  for (int c = 0; c < from.size(); ++c) {
    const double inverse = inverse_[static_cast<std::size_t>(from.first + c)];
    const double* column =
        &value_[from.value + static_cast<std::size_t>(c) * from.height()] - from.row;
    for (std::size_t j = at; j < from.end && row_[j] < to.last; ++j) {
      const double factor = column[j] * inverse;
      double* target =
          &value_[to.value + static_cast<std::size_t>(row_[j] - to.first) * to.height()];
      for (std::size_t i = j; i < from.end; ++i)
        target[where_[static_cast<std::size_t>(row_[i])]] -= factor * column[i];
    }
  }
}

bool FilteredFactor::eliminate(const Block& block, const double* tau) {
  const auto size = static_cast<std::size_t>(block.size()), height = block.height(),
             first = static_cast<std::size_t>(block.first);
  double* a = &value_[block.value];
  if (!block.loop) {
    if (!(a[0] > 0) || !std::isfinite(a[0])) {
      singular_joint_ = unknown_[first];
      return false;
    }
    inverse_[first] = 1 / a[0];
    turn_[first] = 0;
    return true;
  }
  // Both triangles of the loop's rows, which are pivoted.
  for (std::size_t j = 0; j < size; ++j)
    for (std::size_t i = 0; i < j; ++i) a[j * height + i] = a[i * height + j];
  int* turn = &turn_[first];
  std::iota(turn, turn + size, 0);
  for (std::size_t k = 0; k < size; ++k) {
    std::size_t best = k;
    double largest = -HUGE_VAL;
    for (std::size_t i = k; i < size; ++i) {
      const auto c = static_cast<std::size_t>(turn[i]);
      const double fades = tau[unknown_[first + c] - n_];
      const double w = -a[c * height + c] / (fades > 0 ? fades : 1);
      if (w > largest) {
        largest = w;
        best = i;
      }
    }
    std::swap(turn[k], turn[best]);
    const auto c = static_cast<std::size_t>(turn[k]);
    const auto row = static_cast<std::size_t>(unknown_[first + c] - n_);
    const double w = -a[c * height + c], f = faded_inverse(w, tau[row]);
    if (!std::isfinite(w)) return false;
    pivot_[row] = w;
    inverse_[first + c] = -f;
    const double* own = a + c * height;
    for (std::size_t i = k + 1; i < size; ++i) {
      double* other = a + static_cast<std::size_t>(turn[i]) * height;
      const double factor = -f * own[turn[i]];
      for (std::size_t j = k + 1; j < size; ++j) other[turn[j]] -= factor * own[turn[j]];
      for (std::size_t j = size; j < height; ++j) other[j] -= factor * own[j];
    }
  }
  return true;
}

void FilteredFactor::solve(double* x) {
  for (std::size_t i = 0; i < work_.size(); ++i) work_[i] = x[unknown_[i]];
  double* y = work_.data();
  for (const Block& b : blocks_) {
    const auto first = static_cast<std::size_t>(b.first), size = static_cast<std::size_t>(b.size());
    const int* turn = &turn_[first];
    for (std::size_t k = 0; k < size; ++k) {
      const auto c = static_cast<std::size_t>(turn[k]);
      const double* column = &value_[b.value + c * b.height()];
      const double z = inverse_[first + c] * y[first + c];
      for (std::size_t i = k + 1; i < size; ++i) y[b.first + turn[i]] -= z * column[turn[i]];
      for (std::size_t i = size; i < b.height(); ++i) y[row_[b.row + i]] -= z * column[i];
    }
  }
  for (std::size_t at = blocks_.size(); at-- > 0;) {
    const Block& b = blocks_[at];
    const auto first = static_cast<std::size_t>(b.first), size = static_cast<std::size_t>(b.size());
    const int* turn = &turn_[first];
    for (std::size_t k = size; k-- > 0;) {
      const auto c = static_cast<std::size_t>(turn[k]);
      const double* column = &value_[b.value + c * b.height()];
      double z = y[first + c];
      for (std::size_t i = k + 1; i < size; ++i) z -= column[turn[i]] * y[b.first + turn[i]];
      for (std::size_t i = size; i < b.height(); ++i) z -= column[i] * y[row_[b.row + i]];
      y[first + c] = inverse_[first + c] * z;
    }
  }
  for (std::size_t i = 0; i < work_.size(); ++i) x[unknown_[i]] = work_[i];
}

}  // namespace momenta
