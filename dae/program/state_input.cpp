#include "state_input.h"

#include <momenta/core/scene/near_name.h>
#include <momenta/dae/joint_places.h>
#include <momenta/dae/measure/drive_reach.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

namespace momenta::program {
namespace {

using Json = nlohmann::json;
using reading::digits;
using reading::in_quotes;

constexpr std::size_t largest_text = std::size_t{64} << 20;
constexpr int deepest = 4;           // a state has three levels
constexpr double norm_slack = 1e-6;  // of quaternions
constexpr std::array<std::string_view, 5> keys = {"t", "q", "v", "p", "tau"};

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
  if (std::filesystem::is_directory(state, trouble))
    throw SceneError(name + ": found a directory, expected a JSON file with a state");
  std::ifstream in(state, std::ios::binary);
  if (!in)
    throw SceneError(name +
                     ": the file cannot be opened, expected a JSON file, -, or a state "
                     "that starts with {");
  return {name, all_of(in, name)};
}

/// "found 2 numbers", in the words of a reader.
std::string found(const Json& value) {
  if (value.is_array()) return "an array of " + std::to_string(value.size());
  if (value.is_object()) return "an object";
  if (value.is_string()) return "the string " + in_quotes(value.get_ref<const std::string&>());
  if (value.is_number()) return "the number " + digits(value.get<double>());
  if (value.is_boolean()) return value.get<bool>() ? "true" : "false";
  return "null";
}

class StateReader {
 public:
  StateReader(const Mechanism& mechanism, const Source& source)
      : mechanism_(mechanism), source_(source), places_(joint_places(mechanism.tree())) {
    for (const JointPlace& joint : places_) by_name_[joint.name] = &joint;
  }

  GivenState read() {
    const Json json = parse();
    if (!json.is_object()) fail("found " + found(json) + ", expected an object with " + listed());
    for (const auto& [key, value] : json.items())
      if (std::find(keys.begin(), keys.end(), key) == keys.end()) unknown_key(key);
    if (json.contains("v") && json.contains("p"))
      fail("found both 'v' and 'p', expected one of them: each follows from the other");
    GivenState state;
    if (json.contains("t")) state.t = number(json["t"], "key 't'", "a time [s]");
    const Values q = values(json, "q", true), v = values(json, "v", false),
                 p = values(json, "p", false), tau = values(json, "tau", false);
    state.of_momenta = json.contains("p");
    const bool all_rates = state.of_momenta ? p.complete() : v.complete();
    start(state, !q.complete() || !all_rates);
    q.put(state.q);
    v.put(state.v);
    state.p = Eigen::VectorXd::Zero(mechanism_.nv());
    p.put(state.p);
    state.p_given = p.given;
    state.tau = Eigen::VectorXd::Zero(mechanism_.nv());
    tau.put(state.tau);
    unit_quaternions(state.q, q.given);
    return state;
  }

 private:
  struct Values {
    Eigen::VectorXd number;
    std::vector<bool> given;
    bool complete() const { return std::find(given.begin(), given.end(), false) == given.end(); }
    void put(Eigen::VectorXd& into) const {
      for (std::size_t i = 0; i < given.size(); ++i)
        if (given[i]) into[static_cast<Eigen::Index>(i)] = number[static_cast<Eigen::Index>(i)];
    }
  };

  [[noreturn]] void fail(const std::string& sentence) const {
    throw SceneError(source_.name + ": " + sentence);
  }
  [[noreturn]] void unknown_key(const std::string& key) const {
    std::string which = reading::did_you_mean(key, keys);
    if (which.empty()) which = "; expected " + listed();
    fail("key " + in_quotes(key) + " is not known" + which);
  }
  static std::string listed() { return reading::listed(keys); }

  /// The text as JSON; keys written twice are refused, since only one of the two would count.
  Json parse() const {
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
          fail("key " + in_quotes(key) + " stands twice, expected once");
      }
      return true;
    };
    try {
      return Json::parse(source_.text, watch);
    } catch (const Json::parse_error& e) {
      const std::size_t at = std::min(e.byte > 0 ? e.byte - 1 : 0, source_.text.size());
      const std::string before = source_.text.substr(0, at);
      const auto line = std::count(before.begin(), before.end(), '\n') + 1;
      const std::size_t column = at - (before.rfind('\n') + 1) + 1;  // npos + 1 = 0
      throw SceneError(source_.name + ":" + std::to_string(line) + ":" + std::to_string(column) +
                       ": the text is not JSON from here on, expected an object with " + listed());
    } catch (const Json::out_of_range&) {
      fail("a number is too large for a double, expected finite numbers");
    }
  }

  double number(const Json& value, const std::string& where, const std::string& what) const {
    if (!value.is_number()) fail(where + ": found " + found(value) + ", expected " + what);
    const double x = value.get<double>();
    if (!std::isfinite(x)) fail(where + ": the number is not finite, expected " + what);
    return x;
  }

  const JointPlace& joint(const std::string& name, const std::string& key) const {
    if (const auto it = by_name_.find(name); it != by_name_.end()) return *it->second;
    std::vector<std::string_view> names;
    for (const JointPlace& place : places_) names.push_back(place.name);
    std::string which = reading::did_you_mean(name, names);
    if (which.empty()) which = "; expected a joint of the scene";
    fail("key '" + key + "': joint " + in_quotes(name) + " is not in the scene" + which);
  }

  Values values(const Json& json, const std::string& key, bool coordinates) const {
    const int size = coordinates ? mechanism_.nq() : mechanism_.nv();
    Values all{Eigen::VectorXd::Zero(size), std::vector<bool>(static_cast<std::size_t>(size))};
    if (!json.contains(key)) return all;
    const Json& table = json[key];
    if (!table.is_object())
      fail("key '" + key + "': found " + found(table) + ", expected an object of joint names");
    for (const auto& [name, value] : table.items()) {
      const JointPlace& place = joint(name, key);
      const std::string where = "key '" + key + "', joint " + in_quotes(name);
      const std::vector<int>& to = coordinates ? place.q : place.u;
      if (to.empty())
        fail(where + (place.drives.empty() ? ": the joint has no coordinates, expected no value"
                                           : ": the joint is driven, expected no value: t alone "
                                             "moves it"));
      const std::string expected =
          to.size() == 1 ? "1 number" : std::to_string(to.size()) + " numbers";
      const bool array = value.is_array();
      if (array ? value.size() != to.size() : to.size() != 1 || !value.is_number())
        fail(where + ": found " + found(value) + ", expected " + expected);
      for (std::size_t i = 0; i < to.size(); ++i) {
        all.number[to[i]] = number(array ? value[i] : value, where, expected);
        all.given[static_cast<std::size_t>(to[i])] = true;
      }
    }
    return all;
  }

  void start(GivenState& state, bool needed) const {
    state.q = mechanism_.tree().q0;
    state.v = mechanism_.tree().u0;
    if (mechanism_.m() == 0 || !needed) return;
    const Assembly assembly = assemble_at(mechanism_, state.t);
    state.q = assembly.start.q;
    state.v = assembly.start.u;
  }

  void unit_quaternions(Eigen::VectorXd& q, const std::vector<bool>& given) const {
    for (const JointPlace& place : places_)
      for (const int at : place.quaternions) {
        if (!given[static_cast<std::size_t>(at)]) continue;
        const double norm = q.segment<4>(at).norm();
        if (!(std::abs(norm - 1) <= norm_slack))
          fail("key 'q', joint " + in_quotes(place.name) + ": found a quaternion of norm " +
               digits(norm) + ", expected 1 within 1e-6");
        q.segment<4>(at) /= norm;
      }
  }

  const Mechanism& mechanism_;
  const Source& source_;
  std::vector<JointPlace> places_;
  std::map<std::string, const JointPlace*> by_name_;
};

}  // namespace

GivenState read_state(const std::string& state, const Mechanism& mechanism) {
  const Source source = source_of(state);
  return StateReader(mechanism, source).read();
}

}  // namespace momenta::program
