#include <momenta/core/expression/function_names.h>
#include <momenta/core/expression/other_notation.h>
#include <momenta/core/text/near_name.h>

#include <algorithm>
#include <array>
#include <cctype>
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

}  // namespace momenta::formula
