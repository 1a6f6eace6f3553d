#include <momenta/dae/output/fit_picture.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/study/fit/swept_poses.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace momenta {
namespace {

using Eigen::VectorXd;

/// Copies a scene's parts with a word in front of their names.
class Renamed {
 public:
  explicit Renamed(std::string with) : with_(std::move(with)) {}

  void add(const Scene& from, Scene& to) const {
    for (BodySpec body : from.bodies) {
      body.name = of(body.name);
      to.bodies.push_back(std::move(body));
    }
    for (JointSpec joint : from.joints) {
      for (std::string* name : {&joint.name, &joint.parent, &joint.child}) *name = of(*name);
      to.joints.push_back(std::move(joint));
    }
    for (LoopSpec loop : from.loops) {
      for (std::string* name : {&loop.name, &loop.parent, &loop.child}) *name = of(*name);
      for (std::string& joint : loop.joints) joint = of(joint);
      to.loops.push_back(std::move(loop));
    }
    for (DriveSpec drive : from.drives) {
      drive.joint = of(drive.joint);
      drive.loop = of(drive.loop);
      to.drives.push_back(std::move(drive));
    }
    for (MarkerSpec marker : from.markers) {
      marker.name = of(marker.name);
      marker.body = of(marker.body);
      to.markers.push_back(std::move(marker));
    }
    for (VisualSpec visual : from.visuals) {
      if (visual.body == "ground") continue;  // already there
      visual.body = of(visual.body);
      to.visuals.push_back(std::move(visual));
    }
    for (const std::string& held : from.held) to.held.push_back(of(held));
  }

 private:
  std::string of(const std::string& name) const {
    return name.empty() || name == "ground" ? name : with_ + name;
  }
  std::string with_;
};

/// Balls in the ground at wanted places of markers; other components are those reached.
void add_wanted(const ParametricMechanism& family, const FitResult& r, Scene& scene) {
  std::map<int, std::array<Eigen::Index, 3>> markers;  // columns of their components
  for (std::size_t k = 0; k < r.wanted.quantities.size(); ++k) {
    const auto& quantity = r.wanted.quantities[k];
    if (quantity.marker < 0) continue;
    auto& columns =
        markers.try_emplace(quantity.marker, std::array<Eigen::Index, 3>{-1, -1, -1}).first->second;
    columns[static_cast<std::size_t>(quantity.component)] = static_cast<Eigen::Index>(k);
  }
  if (markers.empty()) return;
  const auto mechanism = family.at(r.found);
  SweptPoses poses(*mechanism, r.swept.name);
  std::vector<VectorXd> q;
  if (!poses.reach(r.places, q)) return;
  const auto e = mechanism->evaluation<double>();
  std::vector<Eigen::Vector3d> places;
  Eigen::AlignedBox3d box;
  for (const auto& [marker, columns] : markers) {
    std::vector<WantedPoses::Quantity> position;
    for (int c = 0; c < 3; ++c) position.push_back({"", "m", -1, marker, c});
    for (Eigen::Index i = 0; i < r.wanted.poses(); ++i) {
      Eigen::Vector3d at = quantities_at(*e, q[static_cast<std::size_t>(i)], position,
                                         static_cast<int>(scene.markers.size()));
      bool asked = false;
      for (std::size_t c = 0; c < 3; ++c)
        if (columns[c] >= 0 && !std::isnan(r.wanted.values(i, columns[c]))) {
          at[static_cast<Eigen::Index>(c)] = r.wanted.values(i, columns[c]);
          asked = true;
        }
      if (!asked) continue;
      box.extend(at);
      places.push_back(at);
    }
  }
  const double extent = box.isEmpty() ? 0 : box.diagonal().norm();
  for (const Eigen::Vector3d& place : places) {
    VisualSpec ball;
    ball.body = "ground";
    ball.kind = "sphere";
    ball.size = {extent > 0 ? extent / 80 : 0.01, 0, 0};
    ball.position = place;
    ball.colour = Eigen::Vector3d(0.85, 0.35, 0.1);
    scene.visuals.push_back(ball);
  }
}

/// Places that both reach, and their poses; `q_before` is empty without any.
void common_places(SweptPoses& after, SweptPoses* before, int frames, std::vector<double>& places,
                   std::vector<VectorXd>& q, std::vector<VectorXd>& q_before) {
  const double by = after.is_angle() ? 2 * std::numbers::pi / frames : 0.02 * after.unit();
  after.sample(by, frames, places, q);
  if (!before) return;
  // `before` may start elsewhere: twice as far to each side.
  std::vector<double> reached;
  std::vector<VectorXd> ignored;
  before->sample(by, 2 * frames, reached, ignored);
  const auto in = [&](double s) { return s >= reached.front() && s <= reached.back(); };
  std::vector<double> common;
  std::vector<VectorXd> poses;
  for (std::size_t i = 0; i < places.size(); ++i)
    if (in(places[i])) common.push_back(places[i]), poses.push_back(q[i]);
  if (common.size() < 2 || !before->reach(common, q_before)) {
    q_before.clear();
    return;
  }
  places = std::move(common);
  q = std::move(poses);
}

/// Both mechanisms in one picture, the fitted one alone where `q_before` is empty. Frames from
/// `first` on, `every` apart.
FitPicture overlaid(Scene scene, const Mechanism& after, const std::vector<VectorXd>& q,
                    const Mechanism* before, const std::vector<VectorXd>& q_before, double first,
                    double every) {
  scene.forces.clear();
  if (!q_before.empty()) Renamed(before_mark).add(before->scene(), scene);
  FitPicture picture;
  picture.mechanism = std::make_unique<Mechanism>(std::move(scene), MechanismOptions{});
  std::map<std::string, std::size_t> place;
  const std::vector<Column> columns = picture.mechanism->coordinate_columns();
  for (std::size_t i = 0; i < columns.size(); ++i) place[columns[i].name] = i;
  const auto put = [&](const Mechanism& from, const std::string& with, const VectorXd& pose,
                       std::vector<double>& frame) {
    const std::vector<Column> own = from.coordinate_columns();
    for (std::size_t i = 0; i < own.size(); ++i)
      frame[place.at(with + own[i].name)] = pose[static_cast<Eigen::Index>(i)];
  };
  picture.first = first;
  picture.film.every = every;
  for (std::size_t i = 0; i < q.size(); ++i) {
    picture.film.frames.emplace_back(columns.size());
    put(after, "", q[i], picture.film.frames.back());
    if (!q_before.empty()) put(*before, before_mark, q_before[i], picture.film.frames.back());
  }
  return picture;
}

/// Whether parts keep their meaning under other names.
bool can_be_renamed(const Scene& scene) {
  return !scene.lagrangian && std::none_of(scene.loops.begin(), scene.loops.end(),
                                           [](const LoopSpec& loop) { return has_equation(loop); });
}

/// Poses at equal times; none where the run fails.
std::unique_ptr<Mechanism> run_of(Scene scene, const RunSettings& settings, int frames,
                                  std::vector<VectorXd>& q) {
  auto mechanism = std::make_unique<Mechanism>(std::move(scene), MechanismOptions{});
  RunRequest request;
  request.settings = settings;
  request.settings.samples = 1;
  request.film_intervals = frames;
  const RunResult run = run_form(*mechanism, assemble(*mechanism).start, request);
  for (const std::vector<double>& frame : run.film.frames)
    q.emplace_back(Eigen::Map<const VectorXd>(frame.data(), mechanism->nq()));
  if (static_cast<int>(q.size()) <= frames) q.clear();
  return mechanism;
}

}  // namespace

FitPicture fit_picture(const ParametricMechanism& family, const FitResult& r, int frames) {
  const auto after = family.at(r.found);
  std::unique_ptr<Mechanism> before;
  std::unique_ptr<SweptPoses> of_before;
  if (can_be_renamed(after->scene())) try {
      before = family.at(r.own);
      of_before = std::make_unique<SweptPoses>(*before, r.swept.name);
    } catch (const SceneError&) {  // the fitted one alone
    }
  SweptPoses of_after(*after, r.swept.name);
  std::vector<double> places;
  std::vector<VectorXd> q, q_before;
  common_places(of_after, of_before.get(), frames, places, q, q_before);

  Scene both = after->scene();
  add_wanted(family, r, both);
  const double every =
      places.size() > 1 ? (places.back() - places.front()) / static_cast<double>(places.size() - 1)
                        : 0;
  return overlaid(std::move(both), *after, q, before.get(), q_before, places.front(), every);
}

FitPicture identification_picture(const ParametricMechanism& family, const Identification& r,
                                  int frames) {
  std::vector<VectorXd> q, q_before;
  const auto after = run_of(family.scene(r.found), r.settings, frames, q);
  std::unique_ptr<Mechanism> before;
  if (r.why_not_before.empty() && can_be_renamed(after->scene()))
    before = run_of(family.scene(r.own), r.settings, frames, q_before);
  return overlaid(after->scene(), *after, q, before.get(), q_before, 0,
                  r.settings.end_time / frames);
}

}  // namespace momenta
