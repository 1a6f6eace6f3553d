#pragma once
// <default> classes of MJCF: attributes that an element has where it does not write them itself.

#include <momenta/core/scene/xml/xml_node.h>

#include <map>
#include <string>
#include <vector>

namespace momenta::reading {

class MjcfDefaults {
 public:
  /// The class that everything belongs to where nothing else is said.
  static constexpr const char* main_class = "main";

  MjcfDefaults() { classes_[main_class]; }

  /// Takes a top <default>. A class inherits what its parent says, wherever in it that stands.
  void take(const Node& node);
  /// Takes the classes of an attached model, with its prefix before their names. Its main class
  /// inherits nothing.
  void take(const MjcfDefaults& attached, const std::string& prefix);

  /// The element with what its class adds to it: that of its `class`, else `active`. `kind` names
  /// it among the defaults: "joint", "geom", "site", "equality". Of the ways to say an orientation
  /// the element's own one stands alone. @throws SceneError for an unknown class
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
