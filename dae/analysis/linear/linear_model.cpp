#include <momenta/core/scene/bearings_refused.h>
#include <momenta/dae/algebra/dense/decompositions.h>
#include <momenta/dae/analysis/linear/independent_coordinates.h>
#include <momenta/dae/analysis/linear/linear_columns.h>
#include <momenta/dae/analysis/linear/linear_model.h>
#include <momenta/dae/analysis/linear/linearisation.h>
#include <momenta/dae/analysis/linear/loop_drives.h>

#include <algorithm>
#include <cmath>

namespace momenta {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Lu = Eigen::PartialPivLU<MatrixXd>;

/// δ, δu, δu̇ (rates of the freed mechanism, then drives of loops), δλ (all rows) and τ as linear
/// functions, by row, of the columns x, then w.
struct Functions {
  MatrixXd delta, v, a, lambda, tau;
  Functions(Eigen::Index n, Eigen::Index m, Eigen::Index columns)
      : delta(MatrixXd::Zero(n, columns)),
        v(delta),
        a(delta),
        lambda(MatrixXd::Zero(m, columns)),
        tau(delta) {}
};

class Eliminated {
 public:
  Eliminated(OperatingPoint point, IndependentCoordinates chosen)
      : at_(std::move(point)),
        c_(std::move(chosen)),
        mechanism_(*at_.freed),
        nv_(mechanism_.nv()),
        drives_(at_.driven) {
    for (int k = 0; k < size(c_.loop_drives); ++k) drives_.push_back(static_cast<int>(nv_) + k);
    places_ = nv_ + size(c_.loop_drives);
    inputs_ = size(at_.free) + 3 * size(drives_);
    solve_state();
    const MatrixXd every = MatrixXd::Identity(nv_, nv_);
    l_ = linearise_state(mechanism_, at_.t, at_.q, at_.u, udot_, lambda_, every);
    for (const MatrixXd* x :
         {&l_.M, &l_.C, &l_.K, &l_.loops, &l_.loop_rates, &l_.second_by_rates, &l_.second_by_poses,
          &l_.turning, &l_.markers_by_poses, &l_.markers_by_rates})
      if (!x->allFinite())
        refuse("the linearised equations are not finite at this state, expected another");
    append_loop_drives();
  }

  const VectorXd& udot() const { return udot_; }
  Eigen::Index inputs() const { return inputs_; }

  /// Columns: δ_I, δu_I, w.
  Functions minimal(MatrixXd& derivative) const {
    const Eigen::Index y = size(c_.free_positions), z = size(c_.free_rates);
    Functions f(places_, mechanism_.m(), y + z + inputs_);
    put_inputs(f, y + z);
    for (Eigen::Index i = 0; i < y; ++i) f.delta(at(c_.free_positions, i), i) = 1;
    if (!c_.position_rows.empty()) {
      const std::vector<int> dependent(c_.dependent.begin(),
                                       c_.dependent.begin() + size(c_.position_rows));
      f.delta(dependent, Eigen::all) =
          -Lu(l_.loops(c_.position_rows, dependent))
               .solve(MatrixXd(l_.loops(c_.position_rows, Eigen::all) * f.delta));
    }
    for (Eigen::Index i = 0; i < z; ++i) f.v(at(c_.free_rates, i), y + i) = 1;
    MatrixXd N = MatrixXd::Zero(places_, z);
    for (Eigen::Index i = 0; i < z; ++i) N(at(c_.free_rates, i), i) = 1;
    if (!c_.rows.empty()) {
      const Lu lu(l_.loops(c_.rows, c_.dependent));
      const MatrixXd rows = l_.loops(c_.rows, Eigen::all),
                     by_pose = l_.loop_rates(c_.rows, Eigen::all),
                     second_by_rate = l_.second_by_rates(c_.rows, Eigen::all),
                     second_by_pose = l_.second_by_poses(c_.rows, Eigen::all);
      const auto follow = [&](MatrixXd& x, const MatrixXd& asked) {
        const MatrixXd solution = lu.solve(asked);
        x(c_.dependent, Eigen::all) = -solution;
      };
      follow(f.v, rows * f.v + by_pose * f.delta);
      follow(f.a, rows * f.a + second_by_rate * f.v + second_by_pose * f.delta);
      follow(N, rows * N);
    }
    // ż, then δu̇ and δλ.
    const MatrixXd mass = N.transpose() * l_.M * N;
    const Eigen::LLT<MatrixXd> cholesky(0.5 * (mass + mass.transpose()));
    if (cholesky.info() != Eigen::Success) refuse_massless();
    MatrixXd left = f.tau - l_.M * f.a - l_.C * f.v - l_.K * f.delta;
    const MatrixXd zdot = cholesky.solve(N.transpose() * left);
    f.a += N * zdot;
    left -= l_.M * N * zdot;
    if (!c_.rows.empty()) {
      const MatrixXd block = MatrixXd(l_.loops(c_.rows, c_.dependent)).transpose();
      const MatrixXd solution = Lu(block).solve(MatrixXd(left(c_.dependent, Eigen::all)));
      f.lambda(c_.rows, Eigen::all) = solution;
    }
    derivative.resize(y + z, f.v.cols());
    derivative << (f.v + l_.turning * f.delta)(c_.free_positions, Eigen::all), zdot;
    return f;
  }

  /// Columns: δ, δu, δu̇, δλ of kept rows, w.
  Functions descriptor(MatrixXd& E, MatrixXd& right) const {
    const Eigen::Index n = size(at_.free), r = size(c_.rows), rp = size(c_.position_rows);
    const Eigen::Index states = 3 * n + r;
    Functions f(places_, mechanism_.m(), states + inputs_);
    put_inputs(f, states);
    for (Eigen::Index i = 0; i < n; ++i) {
      f.delta(at(at_.free, i), i) = 1;
      f.v(at(at_.free, i), n + i) = 1;
      f.a(at(at_.free, i), 2 * n + i) = 1;
    }
    for (Eigen::Index i = 0; i < r; ++i) f.lambda(at(c_.rows, i), 3 * n + i) = 1;
    E = MatrixXd::Zero(states, states);
    const Eigen::Index y = size(c_.free_positions), z = size(c_.free_rates);
    E.topRows(y) = f.delta(c_.free_positions, Eigen::all).leftCols(states);
    E.middleRows(y + rp, z) = f.v(c_.free_rates, Eigen::all).leftCols(states);
    right.resize(states, states + inputs_);
    right << (f.v + l_.turning * f.delta)(c_.free_positions, Eigen::all),
        l_.loops(c_.position_rows, Eigen::all) * f.delta, f.a(c_.free_rates, Eigen::all),
        l_.loops(c_.rows, Eigen::all) * f.v + l_.loop_rates(c_.rows, Eigen::all) * f.delta,
        forces(f)(at_.free, Eigen::all),
        l_.loops(c_.rows, Eigen::all) * f.a + l_.second_by_rates(c_.rows, Eigen::all) * f.v +
            l_.second_by_poses(c_.rows, Eigen::all) * f.delta;
    return f;
  }

  /// y, in the order of linear_outputs(), as functions and at the state.
  MatrixXd outputs(const Functions& f) const {
    const Eigen::Index markers = l_.markers_by_poses.rows();
    std::vector<int> unique;
    for (int i = 0; i < mechanism_.m(); ++i)
      if (c_.unique[static_cast<std::size_t>(i)]) unique.push_back(i);
    MatrixXd y(3 * size(at_.free) + markers + size(at_.driven) + size(unique), f.v.cols());
    y << f.delta(at_.free, Eigen::all), f.v(at_.free, Eigen::all), f.a(at_.free, Eigen::all),
        marked(f), forces(f)(at_.driven, Eigen::all), f.lambda(unique, Eigen::all);
    return y;
  }

  LinearColumns columns() const { return linear_columns(at_, c_); }

 private:
  static Eigen::Index size(const std::vector<int>& x) {
    return static_cast<Eigen::Index>(x.size());
  }
  static Eigen::Index at(const std::vector<int>& x, Eigen::Index i) {
    return x[static_cast<std::size_t>(i)];
  }
  [[noreturn]] void refuse(const std::string& what) const {
    throw SceneError(mechanism_.scene().where({}) + what + "; expected a state at which they are");
  }
  [[noreturn]] void refuse_massless() const {
    throw SceneError(mechanism_.scene().where({}) +
                     "a motion that the loops allow moves no mass: expected inertia in every "
                     "motion");
  }

  void put_inputs(Functions& f, Eigen::Index from) const {
    for (Eigen::Index i = 0; i < size(at_.free); ++i) f.tau(at(at_.free, i), from + i) = 1;
    for (Eigen::Index k = 0; k < size(drives_); ++k) {
      const Eigen::Index column = from + size(at_.free) + 3 * k, rate = at(drives_, k);
      f.delta(rate, column) = f.v(rate, column + 1) = f.a(rate, column + 2) = 1;
    }
  }

  /// Columns of drives of loops: each is a coordinate f with given δ, δu and δu̇. Their rows of (1a)
  /// are unused.
  void append_loop_drives() {
    const Eigen::Index more = size(c_.loop_drives);
    const LoopDriveColumns columns =
        loop_drive_columns(mechanism_, c_.loop_drives, at_.t, at_.q, at_.u, udot_, lambda_);
    const auto beside = [&](MatrixXd& all, const MatrixXd& own) {
      MatrixXd wide(all.rows(), all.cols() + more);
      wide << all, own;
      all = std::move(wide);
    };
    beside(l_.loops, columns.loops);
    beside(l_.loop_rates, columns.loop_rates);
    beside(l_.second_by_rates, 2 * columns.loop_rates);
    beside(l_.second_by_poses, columns.second_by_poses);
    beside(l_.K, columns.forces);
    for (MatrixXd* a : {&l_.M, &l_.C, &l_.turning, &l_.markers_by_poses, &l_.markers_by_rates})
      beside(*a, MatrixXd::Zero(a->rows(), more));
    for (MatrixXd* a : {&l_.M, &l_.C, &l_.K, &l_.turning}) {
      a->conservativeResize(places_, Eigen::NoChange);
      a->bottomRows(more).setZero();
    }
    for (const MatrixXd* x : {&l_.loops, &l_.loop_rates, &l_.second_by_poses, &l_.K})
      if (!x->allFinite())
        refuse("the linearised equations are not finite at this state, expected another");
  }

  /// M δu̇ + C δu + K δ + Aᵀ δλ − τ
  MatrixXd forces(const Functions& f) const {
    return l_.M * f.a + l_.C * f.v + l_.K * f.delta + l_.loops.transpose() * f.lambda - f.tau;
  }
  MatrixXd marked(const Functions& f) const {
    return l_.markers_by_poses * f.delta + l_.markers_by_rates * f.v;
  }

  /// u̇ and λ: u̇ of free rates by N and f̈, as in minimal().
  void solve_state() {
    const int m = mechanism_.m();
    udot_ = VectorXd::Zero(nv_);
    lambda_ = VectorXd::Zero(m);
    for (Eigen::Index k = 0; k < size(at_.driven); ++k)
      udot_[at(at_.driven, k)] = at_.driven_accelerations[k];
    const auto e = mechanism_.evaluation<double>();
    VectorXd r(nv_), second(m);
    const auto residual = [&] {
      e->joint_forces(at_.q.data(), at_.u.data(), udot_.data(), lambda_.data(), r.data());
      if (m > 0) e->accelerations(second.data());
      if (!r.allFinite() || !second.allFinite())
        refuse("the equations of motion are not finite at this state, expected another");
    };
    e->place(at_.t, at_.q.data());
    e->move(at_.u.data());
    residual();
    const MatrixXd every = MatrixXd::Identity(nv_, nv_);
    const Linearisation l = linearise(mechanism_, at_.t, at_.q, lambda_, every);
    if (!l.M.allFinite() || !l.loops.allFinite())
      refuse("the equations of motion are not finite at this state, expected another");
    MatrixXd N = MatrixXd::Zero(nv_, size(c_.free_rates));
    for (Eigen::Index i = 0; i < N.cols(); ++i) N(at(c_.free_rates, i), i) = 1;
    Lu lu, transposed;
    if (!c_.rows.empty()) {
      const MatrixXd block = l.loops(c_.rows, c_.dependent);
      lu.compute(block);
      transposed.compute(MatrixXd(block.transpose()));
      N(c_.dependent, Eigen::all) = -lu.solve(l.loops(c_.rows, Eigen::all) * N);
    }
    const Eigen::LLT<MatrixXd> cholesky(N.transpose() * l.M * N);
    if (cholesky.info() != Eigen::Success) refuse_massless();
    // Solution and refinement.
    for (int k = 0; k < 2; ++k) {
      if (!c_.rows.empty()) {
        udot_(c_.dependent) -= lu.solve(VectorXd(second(c_.rows)));
        residual();
      }
      udot_ -= N * cholesky.solve(N.transpose() * r);
      residual();
      if (c_.rows.empty()) continue;
      lambda_(c_.rows) -= transposed.solve(VectorXd(r(c_.dependent)));
      residual();
    }
  }

  OperatingPoint at_;
  IndependentCoordinates c_;
  const Mechanism& mechanism_;
  Eigen::Index nv_, places_ = 0;
  std::vector<int> drives_;  ///< joints, then loops
  Eigen::Index inputs_ = 0;
  VectorXd udot_, lambda_;
  StateLinearisation l_;
};

/// Singular values of Φ_q above `pivot` count; 0: as in independent_coordinates().
LinearModel model_at(const Mechanism& mechanism, const Start& start, const LinearRequest& request,
                     double pivot) {
  refuse_bearings(mechanism.scene(), "linearisation");
  const int unknowns = mechanism.nv() + mechanism.m();
  if (unknowns > most_of_linear_model)
    throw SceneError(mechanism.scene().where({}) + "a linear model of " + std::to_string(unknowns) +
                     " rates and loop equations is dense; expected " +
                     std::to_string(most_of_linear_model) + " at the most");
  if (!std::isfinite(start.t) || !start.q.allFinite() || !start.u.allFinite())
    throw SceneError(mechanism.scene().where({}) +
                     "the state is not finite; expected numbers for t, q and v");
  expect_regular(mechanism, start);
  OperatingPoint point = operating_point(mechanism, start);
  const std::vector<int> named = independent_places(point, request.independent);
  IndependentCoordinates chosen = independent_coordinates(point, named, pivot);
  LinearModel result;
  result.kind = request.kind;
  result.scene = mechanism.scene().name;
  result.kept = chosen.kept;
  const Eliminated model(std::move(point), std::move(chosen));
  LinearColumns columns = model.columns();
  const std::vector<int> w = picked(columns.inputs, request.inputs, "input"),
                         y = picked(columns.outputs, request.outputs, "output");
  const bool minimal = request.kind == LinearRequest::Kind::minimal;
  // Poles of both kinds.
  MatrixXd right, E;
  Functions f = model.minimal(right);
  const Eigen::Index least = right.rows();
  if (least > 0) {
    const Eigen::EigenSolver<MatrixXd> solver(right.leftCols(least), false);
    result.poles = solver.eigenvalues();
    std::stable_sort(result.poles.begin(), result.poles.end(), [](auto a, auto b) {
      return a.real() != b.real() ? a.real() > b.real() : a.imag() > b.imag();
    });
  }
  E = MatrixXd::Identity(least, least);
  if (!minimal) f = model.descriptor(E, right);
  const Eigen::Index states = right.rows();
  const MatrixXd of_outputs = model.outputs(f);
  result.E = E;
  result.A = right.leftCols(states);
  result.B = right.rightCols(model.inputs())(Eigen::all, w);
  result.C = of_outputs.leftCols(states)(y, Eigen::all);
  result.D = of_outputs.rightCols(model.inputs())(y, w);
  for (const MatrixXd* x : {&result.A, &result.B, &result.C, &result.D})
    if (!x->allFinite())
      throw SceneError(mechanism.scene().where({}) +
                       "the linear model is not finite at this state; expected a state at which "
                       "it is");
  const auto pick = [](const std::vector<GroupedColumn>& from, const std::vector<int>& which) {
    std::vector<Column> to;
    for (const int i : which) to.push_back(from[static_cast<std::size_t>(i)].column);
    return to;
  };
  result.states = minimal ? columns.minimal : columns.descriptor;
  result.inputs = pick(columns.inputs, w);
  result.outputs = pick(columns.outputs, y);
  result.left_out = columns.left_out;
  result.t = start.t;
  result.coordinates = mechanism.coordinate_columns();
  result.rates = mechanism.rate_columns();
  result.q = start.q;
  result.u = start.u;
  result.udot = model.udot()(columns.free);
  return result;
}

}  // namespace

LinearModel linear_model(const Mechanism& mechanism, const Start& at,
                         const LinearRequest& request) {
  return model_at(mechanism, at, request, 0);
}

LinearModel linear_model(const Mechanism& mechanism, const Equilibrium& at,
                         const LinearRequest& request) {
  Start rest;
  rest.t = at.t;
  rest.q = at.q;
  rest.u = VectorXd::Zero(mechanism.nv());
  return model_at(mechanism, rest, request, at.pivot);
}

}  // namespace momenta
