#include <momenta/core/expression/evaluate.h>
#include <momenta/core/text/quoting.h>
#include <momenta/dae/gradient/functional.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace momenta {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Functional::Name {
  enum class Of { time, coordinate, rate, marker, energy, parameter };
  Of of = Of::time;
  int place = 0;     ///< place in q, u, marker columns or variables; −1: a constant parameter
  double value = 0;  ///< parameter's value
};

Functional::Functional(const std::string& formula, const Mechanism& mechanism,
                       const std::vector<RunVariable>& variables,
                       const std::vector<OtherParameter>& others)
    : mechanism_(mechanism), others_(others), e_(mechanism.evaluation<double>()) {
  using Of = Name::Of;
  std::vector<std::string> names;
  const auto add = [&](const std::string& name, Name meaning) {
    if (std::find(names.begin(), names.end(), name) != names.end()) return;
    names.push_back(name);
    names_.push_back(meaning);
  };
  add("t", {Of::time});
  const auto add_columns = [&](const std::vector<Column>& columns, Of of) {
    for (std::size_t i = 0; i < columns.size(); ++i)
      add(columns[i].name, {of, static_cast<int>(i)});
  };
  for (const ParameterSpec& p : mechanism.scene().parameters) {
    const auto found = std::find_if(variables.begin(), variables.end(), [&](const RunVariable& v) {
      return v.kind == RunVariable::Kind::parameter && v.name == p.name;
    });
    add(p.name,
        {Of::parameter, found == variables.end() ? -1 : static_cast<int>(found - variables.begin()),
         p.value});
  }
  add_columns(mechanism.coordinate_columns(), Of::coordinate);
  add_columns(mechanism.rate_columns(), Of::rate);
  add_columns(mechanism.marker_columns(), Of::marker);
  add("energy", {Of::energy});
  try {
    const Expression plain(formula, names);
    if (plain.is_truth())
      throw std::invalid_argument(reading::in_quotes(formula) +
                                  " is a comparison; expected a formula with a value");
    corner_ = plain.corner();
    used_ = plain.variables();
    formula_ = std::make_unique<Expression>(plain.with_derivatives(used_));
  } catch (const ExpressionError& error) {
    throw std::invalid_argument(reading::in_quotes(formula) + ": " + error.what());
  }
  for (const int v : used_) {
    const Name& name = names_[static_cast<std::size_t>(v)];
    if (name.of == Of::marker && !markers_) markers_ = make_marker_motion<Dual8>(mechanism);
    takes_energy_ |= name.of == Of::energy;
  }
  x_.resize(names.size());
  line_.resize(formula_->tape().size());
  values_.resize(1 + used_.size());
}

Functional::~Functional() = default;

void Functional::take_markers(double t, const VectorXd& q, const VectorXd& u, const MatrixXd& dq,
                              const MatrixXd& du) {
  const auto size = static_cast<Index>(6 * mechanism_.scene().markers.size());
  marker_values_.resize(size);
  marker_tangents_.resize(size, dq.cols());
  std::vector<Dual8> place(static_cast<std::size_t>(q.size())),
      rate(static_cast<std::size_t>(u.size())), out(static_cast<std::size_t>(size));
  for (Index first = 0; first < dq.cols(); first += 8) {
    const Index count = std::min<Index>(8, dq.cols() - first);
    const auto seed = [&](std::vector<Dual8>& x, const VectorXd& value, const MatrixXd& d) {
      for (std::size_t i = 0; i < x.size(); ++i) {
        x[i] = Dual8(value[static_cast<Index>(i)]);
        for (Index k = 0; k < count; ++k)
          x[i].b[static_cast<std::size_t>(k)] = d(static_cast<Index>(i), first + k);
      }
    };
    seed(place, q, dq);
    seed(rate, u, du);
    markers_->at(t, place.data(), rate.data(), out.data());
    for (Index i = 0; i < size; ++i) {
      marker_values_[i] = out[static_cast<std::size_t>(i)].a;
      for (Index k = 0; k < count; ++k)
        marker_tangents_(i, first + k) =
            out[static_cast<std::size_t>(i)].b[static_cast<std::size_t>(k)];
    }
  }
  for (Index j = 0; j < dq.cols(); ++j) {
    const OtherParameter& other = others_[static_cast<std::size_t>(j)];
    if (other.by_mechanisms)
      marker_tangents_.col(j) +=
          other.near->slope(size, [&](Evaluation<double>& e, VectorXd& there) {
            e.place(t, q.data());
            e.move(u.data());
            e.markers(there.data());
          });
  }
}

double Functional::energy(Evaluation<double>& e, double t, const VectorXd& q,
                          const VectorXd& u) const {
  e.place(t, q.data());
  e.move(u.data());
  return e.kinetic() + e.potential(q.data());
}

void Functional::take_energy(double t, const VectorXd& q, const VectorXd& u, const MatrixXd& dq,
                             const MatrixXd& du) {
  energy_ = energy(*e_, t, q, u);
  energy_tangents_.setZero(dq.cols());
  for (Index j = 0; j < dq.cols(); ++j) {
    const double along =
        std::max(dq.col(j).lpNorm<Eigen::Infinity>() / (1 + q.lpNorm<Eigen::Infinity>()),
                 du.col(j).lpNorm<Eigen::Infinity>() / (1 + u.lpNorm<Eigen::Infinity>()));
    if (along > 0)
      energy_tangents_[j] +=
          sixth_order::slope_of(sixth_order::part / along, sixth_order::exact,
                                [&](std::size_t i, double h) {
                                  const double s = sixth_order::k_of(i) * h;
                                  return VectorXd(VectorXd::Constant(
                                      1, energy(*e_, t, q + s * dq.col(j), u + s * du.col(j))));
                                })
              .by[0];
    const OtherParameter& other = others_[static_cast<std::size_t>(j)];
    if (other.by_mechanisms)
      energy_tangents_[j] += other.near->slope(
          1, [&](Evaluation<double>& e, VectorXd& there) { there[0] = energy(e, t, q, u); })[0];
  }
}

double Functional::operator()(double t, const VectorXd& q, const VectorXd& u, const MatrixXd& dq,
                              const MatrixXd& du, VectorXd& dg) {
  using Of = Name::Of;
  if (markers_) take_markers(t, q, u, dq, du);
  if (takes_energy_) take_energy(t, q, u, dq, du);
  for (const int v : used_) {
    const Name& name = names_[static_cast<std::size_t>(v)];
    double& x = x_[static_cast<std::size_t>(v)];
    switch (name.of) {
      case Of::time:
        x = t;
        break;
      case Of::coordinate:
        x = q[name.place];
        break;
      case Of::rate:
        x = u[name.place];
        break;
      case Of::marker:
        x = marker_values_[name.place];
        break;
      case Of::energy:
        x = energy_;
        break;
      case Of::parameter:
        x = name.value;
        break;
    }
  }
  evaluate(*formula_, x_.data(), line_.data(), values_.data());
  dg.setZero(dq.cols());
  for (std::size_t i = 0; i < used_.size(); ++i) {
    const Name& name = names_[static_cast<std::size_t>(used_[i])];
    const double slope = values_[i + 1];
    switch (name.of) {
      case Of::time:
        break;
      case Of::coordinate:
        dg += slope * dq.row(name.place).transpose();
        break;
      case Of::rate:
        dg += slope * du.row(name.place).transpose();
        break;
      case Of::marker:
        dg += slope * marker_tangents_.row(name.place).transpose();
        break;
      case Of::energy:
        dg += slope * energy_tangents_;
        break;
      case Of::parameter:
        if (name.place >= 0) dg[name.place] += slope;
        break;
    }
  }
  return values_[0];
}

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

FunctionalSlopes::FunctionalSlopes(const std::string& formula, const Mechanism& mechanism,
                                   const std::vector<RunVariable>& variables,
                                   const std::vector<OtherParameter>& others)
    : n_(mechanism.nv()),
      none_(2 * static_cast<std::size_t>(n_)),
      along_q_(MatrixXd::Zero(n_, 2 * n_)),
      along_u_(MatrixXd::Zero(n_, 2 * n_)),
      still_(MatrixXd::Zero(n_, static_cast<Index>(variables.size()))),
      of_state_(formula, mechanism, {}, none_),
      of_parameters_(formula, mechanism, variables, others) {
  along_q_.leftCols(n_).setIdentity();
  along_u_.rightCols(n_).setIdentity();
}

double FunctionalSlopes::at(double t, const VectorXd& q, const VectorXd& u, VectorXd& by_q,
                            VectorXd& by_u, VectorXd& by_parameters) {
  of_parameters_(t, q, u, still_, still_, by_parameters);
  const double value = of_state_(t, q, u, along_q_, along_u_, slopes_);
  by_q = slopes_.head(n_);
  by_u = slopes_.tail(n_);
  return value;
}

}  // namespace momenta
