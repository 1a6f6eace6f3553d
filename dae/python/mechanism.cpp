// Mechanism: the data of a scene, its consistent start, and the equations at one state.

#include <momenta/core/format/toml/parse_scene.h>
#include <momenta/core/format/toml/write_scene.h>
#include <momenta/core/scene/bearings_refused.h>
#include <momenta/dae/kkt/body_matrix.h>
#include <momenta/dae/kkt/solver_choice.h>
#include <momenta/dae/run/state_values.h>
#include <momenta/dae/topology/assembly/drive_reach.h>

#include <Eigen/Cholesky>
#include <optional>

#include "bindings.h"

namespace momenta::python {

MechanismOptions options_of(const std::string& algebra, const std::string& kkt,
                            const std::string& cut) {
  MechanismOptions options;
  if (algebra == "planar")
    options.algebra = Algebra::planar;
  else if (algebra == "spatial")
    options.algebra = Algebra::spatial;
  else if (algebra != "auto")
    throw py::value_error("algebra '" + algebra + "': expected auto, planar or spatial");
  if (kkt == "sweeps")
    options.kkt = KktChoice::sweeps;
  else if (kkt == "sparse")
    options.kkt = KktChoice::sparse;
  else if (kkt == "dense")
    options.kkt = KktChoice::dense;
  else if (kkt != "auto")
    throw py::value_error("kkt '" + kkt + "': expected auto, sweeps, sparse or dense");
  if (cut == "scene")
    options.cut = CutChoice::scene;
  else if (cut != "auto")
    throw py::value_error("cut '" + cut + "': expected auto or scene");
  return options;
}

std::string toml_of(const Bench& bench) {
  return bench.text.empty() ? scene_text(bench.mechanism->scene()) : bench.text;
}

namespace {

/// (u, σ, ṗ) of (7)-(8).
py::tuple momentum_rates(Bench& b, double t, const In& q, const In& p,
                         const std::optional<Vector>& centre, double leak,
                         const std::optional<Vector>& tau) {
  const int nv = b.mechanism->nv(), m = b.mechanism->m();
  b.expect(t, &q, &p, "p");
  refuse_bearings(b.mechanism->scene(), "momentum_rates");
  if (tau) expect_size(*tau, nv, "tau", "nv");
  Vector u(nv), pdot(nv), sigma(m);
  if (centre) expect_size(*centre, m, "centre", "m");
  expect_leak("momentum_rates", leak);
  const bool ok =
      m == 0 ? b.e->open_momentum_rates(t, q.data(), p.data(), u.data(), pdot.data())
             : b.solver->momentum(t, q.data(), p.data(), centre ? centre->data() : nullptr,
                                  fade_evaluation, leak, u.data(), sigma.data(), pdot.data());
  if (!ok) b.fail(t, q);
  if (tau) pdot += *tau;  // u and sigma follow from p alone
  b.expect_finite(u, sigma, pdot);
  return py::make_tuple(std::move(u), std::move(sigma), std::move(pdot));
}

/// (u̇, λ) of (3).
py::tuple accelerations(Bench& b, double t, const In& q, const In& u,
                        const std::optional<Vector>& tau) {
  const int nv = b.mechanism->nv(), m = b.mechanism->m();
  b.expect(t, &q, &u);
  refuse_bearings(b.mechanism->scene(), "accelerations");
  Vector udot(nv), lambda(m);
  if (tau) {
    expect_size(*tau, nv, "tau", "nv");
    if (!b.closed().accelerations(t, q, u, *tau, udot, lambda))
      throw SceneError(b.closed().failure());
    return py::make_tuple(std::move(udot), std::move(lambda));
  }
  const bool ok = m == 0 ? b.e->open_accelerations(t, q.data(), u.data(), udot.data())
                         : b.solver->acceleration(t, q.data(), u.data(), nullptr, 0, 0, udot.data(),
                                                  lambda.data());
  if (!ok) b.fail(t, q);
  b.expect_finite(udot, lambda);
  return py::make_tuple(std::move(udot), std::move(lambda));
}

Vector momenta_of(Bench& b, double t, const In& q, const In& u,
                  const std::optional<Vector>& sigma) {
  b.expect(t, &q, &u);
  if (sigma) expect_size(*sigma, b.mechanism->m(), "sigma", "m");
  Vector p(b.mechanism->nv());
  b.e->place(t, q.data());
  b.e->move(u.data());
  b.e->momenta(sigma ? sigma->data() : nullptr, p.data());
  b.expect_finite(p);
  return p;
}

/// (Φ, Φ̇)
py::tuple constraints(Bench& b, double t, const In& q, const In& u) {
  b.expect(t, &q, &u);
  Vector phi(b.mechanism->m()), rate(b.mechanism->m());
  b.e->place(t, q.data());
  b.e->positions(phi.data());
  b.e->move(u.data());
  b.e->velocities(rate.data());
  b.expect_finite(phi, rate);
  return py::make_tuple(std::move(phi), std::move(rate));
}

/// M and Φ_q, dense.
py::tuple kkt(Bench& b, double t, const In& q) {
  b.expect(t, &q, nullptr);
  b.e->place(t, q.data());
  Eigen::MatrixXd mass = dense_mass(*b.mechanism, *b.e),
                  constraints = dense_constraints(*b.mechanism, *b.e);
  b.expect_finite(mass, constraints);
  return py::make_tuple(std::move(mass), std::move(constraints));
}

Vector inverse_mass_times(Bench& b, double t, const In& q, const In& x) {
  b.expect(t, &q, &x, "x");
  Vector result(b.mechanism->nv());
  if (b.mechanism->scene().lagrangian) {
    b.e->place(t, q.data());
    const Eigen::MatrixXd mass = dense_mass(*b.mechanism, *b.e);
    b.expect_finite(mass);
    const Eigen::LLT<Eigen::MatrixXd> factor(mass);
    if (factor.info() != Eigen::Success)
      throw SceneError("the mass matrix is not positive definite at q, expected one that is");
    result = factor.solve(x);
    b.expect_finite(result);
    return result;
  }
  if (!b.chain().inverse_mass_times(t, q, x, result)) throw SceneError(b.chain().failure());
  return result;
}

py::tuple energies(Bench& b, double t, const In& q, const In& u) {
  b.expect(t, &q, &u);
  b.e->place(t, q.data());
  b.e->move(u.data());
  const Eigen::Vector2d found(b.e->kinetic(), b.e->potential(q.data()));
  b.expect_finite(found);
  return py::make_tuple(found[0], found[1]);
}

/// Missing values are those of the scene's start, assembled where there are loops, as in the
/// program.
py::dict evaluate(Bench& b, double t, const std::optional<Vector>& q,
                  const std::optional<Vector>& v, const std::optional<Vector>& p) {
  const Tree& tree = b.mechanism->tree();
  if (v && p) throw py::value_error("v and p are both given; expected one of them");
  expect_time(t);
  GivenState given;
  given.t = t;
  given.tau = Vector::Zero(tree.nv);
  if (b.mechanism->m() > 0 && (!q || (!v && !p))) {
    const Assembly a = assemble_at(*b.mechanism, t, Assembled::rates);
    given.q = q.value_or(a.start.q);
    given.v = v.value_or(a.start.u);
  } else {
    given.q = q.value_or(tree.q0);
    given.v = v.value_or(tree.u0);
  }
  expect_size(given.q, tree.nq, "q", "nq");
  expect_size(given.v, tree.nv, "v", "nv");
  if (p) {
    expect_size(*p, tree.nv, "p", "nv");
    given.of_momenta = true;
    given.p = *p;
    given.p_given.assign(static_cast<std::size_t>(tree.nv), true);
  }
  StateValues s = evaluate_state(*b.mechanism, given);
  py::dict all;
  const auto put = [&](const char* name, const auto& value) { all[name] = py::cast(value); };
  put("v", s.v), put("p", s.p), put("qdot", s.qdot), put("pdot", s.pdot), put("bias", s.bias);
  put("udot_free", s.free), put("udot", b.mechanism->m() > 0 ? s.constrained : s.free);
  put("phi", s.phi), put("phidot", s.phidot), put("sigma", s.sigma), put("lambda_", s.lambda);
  put("T", s.kinetic), put("V", s.potential), put("H", s.hamiltonian);
  if (s.dense)
    put("M", s.mass), put("rank", s.loops.rank), put("dependent_rows", s.loops.dependent),
        put("singular_values", s.loops.singular_values);
  if (!s.not_there.empty()) put("not_there", s.not_there);
  py::dict reactions;
  for (const auto* list : {&s.reactions.joints, &s.reactions.loops})
    for (const Transmitted& r : *list)
      reactions[r.name.c_str()] = py::make_tuple(r.force, r.torque);
  all["reactions"] = reactions;
  return all;
}

py::dict plan(const Bench& b) {
  py::dict lines;
  for (const auto& [name, text] : plan_lines(*b.mechanism)) lines[name.c_str()] = text;
  return lines;
}

}  // namespace

void bind_mechanism(py::module_& module) {
  using namespace py::literals;
  py::class_<Assembly>(module, "Start",
                       "A consistent start: positions and rates that satisfy the loop equations.")
      .def_property_readonly(
          "t", [](const Assembly& a) { return a.start.t; }, "time [s]")
      .def_property_readonly(
          "q", [](const Assembly& a) { return a.start.q; }, "coordinates (nq)")
      .def_property_readonly(
          "u", [](const Assembly& a) { return a.start.u; }, "rates (nv)")
      .def_property_readonly(
          "udot", [](const Assembly& a) { return a.start.udot; }, "accelerations (nv)")
      .def_property_readonly(
          "lambda_", [](const Assembly& a) { return a.start.lambda; }, "force multipliers (m)")
      .def_readonly("rank", &Assembly::rank, "rank of the loop equations")
      .def_readonly("mobility", &Assembly::mobility, "degrees of freedom: nv - rank")
      .def_readonly("free_positions", &Assembly::free_positions,
                    "how many coordinates are free: more than rates under nonholonomic equations")
      .def_readonly("dependent_rows", &Assembly::dependent_rows,
                    "loop equations that follow from the others, as indices of `equations`")
      .def_readonly("moved", &Assembly::moved,
                    "largest change of a coordinate from the guess [rad or m]")
      .def_readonly("residue", &Assembly::residue,
                    "one sentence on what redundant equations leave open, or empty")
      .def_readonly(
          "branch", &Assembly::branch,
          "one sentence on which of several assemblies it is, where the guess does not decide "
          "it, or empty");

  py::class_<Bench, BenchPtr> mechanism(module, "Mechanism",
                                        "A mechanism, made from a scene by load().");
  const auto of = [](auto f) { return [f](const Bench& b) { return f(*b.mechanism); }; };
  mechanism
      .def_property_readonly("name", of([](const Mechanism& m) { return m.scene().name; }),
                             "name of the scene")
      .def_property_readonly("nq", of([](const Mechanism& m) { return m.nq(); }),
                             "number of coordinates")
      .def_property_readonly("nv", of([](const Mechanism& m) { return m.nv(); }),
                             "number of rates, and of momenta")
      .def_property_readonly("m", of([](const Mechanism& m) { return m.m(); }),
                             "number of loop equations")
      .def_property_readonly(
          "coordinates", of([](const Mechanism& m) { return labels_of(m.coordinate_columns()); }),
          "names of q with units")
      .def_property_readonly("rates",
                             of([](const Mechanism& m) { return labels_of(m.rate_columns()); }),
                             "names of u with units")
      .def_property_readonly("equations", of([](const Mechanism& m) {
                               std::vector<std::string> names;
                               for (const RowName& r : m.rows())
                                 names.push_back(r.loop + ": " + r.what);
                               return names;
                             }),
                             "names of the loop equations")
      .def_property_readonly("q0", of([](const Mechanism& m) { return m.tree().q0; }),
                             "coordinates of the scene, the guess of assemble() (nq)")
      .def_property_readonly("u0", of([](const Mechanism& m) { return m.tree().u0; }),
                             "rates of the scene, the guess of assemble() (nv)")
      .def_property_readonly(
          "options",
          [](const Bench& b) {
            py::dict options;
            options["algebra"] = b.algebra, options["kkt"] = b.kkt, options["cut"] = b.cut;
            return options;
          },
          "the arguments algebra, kkt and cut of load()")
      .def_property_readonly(
          "remarks", of([](const Mechanism& m) { return m.scene().remarks; }),
          "what the reader of a URDF, MJCF or SDF left out or changed, one sentence per kind")
      .def("to_toml", of([](const Mechanism& m) { return scene_text(m.scene()); }),
           "The scene as TOML text, from which parse() reads the same scene, bit by bit.")
      .def(py::pickle(
          [](const Bench& b) {
            return py::make_tuple(toml_of(b), b.mechanism->scene().name, b.algebra, b.kkt, b.cut);
          },
          [](const py::tuple& kept) {
            if (kept.size() != 5) throw py::value_error("this is no pickled Mechanism");
            const auto text = kept[0].cast<std::string>();
            auto bench = std::make_shared<Bench>(
                parse_scene(text, kept[1].cast<std::string>()), kept[2].cast<std::string>(),
                kept[3].cast<std::string>(), kept[4].cast<std::string>());
            bench->text = text;
            return bench;
          }))
      .def_property_readonly("plan", &plan, "what an evaluation computes and leaves out, by topic")
      .def("__repr__", of([](const Mechanism& m) {
             return "<momenta.Mechanism '" + m.scene().name + "': " + std::to_string(m.nv()) +
                    " rates, " + std::to_string(m.m()) + " loop equations>";
           }))
      .def(
          "assemble", [](const Bench& b) { return assemble(*b.mechanism); },
          "A Start: closes the loops, beginning at q0 and u0. Raises SceneError where they stay "
          "open.")
      .def("momentum_rates", &momentum_rates, "t"_a, "q"_a, "p"_a, "centre"_a = py::none(),
           "leak"_a = 0.0, "tau"_a = py::none(),
           "(u, sigma, pdot) from (t, q, p): eqs. (7), (8). `centre` (m): the value towards which "
           "sigma fades in weak equations; `leak` [1/s]: kappa; `tau` (nv): joint forces in "
           "addition to those of the scene [N m or N]. O(bodies).")
      .def("accelerations", &accelerations, "t"_a, "q"_a, "u"_a, "tau"_a = py::none(),
           "(udot, lambda_) from (t, q, u): eq. (3). `tau` (nv): joint forces in addition to those "
           "of the scene [N m or N]. O(bodies).")
      .def("momenta", &momenta_of, "t"_a, "q"_a, "u"_a, "sigma"_a = py::none(),
           "p = M u + Phi_q' sigma, plus the part of prescribed motion (nv). O(bodies).")
      .def("constraints", &constraints, "t"_a, "q"_a, "u"_a, "(Phi, Phidot), both (m).")
      .def("kkt", &kkt, "t"_a, "q"_a, "(M, Phi_q), dense: (nv, nv) and (m, nv).")
      .def("inverse_mass_times", &inverse_mass_times, "t"_a, "q"_a, "x"_a,
           "M^-1 x (nv) of the tree, without its loops: O(bodies). Of a Lagrangian without its "
           "constraints, by Cholesky's factors of M: O(nv^3).")
      .def("energies", &energies, "t"_a, "q"_a, "u"_a, "(T, V) [J].")
      .def("evaluate", &evaluate, "t"_a = 0.0, "q"_a = py::none(), "v"_a = py::none(),
           "p"_a = py::none(),
           "All values at one state as a dict: momenta, accelerations, multipliers, energies, "
           "reactions on the child (force [N], torque [N m] about the joint's point, ground axes), "
           "and M of small mechanisms. Arguments left out are those of the start of the scene, "
           "assembled where there are loops.");
  add_batches(mechanism);
  add_runs(mechanism);
  add_move(mechanism);
  add_assemblies(mechanism);
  add_effort(mechanism);
  add_fit(mechanism);
  add_gradient(mechanism);
  add_modes(mechanism);
  add_linearise(mechanism);
}

}  // namespace momenta::python
