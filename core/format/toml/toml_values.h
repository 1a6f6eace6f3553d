#pragma once
// TOML as plain values with their places. Only toml_values.cpp includes the parser, toml++.

#include <momenta/core/scene/scene.h>

#include <string>
#include <string_view>
#include <vector>

namespace momenta::reading {

struct Entry;

/// One TOML value; members of other types are empty.
struct Value {
  enum class Type { text, integer, number, boolean, date, time, date_time, array, table };
  Type type = Type::table;
  Location at;
  std::string text;            ///< text
  double number = 0;           ///< integer, number
  bool truth = false;          ///< boolean
  std::vector<Value> items;    ///< array
  std::vector<Entry> entries;  ///< table, in the order of the file
};

struct Entry {
  std::string key;
  Location at;
  Value value;
};

/// The value of a key of a table; null: none.
const Value* find(const Value& table, std::string_view key);
Value* find(Value& table, std::string_view key);

/// Whether a value is a number, whole or not.
bool is_number(const Value& value);

/// The type of a value in words, for "... is a string, expected ...".
std::string_view described(Value::Type type);

/// The root table of a TOML text. `file` only names it in messages.
/// @throws SceneError for text that is no UTF-8, no TOML, or beyond the limits of check_text.
Value parse_toml(std::string_view text, const std::string& file);

/// Refuses, before any parser, text that cannot be a scene:
///   - empty, over 64 MiB, not UTF-8, or holding NUL
///   - brackets nested, or keys dotted, more than 16 deep (a scene needs 3; the parser and the
///     destructors recurse over this depth)
///   - more than 4 million values, which bounds memory
///   - malformed in a way toml++ 3.3 meets with undefined behaviour: characters outside ASCII
///     outside strings and comments, table headers without a name, brackets that do not match
///
/// Cost O(size). @throws SceneError
void check_text(std::string_view text, const std::string& file);

}  // namespace momenta::reading
