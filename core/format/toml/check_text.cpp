#include <momenta/core/format/toml/toml_values.h>
#include <momenta/core/scene/file_text.h>
#include <momenta/core/text/utf8.h>

#include <array>

namespace momenta::reading {
namespace {

constexpr std::size_t deepest = 16;
constexpr int most_values = 4'000'000;

void check_characters(std::string_view text, const std::string& file) {
  Location at{1, 1};
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = utf8_length(text.substr(i));
    if (length == 0) fail(file, at, "a byte that is not UTF-8, expected a scene in UTF-8 text");
    if (text[i] == '\0') fail(file, at, "a NUL byte, expected a scene in UTF-8 text");
    if (text[i] == '\n') {
      ++at.line;
      at.column = 0;
    }
    ++at.column;
    i += length;
  }
}

/// Walks over the text as a TOML lexer, far enough to tell strings and comments from the rest, and
/// counts. In malformed text it may end early, as the parser does.
class TextWalk {
 public:
  TextWalk(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  void check() {
    if (text_.starts_with("\xef\xbb\xbf")) i_ = line_begin_ = 3;  // byte order mark
    while (i_ < text_.size()) {
      const char c = text_[i_];
      if (c == '#') {
        while (i_ < text_.size() && text_[i_] != '\n') ++i_;
        continue;
      }
      if (c == '"' || c == '\'') {
        begins_line_ = false;
        TextWalk here = *this;
        const bool closed = skip_string(c);
        in_word_ = true;
        if (!closed || here.within_a_word()) here.require_ascii_line();
        if (!closed) return;
        continue;
      }
      require_ascii("outside strings and comments");
      if (c == '[' && begins_line_ && depth_ == 0) {
        check_header();
        is_header_ = true;
      }
      note_word(c);
      if (c != ' ' && c != '\t') begins_line_ = false;
      count(c);
      ++i_;
    }
  }

 private:
  void count(char c) {
    switch (c) {
      case '.':
        if (++dots_ > static_cast<int>(deepest)) refuse("a key of more than 16 parts");
        return;
      case '[':
      case '{':
        if (depth_ == deepest) refuse("brackets nested more than 16 deep");
        closing_[depth_++] = c == '[' ? ']' : '}';
        break;
      case ']':
      case '}':
        if (depth_ > 0 && closing_[--depth_] != c)
          refuse(std::string("not valid TOML: a ") + c, std::string(1, closing_[depth_]));
        dots_ = 0;
        return;
      case '\n':
        ++line_;
        line_begin_ = i_ + 1;
        begins_line_ = true;
        is_header_ = false;
        dots_ = equals_ = 0;
        return;
      case '=':
      case ',':
        break;
      default:
        return;
    }
    dots_ = 0;
    if (++values_ > most_values) refuse("more than 4 million values", "a scene of fewer");
  }

  /// Whether a key may stand here: no value since the line, the inline table or its last comma
  /// began.
  bool at_key() const {
    return is_header_ || (equals_ == 0 && (depth_ == 0 || closing_[depth_ - 1] == '}'));
  }
  /// Notes words as toml++ reads them: up to white space, a comma or a closing bracket; keys up to
  /// their equals sign.
  void note_word(char c) {
    switch (c) {
      case ' ':
      case '\t':
      case '\r':
      case '\n':
      case ']':
      case '}':
        in_word_ = false;
        return;
      case ',':
        in_word_ = false;
        equals_ = 0;
        return;
      case '{':
        equals_ = 0;
        return;
      case '[':
        return;
      case '=':
        if (at_key()) in_word_ = false;
        ++equals_;
        return;
      default:
        in_word_ = true;
    }
  }
  /// Whether a quote begins no string: toml++ reads on over it within numbers and words.
  bool within_a_word() const { return in_word_ && !(at_key() && text_[i_ - 1] == '.'); }
  void require_ascii_line() {
    for (; i_ < text_.size() && text_[i_] != '\n'; ++i_)
      require_ascii("after a quote that is none of a string");
  }

  /// Refuses [ or [[ without a name, which toml++ takes for granted.
  void check_header() const {
    std::size_t k = i_ + 1;
    if (k < text_.size() && text_[k] == '[') ++k;
    while (k < text_.size() && (text_[k] == ' ' || text_[k] == '\t')) ++k;
    if (k == text_.size()) return;
    const char c = text_[k];
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (!letter && std::string_view("_-\"']").find(c) == std::string_view::npos)
      fail(file_, {line_, static_cast<int>(k - line_begin_) + 1},
           "not valid TOML: expected the name of a table after '['");
  }

  bool starts_with_three(char quote) const {
    return text_.substr(i_, 3) == std::string_view(quote == '"' ? "\"\"\"" : "'''");
  }

  /// Skips a string. @return false where it is not closed
  bool skip_string(char quote) {
    const bool many_lines = starts_with_three(quote);
    i_ += many_lines ? 3 : 1;
    while (i_ < text_.size()) {
      const char c = text_[i_];
      if (c == '\\' && quote == '"') {
        skip_escape(many_lines);
      } else if (c == quote && !many_lines) {
        ++i_;
        return true;
      } else if (c == quote && starts_with_three(quote)) {
        // up to two quotes may stand before the closing three
        i_ += 3;
        for (int more = 0; more < 2 && i_ < text_.size() && text_[i_] == quote; ++more) ++i_;
        return true;
      } else {
        if (c == '\n') {
          if (!many_lines) return false;
          break_line(i_);
        }
        ++i_;
      }
    }
    return false;
  }

  /// Skips a backslash and the character after it or, at the end of a line, all white space.
  void skip_escape(bool many_lines) {
    const auto is_white = [&] {
      return i_ < text_.size() &&
             std::string_view(" \t\r\n").find(text_[i_]) != std::string_view::npos;
    };
    ++i_;
    if (!many_lines || !is_white()) {
      require_ascii("after a backslash");
      if (i_ < text_.size() && text_[i_] != '\n') ++i_;
      return;
    }
    for (; is_white(); ++i_)
      if (text_[i_] == '\n') break_line(i_);
    require_ascii("after a backslash at the end of a line");
  }

  /// Refuses a character outside ASCII: toml++ has undefined behaviour where it asks whether such
  /// is white space. That is never within a comment, and within a string only at the places asked
  /// here.
  void require_ascii(const std::string& where) const {
    if (i_ < text_.size() && static_cast<unsigned char>(text_[i_]) >= 0x80)
      refuse("not valid TOML: a character outside ASCII " + where,
             "such characters in strings and comments only");
  }

  void break_line(std::size_t newline) {
    ++line_;
    line_begin_ = newline + 1;
  }

  [[noreturn]] void refuse(const std::string& what,
                           const std::string& expected = "a scene (which needs 3 levels)") const {
    fail(file_, {line_, static_cast<int>(i_ - line_begin_) + 1}, what + ", expected " + expected);
  }

  std::string_view text_;
  const std::string& file_;
  std::size_t i_ = 0, line_begin_ = 0;
  bool begins_line_ = true, is_header_ = false, in_word_ = false;
  int equals_ = 0;                       ///< equals signs since a key was last expected
  std::array<char, deepest> closing_{};  // for the brackets open here
  std::size_t depth_ = 0;
  int line_ = 1, dots_ = 0, values_ = 0;
};

}  // namespace

void check_text(std::string_view text, const std::string& file) {
  if (text.empty()) fail(file, {}, "the file is empty, expected a scene");
  if (text.size() > largest_text)
    fail(file, {}, "the file is over 64 MiB, expected a scene of at most 64 MiB");
  check_characters(text, file);
  TextWalk(text, file).check();
}

}  // namespace momenta::reading
