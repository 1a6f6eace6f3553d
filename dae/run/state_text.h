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
  /// Table of a key; null: none.
  const Json* table(const std::string& key) const;
  /// Reads `size` numbers into `into`, from an array or a single number.
  void numbers(const Json& value, const std::string& where, std::size_t size, double* into) const;
  [[noreturn]] void fail(const std::string& sentence) const;
  /// Refuses a joint, or coordinate of formulas, not in the scene; `names`: those in it.
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
