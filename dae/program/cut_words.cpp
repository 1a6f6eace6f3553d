#include "cut_words.h"

#include <cstdio>

namespace momenta::program {
std::string cuts_in_words(const Recut& recut) {
  const CutCost &a = recut.before, &b = recut.after;
  if (!recut.gains()) return "no other cuts found that would be less work";
  char numbers[256];
  std::snprintf(numbers, sizeof numbers,
                "at most %d loop equations open at once, now %d; work on loops %.3g, now %.3g; "
                "entries of M %.3g, now %.3g; tree %d deep, now %d",
                b.open, a.open, static_cast<double>(b.work), static_cast<double>(a.work),
                static_cast<double>(b.mass_entries), static_cast<double>(a.mass_entries), b.depth,
                a.depth);
  std::string factors;
  if (b.factor_entries > 0) {
    char text[64];
    std::snprintf(text, sizeof text, "; entries of the factors %.3g, now %.3g",
                  static_cast<double>(b.factor_entries), static_cast<double>(a.factor_entries));
    factors = text;
  }
  return in_words(recut) + ": " + numbers + factors;
}

}  // namespace momenta::program
