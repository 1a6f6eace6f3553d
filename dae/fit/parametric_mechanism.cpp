#include <momenta/core/scene/toml/toml_values.h>
#include <momenta/core/scene/toml/write_scene.h>
#include <momenta/core/text/near_name.h>
#include <momenta/dae/fit/parametric_mechanism.h>
#include <momenta/dae/linear/linearisation.h>

#include <algorithm>
#include <stdexcept>

namespace momenta {
namespace {

const ParameterSpec* parameter_of(const Scene& scene, const std::string& name) {
  const auto found = std::find_if(scene.parameters.begin(), scene.parameters.end(),
                                  [&](const ParameterSpec& p) { return p.name == name; });
  return found == scene.parameters.end() ? nullptr : &*found;
}

/// Where the line `at.line` has its character `at.column` [byte]; npos: nowhere.
std::size_t byte_of(const std::string& text, Location at) {
  std::size_t begin = 0;
  for (int line = 1; line < at.line; ++line) {
    begin = text.find('\n', begin);
    if (begin == std::string::npos) return begin;
    ++begin;
  }
  int column = 1;
  while (begin < text.size() && column < at.column) {
    ++begin;
    while (begin < text.size() && (static_cast<unsigned char>(text[begin]) & 0xC0U) == 0x80U)
      ++begin;
    ++column;
  }
  return at.column > 0 && begin < text.size() ? begin : std::string::npos;
}

/// The text with a number in the place of one that stands there, or of a formula in quotes.
bool put_number(std::string& text, Location at, double number) {
  const std::size_t begin = byte_of(text, at);
  if (begin == std::string::npos) return false;
  std::size_t end = begin;
  if (text[begin] == '"' || text[begin] == '\'') {
    end = text.find(text[begin], begin + 1);
    if (end == std::string::npos) return false;
    ++end;
  } else {
    end = text.find_first_of(" \t\r\n,}#", begin);
    if (end == std::string::npos) end = text.size();
  }
  text.replace(begin, end - begin, reading::digits(number));
  return true;
}

}  // namespace

ParametricMechanism::ParametricMechanism(std::string text, std::string file,
                                         std::vector<Setting> fixed, std::vector<std::string> names,
                                         MechanismOptions options)
    : text_(std::move(text)),
      file_(std::move(file)),
      fixed_(std::move(fixed)),
      names_(std::move(names)),
      options_(options) {
  const Scene own = parse_scene(text_, file_, fixed_);
  std::vector<std::string_view> known;
  for (const ParameterSpec& p : own.parameters) known.push_back(p.name);
  own_.resize(static_cast<Eigen::Index>(names_.size()));
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const ParameterSpec* p = parameter_of(own, names_[i]);
    if (!p) {
      const std::string near = reading::did_you_mean(names_[i], known);
      throw std::invalid_argument(
          reading::in_quotes(names_[i]) + ": the scene has no parameter of that name" +
          (!near.empty()   ? near
           : known.empty() ? ", expected a table [parameters] with numbers to vary"
                           : ", expected one of: " + reading::listed(known)));
    }
    if (std::count(names_.begin(), names_.end(), names_[i]) > 1)
      throw std::invalid_argument(reading::in_quotes(names_[i]) + " is varied twice");
    own_[static_cast<Eigen::Index>(i)] = p->value;
  }
}

std::vector<Setting> ParametricMechanism::settings(const Eigen::VectorXd& values) const {
  std::vector<Setting> all = fixed_;
  for (std::size_t i = 0; i < names_.size(); ++i)
    all.push_back({names_[i], values[static_cast<Eigen::Index>(i)]});
  return all;
}

Scene ParametricMechanism::scene(const Eigen::VectorXd& values) const {
  return parse_scene(text_, file_, settings(values));
}

std::unique_ptr<Mechanism> ParametricMechanism::at(const Eigen::VectorXd& values) const {
  return std::make_unique<Mechanism>(held_at_start(scene(values)), options_);
}

std::string ParametricMechanism::text(const Eigen::VectorXd& values) const {
  std::string text = text_;
  bool put = true;
  for (const Setting& setting : settings(values)) {
    const reading::Value root = reading::parse_toml(text, file_);
    const reading::Value* parameters = reading::find(root, "parameters");
    const reading::Value* value = parameters ? reading::find(*parameters, setting.place) : nullptr;
    put = put && value && put_number(text, value->at, setting.value);
  }
  // What was put in is read again: a text that does not say the same is written anew.
  const auto same = [&] {
    const Scene read = parse_scene(text, file_, {}), meant = scene(values);
    return std::equal(read.parameters.begin(), read.parameters.end(), meant.parameters.begin(),
                      meant.parameters.end(), [](const ParameterSpec& a, const ParameterSpec& b) {
                        return a.name == b.name && a.value == b.value;
                      });
  };
  try {
    if (put && same()) return text;
  } catch (const SceneError&) {  // no scene: written anew
  }
  return scene_text(scene(values));
}

}  // namespace momenta
