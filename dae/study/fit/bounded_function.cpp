#include <momenta/dae/study/fit/bounded_function.h>

#include <cmath>

namespace momenta {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Ref;
using Eigen::VectorXd;

void BoundedFunction::choose(const MotionValues& first) {
  bounded_ = f_->bounded(first);
  rows_ = 0;
  for (const std::size_t k : bounded_) rows_ += first.parts[f_->places()[k]].size();
}

void BoundedFunction::start(const MotionValues& values, Ref<VectorXd> tau,
                            Ref<VectorXd> sizes) const {
  const std::vector<Index> at = f_->rows(values);
  for (Index k = 0; k < unknowns(); ++k) {
    const std::size_t part = bounded_[static_cast<std::size_t>(k)];
    const VectorXd& g = values.parts[f_->places()[part]];
    tau[k] = g[at[part]];
    const double size = g.cwiseAbs().maxCoeff();
    sizes[k] = size > 0 ? size : 1;
  }
}

double BoundedFunction::at(const MotionValues& values, const VectorXd& tau, VectorXd* by_theta,
                           VectorXd* by_tau) const {
  VectorXd taken = VectorXd::Constant(static_cast<Index>(f_->parts().size()), NAN), by_parts;
  for (Index k = 0; k < unknowns(); ++k)
    taken[static_cast<Index>(bounded_[static_cast<std::size_t>(k)])] = tau[k];
  const double f = f_->at(values, f_->rows(values), taken, by_theta, by_tau ? &by_parts : nullptr);
  if (by_tau) {
    by_tau->resize(unknowns());
    for (Index k = 0; k < unknowns(); ++k)
      (*by_tau)[k] = by_parts[static_cast<Index>(bounded_[static_cast<std::size_t>(k)])];
  }
  return f;
}

void BoundedFunction::bounds(const MotionValues& values, const VectorXd& tau, Ref<VectorXd> rows,
                             MatrixXd* by_theta, MatrixXd* by_tau) const {
  if (by_theta) by_theta->resize(rows_, values.parameters_by.cols());
  if (by_tau) by_tau->setZero(rows_, unknowns());
  Index row = 0;
  for (Index k = 0; k < unknowns(); ++k) {
    const std::size_t part = bounded_[static_cast<std::size_t>(k)], place = f_->places()[part];
    const double sign = f_->parts()[part].kind == MotionPart::Kind::most ? 1 : -1;
    const VectorXd& g = values.parts[place];
    rows.segment(row, g.size()) = sign * (g.array() - tau[k]);
    if (by_theta) by_theta->middleRows(row, g.size()) = sign * values.parts_by[place];
    if (by_tau) by_tau->block(row, k, g.size(), 1).setConstant(-sign);
    row += g.size();
  }
}

}  // namespace momenta
