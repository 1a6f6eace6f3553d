#include <momenta/core/expression/formula_text.h>
#include <momenta/core/expression/simplify.h>
#include <momenta/core/scalar/sixth_order.h>
#include <momenta/core/scene/formula.h>
#include <momenta/core/text/quoting.h>
#include <momenta/dae/gradient/linear_formulas.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace momenta {
namespace {

bool begins_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

std::string in_formula(double number) {
  const std::string digits = reading::digits(number);
  return digits.front() == '-' ? "(" + digits + ")" : digits;
}

/// A number in a formula, a name, or any other sign.
struct Token {
  std::string text;
  std::optional<double> number;
  bool apart = false;  ///< a blank stands before it
  bool is_name() const {
    return !number && !text.empty() && (begins_name(text.front()) || text.front() == '\'');
  }
};

/// End of the name that begins here: 'left-knee'.q, J.q0.
std::size_t end_of_name(std::string_view text, std::size_t at) {
  if (text[at] == '\'') {
    at = text.find('\'', at + 1);
    if (at == std::string_view::npos) return text.size();
    ++at;
  }
  while (at < text.size() && (begins_name(text[at]) || is_digit(text[at]) || text[at] == '.')) ++at;
  return at;
}

/// Number that begins here, as (−2) with its brackets, and its end.
std::optional<std::pair<double, std::size_t>> number_at(std::string_view text, std::size_t at) {
  const bool in_brackets = text.substr(at).starts_with("(-");
  const std::size_t first = in_brackets ? at + 1 : at;
  std::size_t digit = in_brackets ? at + 2 : at;
  if (digit < text.size() && text[digit] == '.') ++digit;
  if (digit >= text.size() || !is_digit(text[digit])) return {};
  double number = 0;
  const auto [end, error] = std::from_chars(text.data() + first, text.data() + text.size(), number);
  if (error != std::errc{}) return {};
  const auto behind = static_cast<std::size_t>(end - text.data());
  if (!in_brackets) return std::pair{number, behind};
  if (behind >= text.size() || text[behind] != ')') return {};
  return std::pair{number, behind + 1};
}

/// `numbers`: parameters in the formula by name.
std::vector<Token> tokens_of(std::string_view text, std::span<const ParameterSpec> numbers) {
  std::vector<Token> all;
  bool apart = false;
  for (std::size_t at = 0; at < text.size();) {
    if (text[at] == ' ' || text[at] == '\t' || text[at] == '\n' || text[at] == '\r') {
      ++at;
      apart = true;
      continue;
    }
    const auto number = number_at(text, at);
    const bool name = begins_name(text[at]) || text[at] == '\'';
    const std::size_t end = number ? number->second : name ? end_of_name(text, at) : at + 1;
    Token& token = all.emplace_back();
    token.text = text.substr(at, end - at);
    token.apart = apart;
    if (number) token.number = number->first;
    apart = false;
    at = end;
    for (const ParameterSpec& p : numbers)
      if (name && token.text == p.name) token.number = p.value;
  }
  return all;
}

/// A number in the formula that θ changes.
struct Changed {
  double value = 0, slope = 0;
};

std::string joined(std::span<const Token> tokens) {
  std::string text;
  for (const Token& token : tokens) text += (token.apart ? " " : "") + token.text;
  return text;
}

/// The first of "n_", "n__", … that is not in a text.
std::string free_name(const std::string& text) {
  std::string name = "n_";
  while (text.find(name) != std::string::npos) name += "_";
  return name;
}

class LinearFormula {
 public:
  LinearFormula(const Scene& own, double h) : own_(own), h_(h) {}

  /// Makes the texts of neighbours linear, where possible.
  void make(const std::string& own, std::vector<std::string*> near,
            std::span<const ParameterSpec> numbers,
            const std::vector<std::span<const ParameterSpec>>& near_numbers) const {
    std::vector<Token> tokens = tokens_of(own, numbers);
    std::vector<std::vector<Token>> others;
    for (std::size_t k = 0; k < near.size(); ++k) {
      others.push_back(tokens_of(*near[k], near_numbers[k]));
      if (others.back().size() != tokens.size()) return;
    }
    const std::string name = free_name(own);
    std::vector<Changed> changed;
    std::vector<std::string> names;
    for (std::size_t i = 0; i < tokens.size(); ++i) {
      const auto differs = [&](const std::vector<Token>& other) {
        return other[i].number != tokens[i].number;
      };
      for (const std::vector<Token>& other : others)
        if (other[i].number.has_value() != tokens[i].number.has_value() ||
            (!tokens[i].number && other[i].text != tokens[i].text))
          return;
      if (!tokens[i].number || std::none_of(others.begin(), others.end(), differs)) continue;
      const auto number = [&](std::size_t k, double) {
        return Eigen::VectorXd::Constant(1, *others[k][i].number);
      };
      const sixth_order::Slope slope = sixth_order::slope_at(
          h_, sixth_order::exact, 0, Eigen::VectorXd::Constant(1, *tokens[i].number), number);
      if (!slope.agrees) return;
      changed.push_back({*tokens[i].number, slope.by[0]});
      names.push_back(name + std::to_string(names.size()));
      tokens[i].text = "(" + names.back() + ")";
    }
    if (changed.empty()) return;
    std::vector<std::string> calls;
    if (!take_calls(tokens, names, "call" + name, calls)) return;
    for (std::size_t i = 0; i < calls.size(); ++i)
      names.push_back("call" + name + std::to_string(i));
    try {
      const std::vector<std::string> all = linear(joined(tokens), names, changed, calls);
      for (std::size_t k = 0; k < near.size(); ++k) *near[k] = all[k];
    } catch (const std::logic_error&) {  // no formula, or names without a number
    }
  }

 private:
  /// Replaces calls of functions by points by names beginning with `name`; false where an argument
  /// depends on θ.
  bool take_calls(std::vector<Token>& tokens, const std::vector<std::string>& changed,
                  const std::string& name, std::vector<std::string>& calls) const {
    for (std::size_t i = 0; i + 1 < tokens.size(); ++i) {
      if (std::none_of(own_.functions.begin(), own_.functions.end(),
                       [&](const FunctionSpec& f) { return f.name == tokens[i].text; }))
        continue;
      std::size_t end = i + 1;
      for (int depth = 0; end < tokens.size(); ++end) {
        const std::string& text = tokens[end].text;
        if (std::any_of(changed.begin(), changed.end(),
                        [&](const std::string& n) { return text == "(" + n + ")"; }))
          return false;
        depth += text == "(" ? 1 : text == ")" ? -1 : 0;
        if (depth == 0) break;
      }
      if (end == tokens.size()) return false;
      calls.push_back(joined(std::span(tokens).subspan(i, end + 1 - i)));
      tokens[i].text = name + std::to_string(calls.size() - 1);
      tokens.erase(tokens.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                   tokens.begin() + static_cast<std::ptrdiff_t>(end) + 1);
    }
    return true;
  }

  /// f + k h Σ ∂f/∂n ∂n/∂θ, at each point.
  std::vector<std::string> linear(const std::string& text, std::vector<std::string> names,
                                  const std::vector<Changed>& changed,
                                  const std::vector<std::string>& calls) const {
    const std::size_t count = changed.size();
    AnyNames known(std::move(names));
    const Expression f(text, known);
    if (f.is_truth()) throw std::logic_error("a comparison");
    std::vector<int> by(count);
    for (std::size_t i = 0; i < count; ++i) by[i] = static_cast<int>(i);
    formula::Tape tape(f.tape());
    const int value = f.outputs().front();
    const std::vector<int> slopes = formula::add_gradient(tape, value, by);
    int slope = tape.number(0);
    for (std::size_t i = 0; i < count; ++i)
      slope = tape.add(
          formula::Operation::add, slope,
          tape.add(formula::Operation::multiply, tape.number(changed[i].slope), slopes[i]));
    std::vector<int> outputs;
    for (const auto& [k, weight] : sixth_order::points)
      outputs.push_back(
          tape.add(formula::Operation::add, value,
                   tape.add(formula::Operation::multiply, tape.number(k * h_), slope)));
    for (std::size_t i = 0; i < count; ++i) known.names[i] = in_formula(changed[i].value);
    for (std::size_t i = 0; i < calls.size(); ++i) known.names[count + i] = calls[i];
    std::vector<std::string> all;
    for (const int output : outputs) {
      const Expression made(tape, std::span(&output, 1));
      all.push_back(formula::text_of(made.tape(), made.outputs().front(), known.names));
    }
    return all;
  }

  const Scene& own_;
  double h_;
};

/// Law of a drive as a formula of t; empty: none.
std::string law_of_time(const DriveSpec& drive) {
  const auto n = in_formula;
  if (drive.kind == "harmonic")
    return n(drive.offset) + " + " + n(drive.amplitude) + "*sin(" + n(drive.frequency) + "*t + " +
           n(drive.phase) + ")";
  if (drive.kind == "step") {
    const std::string x = "((t - " + n(drive.start) + ")/" + n(drive.duration) + ")";
    return "if(t < " + n(drive.start) + ", " + n(drive.from) + ", if(t < " + n(drive.start) +
           " + " + n(drive.duration) + ", " + n(drive.from) + " + (" + n(drive.to) + " - " +
           n(drive.from) + ")*" + x + "^3*(10 - " + x + "*(15 - 6*" + x + ")), " + n(drive.to) +
           "))";
  }
  if (drive.kind == "polynomial") {
    std::string text;
    for (std::size_t i = drive.coefficients.size(); i-- > 0;)
      text = n(drive.coefficients[i]) + (text.empty() ? "" : " + t*(" + text + ")");
    return text;
  }
  return drive.kind == "formula" ? drive.law : "";
}

/// All formulas of a run, those of drives last, in one order for scenes that differ in numbers
/// alone.
std::vector<std::string*> formulas_in(Scene& scene) {
  std::vector<std::string*> all;
  for (ForceSpec& force : scene.forces)
    each_formula(force, [&](const std::string&, std::string& text) { all.push_back(&text); });
  for (LoopSpec& loop : scene.loops)
    if (!loop.equation.empty()) all.push_back(&loop.equation);
  if (scene.lagrangian) {
    LagrangianSpec& l = *scene.lagrangian;
    for (FormulaSpec* of : {&l.lagrangian, &l.kinetic, &l.potential})
      if (!of->text.empty()) all.push_back(&of->text);
    for (LagrangianSpec::Force& force : l.forces) all.push_back(&force.value.text);
    for (LagrangianSpec::Constraint& c : l.constraints) all.push_back(&c.equation.text);
  }
  for (DriveSpec& drive : scene.drives) all.push_back(&drive.law);
  return all;
}

}  // namespace

void make_formulas_linear(const Scene& own, double h, std::vector<Scene>& near) {
  Scene scene = own;
  if (std::any_of(near.begin(), near.end(),
                  [&](const Scene& other) { return other.drives.size() != own.drives.size(); }))
    return;
  for (std::size_t d = 0; d < own.drives.size(); ++d) {
    const std::string law = law_of_time(own.drives[d]);
    std::vector<std::string> laws;
    for (const Scene& other : near) laws.push_back(law_of_time(other.drives[d]));
    if (std::all_of(laws.begin(), laws.end(), [&](const std::string& text) { return text == law; }))
      continue;
    scene.drives[d].law = law;
    for (std::size_t k = 0; k < near.size(); ++k) {
      near[k].drives[d].kind = "formula";
      near[k].drives[d].law = laws[k];
    }
  }
  const std::vector<std::string*> texts = formulas_in(scene);
  std::vector<std::vector<std::string*>> others;
  std::vector<std::span<const ParameterSpec>> numbers;
  for (Scene& other : near) {
    others.push_back(formulas_in(other));
    if (others.back().size() != texts.size()) return;
    numbers.emplace_back();
    if (own.lagrangian) numbers.back() = other.parameters;
  }
  const LinearFormula linear(own, h);
  std::span<const ParameterSpec> own_numbers;
  if (own.lagrangian) own_numbers = own.parameters;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    std::vector<std::string*> of_near;
    for (const auto& other : others) of_near.push_back(other[i]);
    linear.make(*texts[i], of_near, own_numbers, numbers);
  }
}

}  // namespace momenta
