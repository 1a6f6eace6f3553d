#include <momenta/dae/gradient/drive_slopes.h>

namespace momenta {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Calls with(place among the numbers, its derivative by θ at t) for f and ḟ of each drive.
template <class With>
void each_number(const NumberSlopes& numbers, const OtherParameter& other, double t, With&& with) {
  for (std::size_t d = 0; d < other.drives; ++d) {
    const VectorXd& by = other.near->law_slope(d, t);
    const Index at = numbers.drives() + 2 * static_cast<Index>(d);
    with(at, by[0]);
    with(at + 1, by[1]);
  }
}

}  // namespace

void add_drive_slopes(const NumberSlopes& numbers, const std::vector<OtherParameter>& others,
                      double t, const VectorXd& slopes, VectorXd& by_parameters) {
  for (std::size_t j = 0; j < others.size(); ++j)
    each_number(numbers, others[j], t, [&](Index at, double by) {
      by_parameters[static_cast<Index>(j)] += slopes[at] * by;
    });
}

VectorXd by_laws(const NumberSlopes& numbers, const OtherParameter& other, double t,
                 const MatrixXd& slopes) {
  VectorXd all = VectorXd::Zero(slopes.rows());
  each_number(numbers, other, t, [&](Index at, double by) { all += by * slopes.col(at); });
  return all;
}

}  // namespace momenta
