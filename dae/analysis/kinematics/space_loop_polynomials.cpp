#include <momenta/dae/analysis/kinematics/loop_screws.h>
#include <momenta/dae/analysis/kinematics/space_loop_polynomials.h>

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>

namespace momenta {
namespace {

using Eigen::Isometry3d;
using Eigen::VectorXcd;
using Eigen::VectorXd;
using Span = Eigen::Matrix<double, 8, 4>;

constexpr double meets = 1e-7;      // mutual moment of lines that cross or are parallel
constexpr double dependent = 1e-7;  // relative singular value of a dependent direction
constexpr double stands = 1e-6;     // largest s/c of a screw that has to stay
constexpr double no_turn = 1e-8;    // least (c² + s²)/(|c|² + |s|²) of a displacement

/// c and s of a screw, up to a factor.
using Pair = std::array<Complex, 2>;

/// x = A B C: a single screw and two in a row.
struct Half {
  std::size_t alone, first, second;  ///< numbers of screws
  double sign;                       ///< −1: inverse
  bool leads;                        ///< the single screw stands before the two
  DualProduct times;                 ///< product with its L, from its side
  Span span;
  Eigen::Matrix<double, 4, 8> parts;  ///< coordinates of a member of the span
  double moment;                      ///< mutual moment of both lines
};

Half half_of(const std::vector<LoopScrew>& screws, double length,
             const std::array<std::size_t, 3>& order, double sign, bool leads) {
  Half h;
  h.alone = leads ? order[0] : order[2];
  h.first = leads ? order[1] : order[0];
  h.second = leads ? order[2] : order[1];
  h.sign = sign;
  h.leads = leads;
  const auto line = [&](std::size_t k) -> DualQuaternion { return sign * screws[k].line(length); };
  h.times = leads ? times_from_left(line(h.alone)) : times_from_right(line(h.alone));
  const DualQuaternion a = line(h.first), b = line(h.second);
  h.span.col(0) = DualQuaternion::Unit(0);
  h.span.col(1) = a;
  h.span.col(2) = b;
  h.span.col(3) = times_from_left(a) * b;
  h.parts = h.span.completeOrthogonalDecomposition().pseudoInverse();
  const Eigen::Vector4d values = Eigen::JacobiSVD<Span>(h.span).singularValues();
  h.moment = values[3] < dependent * values[0]
                 ? -1
                 : std::abs(a.head<4>().dot(b.tail<4>()) + a.tail<4>().dot(b.head<4>()));
  return h;
}

class SpaceLoop final : public LoopPolynomials {
 public:
  SpaceLoop(const Mechanism& mechanism, double t, const VectorXd& own,
            const std::vector<bool>& held)
      : mechanism_(mechanism),
        own_(own),
        poses_(poses_of_polynomials(mechanism, t, own)),
        pieces_(mechanism, t, poses_, held),
        length_(length_of(mechanism.scene())),
        loop_(known_chain(), length_) {
    if (loop_.freedoms() > 6)
      refuse({}, "its one loop has " + std::to_string(loop_.freedoms()) +
                     " freedoms; expected six at the most, others held");
    choose_halves();
    std::vector<Polynomial> equations;
    for (std::size_t h = 0; h < 2; ++h) {
      const std::array<Polynomial, 8> moved = moved_by(h);
      const Eigen::JacobiSVD<Eigen::MatrixXd> svd(halves_[h].span.transpose(), Eigen::ComputeFullV);
      for (int k = 4; k < 8; ++k) equations.push_back(combined(svd.matrixV().col(k), moved));
    }
    const auto met = std::find_if(halves_.begin(), halves_.end(),
                                  [](const Half& half) { return half.moment < meets; });
    if (met == halves_.end()) {
      Polynomial study;
      for (int i = 0; i < 4; ++i) study.push_back({1, {4 + i, 8 + i}});
      equations.push_back(std::move(study));
    } else {
      const auto h = static_cast<std::size_t>(met - halves_.begin());
      const std::array<Polynomial, 8> moved = moved_by(h);
      const auto part = [&](int k) { return combined(halves_[h].parts.row(k).transpose(), moved); };
      equations.push_back(part(0) * part(3) + scaled(part(1) * part(2), -1));
    }
    std::vector<VariableGroup> groups(3);
    for (int g = 0; g < 2; ++g) {
      const int at = 2 * g;
      const bool slides = screw(halves_[static_cast<std::size_t>(g)].alone).slides;
      groups[static_cast<std::size_t>(g)] = {{at, at + 1}, {{at}}};
      if (!slides) groups[static_cast<std::size_t>(g)].proper.push_back({at + 1});
    }
    groups[2] = {{4, 5, 6, 7, 8, 9, 10, 11}, {{4, 5, 6, 7}}};
    system_.emplace(std::move(equations), std::move(groups));
  }

  const PolynomialSystem& system() const override { return *system_; }
  long copies() const override { return loop_.copies(); }

  bool is_solution(const VectorXcd& x) const override {
    const std::array<Pair, 6> pairs = pairs_of(x);
    for (std::size_t k = 0; k < 6; ++k) {
      const auto& [c, s] = pairs[k];
      const double size = std::norm(c) + std::norm(s);
      if (std::abs(screw(k).slides ? c * c : c * c + s * s) < no_turn * size) return false;
      if (screw(k).fills() && std::abs(s) > stands * std::abs(c)) return false;
    }
    return true;
  }

  std::optional<VectorXd> pose(const VectorXcd& x) const override {
    const std::array<Pair, 6> pairs = pairs_of(x);
    std::array<double, 6> tangents{};
    for (std::size_t k = 0; k < 6; ++k) {
      auto [c, s] = pairs[k];
      if (screw(k).fills()) continue;
      const Complex larger = std::abs(c) > std::abs(s) ? c : s;
      c /= larger;
      s /= larger;
      if (std::abs(c.imag()) + std::abs(s.imag()) > real_enough) return std::nullopt;
      tangents[k] = s.real() / c.real();  // infinite at half a turn
    }
    const std::vector<Isometry3d> moved = loop_.displaced(tangents);
    std::vector<Isometry3d> displaced(static_cast<std::size_t>(pieces_.count()),
                                      Isometry3d::Identity());
    for (std::size_t i = 0; i < moved.size(); ++i)
      displaced[static_cast<std::size_t>(loop_.chain().pieces[i])] = moved[i];
    return pieces_.coordinates(displaced, own_);
  }

 private:
  const LoopScrew& screw(std::size_t k) const { return loop_.screws()[k]; }

  [[noreturn]] void refuse(Location at, const std::string& why) const {
    refuse_in_space(mechanism_, at, why);
  }

  TieChain known_chain() const {
    for (const Tie& tie : pieces_.ties())
      if (tie.kind == Tie::Kind::other)
        refuse(tie.at(), tie.in_words() + (tie.in_part ? " has driven coordinates; expected none"
                                                       : "; expected hinges, slides and balls in "
                                                         "its one loop"));
    return tie_chains(pieces_).front();
  }

  void choose_halves() {
    double best = -1;
    for (std::size_t r = 0; r < 3; ++r)
      for (const bool left : {true, false})
        for (const bool right : {true, false}) {
          const auto at = [&](std::size_t k) { return (r + k) % 6; };
          const Half a = half_of(loop_.screws(), length_, {at(0), at(1), at(2)}, 1, left),
                     b = half_of(loop_.screws(), length_, {at(5), at(4), at(3)}, -1, right);
          if (a.moment < 0 || b.moment < 0) continue;
          const double least = std::min(a.moment, b.moment), most = std::max(a.moment, b.moment);
          // Both pairs are apart, or else one.
          const double worth = least > meets ? 1 + least : most > meets ? most / (1 + most) : -1;
          if (worth <= best) continue;
          best = worth;
          halves_ = {a, b};
        }
    if (best < 0)
      refuse({}, "the lines of its joints cross or are parallel one by one; expected others");
  }

  /// Ā(u) x, or x C̄.
  std::array<Polynomial, 8> moved_by(std::size_t h) const {
    const int z = 2 * static_cast<int>(h), w = z + 1;
    const Half& half = halves_[h];
    const Complex i(0, 1);
    const bool slides = screw(half.alone).slides;
    const Polynomial c = slides ? Polynomial{{1, {z}}} : Polynomial{{0.5, {z}}, {0.5, {w}}},
                     s = slides ? Polynomial{{1, {w}}}
                                : Polynomial{{0.5 / i, {z}}, {-0.5 / i, {w}}};
    std::array<Polynomial, 8> moved;
    for (int row = 0; row < 8; ++row) {
      Polynomial turned;
      for (int k = 0; k < 8; ++k)
        if (half.times(row, k) != 0) turned.push_back({-half.times(row, k), {4 + k}});
      moved[static_cast<std::size_t>(row)] = c * Polynomial{{1, {4 + row}}} + s * turned;
    }
    return moved;
  }

  static Polynomial combined(const VectorXd& factors, const std::array<Polynomial, 8>& of) {
    Polynomial sum;
    for (std::size_t k = 0; k < 8; ++k)
      sum = sum + scaled(of[k], factors[static_cast<Eigen::Index>(k)]);
    return sum;
  }

  /// c and s of all six.
  std::array<Pair, 6> pairs_of(const VectorXcd& x) const {
    std::array<Pair, 6> pairs;
    for (std::size_t h = 0; h < 2; ++h) {
      const Half& half = halves_[h];
      const auto at = static_cast<Eigen::Index>(2 * h);
      Complex c = x[at], s = x[at + 1];
      if (!screw(half.alone).slides) {
        c = 0.5 * (x[at] + x[at + 1]);
        s = (x[at] - x[at + 1]) / Complex(0, 2);
      }
      pairs[half.alone] = {c, s};
      const VectorXcd whole = x.segment(4, 8);
      const VectorXcd parts =
          half.parts.cast<Complex>() * (c * whole - s * (half.times.cast<Complex>() * whole));
      // (c, s) of the first times (c, s) of the second, a matrix of rank one.
      Eigen::Matrix2cd both;
      both << parts[0], parts[2], parts[1], parts[3];
      Eigen::Index i, j;
      both.cwiseAbs().maxCoeff(&i, &j);
      pairs[half.first] = {both(0, j), both(1, j)};
      pairs[half.second] = {both(i, 0), both(i, 1)};
    }
    return pairs;
  }

  const Mechanism& mechanism_;
  VectorXd own_;
  std::vector<Isometry3d> poses_;
  Pieces pieces_;
  double length_;
  LoopScrews loop_;
  std::array<Half, 2> halves_;
  std::optional<PolynomialSystem> system_;
};

}  // namespace

std::unique_ptr<LoopPolynomials> space_loop_polynomials(const Mechanism& mechanism, double t,
                                                        const VectorXd& own,
                                                        const std::vector<bool>& held) {
  return std::make_unique<SpaceLoop>(mechanism, t, own, held);
}

}  // namespace momenta
