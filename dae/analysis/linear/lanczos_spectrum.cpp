#include <Spectra/GenEigsSolver.h>
#include <Spectra/SymGEigsShiftSolver.h>
#include <momenta/dae/analysis/linear/lanczos_spectrum.h>
#include <momenta/dae/analysis/linear/linearisation.h>
#include <momenta/dae/analysis/linear/local_pencil.h>
#include <momenta/dae/analysis/linear/reduced_spectrum.h>

#include <algorithm>
#include <cmath>

namespace momenta {
namespace {

using Eigen::Map;
using Eigen::VectorXcd;
using Eigen::VectorXd;
using ConstMap = Map<const VectorXd>;

constexpr int most_restarts = 300;
constexpr double promised = 1e-11;  // relative, of the inverse's eigenvalues
constexpr double zero = 1e-8;       // s² of a rigid mode, relative to the shift

class Products {
 public:
  Products(const Mechanism& mechanism, const Equilibrium& at, const std::vector<int>& dependent)
      : mechanism_(mechanism),
        at_(at),
        e_(mechanism.evaluation<double>()),
        dual_(mechanism.evaluation<Dual8>()),
        pencil_(mechanism) {
    pencil_.leave_out(dependent);
  }
  int size() const { return mechanism_.nv(); }

  void factor(double a, double c) {
    if (!pencil_.factor(at_.t, at_.q, at_.lambda, a, c))
      throw SceneError(mechanism_.scene().where({}) +
                       "the linearised equations are singular: expected inertia in every motion");
  }
  /// δ of (K + cC + aM) δ + Φ_qᵀν = f, Φ_q δ = 0
  VectorXd inverse(VectorXd f) {
    VectorXd g = VectorXd::Zero(mechanism_.m());
    pencil_.solve(f, g);
    return f;
  }
  VectorXd mass(const VectorXd& x) {
    const VectorXd rest = VectorXd::Zero(size());
    VectorXd p(size()), prescribed(size());
    e_->place(at_.t, at_.q.data());
    e_->move(x.data());
    e_->momenta(nullptr, p.data());
    if (!mechanism_.plan().drives) return p;
    e_->move(rest.data());
    e_->momenta(nullptr, prescribed.data());
    return p - prescribed;
  }
  VectorXd damping(const VectorXd& x) {
    std::vector<Dual8> q(at_.q.begin(), at_.q.end()), u(static_cast<std::size_t>(size())),
        lambda(at_.lambda.begin(), at_.lambda.end()), r(u.size());
    for (std::size_t i = 0; i < u.size(); ++i) u[i].b[0] = x[static_cast<long>(i)];
    dual_->place(at_.t, q.data());
    dual_->move(u.data());
    dual_->joint_forces(q.data(), u.data(), nullptr, lambda.data(), r.data());
    VectorXd result(size());
    for (std::size_t i = 0; i < u.size(); ++i) result[static_cast<long>(i)] = r[i].b[0];
    return result;
  }
  /// Smallest natural 1/s² of joints, about that of the lowest modes.
  double least_natural() {
    const VectorXd rest = VectorXd::Zero(size());
    VectorXd inertia(size());
    e_->place(at_.t, at_.q.data());
    e_->move(rest.data());
    const VectorXd forces = force_scales(mechanism_, *e_);
    e_->mass_diagonal(inertia.data());
    const double least = forces.cwiseQuotient(inertia.cwiseMax(1e-300)).minCoeff();
    return std::max(least, 1e-12);
  }

 private:
  const Mechanism& mechanism_;
  const Equilibrium& at_;
  std::unique_ptr<Evaluation<double>> e_;
  std::unique_ptr<Evaluation<Dual8>> dual_;
  LocalPencil pencil_;
};

/// (K − τM)⁻¹ and M, as Spectra takes them.
struct Inverse {
  using Scalar = double;
  Products& products;
  Eigen::Index rows() const { return products.size(); }
  Eigen::Index cols() const { return products.size(); }
  void set_shift(double tau) { products.factor(-tau, 0); }
  void perform_op(const double* x, double* y) const {
    Map<VectorXd>(y, rows()) = products.inverse(ConstMap(x, rows()));
  }
};
struct Mass {
  using Scalar = double;
  Products& products;
  Eigen::Index rows() const { return products.size(); }
  Eigen::Index cols() const { return products.size(); }
  void perform_op(const double* x, double* y) const {
    Map<VectorXd>(y, rows()) = products.mass(ConstMap(x, rows()));
  }
};

/// (x, v) → ((A − τB)⁻¹ B)(x, v) of A = (0 1; −K −C), B = (1 0; 0 M): with v′ = τ x′ + x,
///
///   (K + τC + τ²M) x′ = −( M v + (C + τM) x )
struct FirstOrder {
  using Scalar = double;
  Products& products;
  double tau;
  Eigen::Index rows() const { return 2 * products.size(); }
  Eigen::Index cols() const { return rows(); }
  void perform_op(const double* in, double* out) const {
    const Eigen::Index n = products.size();
    const VectorXd x = ConstMap(in, n), v = ConstMap(in + n, n);
    const VectorXd next = -products.inverse(products.mass(v + tau * x) + products.damping(x));
    Map<VectorXd>(out, n) = next;
    Map<VectorXd>(out + n, n) = tau * next + x;
  }
};

[[noreturn]] void stopped(const Mechanism& mechanism, Eigen::Index converged, int count) {
  throw SceneError(mechanism.scene().where({}) + "only " + std::to_string(converged) + " of " +
                   std::to_string(count) +
                   " modes have converged; expected fewer to be asked for (--count)");
}

void lanczos(const Mechanism& mechanism, Products& products, int count, Spectrum& found) {
  const double tau = -0.1 * products.least_natural();
  Inverse inverse{products};
  Mass mass{products};
  const int basis = std::min(found.mobility - 1, std::max(2 * count + 1, count + 20));
  Spectra::SymGEigsShiftSolver<Inverse, Mass, Spectra::GEigsMode::ShiftInvert> solver(
      inverse, mass, count, basis, tau);
  solver.init();
  const auto converged = solver.compute(Spectra::SortRule::LargestMagn, most_restarts, promised);
  if (solver.info() != Spectra::CompInfo::Successful) stopped(mechanism, converged, count);
  const VectorXd squares = solver.eigenvalues();
  const Eigen::MatrixXd shapes = solver.eigenvectors();
  for (Eigen::Index i = 0; i < squares.size(); ++i) {
    Mode mode;
    if (std::abs(squares[i]) > zero * std::abs(tau))
      mode.s = squares[i] > 0 ? std::complex<double>(0, std::sqrt(squares[i]))
                              : std::complex<double>(std::sqrt(-squares[i]), 0);
    const VectorXd shape = shapes.col(i);
    mode.shape = shape.cast<std::complex<double>>();
    normalise(mode, shape.dot(products.mass(shape)));
    found.modes.push_back(std::move(mode));
  }
}

void arnoldi(const Mechanism& mechanism, Products& products, int count, Spectrum& found) {
  const double tau = std::sqrt(0.1 * products.least_natural());
  products.factor(tau * tau, tau);
  FirstOrder inverse{products, tau};
  const int wanted = 2 * count;
  const int basis = std::min(2 * found.mobility - 1, std::max(2 * wanted + 1, wanted + 20));
  Spectra::GenEigsSolver<FirstOrder> solver(inverse, wanted, basis);
  solver.init();
  const auto converged = solver.compute(Spectra::SortRule::LargestMagn, most_restarts, promised);
  if (solver.info() != Spectra::CompInfo::Successful) stopped(mechanism, converged, wanted);
  const VectorXcd values = solver.eigenvalues();
  const Eigen::MatrixXcd vectors = solver.eigenvectors();
  const Eigen::Index n = products.size();
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    Mode mode;
    mode.s = tau + 1.0 / values[i];
    if (std::abs(mode.s) <= std::sqrt(zero) * tau) mode.s = 0;
    if (std::abs(mode.s.imag()) <= zero * std::abs(mode.s)) mode.s.imag(0);
    if (std::abs(mode.s.real()) <= zero * std::abs(mode.s)) mode.s.real(0);
    if (mode.s.imag() < 0) continue;
    mode.real = mode.s.imag() == 0;
    mode.shape = vectors.col(i).head(n);
    const VectorXd re = mode.shape.real(), im = mode.shape.imag();
    normalise(mode, re.dot(products.mass(re)) + im.dot(products.mass(im)));
    found.modes.push_back(std::move(mode));
  }
}

}  // namespace

void lanczos_spectrum(const Mechanism& mechanism, const Equilibrium& at, int count,
                      Spectrum& found) {
  Products products(mechanism, at, found.dependent_rows);
  count = std::clamp(count, 1, (found.mobility - 3) / 2);
  // C is zero where no entry is: one vector with all rates tells.
  found.conservative = has_potential(mechanism) &&
                       products.damping(VectorXd::LinSpaced(products.size(), 1, 2)).isZero(0);
  found.complete = false;
  if (found.conservative)
    lanczos(mechanism, products, count, found);
  else
    arnoldi(mechanism, products, count, found);
  sort_modes(found.modes);
  if (found.modes.size() > static_cast<std::size_t>(count))
    found.modes.resize(static_cast<std::size_t>(count));
}

}  // namespace momenta
