#include <momenta/core/expression/expression.h>
#include <momenta/core/expression/function_names.h>
#include <momenta/core/expression/scanner.h>
#include <momenta/core/text/quoting.h>

#include <charconv>

namespace momenta::formula {
namespace {

constexpr std::size_t longest = 1'000'000;  // characters of a formula

bool letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
bool digit(char c) {
  return c >= '0' && c <= '9';
}
bool blank(char c) {
  return c == ' ' || c == '\t' || c == '\n';
}

}  // namespace

Scanner::Scanner(std::string_view text) : text_(text) {
  if (text_.size() > longest)
    fail(0, "has " + std::to_string(text_.size()) + " characters, expected at most " +
                std::to_string(longest));
}

void Scanner::skip_blanks() {
  while (!at_end() && blank(text_[at_])) ++at_;
}

bool Scanner::at_letter() const {
  return !at_end() && letter(text_[at_]);
}

bool Scanner::at_number() const {
  if (at_end()) return false;
  return digit(text_[at_]) ||
         (text_[at_] == '.' && at_ + 1 < text_.size() && digit(text_[at_ + 1]));
}

std::string_view Scanner::word() const {
  std::size_t end = at_;
  if (!at_end() && text_[end] == '\'') {
    end = text_.find('\'', at_ + 1);
    if (end == std::string_view::npos) return text_.substr(at_, 1);
    ++end;
  }
  if (end < text_.size() && (end > at_ ? text_[end] == '.' : letter(text_[end])))
    while (end < text_.size() &&
           (letter(text_[end]) || digit(text_[end]) ||
            (text_[end] == '.' && end + 1 < text_.size() && letter(text_[end + 1]))))
      ++end;
  else if (end < text_.size() && end == at_)
    ++end;
  while (end < text_.size() && (text_[end] & 0xC0) == 0x80) ++end;  // the rest of a character
  return text_.substr(at_, end - at_);
}

std::string Scanner::with_brackets(std::size_t from) const {
  const std::size_t close = text_.find(')', from);
  std::string whole;
  if (close != std::string_view::npos)
    for (const char c : text_.substr(from, close + 1 - from))
      if (!blank(c)) whole += c;
  return whole;
}

bool Scanner::take(std::string_view sign) {
  skip_blanks();
  if (!rest().starts_with(sign)) return false;
  at_ += sign.size();
  return true;
}

bool Scanner::take_word(std::string_view expected) {
  skip_blanks();
  if (word() != expected) return false;
  at_ += expected.size();
  return true;
}

double Scanner::take_number() {
  double x = 0;
  const char* begin = text_.data() + at_;
  const auto [end, error] = std::from_chars(begin, text_.data() + text_.size(), x);
  if (error != std::errc{})
    fail(at_, "found a number that no double can hold, expected one below 1.8e308");
  const std::size_t from = at_;
  at_ += static_cast<std::size_t>(end - begin);
  if (at_letter() || (!at_end() && text_[at_] == '.'))
    fail(from, "found " + reading::in_quotes(text_.substr(from, at_ - from + 1)) +
                   ", expected an operator after the number");
  return x;
}

void Scanner::fail(std::size_t place, const std::string& sentence) const {
  throw ExpressionError(sentence, place);
}

void Scanner::fail_here(const std::string& ending) const {
  if (at_end()) fail(at_, "ends" + ending);
  const std::string_view left = rest();
  if (left.front() == ',' && at_ > 0 && digit(text_[at_ - 1]) && left.size() > 1 && digit(left[1]))
    fail(at_, "found ',' in a number, expected '.'");
  if (left.front() == '=' && !left.starts_with("=<") && !left.starts_with("=>"))
    fail(at_, "found '=', expected one formula, or '==' where two numbers are compared");
  const std::string here = sign_elsewhere(left);
  std::string_view found = word();
  for (const std::string_view two : {"&&", "||", "=<", "=>"})
    if (left.starts_with(two)) found = left.substr(0, 2);
  fail(at_, "found " + reading::in_quotes(found) + (here.empty() ? ending : ", expected " + here));
}

}  // namespace momenta::formula
