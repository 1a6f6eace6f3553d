#include <momenta/core/expression/simplify.h>
#include <momenta/core/expression/tape.h>
#include <momenta/core/scene/lagrangian/lagrangian_formulas.h>
#include <momenta/core/scene/lagrangian/lagrangian_model.h>
#include <momenta/core/text/quoting.h>

#include <algorithm>
#include <utility>

namespace momenta {
namespace {

using formula::Instruction;
using formula::Operation;
using formula::Tape;
using Places = std::vector<int>;

/// Whether value i of a formula is the number 0.
bool is_zero_value(const Expression& formula, std::size_t i) {
  const Instruction& in = formula.tape()[static_cast<std::size_t>(formula.outputs()[i])];
  return in.operation == Operation::number && in.number == 0;
}

/// Writes the tapes of a model, all on one.
class Writer {
 public:
  Writer(const Scene& scene, int n, int m) : scene_(scene), formulas_(scene), n_(n), m_(m) {
    for (int i = 0; i < 4 * n + 1 + m; ++i) x_.push_back(tape_.add(Operation::variable, i));
    known_.assign(x_.begin(), x_.begin() + 2 * n + 1);
    for (const ParameterSpec& p : scene.parameters) known_.push_back(tape_.number(p.value));
    const int zero = tape_.number(0);
    lagrangian_ = formulas_.lagrangian ? add(*formulas_.lagrangian) : add(*formulas_.kinetic);
    if (formulas_.potential)
      lagrangian_ = add(Operation::subtract, lagrangian_, add(*formulas_.potential));
    p_ = gradient(lagrangian_, range(n, n));
    lq_ = gradient(lagrangian_, range(0, n));
    lt_ = gradient(lagrangian_, range(2 * n, 1)).front();
    forces_.assign(static_cast<std::size_t>(n), zero);
    const auto& spec = scene.lagrangian->forces;
    for (std::size_t k = 0; k < spec.size(); ++k)
      forces_[coordinate(spec[k].coordinate)] = add(formulas_.forces[k]);
    for (const Expression& c : formulas_.constraints) phi_.push_back(add(c));
    for (const int phi : phi_) phi_dot_.push_back(along(phi, {{0, 2 * n + 1}}));
  }

  Expression of(const Places& outputs) const { return {tape_, outputs}; }
  Expression of(int output) const { return of(Places{output}); }

  Expression positions() const { return of(phi_); }
  Expression velocities() const { return of(phi_dot_); }
  Expression accelerations() {
    Places all;
    for (const int rate : phi_dot_)
      all.push_back(along(rate, {{0, 2 * n_ + 1}, {2 * n_ + 1, 3 * n_ + 1}}));
    return of(all);
  }
  /// ∂(s·y)/∂q
  Expression transposed(const Places& y) {
    int sum = tape_.number(0);
    for (int k = 0; k < m_; ++k)
      sum = add(Operation::add, sum,
                add(Operation::multiply, x(4 * n_ + 1 + k), y[static_cast<std::size_t>(k)]));
    return of(gradient(sum, range(0, n_)));
  }
  Expression constraint_forces() { return transposed(phi_); }
  Expression constraint_rates() { return transposed(phi_dot_); }

  Expression momenta() const { return of(p_); }
  Expression momentum_rates() {
    Places all;
    for (std::size_t i = 0; i < lq_.size(); ++i)
      all.push_back(add(Operation::add, lq_[i], forces_[i]));
    return of(all);
  }
  Expression joint_forces() {
    // D with a term for each q_j, each q̇_j and t.
    int d = lt_;
    for (int j = 0; j < n_; ++j) {
      const auto i = static_cast<std::size_t>(j);
      d = add(Operation::add, d, add(Operation::multiply, x(2 * n_ + 1 + j), lq_[i]));
      d = add(Operation::add, d, add(Operation::multiply, x(3 * n_ + 1 + j), p_[i]));
    }
    Places all = gradient(d, range(n_, n_));
    for (std::size_t i = 0; i < all.size(); ++i) {
      all[i] = add(Operation::subtract, all[i], lq_[i]);
      all[i] = add(Operation::subtract, all[i], forces_[i]);
    }
    return of(all);
  }
  Expression applied() const { return of(forces_); }
  Expression at_rest(const Places& y) const {
    Tape rest;
    Places outputs = y;
    const std::vector<Instruction> needed = tape_.needed_for(outputs);
    std::vector<int> zeros(x_.size(), -1);
    for (int i = 0; i < n_; ++i) zeros[static_cast<std::size_t>(n_ + i)] = rest.number(0);
    const Places place = formula::add_simplified(rest, needed, zeros);
    for (int& i : outputs) i = place[static_cast<std::size_t>(i)];
    return {rest, outputs};
  }
  Expression linear_part() const { return at_rest(p_); }
  bool has_linear_part() const {
    const Expression b = linear_part();
    for (std::size_t i = 0; i < b.outputs().size(); ++i)
      if (!is_zero_value(b, i)) return true;
    return false;
  }
  Expression kinetic() {
    // ½ Σ q̇_i (p_i − b_i)
    const Expression b = linear_part();
    const Places place = formula::add_simplified(tape_, b.tape(), {});
    int sum = tape_.number(0);
    for (int i = 0; i < n_; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const int moving =
          add(Operation::subtract, p_[at], place[static_cast<std::size_t>(b.outputs()[at])]);
      sum = add(Operation::add, sum, add(Operation::multiply, x(n_ + i), moving));
    }
    return of(add(Operation::multiply, tape_.number(0.5), sum));
  }
  bool forces_rest() const {
    const Expression q = at_rest(forces_);
    for (std::size_t i = 0; i < q.outputs().size(); ++i)
      if (!is_zero_value(q, i)) return false;
    return true;
  }
  Expression potential() { return at_rest({add(Operation::negative, lagrangian_)}); }
  Expression power() {
    int sum = add(Operation::negative, lt_);
    for (int i = 0; i < n_; ++i)
      sum = add(Operation::add, sum,
                add(Operation::multiply, x(n_ + i), forces_[static_cast<std::size_t>(i)]));
    return of(sum);
  }

  LagrangianModel::Entries mass() {
    const auto n = static_cast<std::size_t>(n_);
    std::vector<Places> all(n);
    std::vector<std::vector<char>> there(n, std::vector<char>(n));
    for (int i = 0; i < n_; ++i) {
      Places& row = all[static_cast<std::size_t>(i)];
      row = gradient(p_[static_cast<std::size_t>(i)], range(n_, n_));
      for (int j = i; j < n_; ++j)
        there[static_cast<std::size_t>(j)][static_cast<std::size_t>(i)] =
            is_there(row[static_cast<std::size_t>(j)], i, j);
    }
    std::vector<LagrangianModel::Entry> places = with_ancestors(std::move(there));
    Places outputs;
    for (const auto& [row, column] : places)
      outputs.push_back(all[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)]);
    return {std::move(places), of(outputs)};
  }
  LagrangianModel::Entries constraint() {
    std::vector<LagrangianModel::Entry> places;
    Places outputs;
    for (int k = 0; k < m_; ++k) {
      const Places row = gradient(phi_[static_cast<std::size_t>(k)], range(0, n_));
      for (int j = 0; j < n_; ++j) {
        const int entry = row[static_cast<std::size_t>(j)];
        if (is_zero(entry)) continue;
        places.push_back({k, j});
        outputs.push_back(entry);
      }
    }
    return {std::move(places), of(outputs)};
  }
  /// Whether y, of positions and time, changes with time alone.
  bool moves(const Places& y) {
    return std::any_of(y.begin(), y.end(),
                       [&](int i) { return !is_zero(gradient(i, range(2 * n_, 1)).front()); });
  }
  bool constraints_move() { return moves(phi_); }

 private:
  static Places range(int first, int count) {
    Places all;
    for (int i = 0; i < count; ++i) all.push_back(first + i);
    return all;
  }
  int x(int i) const { return x_[static_cast<std::size_t>(i)]; }
  int add(Operation o, int a, int b = -1) {
    return formula::add_simplified(tape_, {o, a, b, -1, 0});
  }
  int add(const Expression& formula) {
    const Places place = formula::add_simplified(tape_, formula.tape(), known_);
    return place[static_cast<std::size_t>(formula.outputs().front())];
  }
  Places gradient(int value, const Places& variables) {
    return formula::add_gradient(tape_, value, variables);
  }
  std::size_t coordinate(const std::string& name) const {
    const auto& all = scene_.lagrangian->coordinates;
    return static_cast<std::size_t>(
        std::find_if(all.begin(), all.end(), [&](const auto& c) { return c.name == name; }) -
        all.begin());
  }
  /// A block of variables from `first`, and where the block of its rates begins.
  struct Way {
    int first, direction;
  };
  /// dy/dt of y(q, t, v): over the blocks, and by t itself.
  int along(int y, const std::vector<Way>& ways) {
    int sum = gradient(y, range(2 * n_, 1)).front();
    for (const Way& way : ways) {
      const Places slopes = gradient(y, range(way.first, n_));
      for (int j = 0; j < n_; ++j)
        sum = add(
            Operation::add, sum,
            add(Operation::multiply, x(way.direction + j), slopes[static_cast<std::size_t>(j)]));
    }
    return sum;
  }
  bool is_zero(int y) const {
    const Instruction& in = tape_[y];
    return (in.operation == Operation::number && in.number == 0) || is_zero_value(of(y), 0);
  }
  /// Whether entry i, j of M, at place y, is not zero. @throws SceneError where it has rates
  bool is_there(int y, int i, int j) const {
    const Expression entry = of(y);
    for (const int v : entry.variables()) {
      if (v < n_ || v >= 2 * n_) continue;
      const LagrangianSpec& spec = *scene_.lagrangian;
      const bool whole = !spec.lagrangian.text.empty();
      const auto name = [&](int k) {
        return reading::in_quotes(formulas_.names[static_cast<std::size_t>(k)]);
      };
      throw SceneError(scene_.where(whole ? spec.lagrangian.at : spec.kinetic.at) +
                       (whole ? "lagrangian" : "kinetic") + ": its second derivative by " +
                       name(n_ + i) + (i == j ? " twice" : " and " + name(n_ + j)) + " has " +
                       name(v) + " in it, expected a formula quadratic in the rates");
    }
    return !is_zero(y);
  }
  /// Places of M with, in each column, all ancestors in the elimination tree: a column's parent is
  /// the nearest row before it, once its descendants are eliminated. `there[k][i]`: row i ≤ k of
  /// column k.
  std::vector<LagrangianModel::Entry> with_ancestors(std::vector<std::vector<char>> there) const {
    std::vector<int> parent(there.size(), -1);
    for (std::size_t k = there.size(); k-- > 0;) {
      for (std::size_t i = k; i-- > 0 && parent[k] < 0;)
        if (there[k][i]) parent[k] = static_cast<int>(i);
      for (int i = 0; i < parent[k]; ++i)
        there[static_cast<std::size_t>(parent[k])][static_cast<std::size_t>(i)] |=
            there[k][static_cast<std::size_t>(i)];
    }
    std::vector<LagrangianModel::Entry> all;
    for (int k = 0; k < n_; ++k)
      for (int i = k; i >= 0; i = parent[static_cast<std::size_t>(i)]) all.push_back({i, k});
    return all;
  }

  const Scene& scene_;
  LagrangianFormulas formulas_;
  int n_, m_;
  Tape tape_;
  Places x_, known_;
  int lagrangian_ = -1, lt_ = -1;
  Places p_, lq_, forces_, phi_, phi_dot_;
};

}  // namespace

LagrangianModel build_lagrangian_model(const Scene& scene) {
  const auto n = static_cast<int>(scene.lagrangian->coordinates.size()),
             m = static_cast<int>(scene.lagrangian->constraints.size());
  Writer write(scene, n, m);
  LagrangianModel model{.n = n,
                        .m = m,
                        .positions = write.positions(),
                        .velocities = write.velocities(),
                        .accelerations = write.accelerations(),
                        .constraint_forces = write.constraint_forces(),
                        .constraint_rates = write.constraint_rates(),
                        .momenta = write.momenta(),
                        .momentum_rates = write.momentum_rates(),
                        .joint_forces = write.joint_forces(),
                        .applied = write.applied(),
                        .kinetic = write.kinetic(),
                        .potential = write.potential(),
                        .power = write.power(),
                        .mass = write.mass(),
                        .constraint = write.constraint(),
                        .in_time = false,
                        .linear = write.has_linear_part(),
                        .balanced = write.forces_rest(),
                        .has_power = false,
                        .moving = write.constraints_move()};
  model.has_power = !is_zero_value(model.power, 0);
  for (const Expression* formula : {&model.positions, &model.momenta, &model.momentum_rates})
    for (const int v : formula->variables()) model.in_time |= v == model.time();
  return model;
}

}  // namespace momenta
