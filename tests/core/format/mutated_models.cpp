// Models by others with one thing in them made wrong: every number not a number, too large, empty
// or a word; masses and the like of the other sign; attributes under another name or twice. Each
// reads to a sentence with file and line, or to the same scene as before: never to another
// mechanism in silence.

#include "equations/mutated_scene.h"

#include <algorithm>
#include <cstdlib>
#include <set>

namespace momenta::core_mutated_models {
namespace {

namespace fs = std::filesystem;
using equations::is_numbers;
using equations::Value;
using equations::values_of;

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

class MutatedModels : public equations::MutatedScene {
 protected:
  /// With the files that stand beside it.
  void take(const fs::path& model) {
    for (const auto& entry : fs::directory_iterator(model.parent_path()))
      if (entry.path().extension() == ".yaml")
        write(entry.path().filename().string(), equations::text_of(entry.path()));
    MutatedScene::take(model.filename().string(), equations::text_of(model));
  }
};

TEST_F(MutatedModels, NumbersThatAreNoneAreRefusedOrHaveNoEffect) {
  int refused_or_told = 0;
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
        // Of what is drawn alone, and of values that MuJoCo takes as not given.
        bool told = false;
        if (found == Outcome::told || found == Outcome::other)
          for (const std::string& remark : read(name_, with(value, now)).remarks)
            told |= remark.starts_with("not drawn: ") || remark.starts_with("taken as not given: ");
        refused_or_told += found == Outcome::refused || told;
        EXPECT_TRUE(found == Outcome::refused || found == Outcome::same || told)
            << model << ": " << value.key << " = '" << now << "', was '" << before << "'";
      }
    }
  }
  EXPECT_GT(refused_or_told, 1000);
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
