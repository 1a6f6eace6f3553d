#include <momenta/dae/assembly_side.h>

#include <Eigen/LU>
#include <cmath>

namespace momenta {
namespace {

using Eigen::MatrixXd;

constexpr double vanishes = 1e-9;  // of an entry, against the largest
constexpr double weak = 1e-6;      // of a determinant at the guess, against Hadamard's bound

/// det over the product of the rows' lengths, so that its size tells how near zero it is.
double relative_determinant(const MatrixXd& block) {
  double bound = 1;
  for (Eigen::Index i = 0; i < block.rows(); ++i) bound *= block.row(i).norm();
  return bound > 0 ? block.determinant() / bound : 0;
}

/// Pairs (i, i) of a matrix with nonzero diagonal that depend on each other both ways.
std::vector<std::vector<Eigen::Index>> diagonal_blocks(const MatrixXd& a) {
  const Eigen::Index n = a.rows();
  Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic> reaches =
      a.cwiseAbs().array() > vanishes * a.cwiseAbs().maxCoeff();
  for (Eigen::Index k = 0; k < n; ++k)
    for (Eigen::Index i = 0; i < n; ++i)
      if (reaches(i, k))
        for (Eigen::Index j = 0; j < n; ++j) reaches(i, j) = reaches(i, j) || reaches(k, j);
  std::vector<std::vector<Eigen::Index>> blocks;
  std::vector<bool> placed(static_cast<std::size_t>(n), false);
  for (Eigen::Index i = 0; i < n; ++i) {
    if (placed[static_cast<std::size_t>(i)]) continue;
    blocks.emplace_back();
    for (Eigen::Index j = i; j < n; ++j)
      if (i == j || (reaches(i, j) && reaches(j, i))) {
        blocks.back().push_back(j);
        placed[static_cast<std::size_t>(j)] = true;
      }
  }
  return blocks;
}

}  // namespace

std::vector<std::vector<int>> rows_that_changed_side(const MatrixXd& from, const MatrixXd& to) {
  std::vector<Eigen::Index> free;
  for (Eigen::Index j = 0; j < to.cols(); ++j)
    if (!to.col(j).isZero(0) || !from.col(j).isZero(0)) free.push_back(j);
  if (free.empty()) return {};
  const MatrixXd here = to(Eigen::all, free), guess = from(Eigen::all, free);
  Eigen::FullPivLU<MatrixXd> lu(here);
  lu.setThreshold(vanishes);
  const Eigen::Index rank = lu.rank();
  if (rank < here.cols()) return {};
  // Independent rows, matched with the columns on which they were pivots.
  MatrixXd matched_here(rank, rank), matched_guess(rank, rank);
  std::vector<int> row(static_cast<std::size_t>(rank));
  const Eigen::MatrixXi order =
      lu.permutationP() *
      Eigen::VectorXi::LinSpaced(here.rows(), 0, static_cast<int>(here.rows()) - 1);
  for (Eigen::Index i = 0; i < rank; ++i) {
    const int r = order(i, 0);
    row[static_cast<std::size_t>(i)] = r;
    for (Eigen::Index j = 0; j < rank; ++j) {
      const Eigen::Index column = lu.permutationQ().indices()[j];
      matched_here(i, j) = here(r, column);
      matched_guess(i, j) = guess(r, column);
    }
  }
  std::vector<std::vector<int>> changed;
  for (const auto& block : diagonal_blocks(matched_here)) {
    const double after = relative_determinant(matched_here(block, block)),
                 before = relative_determinant(matched_guess(block, block));
    if (std::abs(before) < weak || std::abs(after) < weak || (before > 0) == (after > 0)) continue;
    changed.emplace_back();
    for (const Eigen::Index i : block) changed.back().push_back(row[static_cast<std::size_t>(i)]);
  }
  return changed;
}

}  // namespace momenta
