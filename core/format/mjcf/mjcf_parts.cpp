#include <momenta/core/format/mjcf/mjcf_parts.h>

namespace momenta::reading {
namespace {

class Flattener {
 public:
  explicit Flattener(const MjcfModel& model) : model_(model), settings_(&model) {}

  void gather(const Node& around, const MjcfFrame& in, const std::string& active) {
    for (const Node& node : around.children()) {
      const std::string& what = node.name();
      if (what == "frame") {
        const MjcfFrame own{node.vector("pos", Eigen::Vector3d::Zero()),
                            read_turn(node, settings_->angles)};
        gather(node, in * own, model_.defaults.active_class(node, active));
      } else if (what == "replicate") {
        replicas(node, in, model_.defaults.active_class(node, active));
      } else if (what == "attach") {
        const MjcfSettings *const before = settings_, *const before_own = own_;
        settings_ = own_ = &model_.attached.at(node.text("model"));
        gather(node, in, active);
        settings_ = before;
        own_ = before_own;
      } else if (what == "composite") {
        node.of("").fail(
            "makes bodies, joints and constraints by a count, which is not read; expected those it "
            "stands for, as MuJoCo writes them when it saves the model (mj_saveLastXML)");
      } else if (what == "flexcomp") {
        node.of("").fail("makes a soft body, which is not read; expected rigid bodies");
      } else if (what == "inertial" && &around != first_) {
        node.of("").fail("stands in a <frame>, expected it in its <body>");
      } else {
        parts.push_back({node, in, active, own_});
      }
    }
  }
  void gather(const Node& body, const std::string& active) {
    first_ = &body;
    gather(body, {}, active);
  }

  std::vector<MjcfPart> parts;

 private:
  /// Adds the copies: the i-th is turned by i euler and lies `offset` from the one before, in its
  /// axes.
  void replicas(const Node& node, const MjcfFrame& in, const std::string& active) {
    const Eigen::Vector3d offset = node.vector("offset", Eigen::Vector3d::Zero());
    const Eigen::Vector3d euler = node.vector("euler", Eigen::Vector3d::Zero());
    MjcfFrame place;
    double i = 0;
    for (const Node& replica : node.children()) {
      place.turn = turn_by_euler(i++ * euler, settings_->angles);
      gather(replica, in * place, active);
      place.at = place * offset;
    }
  }

  const MjcfModel& model_;
  const MjcfSettings* settings_;       ///< settings that hold here
  const MjcfSettings* own_ = nullptr;  ///< settings of an attached model
  const Node* first_ = nullptr;
};

}  // namespace

std::vector<MjcfPart> parts_of(const Node& body, const std::string& active,
                               const MjcfModel& model) {
  Flattener flattener(model);
  flattener.gather(body, active);
  return std::move(flattener.parts);
}

}  // namespace momenta::reading
