#include <momenta/core/scene/scene.h>
#include <momenta/core/text/quoting.h>
#include <momenta/dae/run/state_text.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <set>
#include <vector>

namespace momenta {
namespace {

using Json = nlohmann::json;

constexpr std::size_t largest_text = std::size_t{64} << 20;
constexpr int deepest = 4;  // a state has three levels

struct Source {
  std::string name, text;
};

std::string all_of(std::istream& in, const std::string& name) {
  std::string text;
  std::array<char, 65536> block;
  while (in.read(block.data(), block.size()), in.gcount() > 0) {
    text.append(block.data(), static_cast<std::size_t>(in.gcount()));
    if (text.size() > largest_text)
      throw SceneError(name + ": found more than 64 MiB, expected a state");
  }
  return text;
}

Source source_of(const std::string& state) {
  if (state.empty()) throw SceneError("--at: found nothing, expected a JSON file, - or a state");
  const auto first = state.find_first_not_of(" \t\r\n");
  if (first != std::string::npos && state[first] == '{') return {"--at", state};
  if (state == "-") return {"standard input", all_of(std::cin, "standard input")};
  const std::string name = reading::on_one_line(state);
  std::error_code trouble;
  const auto status = std::filesystem::status(state, trouble);
  if (std::filesystem::is_directory(status))
    throw SceneError(name + ": found a directory, expected a JSON file with a state");
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    throw SceneError(name + ": found a pipe or a device, expected a JSON file with a state, or -");
  std::ifstream in(state, std::ios::binary);
  if (!in)
    throw SceneError(name +
                     ": the file cannot be opened, expected a JSON file, -, or a state "
                     "that starts with {");
  return {name, all_of(in, name)};
}

/// "an array of 2", "the number 1.5".
std::string found(const Json& value) {
  if (value.is_array()) return "an array of " + std::to_string(value.size());
  if (value.is_object()) return "an object";
  if (value.is_string())
    return "the string " + reading::in_quotes(value.get_ref<const std::string&>());
  if (value.is_number()) return "the number " + reading::digits(value.get<double>());
  if (value.is_boolean()) return value.get<bool>() ? "true" : "false";
  return "null";
}

}  // namespace

StateText::StateText(const std::string& state, std::span<const std::string_view> keys)
    : keys_(keys) {
  Source source = source_of(state);
  source_ = std::move(source.name);
  json_ = parse(source.text);
  if (!json_.is_object()) fail("found " + found(json_) + ", expected an object with " + listed());
  for (const auto& [key, value] : json_.items())
    if (std::find(keys_.begin(), keys_.end(), key) == keys_.end()) {
      std::string which = reading::did_you_mean(key, keys_);
      which = "; expected " + listed() + which;
      fail("key " + reading::in_quotes(key) + " is not known" + which);
    }
}

void StateText::fail(const std::string& sentence) const {
  throw SceneError(source_ + ": " + sentence);
}

std::string StateText::listed() const {
  return reading::listed(keys_);
}

/// The text as JSON; keys written twice are refused, since only one of the two would count.
Json StateText::parse(const std::string& text) const {
  std::vector<std::set<std::string>> seen;
  const auto watch = [&](int depth, Json::parse_event_t event, Json& value) {
    const auto level = static_cast<std::size_t>(depth);
    if (depth > deepest) fail("found values nested deeper than a state, expected " + listed());
    if (event == Json::parse_event_t::object_start) {
      seen.resize(level + 2);
      seen[level + 1].clear();
    } else if (event == Json::parse_event_t::key) {
      const auto& key = value.get_ref<const std::string&>();
      if (!seen[level].insert(key).second)
        fail("key " + reading::in_quotes(key) + " stands twice, expected once");
    }
    return true;
  };
  try {
    return Json::parse(text, watch);
  } catch (const Json::parse_error& e) {
    const std::size_t at = std::min(e.byte > 0 ? e.byte - 1 : 0, text.size());
    const std::string before = text.substr(0, at);
    const auto line = std::count(before.begin(), before.end(), '\n') + 1;
    const std::size_t column = at - (before.rfind('\n') + 1) + 1;  // npos + 1 = 0
    throw SceneError(source_ + ":" + std::to_string(line) + ":" + std::to_string(column) +
                     ": the text is not JSON from here on, expected an object with " + listed());
  } catch (const Json::out_of_range&) {
    fail("a number is too large for a double, expected finite numbers");
  }
}

double StateText::number(const Json& value, const std::string& where,
                         const std::string& what) const {
  if (!value.is_number()) fail(where + ": found " + found(value) + ", expected " + what);
  const double x = value.get<double>();
  if (!std::isfinite(x)) fail(where + ": the number is not finite, expected " + what);
  return x;
}

const Json* StateText::table(const std::string& key) const {
  if (!json_.contains(key)) return nullptr;
  const Json& table = json_[key];
  if (!table.is_object())
    fail("key '" + key + "': found " + found(table) + ", expected an object of joint names");
  return &table;
}

void StateText::numbers(const Json& value, const std::string& where, std::size_t size,
                        double* into) const {
  const std::string expected = size == 1 ? "1 number" : std::to_string(size) + " numbers";
  const bool array = value.is_array();
  if (array ? value.size() != size : size != 1 || !value.is_number())
    fail(where + ": found " + found(value) + ", expected " + expected);
  for (std::size_t i = 0; i < size; ++i)
    into[i] = number(array ? value[i] : value, where, expected);
}

void StateText::unknown_joint(const std::string& name, const std::string& key,
                              std::span<const std::string_view> names,
                              const std::string& word) const {
  std::string which = reading::did_you_mean(name, names);
  which = "; expected a " + word + " of the scene" + which;
  fail("key '" + key + "': " + word + " " + reading::in_quotes(name) + " is not in the scene" +
       which);
}

std::string place_in_state(const std::string& key, const std::string& joint) {
  return "key '" + key + "', joint " + reading::in_quotes(joint);
}

}  // namespace momenta
