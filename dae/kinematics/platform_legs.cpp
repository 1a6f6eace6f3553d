#include <momenta/dae/kinematics/platform_legs.h>

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

}  // namespace momenta
