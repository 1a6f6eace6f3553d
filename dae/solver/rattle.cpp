// RATTLE for a Hamiltonian that is not separable, with fixed steps: the index-3 equations
// (5a)-(5c), positions and velocities on their constraints after every step,
//
//   p_½ = p_n + h/2 (g(q_n, u_0) − Φ_qᵀ(q_n) λ),          M(q_n) u_0 = p_½
//   q_{n+1} = q_n ∘ exp(h/2 u_0) ∘ exp(h/2 u_1),          M(q_{n+1}) u_1 = p_½,  Φ(q_{n+1}) = 0
//   p_{n+1} = p_½ + h/2 (g(q_{n+1}, u_1) − Φ_qᵀ(q_{n+1}) μ),   Φ_q u_{n+1} + Φ_t = 0,
//
// g = L_q + Q. Order 2, symmetric; symplectic on the constraint manifold where q' = u. It is the
// Lobatto IIIA-IIIB pair of two stages; the last line resets the gauge: no σ is in p.
//
// The first two lines are iterated together to rounding: u_0, u_1 and q by substitution, which
// contracts like h, λ by λ += 2/h² (Φ_q(q_{n+1}) M⁻¹ Φ_qᵀ(q_n))⁻¹ Φ(q_{n+1}). Dense, O(nv³) an
// iteration. Rows that depend on others get the smallest multipliers.
// Source: Andersen, J. Comput. Phys. 52 (1983) 24-34; Jay, SIAM J. Numer. Anal. 33 (1996) 368-387;
// Hairer, Lubich, Wanner, Geometric Numerical Integration, VII.1.4.

#include <momenta/core/scalar/all_finite.h>
#include <momenta/dae/dense/least_squares.h>
#include <momenta/dae/solver/constrained_hamiltonian.h>
#include <momenta/dae/solver/fixed_grid.h>
#include <momenta/dae/solver/implicit_methods.h>
#include <momenta/dae/solver/multistep_run.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace momenta {
namespace {

using Eigen::VectorXd;

constexpr int most_iterations = 100;
constexpr double reached = 4 * std::numeric_limits<double>::epsilon();
constexpr double rounding = 1e-13;        ///< below this, corrections that do not shrink are noise
constexpr int patience = 3;               ///< times they may not
constexpr double dependent_rows = 1e-10;  ///< relative pivot of Φ_q M⁻¹ Φ_qᵀ

/// A place with its factorised mass matrix.
struct Place : PlacedHamiltonian {
  Place(int nv, int m) {
    mass.resize(nv, nv);
    constraint.resize(m, nv);
    prescribed.resize(nv);
    phi.resize(m);
    phi_t.resize(m);
  }
  Eigen::LLT<Eigen::MatrixXd> cholesky;
  /// False where M is not positive definite.
  bool at(ConstrainedHamiltonian& system, double t, const VectorXd& q) {
    system.place(t, q.data(), *this);
    cholesky.compute(mass);
    return cholesky.info() == Eigen::Success;
  }
  VectorXd rates(const VectorXd& p) const { return cholesky.solve(p - prescribed); }
};

struct State {
  VectorXd q, p, u;
};

class Rattle {
 public:
  Rattle(ConstrainedHamiltonian& parts, double t0, const std::vector<double>& y0, double step)
      : parts_(parts),
        grid_(t0, step),
        nq_(parts.coordinates()),
        nv_(parts.momenta()),
        here_(nv_, parts.multipliers()),
        there_(nv_, parts.multipliers()),
        y_(y0),
        t0_(t0),
        t1_(t0) {
    now_.q = Eigen::Map<const VectorXd>(y0.data(), nq_);
    now_.p = Eigen::Map<const VectorXd>(y0.data() + nq_, nv_);
    old_ = now_;
    lambda_ = VectorXd::Zero(parts.multipliers());
  }

  static const char* name() { return "rattle"; }
  double* y() { return y_.data(); }
  double* ydot() { return nullptr; }

  /// Takes Φ_qᵀσ out of the start's momenta.
  bool start() {
    if (!here_.at(parts_, t0_, now_.q)) return false;
    on_velocities(here_, now_);
    store(now_, y_.data());
    return all_finite(y_.data(), y_.size());
  }

  bool step(double& t, double end, std::string& cause) {
    const double t1 = grid_.next(counters_.steps, end), h = grid_.length(t, t1);
    State next;
    if (!advance(t, h, now_, next, lambda_, counters_)) {
      ++counters_.rejected;
      cause = cause_ + ", with a step of " + in_words(h) + " s";
      return false;
    }
    old_ = std::move(now_);
    now_ = std::move(next);
    store(now_, y_.data());
    ++counters_.steps;
    t0_ = t, t1_ = t1;
    t = t1;
    return true;
  }

  /// Hermite's cubic for q, a line for p.
  bool at(double t, double* y, double*) {
    const double h = t1_ - t0_, x = (t - t0_) / h;
    VectorXd from(nq_), to(nq_);
    parts_.coordinate_rates(old_.q.data(), old_.u.data(), from.data());
    parts_.coordinate_rates(now_.q.data(), now_.u.data(), to.data());
    const VectorXd step = now_.q - old_.q;
    Eigen::Map<VectorXd>(y, nq_) =
        old_.q + x * step + x * (x - 1) * ((1 - 2 * x) * step + h * ((x - 1) * from + x * to));
    Eigen::Map<VectorXd>(y + nq_, nv_) = old_.p + x * (now_.p - old_.p);
    return true;
  }

  /// The step from the last one's start to an output time; the cubic where that does not converge.
  bool sample(double t, double* y, double*) {
    if (std::abs(t - t1_) <= grid_.tolerance()) return store(now_, y), true;
    if (std::abs(t - t0_) <= grid_.tolerance()) return store(old_, y), true;
    State there;
    Counters uncounted;
    VectorXd lambda = lambda_;
    if (!advance(t0_, t - t0_, old_, there, lambda, uncounted)) return at(t, y, nullptr);
    store(there, y);
    return true;
  }

  const Counters& counters() const { return counters_; }

 private:
  void store(const State& state, double* y) const {
    Eigen::Map<VectorXd>(y, nq_) = state.q;
    Eigen::Map<VectorXd>(y + nq_, nv_) = state.p;
  }

  const DenseLeastSquares& decomposed(const Eigen::MatrixXd& w) {
    least_squares_.compute(w, dependent_rows);
    return least_squares_;
  }

  /// The last line of the step: p onto Φ_q u + Φ_t = 0, and u.
  void on_velocities(const Place& place, State& state) {
    state.u = place.rates(state.p);
    if (parts_.multipliers() == 0) return;
    const Eigen::MatrixXd w = place.constraint * place.cholesky.solve(place.constraint.transpose());
    const VectorXd mu = decomposed(w).solve(VectorXd(place.constraint * state.u + place.phi_t));
    state.p -= place.constraint.transpose() * mu;
    state.u = place.rates(state.p);
  }

  bool advance(double t, double h, const State& from, State& to, VectorXd& lambda,
               Counters& counters) {
    cause_ = "the mass matrix is not positive definite";
    if (!here_.at(parts_, t, from.q)) return false;
    const int m = parts_.multipliers();
    VectorXd u0 = from.u, u1 = from.u, g(nv_), middle(nq_);
    to.q.resize(nq_);
    double last = std::numeric_limits<double>::infinity();
    int stalls = 0;
    for (int count = 1;; ++count) {
      ++counters.evaluations;
      ++counters.newton_iterations;
      if (count > 1) parts_.place(t, from.q.data(), here_);  // for force() and move()
      parts_.force(from.q.data(), u0.data(), g.data());
      to.p = from.p + 0.5 * h * g;
      if (m > 0) to.p -= 0.5 * h * here_.constraint.transpose() * lambda;
      const VectorXd u0_before = u0, u1_before = u1;
      u0 = here_.rates(to.p);
      u1 += u0 - u0_before;  // it follows p_½ too: λ's correction counts on both
      const VectorXd first = 0.5 * h * u0, second = 0.5 * h * u1;
      parts_.move(from.q.data(), first.data(), middle.data());
      parts_.move(middle.data(), second.data(), to.q.data());
      if (!there_.at(parts_, t + h, to.q)) return false;
      u1 = there_.rates(to.p);
      double open = 0;
      if (m > 0) {
        const Eigen::MatrixXd w =
            there_.constraint * there_.cholesky.solve(here_.constraint.transpose());
        const VectorXd change = decomposed(w).solve(VectorXd(2 / (h * h) * there_.phi));
        lambda += change;
        open = 0.5 * h * h *
               here_.cholesky.solve(here_.constraint.transpose() * change).cwiseAbs().maxCoeff();
      }
      const double size = std::max({open, h * (u0 - u0_before).cwiseAbs().maxCoeff(),
                                    h * (u1 - u1_before).cwiseAbs().maxCoeff()}) /
                          (1 + from.q.cwiseAbs().maxCoeff());
      if (!std::isfinite(size))
        return cause_ = "a value that is not a finite number came up", false;
      if (size >= last && size <= rounding) ++stalls;
      if (size <= reached || stalls == patience) break;
      if (count == most_iterations || size > 1e6 * last)
        return cause_ = "the implicit stages did not converge", false;
      last = size;
    }
    counters.factorizations += 1;
    parts_.force(to.q.data(), u1.data(), g.data());
    ++counters.evaluations;
    to.p += 0.5 * h * g;
    on_velocities(there_, to);
    if (to.p.allFinite() && to.q.allFinite()) return true;
    cause_ = "a value that is not a finite number came up";
    return false;
  }

  ConstrainedHamiltonian& parts_;
  DenseLeastSquares least_squares_;
  FixedGrid grid_;
  int nq_, nv_;
  Place here_, there_;
  std::vector<double> y_;
  State old_, now_;
  VectorXd lambda_;
  double t0_, t1_;  ///< the last step [s]
  std::string cause_;
  Counters counters_;
};

}  // namespace

IntegrationResult integrate_rattle(OdeSystem& system, double t0, const std::vector<double>& y0,
                                   const std::vector<double>& output_times,
                                   const IntegrationOptions& options, const Observer& observer) {
  auto* parts = dynamic_cast<ConstrainedHamiltonian*>(&system);
  if (parts == nullptr)
    throw std::invalid_argument("rattle takes a Hamiltonian: expected form momentum");
  if (y0.size() != static_cast<std::size_t>(system.size()))
    throw std::invalid_argument("the start state must have the size of the system");
  if (!(options.step > 0) || !std::isfinite(options.step))
    throw std::invalid_argument("rattle has fixed steps and needs a step > 0");
  const OutputCursor outputs(t0, output_times);
  Rattle method(*parts, t0, y0, options.step);
  IntegrationResult result;
  if (!method.start()) {
    result.y = y0;
    result.end_time = t0;
    result.reason = stop_sentence("rattle", t0, "the start has no rates: a joint has no inertia");
    return result;
  }
  MultistepRun<Rattle>(method, system.size(), t0, output_times, options, observer).run(result);
  result.counters = method.counters();
  return result;
}

}  // namespace momenta
