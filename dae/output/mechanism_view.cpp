#include <momenta/core/text/number_text.h>
#include <momenta/dae/output/mechanism_view.h>
#include <momenta/dae/output/picture_data.h>
#include <momenta/dae/run/motion.h>
#include <momenta/dae/topology/assembly/drive_reach.h>

#include <algorithm>
#include <stdexcept>

namespace momenta {
namespace {

std::string counted(std::size_t n, const std::string& one, const std::string& more) {
  return std::to_string(n) + " " + (n == 1 ? one : more);
}

/// Motion by drives with the least motion of free coordinates; the start alone without drives.
Film driven_film(const Mechanism& mechanism, const Assembly& assembly) {
  constexpr int frames = 400;
  Eigen::VectorXd q = assembly.start.q;
  Film film{assembly.start.t, 0, {std::vector<double>(q.begin(), q.end())}};
  if (mechanism.scene().drives.empty()) return film;
  const double end = mechanism.scene().run.end_time;
  film.every = (end - film.start) / frames;
  for (int i = 1; i <= frames; ++i) {
    const double from = film.start + (i - 1) * film.every, to = film.start + i * film.every;
    const DriveReach reach = drive_reach(mechanism, from, q, to, Followed::all);
    if (!reach.obstacle.empty() || !reach.q.allFinite()) break;
    q = reach.q;
    film.frames.emplace_back(q.begin(), q.end());
  }
  return film;
}

}  // namespace

std::string still_words(const Mechanism& mechanism, const Assembly& a) {
  const Scene& scene = mechanism.scene();
  if (scene.lagrangian)
    return counted(static_cast<std::size_t>(mechanism.nv()), "coordinate", "coordinates") + ", " +
           counted(static_cast<std::size_t>(mechanism.m()), "constraint", "constraints") +
           ", without bodies." +
           (mechanism.m() > 0 ? " Assembly moved the coordinates by up to " + compact(a.moved, 2) +
                                    " against the guess."
                              : "");
  const auto couplers = static_cast<std::size_t>(
      std::count_if(scene.loops.begin(), scene.loops.end(),
                    [](const LoopSpec& l) { return l.kind == LoopKind::coupler; }));
  std::string words =
      counted(scene.bodies.size(), "body", "bodies") + ", " +
      counted(scene.joints.size(), "joint", "joints") + ", " +
      counted(scene.loops.size() - couplers, "loop", "loops") +
      (couplers > 0 ? ", " + counted(couplers, "coupler", "couplers") : "") + "; " +
      counted(static_cast<std::size_t>(mechanism.nv()), "rate", "rates") + ", " +
      counted(static_cast<std::size_t>(mechanism.m()), "loop equation", "loop equations") +
      (mechanism.plan().planar ? ", in a plane." : ", in space.");
  if (mechanism.m() > 0)
    words += " Assembly moved the joints by up to " + compact(a.moved, 2) +
             " against the guess (rad or m).";
  if (!a.branch.empty()) words += " This is " + a.branch + ".";
  if (!scene.drives.empty())
    words +=
        " It moves as its drives say, up to the end of its run; what they leave free moves as "
        "little as it can.";
  return words;
}

void expect_drawable(const Mechanism& mechanism) {
  if (mechanism.scene().lagrangian)
    throw std::invalid_argument(
        "view: a system of formulas has no bodies to draw, expected momenta run, whose page has "
        "its coordinates over time");
  const std::size_t bodies = mechanism.scene().bodies.size();
  if (bodies > most_bodies_drawn)
    throw std::invalid_argument("view: found " + std::to_string(bodies) +
                                " bodies, expected at most " + std::to_string(most_bodies_drawn));
}

std::vector<std::string> show(StudyResult& study, const Mechanism& mechanism,
                              const Assembly& assembly, std::size_t mesh_bytes) {
  study.picture.without_bodies = mechanism.scene().lagrangian.has_value();
  if (study.picture.without_bodies || mechanism.scene().bodies.size() > most_bodies_drawn)
    return {};
  study.picture = picture_of(mechanism);
  std::vector<std::string> left_out =
      take_meshes(study.picture, mechanism.scene().file, mesh_bytes);
  for (std::size_t i = 0; i < study.runs.size(); ++i) {
    if (study.runs[i].film.frames.empty()) continue;
    Motion motion = motion_of(mechanism, study.runs[i].film);
    motion.run = static_cast<int>(i);
    thin(motion, study.picture);
    study.motions.push_back(std::move(motion));
  }
  if (!study.motions.empty()) return left_out;
  study.motions.push_back(motion_of(mechanism, driven_film(mechanism, assembly)));
  thin(study.motions.back(), study.picture);
  return left_out;
}

}  // namespace momenta
