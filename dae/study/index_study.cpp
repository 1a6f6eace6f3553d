#include <momenta/dae/algebra/dense/singular_values.h>
#include <momenta/dae/form/dae_form.h>
#include <momenta/dae/kkt/body_matrix.h>
#include <momenta/dae/kkt/loop_rank.h>
#include <momenta/dae/study/index_study.h>

#include <algorithm>
#include <cmath>

namespace momenta {
namespace {

/// (M Φ_qᵀ; Φ_q 0) at the configuration of `start`, and Φ_q alone.
struct Matrices {
  Eigen::MatrixXd kkt, constraint;
};

Matrices matrices(const Mechanism& mechanism, const Start& start) {
  const int nv = mechanism.nv(), m = mechanism.m();
  Matrices a{Eigen::MatrixXd::Zero(nv + m, nv + m), {}};
  const auto e = mechanism.evaluation<double>();
  e->place(start.t, start.q.data());
  a.constraint = dense_constraints(mechanism, *e);
  a.kkt.topLeftCorner(nv, nv) = dense_mass(mechanism, *e);
  a.kkt.bottomLeftCorner(m, nv) = a.constraint;
  a.kkt.topRightCorner(nv, m) = a.constraint.transpose();
  return a;
}

RankFound rank_of(Eigen::MatrixXd matrix) {
  if (matrix.size() == 0) return {};
  Eigen::VectorXd none = Eigen::VectorXd::Zero(matrix.rows());
  equilibrate(matrix, none);
  const Eigen::VectorXd values = SingularValues(matrix).values;
  return rank_by_gap(values, values[0]);
}

/// Rank of Φ_q by kkt/loop_rank.h.
RankFound rank_of_loops(const Mechanism& mechanism, const Start& start) {
  const auto e = mechanism.evaluation<double>();
  e->place(start.t, start.q.data());
  const LoopRank loops = loop_rank(mechanism, *e);
  RankFound found;
  found.rank = loops.rank;
  if (!(loops.singular_values.size() > 0 && loops.singular_values[0] > 0)) return found;
  found.kept = loops.kept / loops.singular_values[0];
  found.dropped = loops.dropped / loops.singular_values[0];
  return found;
}

double time_scale(const Mechanism& mechanism, const Start& start) {
  if (mechanism.m() > 0) return 1 / default_leak(mechanism, start);
  double rate = 0;
  for (const double u : start.u) rate = std::max(rate, std::abs(u));
  for (const double udot : start.udot) rate = std::max(rate, std::sqrt(std::abs(udot)));
  return rate > 0 ? 1 / rate : 1;
}

std::vector<UnknownBlock> blocks_of(const DaeForm& form, const FormInWords& words,
                                    const IndexFound& found) {
  const DaeLayout& l = form.layout();
  const std::string x = words.x.empty() ? "x" : words.x, s = words.s.empty() ? "s" : words.s;
  std::vector<UnknownBlock> blocks;
  int first = 0;
  const auto add = [&](const std::string& symbol, int size) {
    if (size == 0) return;
    UnknownBlock b;
    b.symbol = symbol;
    b.size = size;
    b.algebraic = true;
    for (int i = first; i < first + size; ++i) {
      b.algebraic &= !found.appears[static_cast<std::size_t>(i)];
      b.tested |= form.differential(i);
      b.in_newton_norm |= std::isfinite(form.scale(i));
    }
    for (const ArrayLevel& level : found.levels) {
      bool all = true;
      for (int i = first; i < first + size && b.determined_after < 0; ++i)
        all &= level.determined.empty() ? false : level.determined[static_cast<std::size_t>(i)];
      if (all && b.determined_after < 0) b.determined_after = level.differentiations;
    }
    first += size;
    blocks.push_back(b);
  };
  add("q", l.nq);
  add(x, l.nv);
  if (l.explicit_velocity) add("v", l.nv);
  add(s, l.m);
  if (l.position_multiplier) add("μ", l.m);
  return blocks;
}

std::string symbols(const std::vector<UnknownBlock>& blocks, bool UnknownBlock::*flag, bool value) {
  std::string all;
  for (const auto& b : blocks)
    if (b.*flag == value) all += (all.empty() ? "" : ", ") + b.symbol;
  return all.empty() ? "nothing" : all;
}

void judge_ida(FormIndex& f) {
  const int appearing =
      static_cast<int>(std::count(f.found.appears.begin(), f.found.appears.end(), true));
  f.semi_explicit = f.found.levels.empty() || f.found.levels.front().rank == appearing;
  bool algebraic_tested = false;
  for (const auto& b : f.blocks) algebraic_tested |= b.algebraic && b.tested;
  const std::string done =
      "here " + symbols(f.blocks, &UnknownBlock::tested, true) + " in the error test; " +
      symbols(f.blocks, &UnknownBlock::tested, false) + " out of it, " +
      symbols(f.blocks, &UnknownBlock::in_newton_norm, false) + " out of the Newton norm";
  const int index = f.found.index;
  if (!f.found.decided) {
    f.ida = "not judged";
    return;
  }
  if (index < 0) {
    f.ida =
        "does not hold without an index: the Newton matrix is singular for every step. Here "
        "-ε times the multiplier in each row of the loops makes it regular";
    return;
  }
  if (index <= 1) {
    f.ida_holds = true;
    f.ida = "holds, index " + std::to_string(index) + "; " + done;
  } else if (index == 2) {
    f.ida_holds = f.semi_explicit && !algebraic_tested;
    f.ida = std::string(f.ida_holds ? "holds" : "does not hold") + ", index 2, " +
            (f.semi_explicit ? "semi-explicit" : "not semi-explicit") +
            ": BDF converges if the algebraic unknowns are not error-tested; " + done;
  } else {
    f.ida = "does not hold, index " + std::to_string(index) +
            (index == 3 ? ": BDF is proved for index 3 with constant steps only; " : "; ") + done;
  }
}

}  // namespace

std::string FormIndex::text() const {
  if (!dae) return "ODE";
  if (found.index >= 0) return std::to_string(found.index);
  return found.decided ? "not defined" : "not decided";
}

IndexStudy run_index_study(const Mechanism& mechanism, const Start& start,
                           std::vector<std::string> forms,
                           const std::function<bool(const std::string& form)>& progress) {
  if (forms.empty())
    forms = mechanism.m() > 0 ? form_names() : std::vector<std::string>{"momentum", "acceleration"};
  for (const auto& form : forms) is_dae_form(form);  // throws for an unknown name
  const int smallest = mechanism.nq() + mechanism.nv() + mechanism.m();
  if (smallest > index_limit)
    throw SceneError(mechanism.scene().where({}) +
                     "the index is found from dense matrices: found " + std::to_string(smallest) +
                     " unknowns, expected at most " + std::to_string(index_limit) +
                     "; take a smaller mechanism of the same kind");
  IndexStudy study;
  study.scene = mechanism.scene().name;
  study.t = start.t;
  study.nq = mechanism.nq();
  study.nv = mechanism.nv();
  study.m = mechanism.m();
  const auto& of_rates = mechanism.nonholonomic();
  study.nonholonomic = static_cast<int>(std::count(of_rates.begin(), of_rates.end(), true));
  const Matrices at = matrices(mechanism, start);
  if (mechanism.m() > 0) study.loops = rank_of_loops(mechanism, start);
  const double time = time_scale(mechanism, start);
  for (const auto& name : forms) {
    if (progress && !progress(name)) break;
    FormIndex f;
    f.form = name;
    f.dae = is_dae_form(name);
    f.words = find_form(name)->words;
    if (!f.dae) {
      f.unknowns = mechanism.nq() + mechanism.nv();
      // M + Φ_qᵀαΦ_q is regular where M is.
      f.inner_size = f.words.penalised ? mechanism.nv() : static_cast<int>(at.kkt.rows());
      f.inner = rank_of(at.kkt.topLeftCorner(f.inner_size, f.inner_size));
      study.forms.push_back(std::move(f));
      continue;
    }
    FormOptions options;
    options.gauge.kind = Gauge::Kind::leak;
    const auto form = make_form(name, mechanism, options, start);
    auto& dae = dynamic_cast<DaeForm&>(*form);
    f.unknowns = dae.size();
    if (f.unknowns > index_limit) {
      f.found.why = "not decided: " + std::to_string(f.unknowns) + " unknowns, at most " +
                    std::to_string(index_limit) + " are taken";
      study.forms.push_back(std::move(f));
      continue;
    }
    Eigen::VectorXd y(f.unknowns), ydot(f.unknowns);
    if (!dae.start(start.t, y.data(), ydot.data())) {
      f.found.why = dae.failure();
      study.forms.push_back(std::move(f));
      continue;
    }
    const CurveSystem system{f.unknowns, [&dae](double t, const Jet* a, const Jet* b, Jet* r) {
                               dae.along(t, a, b, r);
                             }};
    f.found = find_index(system, start.t, y, ydot, time);
    f.blocks = blocks_of(dae, f.words, f.found);
    judge_ida(f);
    study.forms.push_back(std::move(f));
  }
  return study;
}

}  // namespace momenta
