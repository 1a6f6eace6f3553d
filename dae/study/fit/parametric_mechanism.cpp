#include <momenta/core/format/toml/number_at.h>
#include <momenta/core/format/toml/write_scene.h>
#include <momenta/core/text/quoting.h>
#include <momenta/dae/analysis/linear/linearisation.h>
#include <momenta/dae/study/fit/parametric_mechanism.h>

#include <algorithm>
#include <stdexcept>

namespace momenta {
namespace {

/// Byte of character `at.column` of line `at.line`; npos: none.
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

/// Puts a number in place of the number, or formula in quotes, at `at`; false: none.
bool put_number(std::string& text, Location at, double number) {
  const std::size_t begin = byte_of(text, at);
  if (begin == std::string::npos) return false;
  std::size_t end = begin;
  if (text[begin] == '"' || text[begin] == '\'') {
    end = text.find(text[begin], begin + 1);
    if (end == std::string::npos) return false;
    ++end;
  } else {
    end = text.find_first_of(" \t\r\n,]}#", begin);
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
  own_.resize(static_cast<Eigen::Index>(names_.size()));
  for (std::size_t i = 0; i < names_.size(); ++i) {
    if (std::count(names_.begin(), names_.end(), names_[i]) > 1)
      throw std::invalid_argument(reading::in_quotes(names_[i]) +
                                  " is varied twice, expected each name once");
    own_[static_cast<Eigen::Index>(i)] = own_number(own, names_[i]);
  }
}

/// The number of a parameter, or at a place of the text.
double ParametricMechanism::own_number(const Scene& own, const std::string& name) const {
  std::vector<std::string_view> known;
  for (const ParameterSpec& p : own.parameters) {
    if (p.name == name) return p.value;
    known.push_back(p.name);
  }
  if (name.find('.') != std::string::npos) return numbers_of(text_, file_, fixed_)(name);
  const std::string near = reading::did_you_mean(name, known);
  throw std::invalid_argument(
      reading::in_quotes(name) + ": the scene has no parameter of that name" +
      (!near.empty()   ? near
       : known.empty() ? ", expected a number by its place, as in body.crank.mass, or a table "
                         "[parameters] with numbers to vary"
                       : ", expected one of: " + reading::listed(known)));
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
  for (const Setting& setting : settings(values)) try {
      put = put && put_number(text, location_of(text, file_, setting.place), setting.value);
    } catch (const std::invalid_argument&) {  // the text leaves it out
      put = false;
    }
  const std::string meant = scene_text(scene(values));
  // The text is read again: if it says something else it is written anew.
  try {
    if (put && scene_text(parse_scene(text, file_, {})) == meant) return text;
  } catch (const SceneError&) {  // no scene: written anew
  }
  return meant;
}

}  // namespace momenta
