// Models by others against values of an independent reader and evaluator in 80-bit numbers: mass
// matrix, bias, accelerations, energies, springs, armatures, and accelerations with loops closed,
// redundant ones too. examples/models/README.md tells what the values are and where the models come
// from; MOMENTA_MODELS names a folder with more of them, and then a table is printed.
#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/dae/mechanism/joint_places.h>
#include <momenta/dae/run/state_values.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "equations/tolerance.h"

namespace momenta::dae_models {
namespace {

namespace fs = std::filesystem;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using nlohmann::json;

/// The values of a folder's models, by file name.
json references(const fs::path& folder) {
  return json::parse(std::ifstream(folder / "reference.json")).at("models");
}

struct Model {
  fs::path file;
  json reference;
};

/// The models of the folders below `folder`: files whose names, in quotes, the folder's values
/// hold. Each test is a process that names all tests: the values are read by those that need them.
std::vector<fs::path> models_below(const fs::path& folder) {
  std::vector<fs::path> all;
  for (const auto& entry : fs::directory_iterator(folder)) {
    std::ifstream values(entry.path() / "reference.json");
    if (!values) continue;
    const std::string text{std::istreambuf_iterator<char>(values), {}};
    for (const auto& file : fs::directory_iterator(entry))
      if (text.find('"' + file.path().filename().string() + "\":") != std::string::npos)
        all.push_back(file.path());
  }
  std::sort(all.begin(), all.end());
  return all;
}

const std::vector<fs::path>& models() {
  static const std::vector<fs::path> all = [] {
    std::vector<fs::path> found =
        models_below(fs::path(MOMENTA_SOURCE_DIR) / "examples" / "models");
    if (const char* more = std::getenv("MOMENTA_MODELS"))
      for (fs::path& file : models_below(more)) found.push_back(std::move(file));
    return found;
  }();
  return all;
}

VectorXd vector(const json& j) {
  const auto values = j.get<std::vector<double>>();
  return VectorXd::Map(values.data(), static_cast<Eigen::Index>(values.size()));
}

/// Largest difference by the largest value, which is at least `scale`.
double deviation(const MatrixXd& found, const MatrixXd& expected, double scale = 0) {
  EXPECT_EQ(found.size(), expected.size());
  if (found.size() != expected.size() || found.size() == 0)
    return found.size() == expected.size() ? 0 : 1;
  scale = std::max(scale, expected.cwiseAbs().maxCoeff());
  return (found - expected).cwiseAbs().maxCoeff() / (scale > 0 ? scale : 1);
}

/// Takes the rotors out of a scene. @return their inertias by joint
std::map<std::string, double> take_rotors(Scene& scene) {
  std::map<std::string, double> armatures;
  for (JointSpec& joint : scene.joints) {
    if (has_rotor(joint)) armatures[joint.name] = joint.rotor_inertia.at(0);
    joint.rotor_inertia.clear();
  }
  return armatures;
}

/// The scene, with joints in the order of the reference.
class Pair {
 public:
  explicit Pair(const Model& model) : reference_(model.reference) {
    ReadOptions options;
    options.free_root = reference_.value("base", "").starts_with("floating");
    scene_ = read_scene(model.file, options);
    with_rotors_ = scene_;
    armatures_ = take_rotors(scene_);
    // the reference leaves out what geoms weigh
    for (const json& b : reference_.at("bodies"))
      if (b.at("mass") == 0.0 && b.at("inertia_com")[0][0] == 0.0)
        for (BodySpec& body : scene_.bodies)
          if (body.name == b.at("name")) {
            body.mass = 0;
            body.inertia.setZero();
          }
    name_joints();
  }

  const Scene& scene() const { return scene_; }
  const Scene& with_rotors() const { return with_rotors_; }
  Scene without_loops() const {
    Scene tree = scene_;
    tree.loops.clear();
    return tree;
  }
  static Scene without_springs(Scene scene) {
    for (JointSpec& joint : scene.joints)
      joint.stiffness = joint.rest = joint.damping = joint.friction = 0;
    std::erase_if(scene.forces, [](const ForceSpec& f) { return f.kind != "torque"; });
    return scene;
  }
  const std::map<std::string, double>& armatures() const { return armatures_; }
  const json& joints() const { return reference_.at("joints"); }
  const std::vector<std::string>& names() const { return names_; }

  /// Where the numbers of the reference stand in q and u of a mechanism, and what turns its rates
  /// into those of a scene: u = T v, T orthogonal; free joints have their velocity in body axes.
  struct Map {
    GivenState given;
    MatrixXd T;
    VectorXd Tdot_v;
  };
  Map state(const Mechanism& mechanism, const json& s) const {
    const VectorXd q = vector(s.at("q")), v = vector(s.at("v")), tau = vector(s.at("tau"));
    Map m;
    m.given.q = VectorXd::Zero(mechanism.nq());
    m.T = MatrixXd::Zero(mechanism.nv(), v.size());
    m.Tdot_v = VectorXd::Zero(mechanism.nv());
    const auto places = joint_places(mechanism);
    for (std::size_t i = 0; i < names_.size(); ++i) {
      const json& j = joints()[i];
      const auto place = std::find_if(places.begin(), places.end(),
                                      [&](const JointPlace& p) { return p.name == names_[i]; });
      if (place == places.end()) ADD_FAILURE() << "no joint " << names_[i];
      const Eigen::Index at = j.at("qposadr"), dof = j.at("dofadr");
      for (std::size_t k = 0; k < place->q.size(); ++k)
        m.given.q[place->q[k]] = q[at + static_cast<Eigen::Index>(k)] - j.value("ref", 0.0);
      for (std::size_t k = 0; k < place->u.size(); ++k)
        m.T(place->u[k], dof + static_cast<Eigen::Index>(k)) = 1;
      if (j.at("type") != "free") continue;
      const Eigen::Matrix3d to_body = Eigen::Quaterniond(q[at + 3], q[at + 4], q[at + 5], q[at + 6])
                                          .toRotationMatrix()
                                          .transpose();
      m.T.block<3, 3>(place->u[0], dof) = to_body;
      const Eigen::Vector3d velocity = to_body * v.segment<3>(dof);
      m.Tdot_v.segment<3>(place->u[0]) = -v.segment<3>(dof + 3).cross(velocity);
    }
    m.given.v = m.T * v;
    m.given.tau = m.T * tau;
    return m;
  }

 private:
  void name_joints() {
    std::vector<std::string> in_order;
    for (const JointSpec& joint : scene_.joints)
      if (joint.kind != JointKind::weld) in_order.push_back(joint.name);
    ASSERT_EQ(in_order.size(), joints().size());
    for (std::size_t i = 0; i < in_order.size(); ++i)
      names_.push_back(joints()[i].at("name").is_null()
                           ? in_order[i]
                           : joints()[i].at("name").get<std::string>());
  }

  json reference_;
  Scene scene_, with_rotors_;
  std::map<std::string, double> armatures_;
  std::vector<std::string> names_;
};

bool has_quaternions(const Mechanism& mechanism) {
  return mechanism.nq() != mechanism.nv();
}

/// From the rows of its lower triangle.
MatrixXd mass_matrix(const json& lower, Eigen::Index n) {
  MatrixXd m(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j <= i; ++j)
      m(i, j) = m(j, i) = lower[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
  return m;
}

class Models : public testing::TestWithParam<std::size_t> {
 protected:
  static const Model& model() {
    static std::map<std::size_t, Model> read;
    const auto [at, first] = read.try_emplace(GetParam());
    if (first) {
      const fs::path& file = models().at(GetParam());
      at->second = {file, references(file.parent_path()).at(file.filename().string())};
    }
    return at->second;
  }
  static double tolerance() { return model().reference.at("constraints").empty() ? 1e-12 : 1e-10; }
};

TEST_P(Models, MassMatrixBiasAndAccelerationsOfTheTree) {
  const Pair pair(model());
  const Mechanism tree(Pair::without_springs(pair.without_loops()));
  const json& reference = model().reference;
  double mass = 0, bias = 0, free = 0, kinetic = 0, potential = 0, first_potential = 0;
  for (const json& s : reference.at("states")) {
    const Pair::Map m = pair.state(tree, s);
    const StateValues x = evaluate_state(tree, m.given);
    ASSERT_TRUE(x.dense);
    const VectorXd tau = vector(s.at("tau"));
    mass = std::max(
        mass, deviation(m.T.transpose() * x.mass * m.T, mass_matrix(s.at("M_lower"), tree.nv())));
    bias = equations::larger(bias, deviation(m.T.transpose() * (x.mass * m.Tdot_v + x.bias) + tau,
                                             vector(s.at("bias")), tau.cwiseAbs().maxCoeff()));
    free = equations::larger(free,
                             deviation(m.T.transpose() * (x.free - m.Tdot_v), vector(s.at("qdd"))));
    const double t = s.at("kinetic_energy"), v = s.at("potential_energy");
    kinetic = equations::larger(kinetic, std::abs(x.kinetic - t) / std::max(1e-300, std::abs(t)));
    if (&s == &reference.at("states")[0]) first_potential = x.potential - v;
    potential =
        equations::larger(potential, std::abs(x.potential - v - first_potential) /
                                         std::max({1.0, std::abs(v), std::abs(x.potential)}));
  }
  if (std::getenv("MOMENTA_MODELS"))
    std::printf("| %s/%s | %d | %.0e | %.0e | %.0e |\n",
                model().file.parent_path().filename().c_str(), model().file.filename().c_str(),
                tree.nv(), mass, bias, free);
  EXPECT_LE(mass, 1e-12);
  EXPECT_LE(bias, 1e-12);
  EXPECT_LE(free, tolerance());
  EXPECT_LE(kinetic, 1e-12);
  EXPECT_LE(potential, 1e-12);
}

TEST_P(Models, AccelerationsWithLoopsClosed) {
  const json& reference = model().reference;
  if (reference.at("constraints").empty()) GTEST_SKIP() << "a tree";
  const Pair pair(model());
  const Mechanism mechanism(Pair::without_springs(pair.scene()));
  double open = 0, speed = 0, constrained = 0, allowed = 1e-10;
  int rank = 0;
  for (const json& s : reference.at("constrained_states")) {
    const Pair::Map m = pair.state(mechanism, s);
    const StateValues x = evaluate_state(mechanism, m.given);
    open = equations::larger(open, x.phi.cwiseAbs().maxCoeff());
    speed = equations::larger(speed, x.phidot.cwiseAbs().maxCoeff());
    constrained = equations::larger(
        constrained,
        deviation(m.T.transpose() * (x.constrained - m.Tdot_v), vector(s.at("qdd_constrained"))));
    // Next to a singular pose the last bit of q may move the answer by more: by 1e-9 in the delta
    // robot, whose singular values go down to 2e-5 of the largest.
    GivenState moved = m.given;
    const VectorXd directions = VectorXd::LinSpaced(moved.q.size(), -1, 1);
    const double step = 1e-9, bits = 4 * std::numeric_limits<double>::epsilon();
    if (!has_quaternions(mechanism)) {
      moved.q += step * directions;
      allowed = std::max(
          allowed,
          bits / step * deviation(evaluate_state(mechanism, moved).constrained, x.constrained));
    }
    rank = x.loops.rank;
    EXPECT_EQ(x.loops.rank, s.at("rank").get<int>());
  }
  if (std::getenv("MOMENTA_MODELS"))
    std::printf("| %s/%s | loops %d rows, rank %d | open %.0e | speed %.0e | %.0e |\n",
                model().file.parent_path().filename().c_str(), model().file.filename().c_str(),
                mechanism.m(), rank, open, speed, constrained);
  EXPECT_LE(open, 1e-10);
  EXPECT_LE(speed, 1e-10);
  EXPECT_LE(constrained, allowed);
  EXPECT_LE(allowed, 1e-7);
}

TEST_P(Models, ArmaturesAreRotorInertias) {
  const Pair pair(model());
  std::size_t expected = 0;
  for (std::size_t i = 0; i < pair.names().size(); ++i) {
    const double armature = pair.joints()[i].value("armature", 0.0);
    if (armature == 0) continue;
    ++expected;
    const auto found = pair.armatures().find(pair.names()[i]);
    ASSERT_NE(found, pair.armatures().end()) << pair.names()[i];
    EXPECT_NEAR(found->second, armature, 1e-15 * armature + 1e-18);
  }
  EXPECT_EQ(pair.armatures().size(), expected);
}

// (M + A) q̈ + bias = τ with A the armatures.
TEST_P(Models, ArmaturesAddToTheDiagonalOfM) {
  const Pair pair(model());
  const json& reference = model().reference;
  if (pair.armatures().empty() || !reference.at("constraints").empty()) GTEST_SKIP();
  const Mechanism mechanism(Pair::without_springs(pair.with_rotors()));
  for (const json& s : reference.at("states")) {
    const Pair::Map m = pair.state(mechanism, s);
    const VectorXd tau = vector(s.at("tau"));
    MatrixXd mass = mass_matrix(s.at("M_lower"), tau.size());
    for (std::size_t i = 0; i < pair.names().size(); ++i)
      if (const Eigen::Index dof = pair.joints()[i].at("dofadr");
          pair.joints()[i].at("type") != "free")
        mass(dof, dof) += pair.joints()[i].value("armature", 0.0);
    const VectorXd expected = mass.ldlt().solve(tau - vector(s.at("bias")));
    const VectorXd found = evaluate_state(mechanism, m.given).free - m.Tdot_v;
    EXPECT_LE(deviation(m.T.transpose() * found, expected), 1e-11);
  }
}

// Springs and dampers of joints of all kinds. The reference has neither friction nor tendons.
TEST_P(Models, SpringsAndDampers) {
  const Pair pair(model());
  Scene scene = pair.without_loops();
  for (JointSpec& joint : scene.joints) joint.friction = 0;
  std::erase_if(scene.forces, [](const ForceSpec& f) { return f.kind == "coordinate-spring"; });
  const Mechanism bare(Pair::without_springs(scene)), tree(scene);
  for (const json& s : model().reference.at("states")) {
    const Pair::Map m = pair.state(tree, s);
    const VectorXd expected = vector(s.at("qfrc_passive_mujoco"));
    VectorXd found =
        m.T.transpose() * (evaluate_state(bare, m.given).bias - evaluate_state(tree, m.given).bias);
    // the two biases lose their digits in the difference
    const double scale = std::max(1.0, evaluate_state(bare, m.given).bias.cwiseAbs().maxCoeff());
    EXPECT_LE((found - expected).cwiseAbs().maxCoeff(), 1e-12 * scale);
  }
}

TEST(ModelsByOthers, OfWhichValuesAreKeptAreAllTried) {
  std::size_t kept = 0;
  std::set<fs::path> folders;
  for (const fs::path& file : models())
    if (folders.insert(file.parent_path()).second) kept += references(file.parent_path()).size();
  EXPECT_EQ(models().size(), kept);
}

INSTANTIATE_TEST_SUITE_P(ByOthers, Models, testing::Range(std::size_t{0}, models().size()),
                         [](const auto& one) {
                           const fs::path& file = models().at(one.param);
                           std::string name = std::to_string(one.param) + "_" +
                                              file.parent_path().filename().string() + "_" +
                                              file.stem().string();
                           for (char& c : name)
                             if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
                           return name;
                         });

}  // namespace
}  // namespace momenta::dae_models
