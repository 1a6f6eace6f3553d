#pragma once
// Shared by the files of the Python module. Python objects share their mechanism; vectors go in and
// out without copies, as NumPy arrays of float64.

#include <momenta/core/format/toml/setting.h>
#include <momenta/core/open_chain/arguments.h>
#include <momenta/core/open_chain/open_chain.h>
#include <momenta/dae/analysis/chain/closed_chain.h>
#include <momenta/dae/kkt/loop_solver.h>
#include <momenta/dae/kkt/unheld_joints.h>
#include <momenta/dae/topology/assembly/assembly.h>
#include <pybind11/eigen.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <string>

namespace momenta::python {

namespace py = pybind11;
using Vector = Eigen::VectorXd;
using In = Eigen::Ref<const Eigen::VectorXd>;
/// A table as NumPy has it.
using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Refuses an array of wrong length or with numbers that are not finite, by its name.
inline void expect_size(const In& x, int size, const char* name, const char* what) {
  if (x.size() != size)
    throw py::value_error(std::string(name) + " has " + std::to_string(x.size()) +
                          " numbers, expected " + std::to_string(size) + " (" + what + ")");
  for (Eigen::Index i = 0; i < x.size(); ++i)
    if (!std::isfinite(x[i])) throw py::value_error(not_finite(name, i, x[i]));
}
inline void expect_time(double t) {
  if (!std::isfinite(t))
    throw py::value_error("t is " + std::string(py::str(py::float_(t))) +
                          ", expected a time in seconds");
}

/// Names with units.
inline std::vector<std::string> labels_of(const std::vector<Column>& columns) {
  std::vector<std::string> all;
  for (const Column& c : columns) all.push_back(c.label());
  return all;
}

/// Kernel, solver of (7) and cuts of runs, by name. @throws py::value_error
MechanismOptions options_of(const std::string& algebra, const std::string& kkt,
                            const std::string& cut);

/// A mechanism with the workspaces of one thread: evaluations, the solver of its loops, its tree.
class Bench {
 public:
  Bench(Scene scene, const std::string& algebra_name, const std::string& kkt_name,
        const std::string& cut_name)
      : algebra(algebra_name),
        kkt(kkt_name),
        cut(cut_name),
        mechanism(
            std::make_shared<const Mechanism>(std::move(scene), options_of(algebra, kkt, cut))),
        e(mechanism->evaluation<double>()) {
    if (mechanism->m() > 0) solver = make_loop_solver(*mechanism, *e);
  }
  /// The open tree: M is the tree's.
  OpenChain& chain() {
    if (!chain_) {
      Scene tree = mechanism->scene();
      tree.loops.clear();
      chain_ = std::make_unique<OpenChain>(tree);
    }
    return *chain_;
  }
  /// The mechanism in ClosedChain: with joint forces, and many states at once.
  ClosedChain& closed() {
    if (!closed_)
      closed_ = std::make_unique<ClosedChain>(mechanism->scene(), options_of(algebra, kkt, cut));
    return *closed_;
  }
  void expect(double t, const In* q, const In* u, const char* rates = "u") const {
    expect_time(t);
    if (q) expect_size(*q, mechanism->nq(), "q", "nq");
    if (u) expect_size(*u, mechanism->nv(), rates, "nv");
  }
  /// Raises SceneError unless all numbers found are finite.
  template <class... Found>
  void expect_finite(const Found&... found) const {
    std::string failure;
    if (!found_finite(failure, found...)) throw SceneError(failure);
  }
  [[noreturn]] void fail(double t, const In& q) const {
    throw SceneError(momenta::no_inertia(
        *mechanism, solver ? solver->singular_joint() : e->singular_joint(), t, q.data()));
  }

  std::string algebra, kkt, cut;
  std::string text;    ///< TOML of the scene; empty: see toml_of()
  std::string source;  ///< TOML with the numbers of `set` in place; empty: `text`
  std::vector<Setting> set;
  std::shared_ptr<const Mechanism> mechanism;
  std::unique_ptr<Evaluation<double>> e;
  std::unique_ptr<LoopSolver> solver;

 private:
  std::unique_ptr<OpenChain> chain_;
  std::unique_ptr<ClosedChain> closed_;
};
using BenchPtr = std::shared_ptr<Bench>;

void bind_mechanism(py::module_& module);
void bind_runs(py::module_& module);
/// Binds functions of the package that are named like the program's verbs.
void bind_verbs(py::module_& module);
/// TOML of the scene: its own text, whose omissions a caller may vary, else one that reads back the
/// same.
std::string toml_of(const Bench& bench);
void add_runs(py::class_<Bench, BenchPtr>& mechanism);
void add_assemblies(py::class_<Bench, BenchPtr>& mechanism);
void add_move(py::class_<Bench, BenchPtr>& mechanism);
void add_batches(py::class_<Bench, BenchPtr>& mechanism);
void add_effort(py::class_<Bench, BenchPtr>& mechanism);
void add_fit(py::class_<Bench, BenchPtr>& mechanism);
void add_gradient(py::class_<Bench, BenchPtr>& mechanism);
void add_modes(py::class_<Bench, BenchPtr>& mechanism);
void add_linearise(py::class_<Bench, BenchPtr>& mechanism);

}  // namespace momenta::python
