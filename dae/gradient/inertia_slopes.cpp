#include <momenta/core/scene/toml/write_scene.h>
#include <momenta/dae/gradient/inertia_slopes.h>
#include <momenta/dae/gradient/levels/tangent_sweeps.h>

namespace momenta {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

template <class Space>
Model<Space> built(const Tree& tree, const Scene& scene, const Plan& plan) {
  if constexpr (Space::dimension == 6)
    return build_spatial_model(tree, scene);
  else
    return build_planar_model(tree, scene, plan.basis);
}

template <class Space>
class InertiaSlopesOf final : public InertiaSlopes {
  static constexpr bool in_space = Space::dimension == 6;
  static constexpr int of_body = in_space ? 10 : 4, axes = in_space ? 3 : 2;

 public:
  explicit InertiaSlopesOf(const Mechanism& mechanism)
      : mechanism_(mechanism),
        model_(built<Space>(mechanism.tree(), mechanism.scene(), mechanism.plan())),
        sweep_(make_inertia_sweep(model_)) {}

  Index size() const override { return of_body * static_cast<Index>(model_.bodies.size()) + axes; }
  Range of(const std::string& body) const override {
    const auto& bodies = mechanism_.tree().bodies;
    for (std::size_t k = 0; k < bodies.size(); ++k)
      if (bodies[k].name == body) return {of_body * static_cast<Index>(k), of_body};
    return {};
  }

  void add(double factor, double t, const double* q, const double* u, const double* dq,
           const double* du, VectorXd& slopes) override {
    sweep_->add(factor, t, q, u, dq, du, slopes.data());
  }

  VectorXd numbers(const Scene& other) const override {
    const Model<Space> model = built<Space>(build_valid_tree(other), other, mechanism_.plan());
    VectorXd all(size());
    Index place = 0;
    for (const auto& body : model.bodies) {
      const auto& b = body.inertia;
      all[place++] = b.m;
      for (int i = 0; i < axes; ++i) all[place++] = b.mc[i];
      if constexpr (in_space) {
        for (int i = 0; i < 3; ++i)
          for (int j = i; j < 3; ++j) all[place++] = b.J(i, j);
      } else {
        all[place++] = b.J;
      }
    }
    for (int i = 0; i < axes; ++i) all[place++] = model.gravity[i];
    return all;
  }

 private:
  const Mechanism& mechanism_;
  Model<Space> model_;
  std::unique_ptr<InertiaSweep> sweep_;
};

/// Whether a string of the text has the name as a word: a formula may, and what it then is is no
/// inertia.
bool is_quoted(const std::string& text, const std::string& name) {
  const auto of_word = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  };
  bool inside = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '"') inside = !inside;
    if (inside && text.compare(i, name.size(), name) == 0 && !of_word(text[i - 1]) &&
        (i + name.size() == text.size() || !of_word(text[i + name.size()])))
      return true;
  }
  return false;
}

}  // namespace

std::unique_ptr<InertiaSlopes> make_inertia_slopes(const Mechanism& mechanism) {
  if (mechanism.plan().planar) return std::make_unique<InertiaSlopesOf<Planar>>(mechanism);
  return std::make_unique<InertiaSlopesOf<Spatial>>(mechanism);
}

InertiasAlone::InertiasAlone(const Scene& scene) : scene_(scene), text_(scene_text(scene)) {}

bool InertiasAlone::as(Scene other) const {
  if (other.bodies.size() != scene_.bodies.size() ||
      other.parameters.size() != scene_.parameters.size())
    return false;
  for (std::size_t i = 0; i < scene_.parameters.size(); ++i)
    if (other.parameters[i].value != scene_.parameters[i].value &&
        is_quoted(text_, scene_.parameters[i].name))
      return false;
  other.gravity = scene_.gravity;
  other.parameters = scene_.parameters;
  for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
    const BodySpec& own = scene_.bodies[i];
    BodySpec& body = other.bodies[i];
    body.mass = own.mass;
    body.com = own.com;
    body.inertia = own.inertia;
    body.shape = own.shape;
  }
  return scene_text(other) == text_;
}

}  // namespace momenta
