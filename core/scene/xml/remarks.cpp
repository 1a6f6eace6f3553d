#include <momenta/core/scene/xml/remarks.h>
#include <momenta/core/text/near_name.h>

#include <algorithm>

namespace momenta::reading {

void Remarks::count(const std::string& sentence) {
  const auto known = std::find_if(counts_.begin(), counts_.end(),
                                  [&](const auto& entry) { return entry.first == sentence; });
  if (known != counts_.end())
    ++known->second;
  else
    counts_.emplace_back(sentence, 1);
}

void Remarks::not_drawn(const std::exception& wrong) {
  say("not drawn: " + std::string(wrong.what()));
}

std::vector<std::string> Remarks::sentences() const {
  std::vector<std::string> all;
  for (const auto& [sentence, count] : counts_)
    all.push_back(on_one_line(sentence) +
                  (count > 0 ? " (" + std::to_string(count) + ")" : std::string()));
  return all;
}

}  // namespace momenta::reading
