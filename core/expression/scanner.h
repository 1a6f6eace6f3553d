#pragma once
// The text of a formula as its parser reads it: a place in it, what stands there, and error
// sentences.

#include <cstddef>
#include <string>
#include <string_view>

namespace momenta::formula {

/// Reads one text. Takers skip blanks, and do not move where they take nothing.
class Scanner {
 public:
  /// @throws ExpressionError: longer than a million characters
  explicit Scanner(std::string_view text);

  void skip_blanks();
  bool at_end() const { return at_ == text_.size(); }
  std::size_t place() const { return at_; }
  void go_to(std::size_t place) { at_ = place; }
  std::string_view rest() const { return text_.substr(at_); }

  /// Whether a letter or _ that begins a name is here; whether a digit, or a dot before one.
  bool at_letter() const;
  bool at_number() const;
  /// A name and the names after its dots, or one character.
  std::string_view word() const;
  /// Text from `from` to the next ')', without blanks: "der(x)"; empty: there is none.
  std::string with_brackets(std::size_t from) const;

  bool take(std::string_view sign);
  bool take_word(std::string_view word);
  /// @throws ExpressionError: no double holds it, or a name follows without an operator
  double take_number();

  /// @throws ExpressionError at that place
  [[noreturn]] void fail(std::size_t place, const std::string& sentence) const;
  /// @throws ExpressionError on the text here, or its end: a hint where it is another notation's, a
  /// comma as decimal point included, else `ending`.
  [[noreturn]] void fail_here(const std::string& ending) const;

 private:
  std::string_view text_;
  std::size_t at_ = 0;
};

}  // namespace momenta::formula
