// Models by others with one thing in them made wrong: every number not a number, too large, empty
// or a word; masses and the like of the other sign; attributes under another name or twice. Each
// reads to a sentence with file and line, or to the same scene as before: never to another
// mechanism in silence.

#include "equations/same_scene.h"
#include "equations/scene_folder.h"

#include <cstdlib>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

namespace momenta::core_mutated_models {
namespace {

namespace fs = std::filesystem;

/// An attribute in a text: of which element, and where its value stands.
struct Value {
  std::string key;  ///< "joint axis"
  std::size_t at = 0, name_at = 0, length = 0;
};

/// All attributes of the elements of a text, its comments left out.
std::vector<Value> values_of(const std::string& text) {
  std::vector<Value> all;
  const std::regex attribute(R"(([A-Za-z_:][\w:.-]*)\s*=\s*("[^"]*"|'[^']*'))");
  for (std::size_t at = 0; (at = text.find('<', at)) != text.npos;) {
    if (text.compare(at, 4, "<!--") == 0) {
      at = text.find("-->", at);
      continue;
    }
    const std::size_t end = std::min(text.find('>', at), text.size());
    const std::string tag = text.substr(at, end - at);
    const std::string element = tag.substr(1, tag.find_first_of(" \t\r\n/>", 1) - 1);
    if (element.find_first_of("?!") == element.npos)
      for (std::sregex_iterator i(tag.begin(), tag.end(), attribute), none; i != none; ++i)
        all.push_back({element + " " + (*i)[1].str(),
                       at + static_cast<std::size_t>(i->position(2)) + 1,
                       at + static_cast<std::size_t>(i->position(1)),
                       static_cast<std::size_t>(i->length(2)) - 2});
    at = end;
  }
  return all;
}

bool is_numbers(const std::string& text) {
  std::istringstream in(text);
  double x;
  int count = 0;
  while (in >> x) ++count;
  return count > 0 && in.eof();
}

std::string text_of(const fs::path& file) {
  std::ostringstream all;
  all << std::ifstream(file).rdbuf();
  return all.str();
}

std::vector<fs::path> models() {
  std::vector<fs::path> folders{fs::path(MOMENTA_SOURCE_DIR) / "examples" / "models"}, all;
  if (const char* more = std::getenv("MOMENTA_MODELS")) folders.emplace_back(more);
  for (const fs::path& folder : folders)
    for (const auto& entry : fs::recursive_directory_iterator(folder))
      if (const auto kind = entry.path().extension();
          kind == ".xml" || kind == ".urdf" || kind == ".sdf")
        all.push_back(entry.path());
  std::sort(all.begin(), all.end());
  return all;
}

class MutatedModels : public equations::SceneFolder {
 protected:
  enum class Outcome { refused, same, told, other };

  /// With the files that stand beside it.
  void take(const fs::path& model) {
    name_ = model.filename().string();
    text_ = text_of(model);
    for (const auto& entry : fs::directory_iterator(model.parent_path()))
      if (entry.path().extension() == ".yaml")
        write(entry.path().filename().string(), text_of(entry.path()));
    whole_ = read(name_, text_);
  }
  Outcome outcome(const std::string& text) {
    try {
      const Scene scene = read(name_, text);
      if (equations::difference(whole_, scene).empty())
        return scene.remarks == whole_.remarks ? Outcome::same : Outcome::told;
      return Outcome::other;
    } catch (const SceneError& error) {
      const std::string sentence = error.what();
      EXPECT_EQ(sentence.find('\n'), std::string::npos) << sentence;
      EXPECT_NE(sentence.find(name_), std::string::npos) << sentence;
      return Outcome::refused;
    }
  }
  std::string with(const Value& value, const std::string& now) const {
    std::string text = text_;
    return text.replace(value.at, value.length, now);
  }
  std::string name_, text_;
  Scene whole_;
};

TEST_F(MutatedModels, NumbersThatAreNoneAreRefusedOrHaveNoEffect) {
  int refused = 0;
  for (const fs::path& model : models()) {
    take(model);
    std::set<std::string> met;
    for (const Value& value : values_of(text_)) {
      const std::string before = text_.substr(value.at, value.length);
      if (!is_numbers(before) || !met.insert(value.key).second) continue;
      const std::string rest =
          before.find(' ') == before.npos ? "" : before.substr(before.find(' '));
      for (const std::string& now : {"nan" + rest, "1e400" + rest, "-inf" + rest,
                                     std::string("word"), std::string(), before + " 0x"}) {
        const Outcome found = outcome(with(value, now));
        refused += found == Outcome::refused;
        EXPECT_TRUE(found == Outcome::refused || found == Outcome::same)
            << model << ": " << value.key << " = '" << now << "', was '" << before << "'";
      }
    }
  }
  EXPECT_GT(refused, 1000);
}

// A name that no element has is told; what stands there twice is no XML.
TEST_F(MutatedModels, AttributesOfOtherNamesAreToldOrRefused) {
  for (const fs::path& model : models()) {
    take(model);
    std::set<std::string> met;
    for (const Value& value : values_of(text_)) {
      if (!met.insert(value.key).second) continue;
      std::string text = text_;
      text.insert(value.name_at, "x");
      const Outcome renamed = outcome(text);
      bool told = renamed == Outcome::refused || renamed == Outcome::told;
      if (renamed == Outcome::other) told = read(name_, text).remarks != whole_.remarks;
      EXPECT_TRUE(told || renamed == Outcome::same) << model << ": " << value.key << " renamed";
      text = text_;
      text.insert(value.name_at,
                  text_.substr(value.name_at, value.at + value.length + 1 - value.name_at) + " ");
      EXPECT_EQ(outcome(text), Outcome::refused) << model << ": " << value.key << " twice";
    }
  }
}

TEST_F(MutatedModels, QuantitiesOfTheOtherSignAreRefusedOrTold) {
  const std::set<std::string> positive{
      "mass value",    "inertia ixx",        "inertia iyy",        "inertia izz",
      "inertial mass", "joint armature",     "joint frictionloss", "geom mass",
      "geom density",  "joint springdamper", "default armature",   "dynamics friction"};
  int refused = 0;
  for (const fs::path& model : models()) {
    take(model);
    for (const Value& value : values_of(text_)) {
      const std::string before = text_.substr(value.at, value.length);
      if (!positive.contains(value.key) || std::atof(before.c_str()) == 0) continue;
      const Outcome found = outcome(with(value, "-" + before));
      refused += found == Outcome::refused;
      // Inertias that no body has are taken as they stand, and that is told.
      bool told = false;
      if (found == Outcome::other && value.key.starts_with("inertia "))
        for (const std::string& remark : read(name_, with(value, "-" + before)).remarks)
          told |= remark.starts_with("taken as written: inertias that no rigid body has");
      // Nor does a default that nothing takes.
      told |= found == Outcome::same && outcome(with(value, "0")) == Outcome::same;
      EXPECT_TRUE(found == Outcome::refused || told)
          << model << ": " << value.key << " = -" << before;
    }
  }
  EXPECT_GT(refused, 50);
}

}  // namespace
}  // namespace momenta::core_mutated_models
