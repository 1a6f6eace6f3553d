#include <momenta/dae/measure/drive_power.h>
#include <momenta/dae/study/integrated_work.h>
#include <momenta/dae/study/measured_columns.h>
#include <momenta/dae/study/own_reference_forces.h>
#include <momenta/dae/study/run_form.h>

#include <algorithm>
#include <cmath>

namespace momenta {

OwnReferenceForces::OwnReferenceForces(const Mechanism& mechanism)
    : mechanism_(mechanism),
      e_(mechanism.evaluation<double>()),
      solver_(mechanism.m() > 0 ? make_loop_solver(mechanism, *e_) : nullptr),
      forces_(mechanism, *e_, solver_.get(), true),
      works_(IntegratedWork::has_any(mechanism) || DrivePower(mechanism, *e_, solver_.get()).any()),
      momenta_(static_cast<std::size_t>(mechanism.nv())) {
  for (const Column& c : mechanism.effort_columns()) columns_.push_back(c.label());
  const std::vector<std::string> without = trajectory_columns(mechanism),
                                 with = trajectory_columns(mechanism, true);
  columns_.insert(columns_.end(), with.begin() + static_cast<std::ptrdiff_t>(without.size()),
                  with.end());
  for (const Column& c : momentum_columns(mechanism)) columns_.push_back(c.label());
  columns_.emplace_back("work [J]");
}

void OwnReferenceForces::add(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& u,
                             const Eigen::VectorXd& udot, const Eigen::VectorXd& lambda) {
  forces_.solve(t, q, u);
  forces_.take(udot, lambda);
  std::vector<double> all;
  std::vector<std::size_t> open;  // not a number: reactions and efforts
  forces_.append(all, open);
  e_->place(t, q.data());
  e_->move(u.data());
  e_->momenta(nullptr, momenta_.data());
  all.insert(all.end(), momenta_.begin(), momenta_.end());
  all.push_back(e_->kinetic() + e_->potential(q.data()));
  // λ and how many are not unique come first.
  all.erase(all.begin(), all.end() - static_cast<std::ptrdiff_t>(columns_.size()));
  rows_.push_back(std::move(all));
}

void OwnReferenceForces::append(std::vector<std::string>& columns,
                                std::vector<std::vector<double>>& rows) const {
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    const bool work = c + 1 == columns_.size();
    const auto everywhere = [&](auto&& is) {
      return std::all_of(rows_.begin(), rows_.end(),
                         [&](const std::vector<double>& row) { return is(row[c]); });
    };
    if (work ? !works_ : !everywhere([](double x) { return std::isfinite(x); })) continue;
    const bool load = columns_[c].find(".force_") != std::string::npos ||
                      columns_[c].find(".torque_") != std::string::npos;
    if (load && mechanism_.plan().planar && everywhere([](double x) { return x == 0; })) continue;
    columns.push_back(columns_[c]);
    for (std::size_t i = 0; i < rows_.size(); ++i)
      rows[i].push_back(rows_[i][c] - (work ? rows_.front()[c] : 0));
  }
}

}  // namespace momenta
