// Poses along a swept coordinate, and assemblies.

#include <momenta/dae/analysis/kinematics/assemblies.h>
#include <momenta/dae/analysis/kinematics/move.h>
#include <momenta/dae/analysis/linear/linearisation.h>
#include <momenta/dae/study/environment.h>

#include <limits>
#include <optional>
#include <variant>

#include "bindings.h"

namespace momenta::python {

namespace {

py::dict move(const Bench& b, const std::variant<std::string, py::dict>& sweep,
              std::optional<double> to, double by, const std::vector<std::string>& hold,
              const std::string& output) {
  MoveRequest request;
  if (const auto* name = std::get_if<std::string>(&sweep)) {
    request.sweep = {{*name, 1}};
  } else {
    for (const auto& [key, amount] : std::get<py::dict>(sweep))
      request.sweep.emplace_back(py::cast<std::string>(key), py::cast<double>(amount));
  }
  if (!(by >= 0)) throw py::value_error("by is " + std::to_string(by) + ", expected 0 or more");
  request.to = to;
  request.by = by;
  request.hold = hold;
  request.output = output;
  MoveResult r;
  {
    const py::gil_scoped_release others_go_on;
    const Mechanism held(held_at_start(b.mechanism->scene()), b.mechanism->options());
    const Assembly a = assemble(held, Assembled::rates);
    r = momenta::move(held, a.start.t, a.start.q, request);
  }
  const auto poses = static_cast<Eigen::Index>(r.poses.size());
  const double none = std::numeric_limits<double>::quiet_NaN();
  Rows q(poses, b.mechanism->nq()), u(poses, b.mechanism->nv()), udot(poses, b.mechanism->nv());
  Vector displacement(poses), angle(poses), joint_force(poses);
  std::vector<int> branch, dead, change;
  for (Eigen::Index i = 0; i < poses; ++i) {
    const MovedPose& pose = r.poses[static_cast<std::size_t>(i)];
    q.row(i) = pose.q;
    displacement[i] = pose.s;
    angle[i] = pose.transmission_angle;
    joint_force[i] = pose.joint_force;
    branch.push_back(pose.branch);
    if (pose.u.size() > 0) {
      u.row(i) = pose.u;
      udot.row(i) = pose.udot;
    } else {
      u.row(i).setConstant(none);
      udot.row(i).setConstant(none);
    }
    if (pose.kind == MovedPose::Kind::dead_point) dead.push_back(static_cast<int>(i));
    if (pose.kind == MovedPose::Kind::change_point) change.push_back(static_cast<int>(i));
  }
  py::dict reach;
  for (std::size_t i = 0; i < r.coordinates.size(); ++i)
    reach[py::str(r.coordinates[i].name)] = py::make_tuple(r.reach[i].least, r.reach[i].most);
  py::dict all;
  all["end"] = name_of(r.end);
  all["why"] = r.why;
  all["displacement"] = std::move(displacement);
  all["q"] = std::move(q);
  all["ratios"] = std::move(u);
  all["ratio_rates"] = std::move(udot);
  all["branch"] = branch;
  all["dead_points"] = dead;
  all["change_points"] = change;
  all["reach"] = reach;
  if (!output.empty()) {
    all["transmission_angle"] = std::move(angle);
    all["joint_force"] = std::move(joint_force);
  }
  return all;
}

py::dict assemblies(const Bench& b, const std::vector<std::string>& hold, const std::string& by,
                    int starts, std::uint64_t seed, int threads) {
  if (by != "search" && by != "homotopy")
    throw py::value_error("by is '" + by + "', expected 'search' or 'homotopy'");
  if (starts < 1)
    throw py::value_error("starts is " + std::to_string(starts) + ", expected 1 or more");
  if (threads < 0)
    throw py::value_error("threads is " + std::to_string(threads) + ", expected 0 or more");
  AssembliesRequest request;
  request.hold = hold;
  request.by_homotopy = by == "homotopy";
  request.starts = starts;
  request.seed = seed;
  request.threads = threads_of(threads);
  Assemblies found;
  {
    const py::gil_scoped_release others_go_on;
    const Mechanism held(held_at_start(b.mechanism->scene()), b.mechanism->options());
    const Assembly a = assemble(held, Assembled::rates);
    found = find_assemblies(held, a.start.t, a.start.q, request);
  }
  const auto count = static_cast<Eigen::Index>(found.all.size());
  Rows q(count, b.mechanism->nq());
  Vector apart(count), least(count), most(count);
  std::vector<int> met;
  for (Eigen::Index i = 0; i < count; ++i) {
    const FoundAssembly& one = found.all[static_cast<std::size_t>(i)];
    q.row(i) = one.q;
    apart[i] = one.apart;
    least[i] = one.least_value;
    most[i] = one.most_value;
    met.push_back(one.met);
  }
  py::dict all;
  all["q"] = std::move(q);
  all["apart"] = std::move(apart);
  all["met"] = met;
  all["least_singular_value"] = std::move(least);
  all["largest_singular_value"] = std::move(most);
  if (found.paths) {
    py::dict paths;
    paths["followed"] = found.paths->paths;
    paths["finite"] = found.paths->finite;
    paths["infinite"] = found.paths->infinite;
    paths["singular"] = found.paths->singular;
    paths["lost"] = found.paths->lost;
    paths["real"] = found.paths->real;
    paths["complete"] = found.paths->is_complete();
    all["paths"] = std::move(paths);
  } else {
    all["starts"] = found.starts;
    all["closed"] = found.closed;
    all["turned"] = found.turned;
    all["met_once"] = found.met_once();
  }
  return all;
}

}  // namespace

void add_assemblies(py::class_<Bench, BenchPtr>& mechanism) {
  using namespace py::literals;
  mechanism.def(
      "assemblies", &assemblies, "hold"_a = std::vector<std::string>(), "by"_a = "search",
      "starts"_a = 1000, "seed"_a = std::uint64_t{1}, "threads"_a = 0,
      "Poses that close the loops while the coordinates of `hold` stay, as a dict: q (assemblies, "
      "nq), the scene's own first, apart [rad or lengths of the scene] from it, "
      "least_singular_value and largest_singular_value (assemblies) of the loop equations in the "
      "free coordinates, met. By search from `starts` random starts, which proves no completeness: "
      "starts, closed, turned, met_once. By homotopy, all solutions of polynomials: paths, a dict "
      "of followed, finite (solutions over the complex numbers), infinite, singular, lost, real "
      "and complete. `threads`: 0, one for each processor. Raises SceneError where more than what "
      "is held is free, or where the loops are no polynomials.");
}

void add_move(py::class_<Bench, BenchPtr>& mechanism) {
  using namespace py::literals;
  mechanism.def(
      "move", &move, "sweep"_a, "to"_a = py::none(), "by"_a = 0.0,
      "hold"_a = std::vector<std::string>(), "output"_a = "",
      "Poses as a coordinate is swept from the start, loops closed, as a dict: displacement "
      "(poses) of it "
      "[rad or m], q (poses, nq), ratios and ratio_rates (poses, nv), first and second "
      "derivatives by it, not a number at dead and change points, branch (poses); places of "
      "dead_points and change_points among the poses; reach, least and most of each coordinate; "
      "end: closed, reached or stopped, then why. `sweep`: its name, or names with amounts in "
      "proportion; `to`: where it ends (None: back at the start); `by`: from pose to pose (0: a "
      "degree or a hundredth of the scene's length); `hold`: coordinates that stay; `output`: a "
      "coordinate whose "
      "transmission_angle [rad] and joint_force, the largest for a unit effort on it, are told. "
      "Raises "
      "SceneError where more than one freedom is left.");
}

}  // namespace momenta::python
