#include <momenta/core/text/quoting.h>
#include <momenta/dae/gradient/run_variable.h>
#include <momenta/dae/study/fit/fitted_parameter.h>

#include <charconv>
#include <cmath>
#include <stdexcept>

namespace momenta {

using Eigen::Index;
using Eigen::VectorXd;

std::array<double, 2> range_from_text(const std::string& option, const std::string& text,
                                      const std::string& like) {
  const auto refuse = [&](const std::string& why) {
    throw std::invalid_argument(option + ": " + why);
  };
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) refuse("expected " + like);
  std::array<double, 2> ends{};
  for (int i = 0; i < 2; ++i) {
    const std::string end = i == 0 ? text.substr(0, colon) : text.substr(colon + 1);
    double& to = ends[static_cast<std::size_t>(i)];
    const auto [read, error] = std::from_chars(end.data(), end.data() + end.size(), to);
    if (error != std::errc{} || read != end.data() + end.size() || !std::isfinite(to))
      refuse("found " + reading::in_quotes(end) + ", expected a number");
  }
  if (!(ends[0] < ends[1])) refuse("expected the smaller end first");
  return ends;
}

FittedParameter FittedParameter::from_text(const std::string& text) {
  const std::string option = "--vary " + reading::in_quotes(text);
  FittedParameter parameter;
  const std::size_t equals = text.find('=');
  parameter.name = text.substr(0, equals);
  if (constexpr std::string_view table = "parameters."; parameter.name.starts_with(table))
    parameter.name.erase(0, table.size());  // the prefix is optional
  if (parameter.name.empty())
    throw std::invalid_argument(option + ": expected NAME or NAME=FROM:TO");
  if (equals != std::string::npos)
    parameter.range =
        range_from_text(option, text.substr(equals + 1), "NAME or NAME=FROM:TO, as in crank=0.1:2");
  return parameter;
}

VectorXd sizes_of(const ParametricMechanism& family,
                  const std::vector<FittedParameter>& parameters) {
  VectorXd sizes = family.own().cwiseAbs();
  for (Index j = 0; j < sizes.size(); ++j) {
    const auto& range = parameters[static_cast<std::size_t>(j)].range;
    const double wide = range ? (*range)[1] - (*range)[0] : 0;
    if (range && sizes[j] < 1e-12 * wide)
      sizes[j] = wide;
    else if (!range)
      sizes[j] = step_size(family.own()[j], [&](double value) {
        VectorXd theta = family.own();
        theta[j] = value;
        family.scene(theta);
      });
  }
  return sizes;
}

void bounds_of(const std::vector<FittedParameter>& parameters, Index more, VectorXd& least,
               VectorXd& most) {
  most = VectorXd::Constant(static_cast<Index>(parameters.size()) + more, INFINITY);
  least = -most;
  for (std::size_t j = 0; j < parameters.size(); ++j)
    if (const auto& range = parameters[j].range) {
      least[static_cast<Index>(j)] = (*range)[0];
      most[static_cast<Index>(j)] = (*range)[1];
    }
}

void expect_starts(const ParametricMechanism& family,
                   const std::vector<FittedParameter>& parameters, int starts) {
  if (parameters.empty())
    throw std::invalid_argument("found no parameter to vary, expected the name of one");
  if (parameters.size() != family.names().size())
    throw std::invalid_argument(
        "found other parameters than those of the mechanism, expected the same");
  if (starts < 1) throw std::invalid_argument("found no starts, expected one or more");
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    const FittedParameter& p = parameters[j];
    const double own = family.own()[static_cast<Index>(j)];
    if (!p.range && starts > 1)
      throw std::invalid_argument("parameter '" + p.name +
                                  "' has no range to draw starts from; expected " + p.name +
                                  "=FROM:TO");
    if (p.range && !(own >= (*p.range)[0] && own <= (*p.range)[1]))
      throw std::invalid_argument("parameter '" + p.name + "' is " + reading::digits(own) +
                                  " in the scene, expected a number in its range, from " +
                                  reading::digits((*p.range)[0]) + " to " +
                                  reading::digits((*p.range)[1]));
  }
}

VectorXd DrawnStarts::next() {
  if (!begun_) {
    begun_ = true;
    return family_.own();
  }
  VectorXd values(family_.own().size());
  for (Index j = 0; j < values.size(); ++j) {
    const auto& [from, to] = *parameters_[static_cast<std::size_t>(j)].range;
    const double part = static_cast<double>(random_() >> 11) / 9007199254740992.0;
    values[j] = from + (to - from) * part;
  }
  return values;
}

}  // namespace momenta
