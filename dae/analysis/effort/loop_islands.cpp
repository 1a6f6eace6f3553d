#include <momenta/dae/algebra/dense/decompositions.h>
#include <momenta/dae/analysis/effort/loop_islands.h>

#include <algorithm>
#include <numeric>

namespace momenta {
Eigen::VectorXd LoopIsland::part(const std::vector<int>& places, const Eigen::VectorXd& all) {
  Eigen::VectorXd some(static_cast<Eigen::Index>(places.size()));
  for (std::size_t i = 0; i < places.size(); ++i)
    some[static_cast<Eigen::Index>(i)] = all[places[i]];
  return some;
}

void LoopIsland::put(const std::vector<int>& places, const Eigen::VectorXd& part,
                     Eigen::VectorXd& all) {
  for (std::size_t i = 0; i < places.size(); ++i)
    all[places[i]] = part[static_cast<Eigen::Index>(i)];
}

Eigen::VectorXd LoopIsland::particular(const Eigen::VectorXd& b) const {
  Eigen::VectorXd chosen(rank());
  for (int i = 0; i < rank(); ++i) chosen[i] = b[order[i]];
  return Y * R.leftCols(rank()).triangularView<Eigen::Upper>().transpose().solve(chosen);
}

Eigen::VectorXd LoopIsland::multipliers(const Eigen::VectorXd& f) const {
  Eigen::VectorXd lambda = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(rows.size()));
  const Eigen::VectorXd chosen =
      R.leftCols(rank()).triangularView<Eigen::Upper>().solve(Eigen::VectorXd(Y.transpose() * f));
  for (int i = 0; i < rank(); ++i) lambda[order[i]] = chosen[i];
  return lambda;
}

Eigen::MatrixXd LoopIsland::idle() const {
  const auto count = static_cast<Eigen::Index>(rows.size()), more = count - rank();
  Eigen::MatrixXd ordered(count, more), all(count, more);
  ordered.topRows(rank()) =
      -R.leftCols(rank()).triangularView<Eigen::Upper>().solve(Eigen::MatrixXd(R.rightCols(more)));
  ordered.bottomRows(more).setIdentity();
  for (Eigen::Index i = 0; i < count; ++i) all.row(order[i]) = ordered.row(i);
  return all;
}

LoopIslands::LoopIslands(const Mechanism& mechanism)
    : island_(static_cast<std::size_t>(mechanism.nv())),
      column_(island_.size()),
      row_(static_cast<std::size_t>(mechanism.m())) {
  // Each rate begins alone; the rates of a row get one root.
  std::vector<int> root(island_.size());
  std::iota(root.begin(), root.end(), 0);
  const auto root_of = [&](int i) {
    while (root[static_cast<std::size_t>(i)] != i)
      i = root[static_cast<std::size_t>(i)] =
          root[static_cast<std::size_t>(root[static_cast<std::size_t>(i)])];
    return i;
  };
  const auto& pattern = mechanism.constraint_pattern();
  std::vector<int> first(row_.size(), -1);
  for (const auto& entry : pattern) {
    int& of_row = first[static_cast<std::size_t>(entry.row)];
    if (of_row < 0) of_row = entry.column;
    const int a = root_of(of_row), b = root_of(entry.column);
    root[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
  }
  std::vector<int> number(island_.size(), -1);
  for (int i = 0; i < mechanism.nv(); ++i) {
    int& place = number[static_cast<std::size_t>(root_of(i))];
    if (place < 0) {
      place = static_cast<int>(islands_.size());
      islands_.emplace_back();
    }
    LoopIsland& island = islands_[static_cast<std::size_t>(place)];
    island_[static_cast<std::size_t>(i)] = place;
    column_[static_cast<std::size_t>(i)] = static_cast<int>(island.rates.size());
    island.rates.push_back(i);
  }
  for (int i = 0; i < mechanism.m(); ++i) {
    const int column = first[static_cast<std::size_t>(i)];
    if (column < 0) continue;  // no joint moves it
    LoopIsland& island =
        islands_[static_cast<std::size_t>(island_[static_cast<std::size_t>(column)])];
    row_[static_cast<std::size_t>(i)] = static_cast<int>(island.rows.size());
    island.rows.push_back(i);
  }
  for (const auto& entry : pattern)
    of_entry_.push_back(island_[static_cast<std::size_t>(entry.column)]);
  for (LoopIsland& island : islands_) {
    const auto n = static_cast<Eigen::Index>(island.rates.size());
    island.N.setIdentity(n, n);
    island.Y.resize(n, 0);
    island.R.resize(0, 0);
  }
}

void LoopIslands::factor(ScaledLoops& loops, double pivot, bool rank_kept) {
  if (row_.empty()) return;
  const std::vector<double> entries = loops.jacobian();
  std::vector<Eigen::MatrixXd> transposed(islands_.size());
  for (std::size_t k = 0; k < islands_.size(); ++k)
    if (!islands_[k].rows.empty())
      transposed[k].setZero(static_cast<Eigen::Index>(islands_[k].rates.size()),
                            static_cast<Eigen::Index>(islands_[k].rows.size()));
  for (std::size_t e = 0; e < entries.size(); ++e) {
    const auto& [row, column] = loops.pattern()[e];
    transposed[static_cast<std::size_t>(of_entry_[e])](column_[static_cast<std::size_t>(column)],
                                                       row_[static_cast<std::size_t>(row)]) =
        entries[e];
  }
  for (std::size_t k = 0; k < islands_.size(); ++k) {
    LoopIsland& island = islands_[k];
    if (island.rows.empty()) continue;
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(transposed[k]);
    qr.setThreshold(pivot);
    const Eigen::Index n = transposed[k].rows(),
                       rank =
                           rank_kept ? std::min<Eigen::Index>(qr.rank(), island.rank()) : qr.rank();
    const Eigen::MatrixXd Q = qr.householderQ() * Eigen::MatrixXd::Identity(n, n);
    island.Y = Q.leftCols(rank);
    island.N = Q.rightCols(n - rank);
    island.R = qr.matrixR().topRows(rank);
    island.order = qr.colsPermutation().indices();
  }
}

}  // namespace momenta
