#include <momenta/core/format/mjcf/mjcf_files.h>
#include <momenta/core/format/xml/file_inside.h>
#include <momenta/core/scene/file_text.h>
#include <momenta/core/text/quoting.h>

#include <algorithm>
#include <system_error>

namespace momenta::reading {
namespace {

namespace fs = std::filesystem;

/// Replaces each <include> by the elements of its file.
class Includer {
 public:
  Includer(const std::string& model, MjcfFiles& files) : model_(model), files_(files) {
    std::error_code error;
    around_.push_back(fs::weakly_canonical(model, error));
  }

  void expand(Element& parent) {
    if (std::none_of(parent.children.begin(), parent.children.end(),
                     [](const Element& e) { return e.name == "include"; })) {
      for (Element& child : parent.children) expand(child);
      return;
    }
    std::vector<Element> all;
    for (Element& child : parent.children) {
      if (child.name != "include") {
        expand(child);
        all.push_back(std::move(child));
        continue;
      }
      const Node node(child, "", model_);
      const fs::path file = place_of(node);
      refuse_again(node, file);
      Element root = files_.read(node, file);
      if (root.children.empty()) node.fail("file", "holds no elements, expected some to include");
      around_.push_back(file);
      expand(root);
      around_.pop_back();
      done_.push_back(file);
      std::move(root.children.begin(), root.children.end(), std::back_inserter(all));
    }
    parent.children = std::move(all);
  }

 private:
  fs::path place_of(const Node& node) const {
    if (!node.element().children.empty())
      node.fail("has elements in it, expected an attribute file alone");
    const std::string name = node.text("file");
    const fs::path beside = around_.back().parent_path() / name;
    std::error_code error;
    const bool nearer = !fs::exists(files_.folder() / name, error) && fs::exists(beside, error);
    return file_inside(
        node, "file", nearer ? fs::path(beside.lexically_relative(files_.folder())).string() : name,
        files_.folder());
  }

  void refuse_again(const Node& node, const fs::path& file) const {
    if (std::find(around_.begin(), around_.end(), file) != around_.end())
      node.fail("file", "is " + in_quotes(node.text("file")) +
                            ", which this element is a part of, expected a file that does not "
                            "include itself");
    if (std::find(done_.begin(), done_.end(), file) != done_.end())
      node.fail("file",
                "is " + in_quotes(node.text("file")) + " a second time, expected each file once");
    if (around_.size() > MjcfFiles::deepest)
      node.fail("is in the last of " + std::to_string(MjcfFiles::deepest) +
                " files that include each other, expected no such depth");
  }

  const std::string& model_;
  MjcfFiles& files_;
  std::vector<fs::path> around_, done_;  ///< files being read, and read
};

}  // namespace

MjcfFiles::MjcfFiles(const std::string& model) : written_(fs::path(model).parent_path()) {
  std::error_code error;
  folder_ = fs::weakly_canonical(written_.empty() ? fs::path(".") : written_, error);
}

std::filesystem::path MjcfFiles::folder_of(const Node& node) const {
  return (folder_ / fs::path(node.file()).lexically_relative(written_)).parent_path();
}

Element MjcfFiles::read(const Node& node, const std::filesystem::path& file) {
  const std::string name = (written_ / file.lexically_relative(folder_)).string();
  names_.push_back(name);
  Element root = parse_xml(text_of(file), name);
  drop_empty(root);
  grow(node, root, 1);
  mark(root, std::make_shared<IncludedFile>(IncludedFile{name, static_cast<int>(names_.size())}));
  return root;
}

void MjcfFiles::grow(const Node& node, const Element& element, std::size_t count) {
  const auto [elements, bytes] = size_of(element);
  elements_ += elements * count;
  bytes_ += bytes * count;
  if (elements_ > most_elements || bytes_ > largest_text)
    node.fail("takes the model over " + std::to_string(most_elements) +
              " elements or 64 MiB, expected less");
}

void MjcfFiles::drop_empty(Element& element) {
  empty_ += static_cast<int>(std::erase_if(element.attributes, [](const Attribute& a) {
    return a.text.find_first_not_of(" \t\r\n") == std::string::npos;
  }));
  for (Element& child : element.children) drop_empty(child);
}

Element with_includes(Element model, const std::string& file, MjcfFiles& files) {
  Includer(file, files).expand(model);
  return model;
}

}  // namespace momenta::reading
