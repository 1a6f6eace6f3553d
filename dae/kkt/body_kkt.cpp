// Deep trees: (7) by the equations of its bodies (body_matrix.h), whose entries grow like the
// bodies, factorised by KLU (klu_solver.h). Pivots are not filtered, faded rows not known.

#include <momenta/dae/kkt/body_matrix.h>
#include <momenta/dae/kkt/factor/axis_scale.h>
#include <momenta/dae/kkt/kkt.h>
#include <momenta/dae/kkt/klu_solver.h>

#include <algorithm>

namespace momenta {
namespace {

template <class Space>
class BodyKkt final : public Kkt {
 public:
  BodyKkt(const Mechanism& mechanism, std::unique_ptr<BodyMatrix<Space>> equations)
      : equations_(std::move(equations)),
        axis_scale_(mechanism),
        n_(mechanism.nv()),
        m_(mechanism.m()),
        inertia_(static_cast<std::size_t>(n_)),
        constraint_(mechanism.constraint_pattern().size()),
        epsilon_(static_cast<std::size_t>(m_)),
        x_(static_cast<std::size_t>(equations_->size())),
        solver_(equations_->size(), m_, equations_->entries(), KluSolver::Order::columns) {}

  bool factor(Evaluation<double>& e, double t, const double* q, double fade) override {
    ++factorizations_;
    e.place(t, q);
    equations_->place(t, q);
    std::size_t i = 0;
    equations_->each_entry([&](int, int, double x) { solver_.matrix().set(i++, x); });
    if (compliance_) {
      epsilon_.assign(compliance_, compliance_ + m_);
    } else {
      e.mass_diagonal(inertia_.data());
      e.constraint_entries(constraint_.data());
      axis_scale_.softness(inertia_, constraint_, fade, epsilon_);
    }
    const bool ok = solver_.factor(epsilon_);
    singular_joint_ =
        ok || solver_.singular_column() < 0 ? -1 : equations_->joint_of(solver_.singular_column());
    return ok;
  }

  bool solve(const double* r, const double* g, const double* centre, double* u,
             double* sigma) override {
    std::fill(x_.begin(), x_.end(), 0.0);
    double *of_u = x_.data() + equations_->rate(0), *of_sigma = x_.data() + equations_->impulse(0);
    std::copy(r, r + n_, of_u);
    std::copy(g, g + m_, of_sigma);
    if (!solver_.solve(x_.data(), centre, compliance_ != nullptr)) return false;
    std::copy(of_u, of_u + n_, u);
    std::copy(of_sigma, of_sigma + m_, sigma);
    return true;
  }

 private:
  std::unique_ptr<BodyMatrix<Space>> equations_;
  AxisScale axis_scale_;
  int n_, m_;
  std::vector<double> inertia_, constraint_, epsilon_, x_;
  KluSolver solver_;
};

}  // namespace

std::unique_ptr<Kkt> make_body_kkt(const Mechanism& mechanism) {
  return with_body_matrix(
      mechanism,
      [&]<class Space>(std::unique_ptr<BodyMatrix<Space>> equations) -> std::unique_ptr<Kkt> {
        return std::make_unique<BodyKkt<Space>>(mechanism, std::move(equations));
      });
}

}  // namespace momenta
