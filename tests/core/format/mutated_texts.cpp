// Files whose meaning stands in texts, not in attributes: SDF and the YAML file beside a URDF, with
// one thing in them made wrong. As in core/format/mutated_models.cpp: a sentence with file and
// line, or the same scene as before; never another mechanism in silence.

#include "equations/mutated_scene.h"

#include <algorithm>
#include <set>

namespace momenta::core_mutated_texts {
namespace {

using equations::MutatedScene;
using equations::text_of;

constexpr const char* sdf_text = R"(<?xml version='1.0'?>
<sdf version='1.9'>
  <world name='w'>
    <gravity>0 0 -9.81</gravity>
    <model name='m'>
      <pose>0.1 0 1 0 0 0.2</pose>
      <frame name='hip' attached_to='a'><pose>0 0.1 0 0.3 0 0</pose></frame>
      <link name='a'>
        <pose>0.1 0.2 0.3 0.3 -0.2 0.4</pose>
        <inertial>
          <pose>0.1 0.2 0.3 0 0 0.1</pose>
          <mass>2</mass>
          <inertia><ixx>0.1</ixx><iyy>0.2</iyy><izz>0.25</izz><ixy>0.01</ixy></inertia>
        </inertial>
        <visual name='v'>
          <pose>0 0 0.1 0 0 0</pose>
          <geometry><box><size>0.1 0.2 0.3</size></box></geometry>
        </visual>
      </link>
      <link name='b'>
        <pose relative_to='a'>0.5 0.1 -0.3 0.2 0.6 -0.1</pose>
        <inertial>
          <mass>3</mass>
          <inertia><ixx>0.3</ixx><iyy>0.2</iyy><izz>0.15</izz></inertia>
        </inertial>
      </link>
      <link name='c'>
        <pose relative_to='hip'>0.2 0.1 0.3 0 0 0</pose>
        <inertial>
          <mass>1.5</mass>
          <inertia><ixx>0.2</ixx><iyy>0.2</iyy><izz>0.15</izz></inertia>
        </inertial>
      </link>
      <joint name='i' type='revolute'>
        <parent>world</parent>
        <child>a</child>
        <axis>
          <xyz>0 1 0</xyz>
          <limit><lower>-1.5</lower><upper>2.5</upper></limit>
          <dynamics>
            <damping>0.7</damping>
            <spring_stiffness>3</spring_stiffness>
            <spring_reference>0.2</spring_reference>
          </dynamics>
        </axis>
      </joint>
      <joint name='j' type='universal'>
        <parent>a</parent>
        <child>b</child>
        <axis><xyz>1 2 2</xyz></axis>
        <axis2><xyz>0 1 1</xyz></axis2>
      </joint>
      <joint name='k' type='screw'>
        <pose>0.1 0 0 0 0 0.5</pose>
        <parent>hip</parent>
        <child>c</child>
        <axis><xyz expressed_in='hip'>0 0 1</xyz></axis>
        <screw_thread_pitch>0.5</screw_thread_pitch>
      </joint>
      <joint name='close' type='ball'><parent>b</parent><child>c</child></joint>
    </model>
  </world>
</sdf>
)";

/// An element without others in it.
struct Leaf {
  std::string key;                   ///< "axis/xyz"
  std::size_t from = 0, to = 0;      ///< the whole of it
  std::size_t text = 0, length = 0;  ///< what stands in it
  std::size_t name_at = 0, closing_name_at = 0;
};

std::vector<Leaf> leaves_of(const std::string& xml) {
  std::vector<Leaf> all;
  const std::regex leaf(R"(<([A-Za-z_:]\w*)[^<>]*>([^<>]*)</\1>)");
  for (std::sregex_iterator i(xml.begin(), xml.end(), leaf), none; i != none; ++i) {
    const auto at = [&](std::size_t group) { return static_cast<std::size_t>(i->position(group)); };
    const auto size = [&](std::size_t group) { return static_cast<std::size_t>(i->length(group)); };
    all.push_back({(*i)[1].str(), at(0), at(0) + size(0), at(2), size(2), at(1),
                   at(0) + size(0) - size(1) - 1});
  }
  return all;
}

class MutatedSdf : public MutatedScene {
 protected:
  MutatedSdf() { take("m.sdf", sdf_text); }
  std::string replaced(std::size_t at, std::size_t length, const std::string& now) const {
    std::string text = text_;
    return text.replace(at, length, now);
  }
  /// Refused; or, where nothing but pictures depends on it, not drawn and told.
  bool refused_or_not_drawn(const std::string& text) {
    if (outcome(text) == Outcome::refused) return true;
    const auto remarks = read(name_, text).remarks;
    return std::any_of(remarks.begin(), remarks.end(),
                       [](const std::string& remark) { return remark.starts_with("not drawn: "); });
  }
};

TEST_F(MutatedSdf, TextsThatAreNoNumbersOrNamesAreRefused) {
  const auto leaves = leaves_of(text_);
  ASSERT_GT(leaves.size(), 40u);
  for (const Leaf& leaf : leaves) {
    const std::string before = text_.substr(leaf.text, leaf.length);
    const std::string rest = before.find(' ') == before.npos ? "" : before.substr(before.find(' '));
    std::vector<std::string> wrong{"word", before + " 0x"};
    if (equations::is_numbers(before))
      for (const char* number : {"nan", "1e400", leaf.key == "lower" ? "inf" : "-inf"})
        wrong.push_back(number + rest);
    if (!rest.empty()) wrong.push_back(rest);
    if (leaf.key != "pose" && leaf.key != "gravity") wrong.emplace_back();
    for (const std::string& now : wrong)
      EXPECT_TRUE(refused_or_not_drawn(replaced(leaf.text, leaf.length, now)))
          << leaf.key << " = '" << now << "', was '" << before << "'";
  }
}

TEST_F(MutatedSdf, ElementsOfOtherNamesAreToldOrRefusedAndNoneIsThereTwice) {
  for (const Leaf& leaf : leaves_of(text_)) {
    std::string text = text_;
    text.insert(leaf.closing_name_at, "x").insert(leaf.name_at, "x");
    const Outcome renamed = outcome(text);
    const bool told = renamed == Outcome::refused || renamed == Outcome::told ||
                      (renamed == Outcome::other && read(name_, text).remarks != whole_.remarks);
    EXPECT_TRUE(told) << leaf.key << " renamed";
    text = text_;
    text.insert(leaf.to, text_.substr(leaf.from, leaf.to - leaf.from));
    EXPECT_TRUE(refused_or_not_drawn(text)) << leaf.key << " twice";
  }
}

TEST_F(MutatedSdf, AttributesAreRefusedOrTold) {
  for (const equations::Value& value : equations::values_of(text_)) {
    std::string text = text_;
    text.insert(value.name_at, "x");
    const Outcome renamed = outcome(text);
    const bool told = renamed == Outcome::refused || renamed == Outcome::told ||
                      (renamed == Outcome::other && read(name_, text).remarks != whole_.remarks);
    EXPECT_TRUE(told || value.key.ends_with("version")) << value.key << " renamed";
    if (value.key.ends_with(" name")) continue;
    EXPECT_EQ(outcome(with(value, "nothing of that name")), Outcome::refused) << value.key;
  }
}

TEST_F(MutatedSdf, QuantitiesOfTheOtherSignAreRefusedOrTold) {
  const std::set<std::string> positive{"mass", "ixx", "iyy", "izz"};
  for (const Leaf& leaf : leaves_of(text_)) {
    if (!positive.contains(leaf.key)) continue;
    const std::string text =
        replaced(leaf.text, leaf.length, "-" + text_.substr(leaf.text, leaf.length));
    const Outcome found = outcome(text);
    EXPECT_TRUE(found == Outcome::refused ||
                (found == Outcome::other && read(name_, text).remarks != whole_.remarks))
        << leaf.key;
  }
}

TEST_F(MutatedSdf, ATextThatEndsAnywhereIsRefused) {
  for (std::size_t length = 0; length + 2 < text_.size(); length += 7)
    EXPECT_EQ(outcome(text_.substr(0, length)), Outcome::refused) << length;
}

/// Files beside URDFs: those of the models, and one that changes joints.
class MutatedYaml : public MutatedScene {
 protected:
  struct Beside {
    std::string urdf, yaml;
  };
  static std::vector<Beside> all() {
    std::vector<Beside> found;
    const std::filesystem::path models =
        std::filesystem::path(MOMENTA_SOURCE_DIR) / "examples" / "models";
    for (const auto& entry : std::filesystem::recursive_directory_iterator(models))
      if (entry.path().extension() == ".yaml")
        found.push_back({text_of(std::filesystem::path(entry.path()).replace_extension("urdf")),
                         text_of(entry.path())});
    std::string urdf = "<robot name='r'><link name='world'/>";
    for (const char* name : {"a", "b", "c", "d"})
      urdf += std::string("<link name='") + name +
              "'><inertial><origin xyz='0.1 0.2 0.3'/><mass value='2'/>"
              "<inertia ixx='0.1' iyy='0.2' izz='0.25'/></inertial></link>";
    for (const char* joint : {"i world a", "j a b", "k b c", "l a d"}) {
      std::istringstream words(joint);
      std::string name, parent, child;
      words >> name >> parent >> child;
      urdf += "<joint name='" + name + "' type='continuous'><parent link='" + parent +
              "'/><child link='" + child + "'/><origin xyz='0.3 -0.2 0.5'/><axis xyz='0 1 0'/>" +
              "</joint>";
    }
    found.push_back({urdf + "</robot>",
                     "joint_name: [j, k]\njoint_type: [SPHERICAL, 'UJOINT_XZ']\n"
                     "closed_loop: [[k, l]]\ntype: ['3d']\nname_mot: [i, \"l\"]\n"});
    return found;
  }
  void take(const Beside& beside) {
    yaml_ = beside.yaml;
    write("r.yaml", yaml_);
    MutatedScene::take("r.urdf", beside.urdf);
  }
  /// Its words: keys and entries, quotes left out.
  std::vector<std::pair<std::size_t, std::size_t>> words() const {
    std::vector<std::pair<std::size_t, std::size_t>> found;
    const std::regex word(R"([\w]+)");
    for (std::sregex_iterator i(yaml_.begin(), yaml_.end(), word), none; i != none; ++i)
      found.emplace_back(i->position(0), i->length(0));
    return found;
  }
  std::string replaced(std::pair<std::size_t, std::size_t> place, const std::string& now) const {
    std::string text = yaml_;
    return text.replace(place.first, place.second, now);
  }
  std::string yaml_;
};

TEST_F(MutatedYaml, WordsThatNameNothingAreRefused) {
  for (const Beside& beside : all()) {
    take(beside);
    for (const auto& place : words())
      for (const std::string& now :
           {std::string("nothing"), std::string("nan"), std::string("~"), std::string("1e400"),
            "[" + yaml_.substr(place.first, place.second) + "]", std::string("{a: b}"),
            std::string("*nowhere"), "x" + yaml_.substr(place.first, place.second)})
        EXPECT_EQ(outcome("r.yaml", replaced(place, now)), Outcome::refused)
            << replaced(place, now);
  }
}

// An entry less or more, where another list has as many.
TEST_F(MutatedYaml, EntriesAreNeitherLeftOutNorDoubledInSilence) {
  for (const Beside& beside : all()) {
    take(beside);
    for (const auto& place : words()) {
      const std::string word = yaml_.substr(place.first, place.second);
      const bool key = yaml_[place.first + place.second] == ':';
      if (key) continue;
      // Quotes go with the word.
      const bool quoted =
          place.first > 0 && (yaml_[place.first - 1] == '\'' || yaml_[place.first - 1] == '"');
      const std::pair whole{place.first - quoted, place.second + 2 * quoted};
      const std::string entry = yaml_.substr(whole.first, whole.second);
      for (const std::string& now : {std::string(), entry + ", " + entry}) {
        const Outcome found = outcome("r.yaml", replaced(whole, now));
        const bool motor = yaml_.rfind("name_mot", place.first) != yaml_.npos &&
                           yaml_.find('\n', yaml_.rfind("name_mot", place.first)) > place.first;
        EXPECT_TRUE(found == Outcome::refused || (motor && found == Outcome::told))
            << replaced(whole, now);
      }
    }
  }
}

TEST_F(MutatedYaml, KeysStandThereOnce) {
  for (const Beside& beside : all()) {
    take(beside);
    std::istringstream lines(yaml_);
    for (std::string line; std::getline(lines, line);)
      EXPECT_EQ(outcome("r.yaml", yaml_ + (yaml_.ends_with('\n') ? "" : "\n") + line + "\n"),
                Outcome::refused)
          << line;
  }
}

TEST_F(MutatedYaml, ATextThatEndsInAListIsRefused) {
  for (const Beside& beside : all()) {
    take(beside);
    for (std::size_t length = 0; length < yaml_.size(); ++length) {
      const std::string text = yaml_.substr(0, length);
      const auto depth =
          std::count(text.begin(), text.end(), '[') - std::count(text.begin(), text.end(), ']');
      if (depth > 0) {
        EXPECT_EQ(outcome("r.yaml", text), Outcome::refused) << text;
      }
    }
  }
}

}  // namespace
}  // namespace momenta::core_mutated_texts
