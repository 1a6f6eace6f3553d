#include <momenta/dae/analysis/kinematics/start_system.h>
#include <momenta/dae/analysis/sample/sample.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <utility>

namespace momenta {

using Eigen::MatrixXcd;
using Eigen::VectorXcd;

Complex UnitCircle::next() {
  return std::polar(1.0, 2 * std::numbers::pi * in_unit_interval(noise(seed_, 71, count_++)));
}

StartSystem::StartSystem(const PolynomialSystem& f, UnitCircle& circle) : f_(f) {
  for (int i = 0; i < f.equations(); ++i) {
    forms_.emplace_back();
    for (std::size_t g = 0; g < f.groups().size(); ++g)
      for (int k = 0; k < f.degree(i, static_cast<int>(g)); ++k) {
        VectorXcd c = VectorXcd::Zero(f.variables());
        for (const int x : f.groups()[g].variables) c[x] = circle.next();
        forms_.back().push_back({static_cast<int>(g), std::move(c)});
      }
  }
  choose(0, std::vector<int>(f.groups().size(), 0), {});
}

VectorXcd StartSystem::solution(std::size_t number) const {
  VectorXcd x = VectorXcd::Zero(f_.variables());
  for (std::size_t g = 0; g < f_.groups().size(); ++g) {
    const auto& own = f_.groups()[g].variables;
    const auto n = static_cast<Eigen::Index>(own.size());
    MatrixXcd a(n - 1, n);
    Eigen::Index row = 0;
    for (std::size_t i = 0; i < forms_.size(); ++i) {
      const Form& form = forms_[i][choices_[number][i]];
      if (form.group != static_cast<int>(g)) continue;
      for (Eigen::Index k = 0; k < n; ++k) a(row, k) = form.c[own[static_cast<std::size_t>(k)]];
      ++row;
    }
    // The last variable is one.
    VectorXcd part(n);
    part[n - 1] = 1;
    if (n > 1) {
      const VectorXcd right = -a.col(n - 1);
      const MatrixXcd left = a.leftCols(n - 1);
      part.head(n - 1) = Eigen::PartialPivLU<MatrixXcd>(left).solve(right);
    }
    part.normalize();
    for (Eigen::Index k = 0; k < n; ++k) x[own[static_cast<std::size_t>(k)]] = part[k];
  }
  return x;
}

void StartSystem::evaluate(const VectorXcd& x, VectorXcd& values, MatrixXcd& slopes) const {
  values.setZero(f_.equations());
  slopes.setZero(f_.equations(), f_.variables());
  for (std::size_t i = 0; i < forms_.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    std::vector<Complex> factors;
    for (const Form& form : forms_[i]) factors.push_back((form.c.transpose() * x)(0));
    Complex product = 1;
    for (const Complex& factor : factors) product *= factor;
    values[row] = product;
    for (std::size_t k = 0; k < factors.size(); ++k) {
      Complex others = 1;
      for (std::size_t j = 0; j < factors.size(); ++j)
        if (j != k) others *= factors[j];
      slopes.row(row) += others * forms_[i][k].c.transpose();
    }
  }
}

void StartSystem::choose(std::size_t equation, const std::vector<int>& taken,
                         std::vector<std::size_t> chosen) {
  if (equation == forms_.size()) {
    choices_.push_back(std::move(chosen));
    return;
  }
  chosen.push_back(0);
  for (std::size_t k = 0; k < forms_[equation].size(); ++k) {
    const auto g = static_cast<std::size_t>(forms_[equation][k].group);
    if (taken[g] + 1 >= static_cast<int>(f_.groups()[g].variables.size())) continue;
    std::vector<int> more = taken;
    ++more[g];
    chosen.back() = k;
    choose(equation + 1, more, chosen);
  }
}

}  // namespace momenta
