#include <momenta/core/format/toml/fields.h>
#include <momenta/core/scene/file_text.h>
#include <momenta/core/scene/kinds.h>
#include <momenta/core/text/quoting.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace momenta::reading {
namespace {

std::string in_unit(Quantity quantity) {
  return quantity.unit.empty() ? std::string() : " [" + std::string(quantity.unit) + "]";
}

std::string expected_number(Quantity quantity) {
  switch (quantity.bound) {
    case Bound::positive:
      return "a number > 0" + in_unit(quantity);
    case Bound::not_negative:
      return "a number >= 0" + in_unit(quantity);
    case Bound::none:
      break;
  }
  return "a number" + in_unit(quantity);
}

std::string expected_three(Quantity quantity) {
  return "an array of 3 numbers" + in_unit(quantity);
}

}  // namespace

Fields::Fields(const Value& value, std::string owner, const std::string& file,
               const Parameters* parameters, std::string path)
    : value_(value),
      owner_(std::move(owner)),
      file_(file),
      parameters_(parameters),
      path_(std::move(path)) {
  if (value.type != Value::Type::table)
    fail_at(value.at, "is " + std::string(described(value.type)) + ", expected a table");
}

void Fields::fail_at(Location at, const std::string& sentence) const {
  fail(file_, at, owner_.empty() ? sentence : owner_ + ": " + sentence);
}

void Fields::fail_key(std::string_view key, const std::string& sentence) const {
  const Value* value = find(key);
  fail_at(value != nullptr ? value->at : value_.at, path_ + std::string(key) + " " + sentence);
}

void Fields::mismatch(const Value& found, const std::string& key,
                      const std::string& expected) const {
  std::string what(described(found.type));
  if (found.type == Value::Type::text) what += " (" + in_quotes(found.text) + ")";
  fail_at(found.at, path_ + key + " is " + what + ", expected " + expected);
}

void Fields::allow(const std::vector<std::string_view>& known) const {
  for (const Entry& entry : value_.entries) {
    if (std::find(known.begin(), known.end(), entry.key) != known.end()) continue;
    const std::string near = did_you_mean(entry.key, known);
    fail_at(entry.at, "unknown key " + in_quotes(path_ + entry.key) +
                          (near.empty() ? ", expected one of: " + listed(known) : near));
  }
}

void Fields::refuse(std::string_view key, const std::string& reason) const {
  for (const Entry& entry : value_.entries)
    if (entry.key == key) fail_at(entry.at, "key " + in_quotes(path_ + entry.key) + " " + reason);
}

const Value* Fields::find(std::string_view key) const {
  return reading::find(value_, key);
}

const Value& Fields::required(std::string_view key, const std::string& expected) const {
  const Value* value = find(key);
  if (value == nullptr)
    fail_at(value_.at,
            "key " + in_quotes(path_ + std::string(key)) + " is missing, expected " + expected);
  return *value;
}

double Fields::number_of(const Value& value, const std::string& key, Quantity quantity) const {
  const bool formula = value.type == Value::Type::text && parameters_;
  if (!formula && !is_number(value)) mismatch(value, key, expected_number(quantity));
  const double number = formula ? value_of(value, key, quantity) : value.number;
  const bool in_bound = quantity.bound == Bound::none || number > 0 ||
                        (quantity.bound == Bound::not_negative && number == 0);
  if (!std::isfinite(number) || !in_bound)
    fail_at(value.at, path_ + key + " is " + digits(number) +
                          (formula ? " by " + in_quotes(value.text) : "") + ", expected " +
                          (std::isfinite(number) ? "" : "finite: ") + expected_number(quantity));
  return number;
}

double Fields::value_of(const Value& formula, const std::string& key, Quantity quantity) const {
  try {
    const Expression read = parameters_->formula(formula.text);
    if (read.is_truth())
      fail_at(formula.at, path_ + key + " is a comparison, " + in_quotes(formula.text) +
                              ", expected " + expected_number(quantity) + " or a formula of one");
    return parameters_->value(read);
  } catch (const ExpressionError& error) {
    fail_at(place_in(formula, error.place()),
            path_ + key + " is a string (" + in_quotes(formula.text) + "), expected " +
                expected_number(quantity) + " or a formula of one: " + error.what());
  }
}

double Fields::number(std::string_view key, Quantity quantity) const {
  return number_of(required(key, expected_number(quantity)), std::string(key), quantity);
}

double Fields::number(std::string_view key, Quantity quantity, double otherwise) const {
  return has(key) ? number(key, quantity) : otherwise;
}

int Fields::whole(std::string_view key, int otherwise, int least) const {
  const Value* value = find(key);
  if (value == nullptr) return otherwise;
  const std::string expected = least > 0 ? "a whole number > 0" : "a whole number >= 0";
  if (value->type != Value::Type::integer) mismatch(*value, std::string(key), expected);
  if (value->number < least || value->number > std::numeric_limits<int>::max())
    fail_key(key, "is " + digits(value->number) + ", expected " + expected + " and below 2^31");
  return static_cast<int>(value->number);
}

int Fields::count(std::string_view key, int otherwise) const {
  return whole(key, otherwise, 1);
}

int Fields::index(std::string_view key, int otherwise) const {
  return whole(key, otherwise, 0);
}

bool Fields::flag(std::string_view key, bool otherwise) const {
  const Value* value = find(key);
  if (value == nullptr) return otherwise;
  if (value->type != Value::Type::boolean) mismatch(*value, std::string(key), "true or false");
  return value->truth;
}

std::string Fields::text(std::string_view key) const {
  const Value& value = required(key, "a string");
  if (value.type != Value::Type::text) mismatch(value, std::string(key), "a string");
  return value.text;
}

std::string Fields::text(std::string_view key, const std::string& otherwise) const {
  return has(key) ? text(key) : otherwise;
}

std::vector<double> Fields::numbers(std::string_view key, Quantity quantity) const {
  const std::string expected = "an array of numbers" + in_unit(quantity);
  const Value& value = required(key, expected);
  if (value.type != Value::Type::array) mismatch(value, std::string(key), expected);
  std::vector<double> numbers;
  numbers.reserve(value.items.size());
  for (const Value& item : value.items)
    numbers.push_back(
        number_of(item, std::string(key) + "[" + std::to_string(numbers.size()) + "]", quantity));
  return numbers;
}

std::vector<std::string> Fields::texts(std::string_view key) const {
  const Value* value = find(key);
  if (value == nullptr) return {};
  if (value->type != Value::Type::array) mismatch(*value, std::string(key), "an array of strings");
  std::vector<std::string> texts;
  for (const Value& item : value->items) {
    if (item.type != Value::Type::text)
      mismatch(item, std::string(key) + "[" + std::to_string(texts.size()) + "]", "a string");
    texts.push_back(item.text);
  }
  return texts;
}

Eigen::Vector3d Fields::vector(std::string_view key, Quantity quantity) const {
  const Value& value = required(key, expected_three(quantity));
  if (value.type != Value::Type::array) mismatch(value, std::string(key), expected_three(quantity));
  if (value.items.size() != 3)
    fail_key(key, "has " + std::to_string(value.items.size()) + " entries, expected " +
                      expected_three(quantity));
  const std::vector<double> three = numbers(key, quantity);
  return {three[0], three[1], three[2]};
}

Eigen::Vector3d Fields::vector(std::string_view key, Quantity quantity,
                               const Eigen::Vector3d& otherwise) const {
  return has(key) ? vector(key, quantity) : otherwise;
}

std::vector<Eigen::Vector3d> Fields::vectors(std::string_view key, Quantity quantity) const {
  const std::string expected = "an array of vectors, each " + expected_three(quantity);
  const Value& value = required(key, expected);
  if (value.type != Value::Type::array) mismatch(value, std::string(key), expected);
  std::vector<Eigen::Vector3d> vectors;
  for (const Value& item : value.items) {
    const std::string which = std::string(key) + "[" + std::to_string(vectors.size()) + "]";
    if (item.type != Value::Type::array) mismatch(item, which, expected_three(quantity));
    if (item.items.size() != 3)
      fail_at(item.at, which + " has " + std::to_string(item.items.size()) + " entries, expected " +
                           expected_three(quantity));
    Eigen::Vector3d v;
    for (int i = 0; i < 3; ++i)
      v[i] = number_of(item.items[static_cast<std::size_t>(i)],
                       which + "[" + std::to_string(i) + "]", quantity);
    vectors.push_back(v);
  }
  return vectors;
}

bool Fields::is_of_parameters(const std::string& formula) const {
  if (!parameters_ || formula.empty()) return true;
  try {
    parameters_->formula(formula);
    return true;
  } catch (const ExpressionError&) {
    return false;
  }
}

void Fields::vector_or_formulas(std::string_view key, Quantity quantity, Eigen::Vector3d& numbers,
                                std::array<std::string, 3>& formulas) const {
  const Value* value = find(key);
  if (value == nullptr) return;
  if (value->type != Value::Type::array || value->items.size() != 3) {
    numbers = vector(key, quantity);  // its sentence says what is expected
    return;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const Value& item = value->items[i];
    if (item.type == Value::Type::text && !is_of_parameters(item.text))
      formulas[i] = item.text;
    else
      numbers[static_cast<Eigen::Index>(i)] =
          number_of(item, std::string(key) + "[" + std::to_string(i) + "]", quantity);
  }
}

Eigen::Vector3d Fields::direction(std::string_view key, const Eigen::Vector3d& otherwise) const {
  const Value* value = find(key);
  if (value == nullptr) return otherwise;
  const std::string expected =
      "a direction: three numbers or \"x\", \"y\", \"z\", \"-x\", \"-y\", \"-z\"";

  if (value->type == Value::Type::text) {
    const bool negative = value->text.starts_with('-');
    const std::string letter = value->text.substr(negative ? 1 : 0);
    if (letter != "x" && letter != "y" && letter != "z")
      mismatch(*value, std::string(key), expected);
    return (negative ? -1.0 : 1.0) * Eigen::Vector3d::Unit(letter[0] - 'x');
  }
  if (value->type != Value::Type::array) mismatch(*value, std::string(key), expected);

  const Eigen::Vector3d along = vector(key, {});
  if (is_unit(along)) return along;
  // scaled first: squares of very large or very small entries would overflow or vanish
  const double largest = along.lpNorm<Eigen::Infinity>();
  if (largest == 0) fail_key(key, "is the zero vector, expected " + expected);
  return (along / largest).normalized();
}

std::optional<Fields> Fields::table(std::string_view key) const {
  const Value* value = find(key);
  if (value == nullptr) return std::nullopt;
  if (value->type != Value::Type::table) mismatch(*value, std::string(key), "a table");
  return Fields(*value, owner_, file_, parameters_, path_ + std::string(key) + ".");
}

std::vector<Fields> Fields::tables(std::string_view key, std::string_view title) const {
  const Value* value = find(key);
  if (value == nullptr) return {};
  const std::string expected = "tables, each opened by [[" + std::string(key) + "]]";
  if (value->type != Value::Type::array) mismatch(*value, std::string(key), expected);
  std::vector<Fields> tables;
  tables.reserve(value->items.size());
  for (const Value& item : value->items) {
    if (item.type != Value::Type::table)
      mismatch(item, std::string(key) + "[" + std::to_string(tables.size()) + "]", expected);
    std::string owner = std::string(title) + " number " + std::to_string(tables.size() + 1);
    for (const Entry& entry : item.entries)
      if (entry.key == "name" && entry.value.type == Value::Type::text && !entry.value.text.empty())
        owner = std::string(title) + " " + in_quotes(entry.value.text);
    tables.emplace_back(item, owner, file_, parameters_);
  }
  return tables;
}

}  // namespace momenta::reading
