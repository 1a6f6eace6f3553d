#include <momenta/dae/gradient/levels/direction_sweeps.h>
#include <momenta/dae/gradient/levels/tangent_sweeps.h>
#include <momenta/dae/gradient/stage_adjoint.h>
#include <momenta/dae/gradient/swept_tangent.h>
#include <momenta/dae/kkt/factor/faded_pivot.h>
#include <momenta/dae/kkt/solver_choice.h>
#include <momenta/dae/kkt/sweeps/levels/loop_sweeps.h>

#include <Eigen/SparseCore>
#include <algorithm>

namespace momenta {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;

template <class Space>
using TreeOf = decltype(build_links(std::declval<const Model<Space>&>()));

template <class Space>
class SweptTangentOf final : public SweptTangent {
 public:
  SweptTangentOf(const Mechanism& mechanism, Model<Space> built, double leak, double beta)
      : model_(std::move(built)),
        links_(build_links(model_)),
        swept_(swept_loops(
            mechanism.tree(), model_,
            in_link_frames(build_loops(mechanism.scene(), mechanism.tree(), model_), links_))) {
    if (!swept_.plan.fits()) return;
    const double fade = fade_beside(fade_evaluation, mechanism.masses_apart());
    sweeps_ = make_tangent_sweeps(links_, swept_, fade, mechanism.has_body_forces());
    lanes_ = make_direction_sweeps(links_, swept_, fade, mechanism.has_body_forces());
    sweeps_->feed_back(leak, beta);
    if (lanes_) lanes_->feed_back(leak, beta);
    for (auto* x : {&u, &du, &dpdot}) x->resize(static_cast<std::size_t>(mechanism.nv()));
    for (auto* x : {&sigma, &dsigma}) x->resize(static_cast<std::size_t>(mechanism.m()));
  }
  /// Whether a front holds the slots.
  bool fits() const { return sweeps_ != nullptr; }

  bool operator()(double t, const double* q, const double* p, const double* dq,
                  const double* dp) override {
    return one(t, q, p, dq, dp, nullptr);
  }

  bool along(double t, const double* q, const double* p, const MatrixXd& dq, const MatrixXd& dp,
             const MatrixXd& besides, MatrixXd& to_u, MatrixXd& to_pdot,
             MatrixXd& to_sigma) override {
    const Index count = dp.cols();
    to_u.resize(dp.rows(), count);
    to_pdot.resize(dp.rows(), count);
    to_sigma.resize(static_cast<Index>(sigma.size()), count);
    const bool any = besides.size() > 0;
    Index k = 0;
    if (lanes_) {
      const Index width = lanes_->width();
      // Empty lanes cost as much as others: two directions go one by one.
      for (; count - k > 2; k += width) {
        const Index of = std::min(width, count - k);
        spread(dq, k, of, in_q_);
        spread(dp, k, of, in_p_);
        if (any) spread_rows(besides, k, of);
        for (auto* x : {&out_u_, &out_pdot_}) x->resize(width, dp.rows());
        out_sigma_.resize(width, to_sigma.rows());
        if (!(*lanes_)(t, q, p, in_q_.data(), in_p_.data(), any ? in_rows_.data() : nullptr,
                       {out_u_.data(), out_pdot_.data(), out_sigma_.data()}))
          return false;
        to_u.middleCols(k, of) = out_u_.topRows(of).transpose();
        to_pdot.middleCols(k, of) = out_pdot_.topRows(of).transpose();
        to_sigma.middleCols(k, of) = out_sigma_.topRows(of).transpose();
      }
    }
    for (Index i = k; i < count; ++i) {
      if (!one(t, q, p, dq.col(i).data(), dp.col(i).data(), any ? besides.col(i).data() : nullptr))
        return false;
      std::copy(du.begin(), du.end(), to_u.col(i).data());
      std::copy(dpdot.begin(), dpdot.end(), to_pdot.col(i).data());
      std::copy(dsigma.begin(), dsigma.end(), to_sigma.col(i).data());
    }
    for (Index i = 0; i < std::min(k, count); ++i) to_given(to_sigma.col(i).data());
    return true;
  }

 private:
  bool one(double t, const double* q, const double* p, const double* dq, const double* dp,
           const double* besides) {
    if (!(*sweeps_)(t, q, p, dq, dp,
                    {u.data(), du.data(), dpdot.data(), sigma.data(), dsigma.data()},
                    besides ? as_swept(besides) : nullptr))
      return false;
    for (auto* x : {&sigma, &dsigma}) to_given(x->data());
    return true;
  }
  void to_given(double* x) {
    if (!swept_.shared.empty()) swept_.shared.to_given(x, 1);
    if (!swept_.carried.all()) swept_.carried.to_given(x, 1, nullptr);
  }
  /// Numbers by rows of Φ (m) as rows are swept, until the next call: for ties paired anew Φ' = T Φ
  /// where σ = Tᵀσ', for balls along other axes as σ'.
  const double* as_swept(const double* rows) {
    if (!swept_.carried.all()) return swept_.carried.to_carried(rows);
    if (swept_.shared.empty()) return rows;
    if (paired_.size() == 0) {
      std::vector<Eigen::Triplet<double>> entries;
      const auto m = static_cast<Index>(sigma.size());
      Eigen::VectorXd row(m);
      for (Index i = 0; i < m; ++i) {
        row = Eigen::VectorXd::Unit(m, i);
        swept_.shared.to_given(row.data(), 1);
        for (Index k = 0; k < m; ++k)
          if (row[k] != 0) entries.emplace_back(static_cast<int>(i), static_cast<int>(k), row[k]);
      }
      paired_.resize(m, m);
      paired_.setFromTriplets(entries.begin(), entries.end());
      in_paired_.resize(m);
    }
    in_paired_.noalias() = paired_ * Eigen::Map<const Eigen::VectorXd>(rows, in_paired_.size());
    return in_paired_.data();
  }
  /// Columns from `first` on as lanes; others are zero.
  void spread(const MatrixXd& columns, Index first, Index count, MatrixXd& to) const {
    to.setZero(lanes_->width(), columns.rows());
    to.topRows(count) = columns.middleCols(first, count).transpose();
  }
  void spread_rows(const MatrixXd& columns, Index first, Index count) {
    const Index rows = swept_.loops.rows;
    in_rows_.setZero(lanes_->width(), rows);
    for (Index i = 0; i < count; ++i)
      in_rows_.row(i) =
          Eigen::Map<const Eigen::RowVectorXd>(as_swept(columns.col(first + i).data()), rows);
  }

  Model<Space> model_;
  TreeOf<Space> links_;
  SweptLoops<Space> swept_;
  std::unique_ptr<TangentSweeps> sweeps_;
  Eigen::SparseMatrix<double, Eigen::RowMajor> paired_;  ///< T, once asked for
  Eigen::VectorXd in_paired_;
  std::unique_ptr<DirectionSweeps> lanes_;                         ///< null: one by one
  MatrixXd in_q_, in_p_, in_rows_, out_u_, out_pdot_, out_sigma_;  ///< lanes × numbers
};

template <class Space>
std::unique_ptr<SweptTangent> made(const Mechanism& mechanism, Model<Space> built, double leak,
                                   double beta) {
  auto tangent = std::make_unique<SweptTangentOf<Space>>(mechanism, std::move(built), leak, beta);
  if (!tangent->fits()) return nullptr;
  return tangent;
}

}  // namespace

std::unique_ptr<SweptTangent> make_swept_tangent(const Mechanism& mechanism, double leak,
                                                 double beta) {
  if (mechanism.scene().lagrangian || mechanism.plan().quasi_velocities) return nullptr;
  if (mechanism.m() > 0 && mechanism.solver().kkt() != KktChoice::sweeps) return nullptr;
  const Tree& tree = mechanism.tree();
  if (mechanism.plan().planar) {
    if (mechanism.has_forces_apart()) return nullptr;
    return made(mechanism, build_planar_model(tree, mechanism.scene(), mechanism.plan().basis),
                leak, beta);
  }
  if (mechanism.has_body_forces()) return nullptr;
  return made(mechanism, build_spatial_model(tree, mechanism.scene()), leak, beta);
}

// Sweeps of StageAdjoint: no matrix, and nothing is allocated unless rows are taken for a θ.

using Eigen::Map;
using Eigen::VectorXd;

bool StageAdjoint::sweep(const AdjointState& at, const VectorXd& w, VectorXd& product,
                         VectorXd& by_parameters) {
  const auto a = w.head(nv_), b = w.tail(nv_);
  along_q_ = -b;
  along_p_ = a;
  if (forces_.any()) {
    still_ = b;
    if (losses_)
      losses_->at(at.q, at.u, still_, by_q_, by_u_);
    else
      forces_.transposed(at.t, at.q, at.u, still_, by_q_, by_u_);
    along_p_ += by_u_;
  }
  SweptTangent& f = *swept_;
  if (!f(at.t, at.q.data(), at.p.data(), along_q_.data(), along_p_.data())) return false;
  const Map<const VectorXd> du(f.du.data(), nv_), dpdot(f.dpdot.data(), nv_);
  product.resize(2 * nv_);
  product.head(nv_) = -dpdot;
  product.tail(nv_) = du;
  if (forces_.any()) {
    // ṗ has Q: its derivative along the direction goes, its transposed product comes.
    still_ = du;
    if (losses_)
      losses_->along_rates(still_, by_u_);
    else
      forces_.along(at.t, at.q, at.u, along_q_, still_, by_u_);
    product.head(nv_) += by_q_ + by_u_;
  }
  if (numbers_) {
    numbers_->add(-1, {at.t, at.q.data(), f.u.data(), f.sigma.data(), along_q_.data(), f.du.data(),
                       f.dsigma.data()});
    take_drives(at.t, by_parameters);
  }
  if (!any_rows_) return true;
  VectorXd weights(2 * nv_ + m_);
  weights << -du, -Map<const VectorXd>(f.dsigma.data(), m_), b;
  add_by_rows(at, weights, false, by_parameters);
  return true;
}

/// p' = c M u − (c − 1) p. u is the same on both sides.
bool StageAdjoint::sweep_gauge(const AdjointState& at, double c, VectorXd& lambda,
                               VectorXd& by_parameters) {
  SweptTangent& f = *swept_;
  still_.setZero();
  u_ = at.u;
  if (u_.size() == 0) {
    if (!f(at.t, at.q.data(), at.p.data(), still_.data(), still_.data())) return false;
    u_ = Map<const VectorXd>(f.u.data(), nv_);
  }
  const auto of_p = lambda.tail(nv_);
  along_q_ = of_p;
  kinetic_->along(at.t, at.q.data(), u_.data(), along_q_.data(), rates_.data(), along_p_.data());
  if (!f(at.t, at.q.data(), at.p.data(), still_.data(), along_p_.data())) return false;
  const Map<const VectorXd> du(f.du.data(), nv_), dpdot(f.dpdot.data(), nv_);
  rates_ -= dpdot;
  if (forces_.any()) {
    along_p_ = du;
    if (losses_) {
      losses_->at(at.q, u_, still_, by_q_, by_u_);
      losses_->along_rates(along_p_, by_u_);
    } else {
      forces_.along(at.t, at.q, u_, still_, along_p_, by_u_);
    }
    rates_ += by_u_;
  }
  along_p_ = of_p - du;
  if (numbers_) {
    for (double& x : f.dsigma) x = -x;
    add_gauge(
        c,
        {at.t, at.q.data(), f.u.data(), f.sigma.data(), nullptr, along_p_.data(), f.dsigma.data()},
        along_q_.data(), by_parameters);
    for (double& x : f.dsigma) x = -x;
  }
  if (any_rows_) {
    VectorXd weights(2 * nv_ + m_);
    weights << c * along_p_, -c * Map<const VectorXd>(f.dsigma.data(), m_), -c * of_p;
    add_by_rows(at, weights, true, by_parameters);
  }
  lambda.head(nv_) += c * rates_;
  lambda.tail(nv_) -= c * along_p_;
  return true;
}

}  // namespace momenta
