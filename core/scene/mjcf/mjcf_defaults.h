#pragma once
// <default> classes of MJCF: attributes of elements that do not write them themselves.

#include <momenta/core/scene/xml/xml_node.h>

#include <map>
#include <string>
#include <vector>

namespace momenta::reading {

class MjcfDefaults {
 public:
  /// The class of everything without another one.
  static constexpr const char* main_class = "main";

  MjcfDefaults() { classes_[main_class]; }

  /// Takes a top <default>. A class inherits all attributes of its parent, whatever their order.
  void take(const Node& node);
  /// Takes the classes of an attached model, with its prefix; its main class inherits nothing.
  void take(const MjcfDefaults& attached, const std::string& prefix);

  /// The element with the attributes of its `class`, else of `active`, added. `kind`: its name in
  /// the defaults: "joint", "geom", "site", "equality". An orientation of the element itself
  /// replaces any in the class. @throws SceneError for an unknown class
  Element with_defaults(const Node& node, const std::string& kind, const std::string& active) const;

  /// `childclass` of a body, else the one around it.
  std::string active_class(const Node& body, const std::string& around) const;

 private:
  using Attributes = std::vector<Attribute>;
  using Class = std::map<std::string, Attributes>;
  void take(const Node& node, const std::string& name);
  const Class& known(const Node& node, const char* attribute, const std::string& name) const;
  std::map<std::string, Class> classes_;
};

}  // namespace momenta::reading
