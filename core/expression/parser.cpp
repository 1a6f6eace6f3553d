// The grammar of expression.h, one function a line; before the formula stand definitions of names
// for its parts,
//
//   whole:      { name ":=" or ";" } or
//
// which the rest of the text may use: "r := hypot(x, y); 1/r - 1/r^2".

#include <momenta/core/expression/evaluate.h>
#include <momenta/core/expression/function_names.h>
#include <momenta/core/expression/parser.h>
#include <momenta/core/expression/scanner.h>
#include <momenta/core/expression/tape.h>
#include <momenta/core/text/quoting.h>

#include <map>
#include <numbers>
#include <optional>

namespace momenta {
namespace formula {
namespace {

constexpr int deepest = 200;  // nested brackets and signs

/// An instruction and its kind of value.
struct Term {
  int at;
  bool truth;
  std::size_t place;  ///< where its text begins
};

class Parser : Scanner {
 public:
  Parser(std::string_view text, FormulaNames& names) : Scanner(text), names_(names) {}

  Term whole() {
    while (const std::optional<std::string_view> name = defined_name()) define(*name);
    const Term t = any();
    skip_blanks();
    if (!at_end()) fail_here(", expected an operator or the end");
    return t;
  }
  const Tape& tape() const { return tape_; }
  std::vector<std::shared_ptr<const CubicSpline>> take_splines() { return std::move(splines_); }

 private:
  /// The name before ":=", which is read too; nothing: no definition stands here.
  std::optional<std::string_view> defined_name() {
    skip_blanks();
    if (!at_letter()) return {};
    const std::size_t from = place();
    const std::string_view name = word();
    go_to(from + name.size());
    if (take(":=")) {
      if (!is_plain_name(name) || is_reserved_name(name) || locals_.contains(name) ||
          names_.meaning(name, from))
        fail(from, reading::in_quotes(name) +
                       " is no new name, expected letters, digits and _ for what ':=' defines");
      return name;
    }
    go_to(from);
    return {};
  }
  void define(std::string_view name) {
    const Term t = any();
    locals_.emplace(name, t);
    if (!take(";")) fail_here(", expected ';' after the definition of " + reading::in_quotes(name));
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
    skip_blanks();
    const std::size_t from = place();
    if (!take_word("not")) return comparison();
    const Depth depth(*this);
    return {tape_.add({Operation::opposite, truth(opposite()), -1, -1, 0}), true, from};
  }
  Term comparison() {
    const Term a = sum();
    if (take("<>")) fail(place() - 2, "found '<>', expected '!='");
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
    skip_blanks();
    for (const std::string_view sign : {"<", ">", "==", "!="})
      if (rest().starts_with(sign))
        fail(place(), "found " + reading::in_quotes(sign) +
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
        if (rest().starts_with('*')) fail(place() - 1, "found '**', expected '^' for a power");
        t = of_numbers(Operation::multiply, t, sign());
      } else if (take("/")) {
        t = of_numbers(Operation::divide, t, sign());
      } else {
        return t;
      }
  }
  Term sign() {
    skip_blanks();
    const std::size_t from = place();
    const bool plus = take("+"), minus = !plus && take("-");
    if (!plus && !minus) return power();
    const Depth depth(*this);
    const int of = number(sign());
    return {plus ? of : tape_.add({Operation::negative, of, -1, -1, 0}), false, from};
  }
  /// Powers with whole exponents are products: x^2 has a derivative where x is negative.
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
    skip_blanks();
    const std::size_t from = place();
    if (at_end())
      fail(from, from == 0 ? "is empty, expected a formula" : "ends where a number is expected");
    if (take("(")) {
      Term t = any();
      if (!take(")")) {
        if (!at_end()) fail_here(", expected an operator or ')'");
        fail(from, "a bracket '(' is not closed, expected ')'");
      }
      t.place = from;
      return t;
    }
    if (at_number()) return {tape_.number(take_number()), false, from};
    if (at_letter()) return named(from);
    if (rest().front() == '\'') {
      if (word().size() == 1)
        fail(from, "a quote ' is not closed, expected another ' behind a name");
      return named(from);
    }
    fail_here(", expected a number or a name");
  }
  Term of_name(const FormulaNames::Meaning& known, std::size_t from) {
    return {known.variable < 0 ? tape_.number(known.number)
                               : tape_.add({Operation::variable, known.variable, -1, -1, 0}),
            false, from};
  }
  Term named(std::size_t from) {
    const std::string_view word = this->word();
    go_to(from + word.size());
    skip_blanks();
    const bool called = rest().starts_with('(');
    const std::optional<Operation> function = function_of_name(word);
    if (const auto local = locals_.find(word); local != locals_.end()) {
      if (called)
        fail(from,
             reading::in_quotes(word) + " is no function, expected an operator between it and '('");
      return {local->second.at, local->second.truth, from};
    }
    if (called && function) return call(word, *function, from);
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
        go_to(place() + rest().find(')') + 1);
        return of_name(*known, from);
      }
    }
    if (called && (names_.meaning(word, from) || word == "pi"))
      fail(from,
           reading::in_quotes(word) + " is no function, expected an operator between it and '('");
    if (word == "pi" && !called) return {tape_.number(std::numbers::pi), false, from};
    if (function)
      fail(from,
           "function " + reading::in_quotes(word) + " stands without '(', expected its arguments");
    if (!called) {
      const std::string here = number_elsewhere(word);
      fail(from, "unknown name " + reading::in_quotes(word) +
                     (here.empty() ? names_.expected(word) : ", expected " + here));
    }
    fail(from, unknown_function(word, names_.functions()));
  }
  std::vector<Term> arguments_of(std::string_view name, int expected, std::size_t from) {
    take("(");
    std::vector<Term> arguments;
    if (!take(")")) {
      do arguments.push_back(any());
      while (take(","));
      if (!take(")")) {
        if (!at_end()) fail_here(", expected ',' or ')'");
        fail(place(), "the bracket of function " + reading::in_quotes(name) +
                          " is not closed, expected ')'");
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
  Term call(std::string_view name, Operation function, std::size_t from) {
    const int expected = operands_of(function);
    const std::vector<Term> arguments = arguments_of(name, expected, from);
    Instruction in{function, -1, -1, -1, 0};
    if (function != Operation::choice) {
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

  /// Counts the nesting of the formula, over which the parser recurses.
  class Depth {
   public:
    explicit Depth(Parser& parser) : parser_(parser) {
      if (++parser_.depth_ > deepest)
        parser_.fail(parser_.place(), "is nested more than " + std::to_string(deepest) +
                                          " deep, expected fewer brackets");
    }
    ~Depth() { --parser_.depth_; }
    Depth(const Depth&) = delete;
    Depth& operator=(const Depth&) = delete;

   private:
    Parser& parser_;
  };

  FormulaNames& names_;
  int depth_ = 0;
  Tape tape_;
  std::map<std::string_view, Term> locals_;  ///< names by ":="
  std::vector<std::shared_ptr<const CubicSpline>> splines_;
};

}  // namespace

Parsed parse(std::string_view text, FormulaNames& names) {
  Parser parser(text, names);
  const Term t = parser.whole();
  return {parser.tape(), parser.take_splines(), t.at, t.truth};
}

}  // namespace formula
}  // namespace momenta
