#include <momenta/dae/gradient/levels/direction_sweeps.h>
#include <momenta/dae/gradient/levels/tangent_sweeps.h>
#include <momenta/dae/gradient/table_tangents.h>

#include <algorithm>

namespace momenta {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Whether numbers change that place joints, loops or springs.
template <class Space>
bool moves_places(const NumberPlaces<Space>& places, const VectorXd& numbers) {
  using Places = NumberPlaces<Space>;
  const auto any = [&](Index first, Index count) {
    return !numbers.segment(first, count).isZero(0);
  };
  for (Index at = places.joints; at < places.loops; at += Places::of_joint)
    if (any(at, Places::of_joint - 6)) return true;
  for (Index at = places.springs; at < places.sums; at += Places::of_spring)
    if (any(at, Places::of_spring - 4) || any(at + Places::of_spring - 1, 1)) return true;
  return any(places.loops, places.springs - places.loops);
}

template <class Space>
class TableTangentsOf final : public TableTangents {
 public:
  TableTangentsOf(Model<Space> built, const Mechanism& mechanism,
                  const std::vector<OtherParameter>& others)
      : model_(std::move(built)), loops_(build_loops(mechanism.scene(), mechanism.tree(), model_)) {
    const auto count = static_cast<Index>(others.size());
    r1.setZero(model_.nv, count);
    r2.setZero(loops_.rows, count);
    r3.setZero(model_.nv, count);
    taken.resize(others.size());
    const NumberPlaces<Space> places = number_places(model_, loops_.loops.size());
    for (std::size_t j = 0; j < others.size(); ++j) {
      taken[j] = others[j].numbers.size() > 0;
      if (!taken[j]) continue;
      const bool moves = moves_places(places, others[j].numbers);
      any_loops |= moves;
      (moves ? with_places_ : linear_).parameters.push_back(static_cast<Index>(j));
    }
    begin(linear_, nullptr, others);
    begin(with_places_, &loops_, others);
  }

  void at(double t, const VectorXd& q, const VectorXd& u, const double* sigma,
          const FedBack& gains) override {
    fill(linear_, t, q, u, nullptr, gains);
    fill(with_places_, t, q, u, sigma, gains);
  }

 private:
  /// θ in blocks of lanes.
  struct Part {
    std::vector<Index> parameters;
    std::unique_ptr<NumberRows> rows;
    MatrixXd r1, r2, r3;  ///< lanes × rows
    std::size_t width() const { return static_cast<std::size_t>(rows->width()); }
  };

  void begin(Part& part, const LoopModel<Space>* loops, const std::vector<OtherParameter>& others) {
    if (part.parameters.empty()) return;
    part.rows = make_number_rows(model_, loops_.loops.size(), loops);
    part.r1.resize(part.rows->width(), r1.rows());
    part.r2.resize(part.rows->width(), r2.rows());
    part.r3.resize(part.rows->width(), r3.rows());
    for (std::size_t first = 0; first < part.parameters.size(); first += part.width()) {
      const auto numbers = [&](std::size_t k) -> const VectorXd& {
        return others[static_cast<std::size_t>(part.parameters[first + k])].numbers;
      };
      MatrixXd dn = MatrixXd::Zero(part.rows->width(), numbers(0).size());
      for (std::size_t k = 0; k < part.width() && first + k < part.parameters.size(); ++k)
        dn.row(static_cast<Index>(k)) = numbers(k).transpose();
      part.rows->take(dn.data());
    }
  }
  void fill(Part& part, double t, const VectorXd& q, const VectorXd& u, const double* sigma,
            const FedBack& gains) {
    if (part.parameters.empty()) return;
    part.rows->feed_back(gains.leak, gains.beta);
    part.rows->place(t, q.data(), u.data(), sigma);
    for (std::size_t first = 0; first < part.parameters.size(); first += part.width()) {
      part.rows->rows(first / part.width(), part.r1.data(), part.r2.data(), part.r3.data());
      for (std::size_t k = 0; k < part.width() && first + k < part.parameters.size(); ++k) {
        const Index j = part.parameters[first + k], lane = static_cast<Index>(k);
        r1.col(j) = part.r1.row(lane).transpose();
        if (&part == &with_places_) r2.col(j) = part.r2.row(lane).transpose();
        r3.col(j) = part.r3.row(lane).transpose();
      }
    }
  }

  Model<Space> model_;
  LoopModel<Space> loops_;
  Part linear_, with_places_;
};

}  // namespace

std::unique_ptr<TableTangents> make_table_tangents(const Mechanism& mechanism,
                                                   const std::vector<OtherParameter>& others) {
  if (std::all_of(others.begin(), others.end(),
                  [](const OtherParameter& other) { return other.numbers.size() == 0; }))
    return nullptr;
  const Tree& tree = mechanism.tree();
  if (mechanism.plan().planar)
    return std::make_unique<TableTangentsOf<Planar>>(
        build_planar_model(tree, mechanism.scene(), mechanism.plan().basis), mechanism, others);
  return std::make_unique<TableTangentsOf<Spatial>>(build_spatial_model(tree, mechanism.scene()),
                                                    mechanism, others);
}

}  // namespace momenta
