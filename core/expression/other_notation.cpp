#include <momenta/core/expression/other_notation.h>
#include <momenta/core/text/near_name.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <span>

namespace momenta::formula {
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
