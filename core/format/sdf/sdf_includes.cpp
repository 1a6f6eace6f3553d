// <include>: replaced by a model of another file.

#include <momenta/core/format/sdf/sdf_model.h>
#include <momenta/core/format/xml/file_inside.h>
#include <momenta/core/scene/file_text.h>
#include <momenta/core/text/quoting.h>

#include <algorithm>
#include <charconv>
#include <filesystem>

namespace momenta::reading {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t deepest = 10, most_elements = 200'000;

/// Conventions of a version: axes and names of joints changed with 1.5 and 1.7.
int manner_of(const std::array<int, 2>& version) {
  return version[1] < 5 ? 0 : version[1] < 7 ? 1 : 2;
}

class Includer {
 public:
  Includer(const std::string& file, std::vector<std::string>& names)
      : written_(fs::path(file).parent_path()), names_(names) {
    std::error_code error;
    folder_ = fs::weakly_canonical(written_.empty() ? fs::path(".") : written_, error);
    around_.push_back(fs::weakly_canonical(file, error));
  }

  void expand(Element& parent, const std::string& file, int manner) {
    for (Element& child : parent.children) {
      if (child.name == "include") child = model_of(Node(child, "", file), file, manner);
      if (child.name == "model" || child.name == "world") expand_once(child, file, manner);
    }
  }

 private:
  /// Expands an element, unless it came from a file, expanded already.
  void expand_once(Element& child, const std::string& file, int manner) {
    const bool own = !child.file || child.file->name == now();
    if (own) expand(child, file, manner);
  }
  std::string now() const {
    return around_.size() == 1 ? ""
                               : (written_ / around_.back().lexically_relative(folder_)).string();
  }

  fs::path place_of(const Node& uri) const {
    std::string name = uri.content();
    constexpr std::string_view model = "model://", plain = "file://";
    if (name.starts_with(model))
      name = name.substr(model.size());
    else if (name.starts_with(plain))
      name = name.substr(plain.size());
    else if (name.find("://") != std::string::npos)
      uri.fail("is " + in_quotes(name) +
               ", expected a file beside this one: nothing is fetched from elsewhere");
    // In the folder of this file, or of the first.
    const fs::path here = around_.back().parent_path();
    std::error_code error;
    for (const fs::path& folder : {here, folder_}) {
      const fs::path found = fs::weakly_canonical(folder / name, error);
      if (fs::is_directory(found, error))
        return file_inside(uri, "", (found / "model.sdf").lexically_relative(folder_).string(),
                           folder_);
      if (fs::exists(found, error))
        return file_inside(uri, "", found.lexically_relative(folder_).string(), folder_);
    }
    return file_inside(uri, "", name, folder_);
  }

  Element model_of(const Node& include, const std::string& file, int manner) {
    if (include.flag("merge", false))
      include.fail("merge", "is true, expected a model that stands for itself");
    const Node uri = include.required("uri");
    const fs::path path = place_of(uri);
    if (std::find(around_.begin(), around_.end(), path) != around_.end())
      uri.fail("is " + in_quotes(uri.content()) +
               ", which this element is a part of, expected a file that does not include itself");
    if (around_.size() > deepest)
      uri.fail("is in the last of " + std::to_string(deepest) +
               " files that include each other, expected no such depth");
    const std::string name = (written_ / path.lexically_relative(folder_)).string();
    names_.push_back(name);
    Element root = parse_xml(text_of(path), name);
    elements_ += size_of(root).first;
    if (elements_ > most_elements)
      uri.fail("takes the scene over " + std::to_string(most_elements) +
               " elements, expected less");
    const auto source =
        std::make_shared<IncludedFile>(IncludedFile{name, static_cast<int>(names_.size())});
    mark(root, source);
    const Node sdf(root, "", file);
    if (root.name != "sdf") uri.fail("holds <" + on_one_line(root.name) + ">, expected <sdf>");
    if (manner_of(read_sdf_version(sdf)) != manner)
      sdf.fail("version", "is " + in_quotes(sdf.text("version")) +
                              ", which reads joints in another way than the file that includes "
                              "this one, expected both from the same of 1.4, 1.5 to 1.6, and 1.7 "
                              "on");
    const std::vector<Node> models = sdf.children("model");
    if (models.size() != 1)
      sdf.fail("holds " + std::to_string(models.size()) +
               " <model>, expected one where it is included");
    around_.push_back(path);
    expand(root, file, manner);
    around_.pop_back();
    Element model = *std::find_if(root.children.begin(), root.children.end(),
                                  [](const Element& e) { return e.name == "model"; });
    override_with(include, model);
    return model;
  }

  /// Sets the attributes and elements of the <include> over those of the model.
  static void override_with(const Node& include, Element& model) {
    const auto set = [&](const char* attribute, const std::string& text) {
      for (Attribute& a : model.attributes)
        if (a.name == attribute) {
          a.text = text;
          return;
        }
      model.attributes.push_back({attribute, text});
    };
    if (const auto name = include.child("name")) set("name", name->content());
    if (const auto frame = include.child("placement_frame"))
      set("placement_frame", frame->content());
    for (const char* kind : {"static", "pose"})
      if (const auto said = include.child(kind)) {
        std::erase_if(model.children, [&](const Element& e) { return e.name == kind; });
        model.children.push_back(said->element());
      }
    for (const Element& other : include.element().children)
      if (other.name == "plugin") model.children.push_back(other);
  }

  fs::path folder_, written_;  ///< folder of the first file, and as written in its name
  std::vector<fs::path> around_;
  std::vector<std::string>& names_;
  std::size_t elements_ = 0;
};

}  // namespace

std::array<int, 2> read_sdf_version(const Node& sdf) {
  const std::string text = sdf.text("version");
  std::array<int, 2> version{0, 0};
  const char *at = text.data(), *end = at + text.size();
  const auto major = std::from_chars(at, end, version[0]);
  const auto minor = std::from_chars(std::min(major.ptr + 1, end), end, version[1]);
  constexpr int oldest = 4, newest = 12;
  if (major.ec != std::errc() || minor.ec != std::errc() || version[0] != 1 || *major.ptr != '.' ||
      minor.ptr != end || version[1] < oldest || version[1] > newest)
    sdf.fail("version", "is " + in_quotes(text) + ", expected 1.4 to 1.12");
  return version;
}

Element with_sdf_includes(Element sdf, const std::string& file, std::vector<std::string>& files) {
  const auto included = [](const auto& self, const Element& e) -> bool {
    return std::any_of(e.children.begin(), e.children.end(), [&](const Element& child) {
      return child.name == "include" || self(self, child);
    });
  };
  if (!included(included, sdf)) return sdf;
  const int manner = manner_of(read_sdf_version(Node(sdf, "", file)));
  Includer(file, files).expand(sdf, file, manner);
  return sdf;
}

}  // namespace momenta::reading
