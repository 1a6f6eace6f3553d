// The grammar of expression.h, one function a line of it; and before the formula definitions of
// names for its parts,
//
//   whole:      { name ":=" or ";" } or
//
// which the rest of the text may use: "r := hypot(x, y); 1/r - 1/r^2".

#include <momenta/core/expression/evaluate.h>
#include <momenta/core/expression/other_notation.h>
#include <momenta/core/expression/parser.h>
#include <momenta/core/expression/tape.h>
#include <momenta/core/text/near_name.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <map>
#include <numbers>
#include <optional>

namespace momenta {
namespace formula {
namespace {

constexpr std::size_t longest = 1'000'000;  // characters of a formula
constexpr int deepest = 200;                // brackets and signs within each other

struct Function {
  std::string_view name;
  Operation operation;
};
constexpr std::array functions{
    Function{"sin", Operation::sin},     Function{"cos", Operation::cos},
    Function{"tan", Operation::tan},     Function{"asin", Operation::asin},
    Function{"acos", Operation::acos},   Function{"atan", Operation::atan},
    Function{"sinh", Operation::sinh},   Function{"cosh", Operation::cosh},
    Function{"tanh", Operation::tanh},   Function{"exp", Operation::exp},
    Function{"log", Operation::log},     Function{"sqrt", Operation::sqrt},
    Function{"abs", Operation::abs},     Function{"sign", Operation::sign},
    Function{"floor", Operation::floor}, Function{"atan2", Operation::atan2},
    Function{"hypot", Operation::hypot}, Function{"min", Operation::min},
    Function{"max", Operation::max},     Function{"if", Operation::choice}};

/// An instruction, and what it gives.
struct Term {
  int at;
  bool truth;
  std::size_t place;  ///< where it begins
};

class Parser {
 public:
  Parser(std::string_view text, FormulaNames& names) : text_(text), names_(names) {}

  Term whole() {
    if (text_.size() > longest)
      fail(0, "has " + std::to_string(text_.size()) + " characters, expected at most " +
                  std::to_string(longest));
    while (const std::optional<std::string_view> name = defined_name()) define(*name);
    const Term t = any();
    skip();
    if (at_ < text_.size()) fail_at_sign(", expected an operator or the end");
    return t;
  }
  const Tape& tape() const { return tape_; }
  std::vector<std::shared_ptr<const CubicSpline>> take_splines() { return std::move(splines_); }

 private:
  [[noreturn]] void fail(std::size_t place, const std::string& sentence) const {
    throw ExpressionError(sentence, place);
  }
  /// Of what stands at at_: what it is here where it is another notation's, else the ending. A
  /// comma between digits is one, where a comma is nothing else.
  [[noreturn]] void fail_at_sign(const std::string& ending) const {
    const std::string_view rest = text_.substr(at_);
    if (rest.front() == ',' && at_ > 0 && digit(text_[at_ - 1]) && rest.size() > 1 &&
        digit(rest[1]))
      fail(at_, "found ',' in a number, expected '.'");
    if (rest.front() == '=' && !rest.starts_with("=<") && !rest.starts_with("=>"))
      fail(at_, "found '=', expected one formula, or '==' where two numbers are compared");
    const std::string here = sign_elsewhere(rest);
    std::string_view word = word_at(at_);
    if (rest.starts_with("&&") || rest.starts_with("||") || rest.starts_with("=<") ||
        rest.starts_with("=>"))
      word = rest.substr(0, 2);
    fail(at_, "found " + reading::in_quotes(word) + (here.empty() ? ending : ", expected " + here));
  }
  static bool letter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
  }
  static bool digit(char c) { return c >= '0' && c <= '9'; }
  void skip() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\n'))
      ++at_;
  }
  /// A name and the names after its dots, or one character.
  std::string_view word_at(std::size_t from) const {
    std::size_t end = from;
    if (end < text_.size() && text_[end] == '\'') {
      end = text_.find('\'', from + 1);
      if (end == std::string_view::npos) return text_.substr(from, 1);
      ++end;
    }
    if (end < text_.size() && (end > from ? text_[end] == '.' : letter(text_[end])))
      while (end < text_.size() &&
             (letter(text_[end]) || digit(text_[end]) ||
              (text_[end] == '.' && end + 1 < text_.size() && letter(text_[end + 1]))))
        ++end;
    else if (end < text_.size() && end == from)
      ++end;
    while (end < text_.size() && (text_[end] & 0xC0) == 0x80) ++end;  // the rest of a character
    return text_.substr(from, end - from);
  }
  bool take(std::string_view sign) {
    skip();
    if (!text_.substr(at_).starts_with(sign)) return false;
    at_ += sign.size();
    return true;
  }
  bool take_word(std::string_view word) {
    skip();
    if (word_at(at_) != word) return false;
    at_ += word.size();
    return true;
  }

  /// The name before ":=", behind which the reading goes on; nothing: no definition stands here.
  std::optional<std::string_view> defined_name() {
    skip();
    const std::size_t from = at_;
    if (from == text_.size() || !letter(text_[from])) return {};
    const std::string_view name = word_at(from);
    at_ += name.size();
    if (take(":=")) {
      if (!is_plain_name(name) || is_reserved_name(name) || locals_.contains(name) ||
          names_.meaning(name, from))
        fail(from, reading::in_quotes(name) +
                       " is no new name, expected letters, digits and _ for what ':=' defines");
      return name;
    }
    at_ = from;
    return {};
  }
  void define(std::string_view name) {
    const Term t = any();
    locals_.emplace(name, t);
    skip();
    if (at_ == text_.size() || text_[at_] != ';')
      fail_at_sign_or_end(", expected ';' after the definition of " + reading::in_quotes(name));
    ++at_;
  }
  [[noreturn]] void fail_at_sign_or_end(const std::string& ending) const {
    if (at_ == text_.size()) fail(at_, "ends" + ending);
    fail_at_sign(ending);
  }

  int number(const Term& t) const {
    if (t.truth) fail(t.place, "a comparison stands where a number is expected");
    return t.at;
  }
  int truth(const Term& t) const {
    if (!t.truth) fail(t.place, "a number stands where a comparison is expected");
    return t.at;
  }
  Term of_truths(Operation o, const Term& a, const Term& b) {
    const int left = truth(a);
    return {tape_.add({o, left, truth(b), -1, 0}), true, a.place};
  }
  Term of_numbers(Operation o, const Term& a, const Term& b, bool compares = false) {
    const int left = number(a);
    return {tape_.add({o, left, number(b), -1, 0}), compares, a.place};
  }

  Term any() {
    Term t = all();
    while (take_word("or")) t = of_truths(Operation::either, t, all());
    return t;
  }
  Term all() {
    Term t = opposite();
    while (take_word("and")) t = of_truths(Operation::both, t, opposite());
    return t;
  }
  Term opposite() {
    skip();
    const std::size_t from = at_;
    if (!take_word("not")) return comparison();
    const Depth depth(*this);
    return {tape_.add({Operation::opposite, truth(opposite()), -1, -1, 0}), true, from};
  }
  Term comparison() {
    const Term a = sum();
    if (take("<>")) fail(at_ - 2, "found '<>', expected '!='");
    const auto compare = [&]() -> std::optional<Term> {
      if (take("<=")) return of_numbers(Operation::less_equal, a, sum(), true);
      if (take(">=")) return turned(of_numbers(Operation::less_equal, sum(), a, true), a);
      if (take("==")) return of_numbers(Operation::equal, a, sum(), true);
      if (take("!=")) return of_numbers(Operation::unequal, a, sum(), true);
      if (take("<")) return of_numbers(Operation::less, a, sum(), true);
      if (take(">")) return turned(of_numbers(Operation::less, sum(), a, true), a);
      return {};
    };
    const std::optional<Term> compared = compare();
    if (!compared) return a;
    skip();
    for (const std::string_view sign : {"<", ">", "==", "!="})
      if (text_.substr(at_).starts_with(sign))
        fail(at_, "found " + reading::in_quotes(sign) +
                      " after a comparison, expected 'and' between two of them");
    return *compared;
  }
  static Term turned(Term t, const Term& first) {
    t.place = first.place;
    return t;
  }
  Term sum() {
    Term t = product();
    for (;;)
      if (take("+"))
        t = of_numbers(Operation::add, t, product());
      else if (take("-"))
        t = of_numbers(Operation::subtract, t, product());
      else
        return t;
  }
  Term product() {
    Term t = sign();
    for (;;)
      if (take("*")) {
        if (at_ < text_.size() && text_[at_] == '*')
          fail(at_ - 1, "found '**', expected '^' for a power");
        t = of_numbers(Operation::multiply, t, sign());
      } else if (take("/")) {
        t = of_numbers(Operation::divide, t, sign());
      } else {
        return t;
      }
  }
  Term sign() {
    skip();
    const std::size_t from = at_;
    const bool plus = take("+"), minus = !plus && take("-");
    if (!plus && !minus) return power();
    const Depth depth(*this);
    const int of = number(sign());
    return {plus ? of : tape_.add({Operation::negative, of, -1, -1, 0}), false, from};
  }
  /// Powers with a whole number are products: x^2 has a derivative where x is negative.
  Term power() {
    const Term base = primary();
    if (!take("^")) return base;
    const Depth depth(*this);
    const Term exponent = sign();
    const Instruction& e = tape_[number(exponent)];
    constexpr double largest = 1000;
    if (e.operation == Operation::number && e.number == std::floor(e.number) &&
        std::abs(e.number) <= largest)
      return {tape_.add({Operation::whole_power, number(base), -1, -1, e.number}), false,
              base.place};
    return of_numbers(Operation::power, base, exponent);
  }
  Term primary() {
    const Depth depth(*this);
    skip();
    const std::size_t from = at_;
    if (at_ == text_.size())
      fail(at_, from == 0 ? "is empty, expected a formula" : "ends where a number is expected");
    if (take("(")) {
      Term t = any();
      if (!take(")")) {
        if (at_ < text_.size()) fail_at_sign(", expected an operator or ')'");
        fail(from, "a bracket '(' is not closed");
      }
      t.place = from;
      return t;
    }
    if (digit(text_[at_]) || (text_[at_] == '.' && at_ + 1 < text_.size() && digit(text_[at_ + 1])))
      return {tape_.number(written_number()), false, from};
    if (letter(text_[at_])) return named(from);
    if (text_[at_] == '\'') {
      if (word_at(at_).size() == 1) fail(from, "a quote ' is not closed");
      return named(from);
    }
    fail_at_sign(", expected a number or a name");
  }
  double written_number() {
    double x = 0;
    const char* begin = text_.data() + at_;
    const auto [end, error] = std::from_chars(begin, text_.data() + text_.size(), x);
    if (error != std::errc{})
      fail(at_, "found a number that no double can hold, expected one below 1.8e308");
    const std::size_t from = at_;
    at_ += static_cast<std::size_t>(end - begin);
    if (at_ < text_.size() && (letter(text_[at_]) || text_[at_] == '.'))
      fail(from, "found " + reading::in_quotes(text_.substr(from, at_ - from + 1)) +
                     ", expected an operator after the number");
    return x;
  }
  /// "der(x)" from a name and the brackets behind it, without blanks; empty: they do not close.
  std::string with_brackets(std::size_t from) const {
    const std::size_t close = text_.find(')', from);
    std::string whole;
    if (close != std::string_view::npos)
      for (const char c : text_.substr(from, close + 1 - from))
        if (c != ' ' && c != '\t' && c != '\n') whole += c;
    return whole;
  }
  Term of_name(const FormulaNames::Meaning& known, std::size_t from) {
    return {known.variable < 0 ? tape_.number(known.number)
                               : tape_.add({Operation::variable, known.variable, -1, -1, 0}),
            false, from};
  }
  Term named(std::size_t from) {
    const std::string_view word = word_at(from);
    at_ += word.size();
    skip();
    const bool called = at_ < text_.size() && text_[at_] == '(';
    const auto* function = std::find_if(functions.begin(), functions.end(),
                                        [&](const Function& f) { return f.name == word; });
    if (const auto local = locals_.find(word); local != locals_.end()) {
      if (called)
        fail(from,
             reading::in_quotes(word) + " is no function, expected an operator between it and '('");
      return {local->second.at, local->second.truth, from};
    }
    if (called && function != functions.end()) return call(*function, from);
    if (called)
      if (auto spline = names_.function(word)) return value_of(std::move(spline), word, from);
    if (!called)
      if (const auto known = names_.meaning(word, from)) return of_name(*known, from);
    if (called) {
      const std::string whole = with_brackets(from);
      const std::string_view name = whole.empty() ? word : std::string_view(whole);
      const std::string expected = names_.expected_in_brackets(word, name);
      if (!expected.empty()) {
        const auto known = whole.empty() ? std::nullopt : names_.meaning(name, from);
        if (!known) fail(from, "unknown name " + reading::in_quotes(name) + expected);
        at_ = text_.find(')', at_) + 1;
        return of_name(*known, from);
      }
    }
    if (called && (names_.meaning(word, from) || word == "pi"))
      fail(from,
           reading::in_quotes(word) + " is no function, expected an operator between it and '('");
    if (word == "pi" && !called) return {tape_.number(std::numbers::pi), false, from};
    if (function != functions.end())
      fail(from,
           "function " + reading::in_quotes(word) + " stands without '(', expected its arguments");
    if (!called) {
      const std::string here = number_elsewhere(word);
      fail(from, "unknown name " + reading::in_quotes(word) +
                     (here.empty() ? names_.expected(word) : ", expected " + here));
    }
    if (const std::string here = function_elsewhere(word); !here.empty())
      fail(from, "unknown function " + reading::in_quotes(word) + ", expected " + here);
    std::string lower(word);
    for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (is_function(lower))
      fail(from, "unknown function " + reading::in_quotes(word) + "; did you mean " +
                     reading::in_quotes(lower) + "?");
    std::vector<std::string_view> near;
    for (const Function& f : functions) near.push_back(f.name);
    for (const std::string_view name : names_.functions()) near.push_back(name);
    const std::string meant = reading::did_you_mean(word, near);
    fail(from, "unknown function " + reading::in_quotes(word) +
                   (!meant.empty() ? meant : ", expected one of: " + reading::listed(near)));
  }
  std::vector<Term> arguments_of(std::string_view name, int expected, std::size_t from) {
    take("(");
    std::vector<Term> arguments;
    if (!take(")")) {
      do arguments.push_back(any());
      while (take(","));
      if (!take(")")) {
        if (at_ < text_.size()) fail_at_sign(", expected ',' or ')'");
        fail(at_, "the bracket of function " + reading::in_quotes(name) + " is not closed");
      }
    }
    if (static_cast<int>(arguments.size()) != expected)
      fail(from, "function " + reading::in_quotes(name) + " has " +
                     std::to_string(arguments.size()) + " arguments, expected " +
                     std::to_string(expected));
    return arguments;
  }
  Term value_of(std::shared_ptr<const CubicSpline> spline, std::string_view name,
                std::size_t from) {
    const int x = number(arguments_of(name, 1, from).front());
    splines_.push_back(std::move(spline));
    return {tape_.add({Operation::spline, x, -1, -1, 0, splines_.back().get()}), false, from};
  }
  Term call(const Function& f, std::size_t from) {
    const int expected = operands_of(f.operation);
    const std::vector<Term> arguments = arguments_of(f.name, expected, from);
    Instruction in{f.operation, -1, -1, -1, 0};
    if (f.operation != Operation::choice) {
      in.a = number(arguments[0]);
      if (expected > 1) in.b = number(arguments[1]);
      return {tape_.add(in), false, from};
    }
    in.a = truth(arguments[0]);
    in.b = number(arguments[1]);
    in.c = number(arguments[2]);
    const Instruction& condition = tape_[in.a];
    if (condition.operation == Operation::number)
      return {condition.number != 0 ? in.b : in.c, false, from};
    return {tape_.add(in), false, from};
  }

  /// Counts how deep a formula is nested, which the parser recurses over.
  class Depth {
   public:
    explicit Depth(Parser& parser) : parser_(parser) {
      if (++parser_.depth_ > deepest)
        parser_.fail(parser_.at_, "is nested more than " + std::to_string(deepest) + " deep");
    }
    ~Depth() { --parser_.depth_; }
    Depth(const Depth&) = delete;
    Depth& operator=(const Depth&) = delete;

   private:
    Parser& parser_;
  };

  std::string_view text_;
  FormulaNames& names_;
  std::size_t at_ = 0;
  int depth_ = 0;
  Tape tape_;
  std::map<std::string_view, Term> locals_;  ///< by ":="
  std::vector<std::shared_ptr<const CubicSpline>> splines_;
};

}  // namespace

Parsed parse(std::string_view text, FormulaNames& names) {
  Parser parser(text, names);
  const Term t = parser.whole();
  return {parser.tape(), parser.take_splines(), t.at, t.truth};
}

std::string_view function_name(Operation operation) {
  for (const Function& f : functions)
    if (f.operation == operation) return f.name;
  return {};
}

bool is_function(std::string_view name) {
  return std::any_of(functions.begin(), functions.end(),
                     [&](const Function& f) { return f.name == name; });
}

}  // namespace formula
}  // namespace momenta
