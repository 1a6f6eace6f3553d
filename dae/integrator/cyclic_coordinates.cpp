#include <momenta/dae/integrator/cyclic_coordinates.h>

#include <random>

namespace momenta {
namespace {

constexpr int states = 3;
constexpr double zero = 1e-12;  ///< relative to the largest of its kind

/// n numbers between −1 and 1, the same everywhere.
Eigen::VectorXd some(std::mt19937& chance, Eigen::Index n) {
  constexpr double half_range = 2147483648.0;
  Eigen::VectorXd x(n);
  for (double& value : x) value = static_cast<double>(chance()) / half_range - 1;
  return x;
}

}  // namespace

std::vector<int> cyclic_coordinates(ConstrainedHamiltonian& parts, double t,
                                    const Eigen::VectorXd& q) {
  const int nv = parts.momenta(), m = parts.multipliers();
  std::vector<bool> cyclic(static_cast<std::size_t>(nv), true);
  const auto place = parts.place();
  std::mt19937 chance;  // NOLINT: the same states in every run
  Eigen::VectorXd there(q.size()), along(nv);
  const auto strike = [&] {
    const double largest = along.size() > 0 ? along.cwiseAbs().maxCoeff() : 0;
    for (int i = 0; i < nv; ++i)
      if (!(std::abs(along[i]) <= zero * largest)) cyclic[static_cast<std::size_t>(i)] = false;
  };
  for (int k = 0; k < states; ++k) {
    const Eigen::VectorXd step = some(chance, nv), u = some(chance, nv), x = some(chance, m);
    parts.move(q.data(), step.data(), there.data());
    if (!place->at(t + some(chance, 1)[0], there.data())) continue;
    place->force(there.data(), u.data(), nullptr, along.data());
    strike();
    if (m == 0) continue;
    place->constraint_forces(x.data(), along.data());
    strike();
  }
  std::vector<int> places;
  for (int i = 0; i < nv; ++i)
    if (cyclic[static_cast<std::size_t>(i)]) places.push_back(i);
  return places;
}

}  // namespace momenta
