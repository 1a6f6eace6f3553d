#pragma once
// Keys of one TOML table, read by type. Complaints name the owner of the key, the key, what was
// found and what was expected, at the place of the value.

#include <momenta/core/format/toml/parameters.h>

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace momenta::reading {

enum class Bound { none, not_negative, positive };

/// Unit (empty: none) and sign of a number.
struct Quantity {
  std::string_view unit;
  Bound bound = Bound::none;
};

class Fields {
 public:
  /// `owner` opens every sentence ("body 'crank'"). `parameters`: names of formulas in place of
  /// numbers; null: no formulas. @throws SceneError unless `value` is a table
  Fields(const Value& value, std::string owner, const std::string& file,
         const Parameters* parameters = nullptr, std::string path = "");

  /// Refuses all other keys; names the first unknown one, and the nearest known key.
  void allow(const std::vector<std::string_view>& known) const;

  /// Refuses `key` for a reason.
  void refuse(std::string_view key, const std::string& reason) const;

  bool has(std::string_view key) const { return find(key) != nullptr; }
  const Value* find(std::string_view key) const;
  Location at() const { return value_.at; }
  const std::string& file() const { return file_; }

  // Keys without `otherwise` are required.
  double number(std::string_view key, Quantity quantity) const;
  double number(std::string_view key, Quantity quantity, double otherwise) const;
  int count(std::string_view key, int otherwise) const;  ///< a whole number > 0
  int index(std::string_view key, int otherwise) const;  ///< a whole number >= 0
  bool flag(std::string_view key, bool otherwise) const;
  std::string text(std::string_view key) const;
  std::string text(std::string_view key, const std::string& otherwise) const;
  std::vector<double> numbers(std::string_view key, Quantity quantity) const;
  std::vector<std::string> texts(std::string_view key) const;  ///< empty when the key is missing
  Eigen::Vector3d vector(std::string_view key, Quantity quantity) const;
  Eigen::Vector3d vector(std::string_view key, Quantity quantity,
                         const Eigen::Vector3d& otherwise) const;
  /// An array of vectors.
  std::vector<Eigen::Vector3d> vectors(std::string_view key, Quantity quantity) const;

  /// A vector whose components may be formulas of the scene (core/scene/formula.h): those that need
  /// more than parameters go to `formulas`, the others to `numbers`; nothing where the key is
  /// missing.
  void vector_or_formulas(std::string_view key, Quantity quantity, Eigen::Vector3d& numbers,
                          std::array<std::string, 3>& formulas) const;

  /// A unit vector: three numbers, normalised, or "x", "-x", "y", ...
  Eigen::Vector3d direction(std::string_view key, const Eigen::Vector3d& otherwise) const;

  /// The table below `key`, if any.
  std::optional<Fields> table(std::string_view key) const;

  /// The tables of [[key]]; their owner is `title` and their name or number.
  std::vector<Fields> tables(std::string_view key, std::string_view title) const;

  [[noreturn]] void fail_at(Location at, const std::string& sentence) const;
  [[noreturn]] void fail_key(std::string_view key, const std::string& sentence) const;

 private:
  const Value& required(std::string_view key, const std::string& expected) const;
  [[noreturn]] void mismatch(const Value& found, const std::string& key,
                             const std::string& expected) const;
  int whole(std::string_view key, int otherwise, int least) const;
  double number_of(const Value& value, const std::string& key, Quantity quantity) const;
  double value_of(const Value& formula, const std::string& key, Quantity quantity) const;
  bool is_of_parameters(const std::string& formula) const;

  const Value& value_;
  std::string owner_;
  const std::string& file_;
  const Parameters* parameters_;
  std::string path_;  ///< "origin." in the table of `origin`
};

}  // namespace momenta::reading
