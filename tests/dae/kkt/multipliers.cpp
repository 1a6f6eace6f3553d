// Which loop forces are unique: by two centres of the solver, against the null space of Φ_qᵀ from
// singular values; at poses, and along runs, where trajectories, summaries and charts tell.

#include "equations/ensemble.h"
#include "equations/examples.h"
#include "equations/linkages.h"
#include "equations/parts.h"
#include "equations/random_loops.h"
#include "equations/runs.h"
#include "equations/scissor.h"
#include "equations/small_scenes.h"

#include <gtest/gtest.h>
#include <momenta/core/format/toml/parse_scene.h>
#include <momenta/dae/kkt/multipliers.h>
#include <momenta/dae/kkt/solver_choice.h>
#include <momenta/dae/output/chart.h>
#include <momenta/dae/output/json.h>
#include <momenta/dae/run/measure/rank.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/study/extremes.h>

#include <algorithm>
#include <map>
#include <numbers>
#include <random>

namespace momenta::dae_multipliers {
namespace {

using namespace equations;
using equations::example;

/// Slow twin: rows in which a force that moves nothing takes part.
std::vector<bool> unique_by_singular_values(const Mechanism& mechanism, double t,
                                            const Eigen::VectorXd& q) {
  const Eigen::MatrixXd idle = idle_forces(mechanism, t, q);
  std::vector<bool> unique(static_cast<std::size_t>(mechanism.m()), true);
  for (int i = 0; i < mechanism.m(); ++i)
    for (Eigen::Index k = 0; k < idle.cols(); ++k)
      if (std::abs(idle(i, k)) > 1e-6 * idle.col(k).cwiseAbs().maxCoeff())
        unique[static_cast<std::size_t>(i)] = false;
  return unique;
}

std::vector<bool> unique_by_centres(const Mechanism& mechanism, const Start& at) {
  const auto e = mechanism.evaluation<double>();
  const auto solver = make_loop_solver(mechanism, *e);
  UniqueMultipliers unique(mechanism, *e, *solver);
  Eigen::VectorXd udot(mechanism.nv()), lambda(mechanism.m());
  EXPECT_TRUE(solver->acceleration(at.t, at.q.data(), at.u.data(), nullptr, 0, 0, udot.data(),
                                   lambda.data()));
  return unique.find(at.t, at.q.data(), at.u.data(), lambda.data());
}

/// The scene with a pendulum on a loop of its own beside it, whose forces are unique.
Scene beside_a_pendulum(Scene scene) {
  scene.bodies.push_back(rod("bob", 0.1));
  scene.joints.push_back(hinge("P9", "ground", "bob", {7, 0, 0}, 0.3));
  scene.joints.back().kind = JointKind::free;
  scene.joints.back().position = {7, 0, 0, 1, 0, 0, 0};
  scene.loops.push_back(equations::make_loop(LoopKind::point, "own", "ground", "bob", {7, 0, 0}));
  return scene;
}

TEST(UniqueMultipliers, AgreeWithSingularValuesWhateverSolves) {
  const Scene three = example("extremes/three_cranks.toml"), four = example("four_bar/scene.toml");
  Scene twice = four;
  twice.loops.push_back(twice.loops[0]);
  twice.loops.back().name = "again";
  int shared = 0, determined = 0, both = 0;
  for (const Scene& scene :
       {three, four, twice, bricard(), row_of_four_bars(2, 0, 1), beside_a_pendulum(three),
        beside_a_pendulum(bricard()), platform(6), driven_scissor(LoopKind::cylindrical),
        driven_scissor(LoopKind::prismatic)})
    for (const Algebra algebra : {Algebra::automatic, Algebra::spatial})
      for (const KktChoice kkt : {KktChoice::sweeps, KktChoice::sparse, KktChoice::dense}) {
        const Mechanism mechanism(scene, {.algebra = algebra, .kkt = kkt});
        const Start start = equations::start_of(mechanism);
        const auto found = unique_by_centres(mechanism, start);
        EXPECT_EQ(found, unique_by_singular_values(mechanism, start.t, start.q))
            << scene.name << " " << static_cast<int>(algebra) << name_of(mechanism.solver().kkt());
        const auto unique = std::count(found.begin(), found.end(), true);
        shared += unique == 0;
        determined += unique == mechanism.m();
        both += unique > 0 && unique < mechanism.m();
      }
  // A coupler that weighs next to nothing: KLU, which does not know what has faded.
  Scene light = beside_a_pendulum(three);
  light.bodies[1].mass *= 1e-12;
  light.bodies[1].inertia *= 1e-12;
  const Mechanism by_klu(light);
  ASSERT_FALSE(by_klu.solver().filters_pivots());
  const Start start = equations::start_of(by_klu);
  EXPECT_EQ(unique_by_centres(by_klu, start), unique_by_singular_values(by_klu, start.t, start.q));
  EXPECT_GE(shared, 10);
  EXPECT_GE(determined, 9);
  EXPECT_GE(both, 10);
}

const Units other_units[] = {{1e-6, 1, 1},    {1e6, 1, 1},       {1, 1e-3, 1},    {1, 1, 1e6},
                             {1e-6, 1e3, 10}, {1e6, 1e-2, 1e-4}, {1e-4, 1e2, 1e3}};

TEST(UniqueMultipliers, AreTheSameInAllUnits) {
  const Scene slide = parse_scene(R"(
gravity = [0, 0, -9.81]
[[body]]
name = "block"
mass = 0.1
inertia = [0.02246, 0.02987, 0.02565, 0.0006046, -0.004856, 0.001354]
com = [0.1, 0.2, 0]
[[joint]]
name = "J"
kind = "universal"
child = "block"
origin = { parent = [0.081, -0.441, -1.116], child = [-0.215, 0.082, -0.257] }
axis = "-y"
axis2 = [-2.274, 1.152, 1.029]
[[loop]]
name = "L"
kind = "prismatic"
child = "block"
axis = [0.5849619959566039, -0.6831211477240658, -0.43722415397438996]
origin = { parent = [0.6290501844800691, -0.2845576447349991, -0.9217900208134625], child = [0.035, 0.21, 0.201] }
rotation = { quaternion = [0.889195926530068, 0.045035369072962315, 0.4512919510510779, -0.060315791392531654] }
)");
  int shared = 0, compared = 0;
  for (const Scene& scene :
       {slide, example("extremes/three_cranks.toml"), example("four_bar/scene.toml"), bricard(),
        driven_scissor(LoopKind::prismatic)}) {
    const Mechanism as_written(scene, {.algebra = Algebra::spatial});
    const auto expected = unique_by_centres(as_written, equations::start_of(as_written));
    shared += std::count(expected.begin(), expected.end(), false) > 0;
    for (const Units& units : other_units) {
      const Mechanism mechanism(in_units(scene, units), {.algebra = Algebra::spatial});
      EXPECT_EQ(unique_by_centres(mechanism, equations::start_of(mechanism)), expected)
          << scene.name << " " << units.length << " " << units.time << " " << units.mass;
      ++compared;
    }
  }
  EXPECT_EQ(shared, 5);
  EXPECT_EQ(compared, 35);
}

/// What drives a mechanism without freedoms is known from virtual work: λ ẋ + dE/dt = 0.
TEST(UniqueMultipliers, OfADrivenScissorIsTheThrust) {
  const Mechanism mechanism(driven_scissor(LoopKind::cylindrical), {.algebra = Algebra::spatial});
  const RunResult run =
      run_form(mechanism, equations::start_of(mechanism),
               equations::kept(equations::adaptive("projected", "vern9", "none", 1e-11, 0.2, 400)));
  ASSERT_EQ(run.status, "done") << run.reason;
  for (const auto& u : run.undetermined)
    EXPECT_EQ(u.samples, static_cast<long>(run.series.t.size())) << u.column;
  EXPECT_EQ(run.undetermined.size(), 10u);
  const auto told = [&](const std::string& column) {
    return std::any_of(run.undetermined.begin(), run.undetermined.end(),
                       [&](const auto& u) { return u.column == column; });
  };
  const auto& columns = run.trajectory.columns;
  const auto place = [&](const std::string& column) {
    const auto at = std::find(columns.begin(), columns.end(), column);
    EXPECT_NE(at, columns.end()) << column;
    return static_cast<std::size_t>(at - columns.begin());
  };
  std::size_t thrust = 0;
  for (const char* column : {"actuator.lambda1 [N]", "actuator.lambda2 [N]", "actuator.lambda3 [N]",
                             "actuator.lambda4 [N]", "actuator.lambda5 [N]"})
    if (std::find(columns.begin(), columns.end(), column) != columns.end() && !told(column))
      thrust = place(column);
  ASSERT_GT(thrust, 0u);
  // Energies of the samples: kinetic and potential, from the mechanism at each state.
  const auto e = mechanism.evaluation<double>();
  const auto energy = [&](std::size_t row) {
    const auto& x = run.trajectory.rows[row];
    e->place(x[0], x.data() + 1);
    e->move(x.data() + 1 + mechanism.nq());
    return e->kinetic() + e->potential(x.data() + 1);
  };
  const double h = run.trajectory.rows[1][0];
  const std::size_t slide = place("F.u [m/s]");
  for (std::size_t i = 2; i + 2 < run.trajectory.rows.size(); i += 20) {
    const double power =
        (8 * (energy(i + 1) - energy(i - 1)) - (energy(i + 2) - energy(i - 2))) / (12 * h);
    const auto& x = run.trajectory.rows[i];
    EXPECT_NEAR(x[thrust] * x[slide], -power, 1e-6 * (1 + std::abs(power))) << x[0];
  }
}

TEST(UniqueMultipliers, AgreeOnRandomLoopsWrittenTwice) {
  std::mt19937 random(3);
  int compared = 0, mixed = 0;
  for (int round = 0; round < 320; ++round) {
    std::vector<unsigned char> bytes(200);
    for (auto& b : bytes) b = static_cast<unsigned char>(random());
    Scene scene = sound_scene(bytes, round % 2 == 0);
    if (round % 3 > 0) {
      scene.loops.push_back(scene.loops.back());
      scene.loops.back().name += "again";
      if (round % 3 > 1) scene.loops.back().kind = LoopKind::point;
    }
    try {
      const Mechanism mechanism(scene);
      const Start start = equations::start_of(mechanism);
      // Poses at which the rank is a matter of taste are no law's business.
      const RankReport rank = rank_report(mechanism, start);
      if (rank.kept < 1e-2 || rank.dropped > 1e-12) continue;
      const auto found = unique_by_centres(mechanism, start);
      EXPECT_EQ(found, unique_by_singular_values(mechanism, start.t, start.q)) << round << "\n"
                                                                               << outline(scene);
      ++compared;
      const auto unique = std::count(found.begin(), found.end(), true);
      mixed += unique > 0 && unique < mechanism.m();
    } catch (const SceneError&) {
    }
  }
  EXPECT_GT(compared, 60);
  EXPECT_GT(mixed, 5);
}

RunResult run_of(const Mechanism& mechanism, const std::string& form, double end, int samples) {
  return run_form(mechanism, equations::start_of(mechanism),
                  equations::kept(equations::adaptive(form, "", "leak", 1e-8, end, samples)));
}

/// What the trajectory says of every sample against its pose; whether some are not unique.
bool expect_told(const Mechanism& mechanism, const RunResult& run) {
  EXPECT_EQ(run.status, "done") << run.reason;
  const auto& columns = run.trajectory.columns;
  std::map<std::string, long> samples;
  EXPECT_EQ(run.trajectory.rows.size(), static_cast<std::size_t>(run.settings.samples + 1));
  for (const auto& row : run.trajectory.rows) {
    const Eigen::VectorXd q = Eigen::Map<const Eigen::VectorXd>(row.data() + 1, mechanism.nq());
    const auto unique = unique_by_singular_values(mechanism, row[0], q);
    std::map<std::string, int> of_loop;
    for (std::size_t i = 0; i < unique.size(); ++i) of_loop[mechanism.rows()[i].loop] += !unique[i];
    std::size_t i = 0;
    for (std::size_t c = 0; c < columns.size(); ++c) {
      if (columns[c].find(".lambda") != std::string::npos && !unique[i++]) ++samples[columns[c]];
      for (const auto& [loop, count] : of_loop)
        if (columns[c] == loop + ".undetermined [1]") {
          EXPECT_EQ(row[c], count) << loop << " at t = " << row[0];
        }
    }
    EXPECT_EQ(i, unique.size());
  }
  EXPECT_EQ(run.undetermined.size(), samples.size());
  for (const auto& u : run.undetermined) EXPECT_EQ(u.samples, samples[u.column]) << u.column;
  return !samples.empty();
}

TEST(UniqueMultipliers, AreToldAlongARun) {
  const Mechanism plain(example("four_bar/scene.toml")),
      hinges(example("four_bar/scene.toml"), {.algebra = Algebra::spatial}),
      cranks(example("extremes/three_cranks.toml")), six_hinges(bricard());
  for (const char* form : {"momentum", "projected", "momentum-index2", "augmented-lagrangian"}) {
    EXPECT_FALSE(expect_told(plain, run_of(plain, form, 1, 20))) << form;
    EXPECT_TRUE(expect_told(hinges, run_of(hinges, form, 1, 20))) << form;
    EXPECT_TRUE(expect_told(cranks, run_of(cranks, form, 1, 20))) << form;
    EXPECT_TRUE(expect_told(six_hinges, run_of(six_hinges, form, 1, 20))) << form;
  }
  // In the plane of a four-bar the forces are unique, hinges or not; across it they are not.
  const RunResult run = run_of(hinges, "momentum", 1, 20);
  std::vector<std::string> told;
  for (const auto& u : run.undetermined) told.push_back(u.column);
  EXPECT_EQ(told,
            (std::vector<std::string>{"B.lambda3 [N]", "B.lambda4 [N m]", "B.lambda5 [N m]"}));
  for (const auto& u : run.undetermined) {
    EXPECT_EQ(u.samples, 21);
    EXPECT_EQ(u.from, 0);
    EXPECT_EQ(u.to, 1);
  }
  // A chart and the summary say it too.
  std::vector<std::string> curves;
  for (const Chart& chart : charts_of_run(run))
    if (chart.key == "forces")
      for (const Curve& curve : chart.curves) curves.push_back(curve.name);
  EXPECT_EQ(curves, (std::vector<std::string>{"B.lambda1", "B.lambda2", "B.lambda3 (not unique)"}));
  const auto json = summary_json(run, {}).at("undetermined");
  ASSERT_EQ(json.size(), 3u);
  EXPECT_EQ(json[0]["column"], "B.lambda3 [N]");
  EXPECT_EQ(json[0]["samples"], 21);
}

/// Two drives hold a square that one would hold: neither effort is unique, however small it is.
TEST(UniqueMultipliers, EffortsOfDrivesAreToldInAllUnits) {
  constexpr double upright = std::numbers::pi / 2;
  Scene square;
  square.gravity = {0, -9.81, 0};
  square.bodies = {rod("crank", 0.1), rod("coupler", 0.1), rod("rocker", 0.1)};
  square.joints = {hinge("O", "ground", "crank", {0, 0, 0}, upright),
                   hinge("A", "crank", "coupler", {1, 0, 0}, -upright),
                   hinge("C", "ground", "rocker", {1, 0, 0}, upright)};
  square.loops = {
      equations::make_loop(LoopKind::revolute, "B", "coupler", "rocker", {1, 0, 0}, {1, 0, 0})};
  for (const char* joint : {"O", "C"}) {
    DriveSpec drive;
    drive.joint = joint;
    drive.kind = "polynomial";
    drive.coefficients = {upright};
    square.drives.push_back(drive);
  }
  for (const double length : {1.0, 1e-8, 1e8}) {
    const Mechanism mechanism(in_units(square, {.length = length}));
    const RunResult run = run_of(mechanism, "momentum", 0.1, 1);
    ASSERT_EQ(run.status, "done") << run.reason;
    int told = 0;
    for (const auto& u : run.undetermined) told += u.column.find(".effort") != std::string::npos;
    EXPECT_EQ(told, 2) << length;
  }
}

TEST(UniqueMultipliers, OfAPoseOnTheWayAreToldThere) {
  // Flat at the start and nowhere after: the sum of both rods' pushes along the row is anybody's.
  const Mechanism mechanism(row_of_four_bars(1, 0, 1));
  const RunResult run = run_of(mechanism, "momentum", 0.5, 5);
  EXPECT_TRUE(expect_told(mechanism, run));
  for (const auto& u : run.undetermined) {
    EXPECT_EQ(u.samples, 1);
    EXPECT_EQ(u.to, 0);
  }
}

}  // namespace
}  // namespace momenta::dae_multipliers
