#pragma once
// Models with one thing in them made wrong, and what becomes of them: a sentence with file and
// line, the same scene as before, the same with other remarks, or another scene.

#include "equations/output_of.h"
#include "equations/same_scene.h"
#include "equations/scene_folder.h"

#include <regex>
#include <sstream>
#include <string>
#include <vector>

namespace momenta::equations {

/// An attribute in a text: of which element, and where its value stands.
struct Value {
  std::string key;  ///< "joint axis"
  std::size_t at = 0, name_at = 0, length = 0;
};

/// All attributes of the elements of a text, its comments left out.
inline std::vector<Value> values_of(const std::string& text) {
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

inline bool is_numbers(const std::string& text) {
  std::istringstream in(text);
  double x;
  int count = 0;
  while (in >> x) ++count;
  return count > 0 && in.eof();
}

/// One model in a folder of its own, read again and again with another text.
class MutatedScene : public SceneFolder {
 protected:
  enum class Outcome { refused, same, told, other };

  /// `name`, with what has been written beside it.
  void take(const std::string& name, const std::string& text) {
    name_ = name;
    text_ = text;
    whole_ = read(name_, text_);
  }
  /// Of the model where `file`, it or one beside it, has this text.
  Outcome outcome(const std::string& file, const std::string& text) {
    const auto there = write(file, text).parent_path();
    try {
      const Scene scene = read_scene(there / name_);
      if (difference(whole_, scene).empty())
        return scene.remarks == whole_.remarks ? Outcome::same : Outcome::told;
      return Outcome::other;
    } catch (const SceneError& error) {
      const std::string sentence = error.what();
      EXPECT_EQ(sentence.find('\n'), std::string::npos) << sentence;
      EXPECT_NE(sentence.find(file), std::string::npos) << sentence;
      return Outcome::refused;
    }
  }
  Outcome outcome(const std::string& text) { return outcome(name_, text); }
  std::string with(const Value& value, const std::string& now) const {
    std::string text = text_;
    return text.replace(value.at, value.length, now);
  }
  std::string name_, text_;
  Scene whole_;
};

}  // namespace momenta::equations
