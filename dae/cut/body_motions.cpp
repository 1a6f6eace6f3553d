#include <momenta/dae/cut/body_motions.h>

namespace momenta {

BodyMotions::BodyMotions(const Mechanism& mechanism, const std::set<std::string>* wanted)
    : poses_(mechanism.tree(), mechanism.scene()) {
  motion_["ground"] = {};
  for (const BodySpec& body : mechanism.scene().bodies)
    if (!wanted || wanted->contains(body.name))
      wanted_.push_back({&motion_[body.name], mechanism.tree().body(body.name)});
}

void BodyMotions::take(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& u) {
  poses_.move(t, q.data(), u.data());
  for (const auto& [motion, body] : wanted_) *motion = poses_.motion(body);
}

}  // namespace momenta
