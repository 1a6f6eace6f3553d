#include <momenta/core/format/toml/toml_values.h>
#include <momenta/core/scene/file_text.h>
#include <momenta/core/text/quoting.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace momenta::reading {
[[noreturn]] static void parser_lost() {
  throw std::logic_error("malformed beyond what the parser can tell");
}
}  // namespace momenta::reading

// toml++ is compiled here alone: the installed library needs no further one. Its assertions throw,
// as some fail on malformed text ("[&"); check_text reports known ones with their place.
#undef NDEBUG
#undef TOML_HEADER_ONLY
#undef TOML_SHARED_LIB
#define TOML_HEADER_ONLY 1
#define TOML_ASSERT(condition) \
  (static_cast<bool>(condition) ? void() : ::momenta::reading::parser_lost())
#include <toml++/toml.h>

namespace momenta::reading {
namespace {

Location place(const toml::source_region& source) {
  return {static_cast<int>(source.begin.line), static_cast<int>(source.begin.column)};
}

bool before(Location a, Location b) {
  return a.line != b.line ? a.line < b.line : a.column < b.column;
}

/// Copies a node. Recursion depth is that of the text, bounded by check_text. `otherwise`: place of
/// the key, for tables without text of their own (dotted keys).
Value copied(const toml::node& node, Location otherwise) {
  Value value;
  value.at = node.source().begin.line > 0 ? place(node.source()) : otherwise;
  switch (node.type()) {
    case toml::node_type::string:
      value.type = Value::Type::text;
      value.text = node.as_string()->get();
      break;
    case toml::node_type::integer:
      value.type = Value::Type::integer;
      value.number = static_cast<double>(node.as_integer()->get());
      break;
    case toml::node_type::floating_point:
      value.type = Value::Type::number;
      value.number = node.as_floating_point()->get();
      break;
    case toml::node_type::date:
      value.type = Value::Type::date;
      break;
    case toml::node_type::time:
      value.type = Value::Type::time;
      break;
    case toml::node_type::date_time:
      value.type = Value::Type::date_time;
      break;
    case toml::node_type::array:
      value.type = Value::Type::array;
      value.items.reserve(node.as_array()->size());
      for (const toml::node& item : *node.as_array()) value.items.push_back(copied(item, value.at));
      break;
    case toml::node_type::table:
      value.type = Value::Type::table;
      value.entries.reserve(node.as_table()->size());
      for (const auto& [key, item] : *node.as_table()) {
        const Location at = place(key.source());
        value.entries.push_back({std::string(key.str()), at, copied(item, at)});
      }
      // toml++ sorts by key; messages should be on the first mistake in the file
      std::sort(value.entries.begin(), value.entries.end(),
                [](const Entry& a, const Entry& b) { return before(a.at, b.at); });
      break;
    default:
      value.type = Value::Type::boolean;
      value.truth = node.value_or(false);
      break;
  }
  return value;
}

}  // namespace

const Value* find(const Value& table, std::string_view key) {
  for (const Entry& entry : table.entries)
    if (entry.key == key) return &entry.value;
  return nullptr;
}

Value* find(Value& table, std::string_view key) {
  return const_cast<Value*>(find(std::as_const(table), key));
}

bool is_number(const Value& value) {
  return value.type == Value::Type::number || value.type == Value::Type::integer;
}

std::string_view described(Value::Type type) {
  switch (type) {
    case Value::Type::text:
      return "a string";
    case Value::Type::integer:
      return "a whole number";
    case Value::Type::number:
      return "a number";
    case Value::Type::boolean:
      return "a boolean";
    case Value::Type::date:
      return "a date";
    case Value::Type::time:
      return "a time of day";
    case Value::Type::date_time:
      return "a date and time";
    case Value::Type::array:
      return "an array";
    case Value::Type::table:
      return "a table";
  }
  return "something else";
}

namespace {

/// The sentence of toml++, with what was expected where it does not say so.
std::string in_words(std::string_view said) {
  return "not valid TOML: " + on_one_line(said) +
         (said.find("expected") == said.npos ? ", expected key = value, [table] or [[table]]" : "");
}

}  // namespace

Value parse_toml(std::string_view text, const std::string& file) {
  check_text(text, file);
  try {
    return copied(toml::parse(text), {1, 1});
  } catch (const toml::parse_error& error) {
    fail(file, place(error.source()), in_words(error.description()));
  } catch (const SceneError&) {
    throw;
  } catch (const std::exception& error) {
    fail(file, {}, in_words(error.what()));
  }
}

}  // namespace momenta::reading
