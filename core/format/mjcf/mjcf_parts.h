#pragma once
// Content of a body, with frames, replicas and attached models resolved: bodies, joints, geoms and
// sites, each with its frame. <frame> moves its content in the body, and may give it another class
// of defaults.

#include <momenta/core/format/mjcf/mjcf_model.h>

namespace momenta::reading {

struct MjcfPart {
  Node node;
  MjcfFrame in;                            ///< frame around it, in the body
  std::string active;                      ///< class of defaults
  const MjcfSettings* settings = nullptr;  ///< settings of an attached model; null: as around
};

/// The content of a body, in the order of the file. @throws SceneError for composites and flexes
std::vector<MjcfPart> parts_of(const Node& body, const std::string& active, const MjcfModel& model);

/// Applies the settings of a part, and restores those before it.
class SettingsOf {
 public:
  SettingsOf(const MjcfPart& part, MjcfSettings& now) : now_(now), before_(now) {
    if (part.settings != nullptr) now_ = *part.settings;
  }
  ~SettingsOf() { now_ = before_; }
  SettingsOf(const SettingsOf&) = delete;
  SettingsOf& operator=(const SettingsOf&) = delete;

 private:
  MjcfSettings& now_;
  const MjcfSettings before_;
};

}  // namespace momenta::reading
