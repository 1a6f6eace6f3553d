#include <momenta/core/expression/function_names.h>
#include <momenta/core/text/quoting.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <span>
#include <vector>

namespace momenta::formula {

namespace {

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

}  // namespace

std::optional<Operation> function_of_name(std::string_view name) {
  for (const Function& f : functions)
    if (f.name == name) return f.operation;
  return {};
}

std::string_view function_name(Operation operation) {
  for (const Function& f : functions)
    if (f.operation == operation) return f.name;
  return {};
}

std::string unknown_function(std::string_view name, std::span<const std::string_view> of_scene) {
  const std::string unknown = "unknown function " + reading::in_quotes(name);
  if (const std::string here = function_elsewhere(name); !here.empty())
    return unknown + ", expected " + here;
  std::string lower(name);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (function_of_name(lower)) return unknown + "; did you mean " + reading::in_quotes(lower) + "?";
  std::vector<std::string_view> near;
  for (const Function& f : functions) near.push_back(f.name);
  near.insert(near.end(), of_scene.begin(), of_scene.end());
  const std::string meant = reading::did_you_mean(name, near);
  return unknown + (!meant.empty() ? meant : ", expected one of: " + reading::listed(near));
}

namespace {

struct OtherName {
  std::string_view elsewhere, here;
};

constexpr std::array other_functions{
    OtherName{"ln", "log(x)"},
    OtherName{"log10", "log(x)/log(10)"},
    OtherName{"log2", "log(x)/log(2)"},
    OtherName{"lg", "log(x)/log(10)"},
    OtherName{"arcsin", "asin(x)"},
    OtherName{"arccos", "acos(x)"},
    OtherName{"arctan", "atan(x)"},
    OtherName{"arctan2", "atan2(y, x)"},
    OtherName{"tg", "tan(x)"},
    OtherName{"cot", "1/tan(x)"},
    OtherName{"ctg", "1/tan(x)"},
    OtherName{"sec", "1/cos(x)"},
    OtherName{"csc", "1/sin(x)"},
    OtherName{"asinh", "log(x + sqrt(x^2 + 1))"},
    OtherName{"acosh", "log(x + sqrt(x^2 - 1))"},
    OtherName{"atanh", "log((1 + x)/(1 - x))/2"},
    OtherName{"pow", "x^y"},
    OtherName{"power", "x^y"},
    OtherName{"sqr", "x^2"},
    OtherName{"square", "x^2"},
    OtherName{"root", "sqrt(x)"},
    OtherName{"cbrt", "sign(x)*abs(x)^(1/3)"},
    OtherName{"sgn", "sign(x)"},
    OtherName{"signum", "sign(x)"},
    OtherName{"fabs", "abs(x)"},
    OtherName{"norm", "hypot(x, y)"},
    OtherName{"ceil", "-floor(-x)"},
    OtherName{"round", "floor(x + 0.5)"},
    OtherName{"mod", "x - y*floor(x/y)"},
    OtherName{"fmod", "x - y*floor(x/y)"},
    OtherName{"heaviside", "if(x < 0, 0, 1)"},
    OtherName{"iif", "if(c, a, b)"},
    OtherName{"where", "if(c, a, b)"},
    OtherName{"sum", "x + y"},
    OtherName{"diff", "a formula without derivatives: the program makes them"},
};

constexpr std::array other_numbers{OtherName{"e", "exp(1)"}, OtherName{"PI", "pi"},
                                   OtherName{"Pi", "pi"}};

// Longer ones first.
constexpr std::array other_signs{
    OtherName{"&&", "and"}, OtherName{"||", "or"},  OtherName{"=<", "<="},
    OtherName{"=>", ">="},  OtherName{"<>", "!="},  OtherName{"=", "=="},
    OtherName{"!", "not"},  OtherName{"·", "*"},    OtherName{"×", "*"},
    OtherName{"∗", "*"},    OtherName{"÷", "/"},    OtherName{"−", "-"},
    OtherName{"–", "-"},    OtherName{"²", "^2"},   OtherName{"³", "^3"},
    OtherName{"½", "0.5"},  OtherName{"¼", "0.25"}, OtherName{"π", "pi"},
    OtherName{"√", "sqrt"}, OtherName{"≤", "<="},   OtherName{"≥", ">="},
    OtherName{"≠", "!="},   OtherName{"[", "("},    OtherName{"]", ")"},
    OtherName{"{", "("},    OtherName{"}", ")"},    OtherName{"?", "if(c, a, b)"},
};

std::string_view here_for(std::span<const OtherName> all, std::string_view name) {
  const auto* end = all.data() + all.size();
  const auto* pair =
      std::find_if(all.data(), end, [&](const OtherName& p) { return p.elsewhere == name; });
  return pair == end ? std::string_view() : pair->here;
}

}  // namespace

std::string function_elsewhere(std::string_view name) {
  std::string lower(name);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return std::string(here_for(other_functions, lower));
}

std::string number_elsewhere(std::string_view name) {
  return std::string(here_for(other_numbers, name));
}

std::string sign_elsewhere(std::string_view text) {
  for (const OtherName& p : other_signs)
    if (text.starts_with(p.elsewhere)) return reading::in_quotes(p.here);
  return "";
}

}  // namespace momenta::formula
