#pragma once
// A STATE as text: JSON with values by joint name, from a file, from standard input ("-") or as the
// text itself.

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>

namespace momenta {

class StateText {
 public:
  using Json = nlohmann::json;

  /// `state`: a file, "-", or text that starts with "{". @throws SceneError: one sentence with the
  /// source, the key, what was found and what was expected
  StateText(const std::string& state, std::span<const std::string_view> keys);

  const Json& json() const { return json_; }
  double number(const Json& value, const std::string& where, const std::string& what) const;
  /// The table of a key: null where it is not there.
  const Json* table(const std::string& key) const;
  /// `size` numbers at `into`: an array, or one number where there is one.
  void numbers(const Json& value, const std::string& where, std::size_t size, double* into) const;
  [[noreturn]] void fail(const std::string& sentence) const;
  /// Says that a joint, or a coordinate of formulas, is not in the scene; `names`: those that are.
  [[noreturn]] void unknown_joint(const std::string& name, const std::string& key,
                                  std::span<const std::string_view> names,
                                  const std::string& word = "joint") const;

 private:
  Json parse(const std::string& text) const;
  std::string listed() const;

  std::string source_;
  std::span<const std::string_view> keys_;
  Json json_;
};

/// "key 'q', joint 'O'"
std::string place_in_state(const std::string& key, const std::string& joint);

}  // namespace momenta
