#include <momenta/dae/body_matrix.h>
#include <momenta/dae/factor/axis_scale.h>
#include <momenta/dae/factor/body_fronts.h>
#include <momenta/dae/factor/filtered_matrix.h>
#include <momenta/dae/leaves_first_matrix.h>

#include <cmath>

namespace momenta {
namespace {

class OfJoints final : public LeavesFirstMatrix {
 public:
  explicit OfJoints(const Mechanism& mechanism)
      : matrix_(mechanism.kkt_pattern(), mechanism.axis_scale(), mechanism.nv(),
                mechanism.row_groups()) {}

  bool factor(Evaluation<double>& e, double, const double*, const double* compliance,
              double fade) override {
    e.mass_entries(matrix_.mass());
    e.constraint_entries(matrix_.constraint());
    return matrix_.factor(compliance, fade);
  }
  void solve(double* x) override { matrix_.solve(x); }
  const std::vector<double>& pivots() const override { return matrix_.factors().pivots(); }
  const std::vector<double>& fading() const override { return matrix_.fading(); }
  const double* constraint() override { return matrix_.constraint(); }
  int singular_joint() const override { return matrix_.factors().singular_joint(); }

 private:
  FilteredMatrix matrix_;
};

template <class Space>
class OfBodies final : public LeavesFirstMatrix {
 public:
  OfBodies(const Mechanism& mechanism, std::unique_ptr<BodyMatrix<Space>> equations)
      : equations_(std::move(equations)),
        scale_(mechanism.axis_scale()),
        inertia_(static_cast<std::size_t>(mechanism.nv())),
        constraint_(mechanism.constraint_pattern().size()),
        tau_(static_cast<std::size_t>(mechanism.m())),
        fronts_(equations_->tree(), equations_->entries(), mechanism.row_groups()) {}

  bool factor(Evaluation<double>& e, double t, const double* q, const double* compliance,
              double fade) override {
    equations_->place(t, q);
    std::size_t i = 0;
    equations_->each_entry([&](int, int, double x) { fronts_.values()[i++] = x; });
    e.mass_diagonal(inertia_.data());
    e.constraint_entries(constraint_.data());
    scale_.of_groups(inertia_, constraint_, tau_);
    for (double& tau : tau_) {
      tau = compliance ? 0 : tau * scale_.fading(fade);
      if (!std::isfinite(tau)) return false;
    }
    return fronts_.factor(compliance, tau_.data());
  }
  void solve(double* x) override { fronts_.solve(x); }
  const std::vector<double>& pivots() const override { return fronts_.pivots(); }
  const std::vector<double>& fading() const override { return tau_; }
  const double* constraint() override { return constraint_.data(); }
  int singular_joint() const override { return fronts_.singular_joint(); }

 private:
  std::unique_ptr<BodyMatrix<Space>> equations_;
  AxisScale scale_;
  std::vector<double> inertia_, constraint_, tau_;
  BodyFronts fronts_;
};

}  // namespace

std::unique_ptr<LeavesFirstMatrix> joint_matrix(const Mechanism& mechanism) {
  return std::make_unique<OfJoints>(mechanism);
}

std::unique_ptr<LeavesFirstMatrix> front_matrix(const Mechanism& mechanism) {
  return with_body_matrix(
      mechanism,
      [&]<class Space>(
          std::unique_ptr<BodyMatrix<Space>> equations) -> std::unique_ptr<LeavesFirstMatrix> {
        return std::make_unique<OfBodies<Space>>(mechanism, std::move(equations));
      });
}

std::unique_ptr<LeavesFirstMatrix> leaves_first_matrix(const Mechanism& mechanism) {
  return mechanism.solved_by_bodies() ? front_matrix(mechanism) : joint_matrix(mechanism);
}

}  // namespace momenta
