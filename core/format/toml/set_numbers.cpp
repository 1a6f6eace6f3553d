#include <momenta/core/expression/expression.h>
#include <momenta/core/format/toml/number_at.h>
#include <momenta/core/format/toml/parameters.h>
#include <momenta/core/format/toml/set_numbers.h>
#include <momenta/core/text/quoting.h>

#include <algorithm>
#include <charconv>
#include <memory>
#include <stdexcept>

namespace momenta::reading {
namespace {

std::string_view name_of(Value& table) {
  const Value* name = find(table, "name");
  return name && name->type == Value::Type::text ? std::string_view(name->text) : "";
}

/// A place among a scene's values, followed key by key.
class Way {
 public:
  explicit Way(const Setting& setting) : setting_(setting), rest_(setting.place) {}

  void set(Value& root) {
    Value& at = find_in(root);
    at.type = Value::Type::number;
    at.number = setting_.value;
  }

  /// The number at the place, or its formula; a missing key is added.
  Value& find_in(Value& root) {
    Value* at = &root;
    if (Value* parameters = find(root, "parameters");
        parameters && parameters->type == Value::Type::table && rest_.find('.') == rest_.npos &&
        !find(root, rest_)) {
      if (!find(*parameters, rest_)) no_parameter(*parameters);
      at = parameters;
    }
    while (!rest_.empty()) {
      if (at->type == Value::Type::array)
        at = is_list_of_tables(*at) ? &named(*at) : &element(*at);
      else if (at->type == Value::Type::table)
        at = &member(*at);
      else
        refuse("a number", at->type);
    }
    const bool formula = at->type == Value::Type::text && is_formula(root, at->text);
    if (!is_number(*at) && !formula) refuse("more keys", at->type);
    return *at;
  }
  /// @throws std::invalid_argument where the key was added
  void expect_there() const {
    if (added_) fail("the scene leaves it out, expected a number that it has");
  }

 private:
  /// Whether a text may stand for a number; other texts are names and words.
  static bool is_formula(Value& root, const std::string& text) {
    std::vector<std::string> names;
    if (const Value* parameters = find(root, "parameters"))
      for (const Entry& e : parameters->entries) names.push_back(e.key);
    try {
      (void)Expression(text, names);
      return true;
    } catch (const ExpressionError&) {
      return false;
    }
  }
  [[noreturn]] void no_parameter(const Value& parameters) const {
    std::vector<std::string_view> names;
    for (const Entry& e : parameters.entries) names.push_back(e.key);
    const std::string near = did_you_mean(rest_, names);
    fail("the scene has no parameter of that name" + (!near.empty() ? near
                                                      : names.empty()
                                                          ? ", expected numbers in [parameters]"
                                                          : ", expected one of: " + listed(names)));
  }
  static bool is_list_of_tables(const Value& v) {
    return !v.items.empty() && v.items.front().type == Value::Type::table;
  }
  [[noreturn]] void fail(const std::string& sentence) const {
    throw std::invalid_argument("'" + setting_.place + "': " + sentence);
  }
  [[noreturn]] void refuse(const std::string& expected, Value::Type found) const {
    fail(std::string(taken()) + " is " + std::string(described(found)) + ", expected " +
         (rest_.empty() ? expected + " after it" : "nothing after it"));
  }
  std::string_view taken() const {
    std::string_view all = setting_.place;
    all.remove_suffix(rest_.size());
    if (all.ends_with('.')) all.remove_suffix(1);
    return all;
  }
  std::string_view next() {
    const std::size_t dot = rest_.find('.');
    const std::string_view key = rest_.substr(0, dot);
    rest_.remove_prefix(dot == rest_.npos ? rest_.size() : dot + 1);
    return key;
  }

  /// The table of this name; names may have dots, and the longest that fits counts.
  Value& named(Value& list) {
    Value* best = nullptr;
    std::size_t length = 0;
    for (Value& table : list.items) {
      const std::string_view name = name_of(table);
      if (name.empty() || name.size() < length || !rest_.starts_with(name)) continue;
      if (rest_.size() > name.size() && rest_[name.size()] != '.') continue;
      best = &table;
      length = name.size();
    }
    if (!best) {
      std::vector<std::string_view> names;
      for (Value& table : list.items)
        if (!name_of(table).empty()) names.push_back(name_of(table));
      const std::string kind(taken());
      fail("the scene has no " + kind + " of that name, expected " +
           (names.empty() ? "names in its [[" + kind + "]]" : "one of: " + listed(names)) +
           did_you_mean(rest_.substr(0, rest_.find('.')), names));
    }
    rest_.remove_prefix(std::min(rest_.size(), length + 1));
    if (rest_.empty()) fail("is a name alone, expected a key after it");
    return *best;
  }
  Value& element(Value& list) {
    const std::string_view key = next();
    std::size_t i = 0;
    const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), i);
    if (error != std::errc{} || end != key.data() + key.size() || i >= list.items.size())
      fail(std::string(taken()) + " is no element, expected 0 to " +
           std::to_string(list.items.size() - 1));
    return list.items[i];
  }
  Value& member(Value& table) {
    const std::string_view key = next();
    if (Value* v = find(table, key)) return *v;
    if (!rest_.empty()) {
      std::vector<std::string_view> keys;
      for (const Entry& e : table.entries) keys.push_back(e.key);
      fail("the scene has no " + std::string(taken()) + ", expected one of: " + listed(keys) +
           did_you_mean(key, keys));
    }
    Value v;
    v.type = Value::Type::number;
    v.at = table.at;
    table.entries.push_back({std::string(key), table.at, v});
    added_ = true;
    return table.entries.back().value;
  }

  const Setting& setting_;
  std::string_view rest_;
  bool added_ = false;
};

}  // namespace

void set_numbers(Value& root, const std::vector<Setting>& settings) {
  for (const Setting& setting : settings) Way(setting).set(root);
}

}  // namespace momenta::reading

namespace momenta {

std::function<double(const std::string&)> numbers_of(std::string_view text, const std::string& file,
                                                     const std::vector<Setting>& settings) {
  struct Read {
    reading::Value root;
    reading::Parameters parameters;
  };
  reading::Value root = reading::parse_toml(text, file);
  reading::set_numbers(root, settings);
  const reading::Parameters parameters(root, file);
  const auto read = std::make_shared<Read>(Read{std::move(root), parameters});
  return [read](const std::string& place) {
    const Setting setting{place, 0};
    reading::Way way(setting);
    const reading::Value& found = way.find_in(read->root);
    way.expect_there();
    return reading::is_number(found) ? found.number
                                     : read->parameters.value(read->parameters.formula(found.text));
  };
}

Location location_of(std::string_view text, const std::string& file, const std::string& place) {
  reading::Value root = reading::parse_toml(text, file);
  const Setting setting{place, 0};
  reading::Way way(setting);
  const Location at = way.find_in(root).at;
  way.expect_there();
  return at;
}

}  // namespace momenta
