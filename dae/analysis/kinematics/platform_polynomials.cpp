#include <momenta/dae/analysis/kinematics/dual_quaternion.h>
#include <momenta/dae/analysis/kinematics/platform_polynomials.h>

#include <algorithm>
#include <vector>

namespace momenta {

namespace {

class LegReader {
 public:
  LegReader(const Mechanism& mechanism, const Pieces& pieces)
      : mechanism_(mechanism), pieces_(pieces) {}

  PlatformLegs read() {
    std::vector<int> met(static_cast<std::size_t>(pieces_.count()), 0);
    for (const Tie& tie : pieces_.ties()) {
      expect_known(tie);
      ++met[static_cast<std::size_t>(tie.first)];
      ++met[static_cast<std::size_t>(tie.second)];
    }
    met[static_cast<std::size_t>(pieces_.base())] = 0;
    const auto most = std::max_element(met.begin(), met.end());
    if (*most == 0) refuse({}, "no body moves; expected a platform");
    legs_.platform = static_cast<int>(most - met.begin());
    for (const Tie& tie : pieces_.ties())
      if (tie.kind == Tie::Kind::distance) expect_between(tie);
    for (const TieChain& chain : tie_chains(pieces_)) add(chain);
    if (legs_.rods.size() != 6)
      refuse({}, std::to_string(legs_.rods.size()) + " rods and legs hold " +
                     pieces_.in_words(legs_.platform) + "; expected six");
    return std::move(legs_);
  }

 private:
  [[noreturn]] void refuse(Location at, const std::string& why) const {
    refuse_in_space(mechanism_, at, why);
  }

  void expect_known(const Tie& tie) const {
    if (tie.in_part) refuse(tie.at(), tie.in_words() + " has driven coordinates; expected none");
    if (tie.kind == Tie::Kind::slide || tie.kind == Tie::Kind::other)
      refuse(tie.at(), tie.joint ? tie.in_words() +
                                       " moves; expected it held or driven, or revolute, universal "
                                       "or spherical in a leg of a platform"
                                 : tie.in_words() +
                                       "; expected kind distance, spherical, point, universal, "
                                       "revolute or weld");
    if (tie.first == tie.second)
      refuse(tie.at(), tie.in_words() +
                           " ties bodies between which nothing moves; expected others, or none of "
                           "it");
  }

  bool is_end(int piece) const { return piece == pieces_.base() || piece == legs_.platform; }

  void expect_between(const Tie& tie) const {
    if (is_end(tie.first) && is_end(tie.second)) return;
    refuse(tie.at(), tie.in_words() + " ends at " +
                         pieces_.in_words(is_end(tie.first) ? tie.second : tie.first) +
                         "; expected its ends on what stands and on " +
                         pieces_.in_words(legs_.platform));
  }

  void add(const TieChain& chain) {
    const std::string platform = pieces_.in_words(legs_.platform);
    const Tie& tie = *chain.ties.front();
    if (!is_end(chain.from) || !is_end(chain.to) || chain.from == chain.to)
      refuse(tie.at(), of_chain(chain) + " " + (chain.ties.size() == 1 ? "ties " : "tie ") +
                           pieces_.in_words(chain.from) + " to " + pieces_.in_words(chain.to) +
                           "; expected legs between what stands and " + platform);
    const auto rod = PlatformRod::of(chain, length_of(mechanism_.scene()));
    if (!rod)
      refuse(tie.at(), of_chain(chain) +
                           " make no leg that keeps two points apart; expected lines of hinges "
                           "that cross in one point at one end and in another at the other, two "
                           "at the least and three, or a ball, at one of them");
    legs_.rods.push_back(*rod);
  }

  /// "joint 'U' of kind universal and loop 'B' of kind spherical"
  static std::string of_chain(const TieChain& chain) {
    std::vector<std::string> words;
    for (const Tie* tie : chain.ties)
      if (words.empty() || words.back() != tie->in_words()) words.push_back(tie->in_words());
    std::string all = words.front();
    for (std::size_t k = 1; k < words.size(); ++k)
      all += (k + 1 == words.size() ? " and " : ", ") + words[k];
    return all;
  }

  const Mechanism& mechanism_;
  const Pieces& pieces_;
  PlatformLegs legs_;
};

}  // namespace

PlatformLegs platform_legs(const Mechanism& mechanism, const Pieces& pieces) {
  return LegReader(mechanism, pieces).read();
}

namespace {

using Eigen::Isometry3d;
using Eigen::Matrix4d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::Vector4d;
using Eigen::VectorXcd;
using Eigen::VectorXd;

class Platform final : public LoopPolynomials {
 public:
  Platform(const Mechanism& mechanism, double t, const VectorXd& own, const std::vector<bool>& held)
      : own_(own),
        poses_(poses_of_polynomials(mechanism, t, own)),
        pieces_(mechanism, t, poses_, held),
        legs_(platform_legs(mechanism, pieces_)),
        length_(length_of(mechanism.scene())) {
    std::vector<Polynomial> equations;
    Polynomial study;
    for (int i = 0; i < 4; ++i) study.push_back({1, {i, 4 + i}});
    equations.push_back(std::move(study));
    for (const PlatformRod& leg : legs_.rods) {
      const Vector3d p = leg.on_platform() / length_, b = leg.on_base() / length_;
      const double rest = p.squaredNorm() + b.squaredNorm() - (p - b).squaredNorm();
      const Matrix4d mixed = 4 * (times_from_right(pure(p)) - times_from_left(pure(b))),
                     turned =
                         -2 * times_from_left(pure(b)).transpose() * times_from_right(pure(p)) +
                         rest * Matrix4d::Identity();
      Polynomial rod;
      for (int i = 0; i < 4; ++i) {
        rod.push_back({4, {4 + i, 4 + i}});
        for (int j = 0; j < 4; ++j) {
          rod.push_back({mixed(i, j), {4 + i, j}});
          rod.push_back({turned(i, j), {i, j}});
        }
      }
      equations.push_back(std::move(rod));
    }
    system_.emplace(std::move(equations),
                    std::vector<VariableGroup>{{{0, 1, 2, 3, 4, 5, 6, 7}, {{0, 1, 2, 3}}}});
  }

  const PolynomialSystem& system() const override { return *system_; }

  std::optional<VectorXd> pose(const VectorXcd& x) const override {
    Eigen::Index largest;
    x.head<4>().cwiseAbs().maxCoeff(&largest);
    const VectorXcd turned = x / x[largest];
    if (turned.imag().norm() > real_enough * turned.norm()) return std::nullopt;
    const Vector4d e = turned.real().head<4>(), g = turned.real().tail<4>();
    const Quaterniond rotation(e[0], e[1], e[2], e[3]), dual(g[0], g[1], g[2], g[3]);
    Isometry3d displacement = Isometry3d::Identity();
    displacement.translate(2 * length_ / e.squaredNorm() * (dual * rotation.conjugate()).vec());
    displacement.rotate(rotation.normalized());
    return with_platform(displacement);
  }

 private:
  /// The pose with the platform displaced, where the legs can follow.
  std::optional<VectorXd> with_platform(const Isometry3d& displacement) const {
    std::vector<Isometry3d> displaced(static_cast<std::size_t>(pieces_.count()),
                                      Isometry3d::Identity());
    displaced[static_cast<std::size_t>(legs_.platform)] = displacement;
    for (const PlatformRod& rod : legs_.rods) {
      const auto leg = rod.displaced(displacement);
      if (!leg) return std::nullopt;
      for (std::size_t k = 0; k < leg->size(); ++k)
        displaced[static_cast<std::size_t>(rod.chain().pieces[k])] = (*leg)[k];
    }
    return pieces_.coordinates(displaced, own_);
  }

  VectorXd own_;
  std::vector<Isometry3d> poses_;
  Pieces pieces_;
  PlatformLegs legs_;
  double length_;
  std::optional<PolynomialSystem> system_;
};

}  // namespace

std::unique_ptr<LoopPolynomials> platform_polynomials(const Mechanism& mechanism, double t,
                                                      const VectorXd& own,
                                                      const std::vector<bool>& held) {
  return std::make_unique<Platform>(mechanism, t, own, held);
}

}  // namespace momenta
