#include <momenta/core/expression/evaluate.h>
#include <momenta/core/expression/function_names.h>
#include <momenta/core/expression/parser.h>
#include <momenta/core/expression/simplify.h>
#include <momenta/core/expression/spline.h>
#include <momenta/core/expression/tape.h>
#include <momenta/core/text/quoting.h>

#include <algorithm>

namespace momenta {
namespace {

/// Variables by a list of their names.
class Listed final : public FormulaNames {
 public:
  explicit Listed(std::span<const std::string> names) : names_(names) {}
  std::optional<Meaning> meaning(std::string_view name, std::size_t) override {
    const auto known = std::find(names_.begin(), names_.end(), name);
    if (known == names_.end()) return {};
    return Meaning{static_cast<int>(known - names_.begin()), 0};
  }
  std::string expected(std::string_view name) const override {
    std::vector<std::string_view> near(names_.begin(), names_.end());
    near.push_back("pi");
    if (name.ends_with(".dot")) {  // as files of equations have it
      const std::string rate = "der(" + std::string(name.substr(0, name.size() - 4)) + ")";
      if (std::find(near.begin(), near.end(), rate) != near.end())
        return "; did you mean " + reading::in_quotes(rate) + "?";
    }
    const std::string meant = reading::did_you_mean(name, near);
    return !meant.empty() ? meant : ", expected one of: " + reading::listed(near);
  }
  std::string expected_in_brackets(std::string_view word, std::string_view name) const override {
    std::vector<std::string_view> near;
    const std::string opened = std::string(word) + "(";
    for (const std::string& one : names_)
      if (one.starts_with(opened)) near.push_back(one);
    if (near.empty()) return "";
    const std::string meant = reading::did_you_mean(name, near);
    return !meant.empty() ? meant : ", expected one of: " + reading::listed(near);
  }

 private:
  std::span<const std::string> names_;
};

}  // namespace

bool is_plain_name(std::string_view name) {
  const auto letter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
  };
  return !name.empty() && letter(name.front()) &&
         std::all_of(name.begin(), name.end(),
                     [&](char c) { return letter(c) || (c >= '0' && c <= '9'); });
}

bool is_reserved_name(std::string_view name) {
  return name == "pi" || name == "t" || name == "and" || name == "or" || name == "not" ||
         formula::function_of_name(name);
}

Expression::Expression(std::string_view text, std::span<const std::string> names) {
  Listed listed(names);
  *this = Expression(text, listed);
}

Expression::Expression(std::string_view text, FormulaNames& names) {
  formula::Parsed parsed = formula::parse(text, names);
  keep(parsed.tape, {parsed.at});
  truth_ = parsed.truth;
  splines_ = std::move(parsed.splines);
}

Expression::Expression(const formula::Tape& tape, std::span<const int> outputs) {
  std::vector<int> at(outputs.begin(), outputs.end());
  const std::vector<Instruction> needed = tape.needed_for(at);
  formula::Tape simple;
  const std::vector<int> place = formula::add_simplified(simple, needed, {});
  for (int& i : at) i = place[static_cast<std::size_t>(i)];
  keep(simple, std::move(at));
}

void Expression::keep(const formula::Tape& tape, std::vector<int> outputs) {
  tape_ = tape.needed_for(outputs);
  outputs_ = std::move(outputs);
  steps_ = formula::steps_of(tape_, outputs_);
}

Expression Expression::with(const formula::Tape& tape, std::vector<int> outputs) const {
  Expression all;
  all.splines_ = splines_;
  all.keep(tape, std::move(outputs));
  return all;
}

Expression Expression::with_derivatives(std::span<const int> variables) const {
  formula::Tape tape(tape_);
  std::vector<int> outputs{outputs_.front()};
  const std::vector<int> slopes = formula::add_gradient(tape, outputs_.front(), variables);
  outputs.insert(outputs.end(), slopes.begin(), slopes.end());
  return with(tape, std::move(outputs));
}

Expression Expression::with_two_derivatives(int variable) const {
  formula::Tape tape(tape_);
  std::vector<int> outputs{outputs_.front()};
  for (int i = 0; i < 2; ++i)
    outputs.push_back(formula::add_gradient(tape, outputs.back(), std::span(&variable, 1)).front());
  return with(tape, std::move(outputs));
}

Expression Expression::with_second_derivatives(std::span<const int> variables) const {
  formula::Tape tape(tape_);
  std::vector<int> outputs{outputs_.front()};
  const std::vector<int> slopes = formula::add_gradient(tape, outputs_.front(), variables);
  outputs.insert(outputs.end(), slopes.begin(), slopes.end());
  for (std::size_t v = 0; v < slopes.size(); ++v) {
    const std::vector<int> bends =
        formula::add_gradient(tape, slopes[v], variables.subspan(0, v + 1));
    outputs.insert(outputs.end(), bends.begin(), bends.end());
  }
  return with(tape, std::move(outputs));
}

std::vector<int> Expression::variables() const {
  std::vector<int> all;
  for (const Instruction& in : tape_)
    if (in.operation == Operation::variable) all.push_back(in.a);
  std::sort(all.begin(), all.end());
  return all;
}

std::string_view Expression::corner() const {
  for (const Operation o : {Operation::abs, Operation::sign, Operation::floor, Operation::min,
                            Operation::max, Operation::choice})
    for (const Instruction& in : tape_)
      if (in.operation == o) return formula::function_name(o);
  for (const Instruction& in : tape_)
    if (in.operation == Operation::spline && in.spline->between() != Interpolation::cubic)
      return in.spline->between() == Interpolation::linear ? "a linear function"
                                                           : "a monotone function";
  return {};
}

double Expression::operator()(std::span<const double> x) const {
  std::vector<double> line(tape_.size()), values(outputs_.size());
  evaluate(*this, x.data(), line.data(), values.data());
  return values.front();
}

}  // namespace momenta
