#include <momenta/core/format/mjcf/mjcf_copies.h>
#include <momenta/core/format/mjcf/mjcf_defaults.h>
#include <momenta/core/format/mjcf/mjcf_names.h>
#include <momenta/core/format/xml/file_inside.h>
#include <momenta/core/text/quoting.h>

#include <algorithm>
#include <array>
#include <map>

namespace momenta::reading {
namespace {

namespace fs = std::filesystem;

/// Adds or replaces an attribute of an element.
void set(Element& element, const std::string& attribute, const std::string& text) {
  for (Attribute& a : element.attributes)
    if (a.name == attribute) {
      a.text = text;
      return;
    }
  element.attributes.push_back({attribute, text});
}

/// Refuses depth that attaching has made; parse_xml bounds single files.
void refuse_depth(const Node& node, int depth) {
  constexpr int deepest = 200;
  if (depth > deepest) node.fail("is nested more than 200 deep, expected no such depth");
  for (const Node& child : node.children()) refuse_depth(child, depth + 1);
}

class Assembler {
 public:
  Assembler(MjcfFiles& files, Remarks& remarks) : files_(files), remarks_(remarks) {}

  /// Includes, attaches and replicates in a model; `way`: the files around it.
  Element assemble(Element root, const std::string& file, std::vector<fs::path> way) {
    root = with_includes(std::move(root), file, files_);
    std::map<std::string, Asset> assets;
    for (const Element& section : root.children)
      if (section.name == "asset")
        for (const Element& asset : section.children)
          if (asset.name == "model") find(Node(asset, "asset", file), assets);
    const std::size_t own = root.children.size();
    for (std::size_t i = 0; i < own; ++i)
      if (root.children[i].name == "worldbody") {
        Element world = std::move(root.children[i]);
        attach_in(world, root, file, assets, way);
        root.children[i] = std::move(world);
      }
    replicate_all(root, file, files_);
    return root;
  }

 private:
  /// A model among the assets of another one.
  struct Asset {
    Element element;
    fs::path file;
  };

  void find(const Node& node, std::map<std::string, Asset>& assets) {
    const std::string written = node.text("file");
    const std::string name = node.text("name", fs::path(written).stem().string());
    if (!assets.emplace(name, Asset{node.element(), written}).second)
      node.fail("name", "is " + in_quotes(name) + " once more, expected each model once");
  }

  void attach_in(Element& element, Element& root, const std::string& file,
                 const std::map<std::string, Asset>& assets, const std::vector<fs::path>& way) {
    if (element.name == "attach") return attach(element, root, file, assets, way);
    for (Element& child : element.children) attach_in(child, root, file, assets, way);
  }

  void attach(Element& element, Element& root, const std::string& file,
              const std::map<std::string, Asset>& assets, std::vector<fs::path> way) {
    const Node node(element, "", file);
    if (!node.has("model"))
      node.fail(
          "has no model, expected the name of a <model> of <asset>: parts of the same model "
          "are not attached");
    const std::string name = node.text("model"), prefix = node.text("prefix");
    const auto asset = assets.find(name);
    if (asset == assets.end()) {
      std::vector<std::string_view> known;
      for (const auto& entry : assets) known.push_back(entry.first);
      node.fail("model", "is " + in_quotes(name) + ", expected the name of a <model> of <asset>" +
                             did_you_mean(name, known));
    }
    const Node from(asset->second.element, "asset", file);
    const fs::path path = file_inside(from, "file", asset->second.file.string(), files_.folder());
    if (std::find(way.begin(), way.end(), path) != way.end() || way.size() > MjcfFiles::deepest)
      node.fail("model", "is " + in_quotes(name) + ", which attaches itself, or is the last of " +
                             std::to_string(MjcfFiles::deepest) + ", expected neither");
    way.push_back(path);
    Element read = files_.read(from, path);
    if (read.name != "mujoco")
      from.fail("file", "holds <" + on_one_line(read.name) + ">, expected <mujoco>");
    Element model = assemble(std::move(read), file, way);
    Element part = part_of(node, model);

    std::set<MjcfName> inside;
    collect_names(part, "", inside);
    const auto everything = [](const std::string&, const std::string&) { return true; };
    rename(part, "", prefix, "", everything);
    element.children.clear();
    const bool whole = part.name == "worldbody";
    if (whole)
      element.children = std::move(part.children);
    else
      element.children.push_back(std::move(part));
    const std::string key = prefix + name;
    set(element, "model", key);
    const bool fresh = std::none_of(
        root.children.begin(), root.children.end(),
        [&](const Element& e) { return e.name == attached_model && *e.find("model") == key; });
    if (fresh) settings_of(model, key, prefix, root);
    for (const Element& section : model.children)
      if (section.name == "keyframe")
        take_keys(section, prefix, key, whole, root);
      else
        follow(section, prefix, key, fresh, inside, root);
  }

  /// The body or frame asked for, or the world, with its class of defaults.
  Element part_of(const Node& node, const Element& model) const {
    const char* kind = node.has("body") ? "body" : node.has("frame") ? "frame" : nullptr;
    if (kind == nullptr) {
      Element world;
      world.name = "worldbody";
      for (const Element& section : model.children)
        if (section.name == "worldbody")
          for (Element child : section.children) {
            with_class(child, MjcfDefaults::main_class);
            world.children.push_back(std::move(child));
          }
      return world;
    }
    const std::string name = node.text(kind);
    for (const Element& section : model.children) {
      if (section.name != "worldbody") continue;
      std::string active = MjcfDefaults::main_class;
      if (const Element* found = found_in(section, kind, name, active)) {
        Element part = *found;
        with_class(part, active);
        return part;
      }
    }
    node.fail(kind, "is " + in_quotes(name) + ", expected a " + kind + " of the model " +
                        in_quotes(node.text("model")));
  }

  /// Gives an element the class `active`, unless it has its own.
  static void with_class(Element& element, const std::string& active) {
    const bool holds_others = element.name == "body" || element.name == "frame" ||
                              element.name == "replicate" || element.name == "attach";
    const char* key = holds_others ? "childclass" : "class";
    if (element.find(key) == nullptr) set(element, key, active);
  }

  static const Element* found_in(const Element& around, const std::string& kind,
                                 const std::string& name, std::string& active) {
    const std::string before = active;
    if (const std::string* own = around.find("childclass")) active = *own;
    const std::string within = active;
    for (const Element& child : around.children) {
      const std::string* own = child.find("name");
      if (child.name == kind && own != nullptr && *own == name) return &child;
      if (const Element* found = found_in(child, kind, name, active)) return found;
      active = within;
    }
    active = before;
    return nullptr;
  }

  /// Adds the <compiler> and <default> of a model, and those of models it attaches, to the root.
  static void settings_of(const Element& model, const std::string& key, const std::string& prefix,
                          Element& root) {
    Element settings;
    settings.name = attached_model;
    settings.line = model.line;
    settings.file = model.file;
    settings.attributes = {{"model", key}, {"prefix", prefix}};
    for (const Element& section : model.children) {
      if (section.name == "compiler" || section.name == "default")
        settings.children.push_back(section);
      if (section.name != attached_model) continue;
      Element inner = section;
      set(inner, "model", prefix + *section.find("model"));
      set(inner, "prefix", prefix + *section.find("prefix"));
      root.children.push_back(std::move(inner));
    }
    root.children.push_back(std::move(settings));
  }

  /// Remarks on sections that do not come along with a part of a model.
  void tell_dropped(const Element& section, bool fresh) {
    constexpr std::array<std::string_view, 9> along{"tendon",   "equality",  "contact",
                                                    "actuator", "asset",     "default",
                                                    "compiler", "worldbody", attached_model};
    if (fresh && std::find(along.begin(), along.end(), section.name) == along.end())
      remarks_.left_out("<" + section.name + "> of attached models");
  }

  /// Keys of a model attached as a whole, named with the prefix. Their numbers are for the joints
  /// of that model.
  void take_keys(const Element& section, const std::string& prefix, const std::string& of,
                 bool whole, Element& root) {
    Element copy = section;
    copy.children.clear();
    for (Element key : section.children) {
      if (!whole) {
        remarks_.left_out("keys of models of which a part is attached");
        continue;
      }
      if (const std::string* name = key.find("name")) set(key, "name", prefix + *name);
      const std::string* const inner = key.find(of_model);
      set(key, of_model, inner == nullptr ? of : prefix + *inner);
      copy.children.push_back(std::move(key));
    }
    if (!copy.children.empty()) root.children.push_back(std::move(copy));
  }

  /// Adds the elements of a section that concern the part to the root.
  void follow(const Element& section, const std::string& prefix, const std::string& key, bool fresh,
              std::set<MjcfName>& inside, Element& root) {
    constexpr std::array<std::string_view, 4> ties{"tendon", "equality", "contact", "actuator"};
    const bool tie = std::find(ties.begin(), ties.end(), section.name) != ties.end();
    tell_dropped(section, fresh);
    if (section.name == "asset" ? !fresh : !tie) return;
    Element copy = section;
    copy.children.clear();
    if (section.name == "asset") {
      const std::string* const inner = section.find(of_model);
      set(copy, of_model, inner == nullptr ? key : prefix + *inner);
    }
    for (Element child : section.children) {
      bool whole = true;
      if (tie)
        each_reference(child, [&](const std::string& kind, const std::string& name) {
          whole &= inside.contains({kind, name});
        });
      if (!whole) {
        remarks_.left_out("what attached models say of parts that are not attached");
        continue;
      }
      if (tie) collect_names(child, section.name, inside);
      if (child.name == "model") continue;
      if (const std::string* mesh = child.find("file"); mesh != nullptr && !child.find("name"))
        set(child, "name", fs::path(*mesh).stem().string());
      if (child.find("class") == nullptr) set(child, "class", MjcfDefaults::main_class);
      rename(child, section.name, prefix, "",
             [](const std::string&, const std::string&) { return true; });
      copy.children.push_back(std::move(child));
    }
    root.children.push_back(std::move(copy));
  }

  MjcfFiles& files_;
  Remarks& remarks_;
};

}  // namespace

Element assembled(const Element& model, const std::string& file, MjcfFiles& files,
                  Remarks& remarks) {
  std::error_code error;
  Element whole = model;
  files.drop_empty(whole);
  whole = Assembler(files, remarks)
              .assemble(std::move(whole), file, {fs::weakly_canonical(file, error)});
  refuse_depth(Node(whole, "", file), 1);
  for (int i = 0; i < files.empty(); ++i) remarks.count("taken as not given: empty attributes");
  bool shared = false;
  rename(whole, "", "", " 2", [&](const std::string& kind, const std::string& name) {
    const bool same = kind == "body" && name == "ground";
    shared |= same;
    return same;
  });
  if (shared) remarks.say("called 'ground 2', as ground is what does not move: body 'ground'");
  return whole;
}

}  // namespace momenta::reading
