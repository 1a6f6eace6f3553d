#pragma once
// The keys of a table of the scene format. Each is declared once, by a call that has its name, the
// member of the spec that holds it, its unit and bound, and its default. The declaration of a table
// is a function; it runs in three stages:
//
//   names   collects the names of the keys, and refuses keys without meaning in this table
//   reads   takes the values from the text to the spec
//   writes  makes the text of the values that differ from their defaults
//
// Where a key is no plain value, key() takes the functions that read and write it.

#include <momenta/core/format/toml/fields.h>
#include <momenta/core/format/toml/toml_text.h>

#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace momenta::reading {

/// The index in `kinds` of the value of `key`; else fails with the kinds there are. `others`: kinds
/// of another table, which the sentence then names.
std::size_t read_kind(const Fields& table, std::span<const std::string_view> kinds,
                      std::string_view key = "kind", std::span<const std::string_view> others = {},
                      std::string_view table_of_others = {});

class Keys {
 public:
  /// Reads a table: refuses keys that declare(keys) does not name, then takes the values.
  template <class Declare>
  static void read(const Fields& table, Declare&& declare) {
    Keys names(Stage::names, &table);
    declare(names);
    table.allow(names.names_);
    Keys values(Stage::reads, &table);
    declare(values);
  }
  /// The keys that differ from their defaults, a line each.
  template <class Declare>
  static std::string lines(Declare&& declare) {
    Keys keys(Stage::writes, nullptr);
    declare(keys);
    return keys.joined("\n", "\n");
  }

  bool names() const { return stage_ == Stage::names; }
  bool reads() const { return stage_ == Stage::reads; }
  bool writes() const { return stage_ == Stage::writes; }
  /// The table. @pre not writes()
  const Fields& in() const { return *in_; }

  /// Keys declared from here on are written after all those of a lower place, which is 0 at first.
  void place(int place) { place_ = place; }

  /// Refuses a key for a reason, ahead of all values.
  void refuse(std::string_view key, const std::string& reason) const;

  /// Whether a key takes part in this stage: it has a name always, is read where it is there, and
  /// written where `differs`.
  bool has(std::string_view key, bool differs) const {
    return names() || (reads() ? in_->has(key) : differs);
  }

  /// A required key, always written.
  template <class T>
  void value(std::string_view key, T& x, Quantity quantity = {}) {
    if (names()) names_.push_back(key);
    if (reads()) Taken{*in_, key, quantity}.to(x);
    if (writes()) put(key, toml_text::of(x));
  }
  /// A key with a default, which is not written.
  template <class T>
  void value_or(std::string_view key, T& x, const std::type_identity_t<T>& otherwise,
                Quantity quantity = {}) {
    if (reads()) x = otherwise;
    if (has(key, !toml_text::same(x, otherwise))) value(key, x, quantity);
  }
  void number(std::string_view key, double& x, Quantity quantity, double otherwise = 0) {
    value_or(key, x, otherwise, quantity);
  }
  void vector(std::string_view key, Eigen::Vector3d& v, Quantity quantity,
              const Eigen::Vector3d& otherwise = Eigen::Vector3d::Zero()) {
    value_or(key, v, otherwise, quantity);
  }
  template <class T>
  void optional(std::string_view key, std::optional<T>& x, Quantity quantity = {}) {
    if (!has(key, x.has_value())) return;
    T taken = x.value_or(T{});
    value(key, taken, quantity);
    if (reads()) x = taken;
  }
  void optional(std::string_view key, std::vector<double>& x, Quantity quantity = {}) {
    if (has(key, !x.empty())) value(key, x, quantity);
  }
  /// A word that decides what other keys there are, read before them.
  void word(std::string_view key, std::string_view text);
  /// A name that is not empty, or no such key.
  void optional_name(std::string& name);
  /// One of `kinds`, the first of them by default.
  void choice(std::string_view key, std::string& text, std::span<const std::string_view> kinds);
  /// A formula that is not empty; read once the whole scene is known, not written where empty.
  void formula(std::string_view key, std::string& formula);
  /// A whole number >= `least`, 0 or 1.
  void whole(std::string_view key, int& n, int least, int otherwise);
  void direction(std::string_view key, Eigen::Vector3d& v, const Eigen::Vector3d& otherwise);
  /// rotation = { rpy = [roll, pitch, yaw] } | { quaternion = [w, x, y, z] } | { axis = .., angle =
  /// .. }; rpy means Rz(yaw) Ry(pitch) Rx(roll). Written as a quaternion.
  void rotation(Eigen::Quaterniond& rotation);

  /// A key of its own: read(in()) takes it, text() writes it, not where that is empty.
  template <class Read, class Text>
  void key(std::string_view key, Read&& read, Text&& text) {
    if (names()) names_.push_back(key);
    if (reads()) read(*in_);
    if (writes()) put(key, text());
  }
  /// A table within the line of its key, which may be missing; not written without keys.
  template <class Declare>
  void table(std::string_view key, Declare&& declare) {
    if (names()) names_.push_back(key);
    if (reads())
      if (const std::optional<Fields> inner = in_->table(key)) read(*inner, declare);
    if (!writes()) return;
    Keys inner(Stage::writes, nullptr);
    declare(inner);
    if (!inner.written_.empty()) put(key, "{ " + inner.joined(", ", " }"));
  }

 private:
  enum class Stage { names, reads, writes };
  /// The value of a key, by type.
  struct Taken {
    const Fields& in;
    std::string_view key;
    Quantity quantity;
    void to(std::string& x) const { x = in.text(key); }
    void to(std::vector<std::string>& x) const { x = in.texts(key); }
    void to(bool& x) const { x = in.flag(key, false); }
    void to(double& x) const { x = in.number(key, quantity); }
    void to(std::vector<double>& x) const { x = in.numbers(key, quantity); }
    void to(Eigen::Vector3d& x) const { x = in.vector(key, quantity); }
    void to(std::vector<Eigen::Vector3d>& x) const { x = in.vectors(key, quantity); }
  };
  struct Line {
    int place;
    std::string text;  ///< key = value
  };
  Keys(Stage stage, const Fields* in) : stage_(stage), in_(in) {}
  void put(std::string_view key, const std::string& value);
  std::string joined(const char* between, const char* last);

  Stage stage_;
  const Fields* in_;  ///< null: writes
  int place_ = 0;
  std::vector<std::string_view> names_;
  std::vector<Line> written_;
};

}  // namespace momenta::reading
