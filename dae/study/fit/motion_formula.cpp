#include <momenta/core/expression/evaluate.h>
#include <momenta/core/text/quoting.h>
#include <momenta/dae/study/fit/motion_formula.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <numeric>
#include <optional>
#include <stdexcept>

namespace momenta {
namespace {

using Kind = MotionPart::Kind;

constexpr std::array<std::pair<std::string_view, Kind>, 6> kinds{{{"max", Kind::most},
                                                                  {"min", Kind::least},
                                                                  {"mean", Kind::mean},
                                                                  {"integral", Kind::integral},
                                                                  {"first", Kind::first},
                                                                  {"last", Kind::last}}};

[[noreturn]] void refuse(const std::string& text, const std::string& why) {
  throw std::invalid_argument(reading::in_quotes(text) + ": " + why);
}

bool in_name(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '.' || c == '\'';
}

/// End of the quoted name that begins at `at`; end of the text if not closed.
std::size_t after_quotes(const std::string& text, std::size_t at) {
  const std::size_t end = text.find('\'', at + 1);
  return end == std::string::npos ? text.size() : end + 1;
}

/// Place where the bracket opened at `at` closes; whether a comma stands directly in it.
std::size_t closing(const std::string& text, std::size_t at, bool& comma) {
  int depth = 0;
  comma = false;
  for (std::size_t i = at; i < text.size(); ++i) {
    if (text[i] == '\'')
      i = after_quotes(text, i) - 1;
    else if (text[i] == '(')
      ++depth;
    else if (text[i] == ')' && --depth == 0)
      return i;
    else if (text[i] == ',' && depth == 1)
      comma = true;
  }
  refuse(text, "a bracket is not closed, expected ')'");
}

/// Whether the formula is a number and takes `names` alone.
bool is_of(const std::string& formula, const std::vector<std::string>& names) {
  try {
    return !Expression(formula, names).is_truth();
  } catch (const ExpressionError&) {
    return false;
  }
}

}  // namespace

SmoothFormula::SmoothFormula(const std::string& formula, const std::vector<std::string>& names) {
  try {
    const Expression plain(formula, names);
    if (plain.is_truth()) refuse(formula, "is a comparison; expected a formula with a value");
    used_ = plain.variables();
    formula_ = std::make_unique<Expression>(plain.with_derivatives(used_));
  } catch (const ExpressionError& error) {
    refuse(formula, error.what());
  }
}

double SmoothFormula::operator()(const Eigen::VectorXd& x, Eigen::VectorXd* by) const {
  std::vector<double> line(formula_->tape().size()), values(1 + used_.size());
  evaluate(*formula_, x.data(), line.data(), values.data());
  if (by) {
    by->setZero(x.size());
    for (std::size_t i = 0; i < used_.size(); ++i) (*by)[used_[i]] = values[i + 1];
  }
  return values[0];
}

MotionFormula MotionFormula::from_text(const std::string& text) {
  MotionFormula f;
  f.text = text;
  for (std::size_t i = 0; i < text.size();) {
    if (text[i] == '\'') {
      const std::size_t end = after_quotes(text, i);
      f.outer += text.substr(i, end - i);
      i = end;
      continue;
    }
    const bool begins =
        std::isalpha(static_cast<unsigned char>(text[i])) && (i == 0 || !in_name(text[i - 1]));
    if (!begins) {
      f.outer += text[i++];
      continue;
    }
    std::size_t end = i;
    while (end < text.size() && in_name(text[end]) && text[end] != '\'') ++end;
    const std::string word = text.substr(i, end - i);
    const auto kind =
        std::find_if(kinds.begin(), kinds.end(), [&](const auto& k) { return k.first == word; });
    const std::size_t bracket = text.find_first_not_of(' ', end);
    f.outer += word;
    i = end;
    if (kind == kinds.end() || bracket == std::string::npos || text[bracket] != '(') continue;
    bool comma = false;
    const std::size_t close = closing(text, bracket, comma);
    if (comma) continue;
    const std::string inner = text.substr(bracket + 1, close - bracket - 1);
    if (!from_text(inner).parts.empty())
      refuse(text,
             word + "(…) of a motion holds another; expected a formula of single poses in it");
    f.outer.resize(f.outer.size() - word.size());
    f.outer += name_of(f.parts.size());
    f.parts.push_back({kind->second, inner});
    i = close + 1;
  }
  return f;
}

MotionCondition MotionCondition::from_text(const std::string& text,
                                           const std::vector<std::string>& parameters) {
  std::optional<std::size_t> at;
  std::size_t length = 0;
  int depth = 0;
  constexpr const char* expected =
      "expected one comparison, as in 'a + d <= b + c', and a condition of its own for each";
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\'')
      i = after_quotes(text, i) - 1;
    else if (text[i] == '(')
      ++depth;
    else if (text[i] == ')')
      --depth;
    else if (depth == 0 && std::string_view("<>=!").find(text[i]) != std::string_view::npos) {
      if (at || text[i] == '!') refuse(text, expected);
      at = i;
      length = i + 1 < text.size() && text[i + 1] == '=' ? 2 : 1;
      if (text[i] == '=' && length == 1) refuse(text, "found '=', expected '==', '<=' or '>='");
      i += length - 1;
    }
  }
  if (!at) refuse(text, expected);
  MotionCondition c;
  c.text = text;
  c.equal = text[*at] == '=';
  const auto bracketed = [](const std::string& side) {
    const std::size_t from = side.find_first_not_of(' '), to = side.find_last_not_of(' ');
    return "(" + (from == std::string::npos ? "" : side.substr(from, to - from + 1)) + ")";
  };
  const std::string left = bracketed(text.substr(0, *at)),
                    right = bracketed(text.substr(*at + length));
  std::string gap = text[*at] == '>' ? right + " - " + left : left + " - " + right;
  if (MotionFormula::from_text(gap).parts.empty() && !is_of(gap, parameters)) {
    if (c.equal)
      refuse(text,
             "an equation cannot hold at every pose; expected one of parameters, or of max(…), "
             "mean(…), last(…) and the like");
    gap = "max(" + gap + ")";
  }
  c.gap = MotionFormula::from_text(gap);
  return c;
}

}  // namespace momenta
