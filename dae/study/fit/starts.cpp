#include <momenta/dae/study/fit/starts.h>

#include <cmath>
#include <string_view>

namespace momenta {

namespace {

using Json = nlohmann::json;

// JSON has no numbers that are not finite.
Json json_of(double x) {
  return std::isfinite(x) ? Json(x) : Json(std::isnan(x) ? "nan" : x > 0 ? "inf" : "-inf");
}
double number_of(const Json& json) {
  if (json.is_number()) return json.get<double>();
  const auto word = json.get<std::string>();
  return word == "nan" ? NAN : word == "inf" ? INFINITY : -INFINITY;
}
template <class Numbers>
Json json_of_all(const Numbers& numbers) {
  Json all = Json::array();
  for (const double x : numbers) all.push_back(json_of(x));
  return all;
}
void read_all(const Json& json, Eigen::VectorXd& to) {
  to.resize(static_cast<Eigen::Index>(json.size()));
  for (Eigen::Index i = 0; i < to.size(); ++i)
    to[i] = number_of(json.at(static_cast<std::size_t>(i)));
}

/// Fields of both kinds of start.
Json common(const SearchStart& s) {
  return {{"from", json_of_all(s.from)},
          {"to", json_of_all(s.to)},
          {"violation", json_of(s.violation)},
          {"slope", json_of(s.slope)},
          {"multipliers", json_of_all(s.multipliers)},
          {"iterations", s.iterations},
          {"converged", s.converged},
          {"why", s.why}};
}
void read_common(const Json& json, SearchStart& s) {
  read_all(json.at("from"), s.from);
  read_all(json.at("to"), s.to);
  s.violation = number_of(json.at("violation"));
  s.slope = number_of(json.at("slope"));
  s.multipliers.clear();
  for (const Json& x : json.at("multipliers")) s.multipliers.push_back(number_of(x));
  s.iterations = json.at("iterations").get<int>();
  s.converged = json.at("converged").get<bool>();
  s.why = json.at("why").get<std::string>();
}

}  // namespace

std::string why_no_minimum(const SearchRequest& request, int iterations,
                           const std::string& refused) {
  if (iterations >= request.most_iterations)
    return "it came to no end within " + std::to_string(iterations) + " iterations";
  const std::string short_steps = "steps became too short";
  return refused.empty() ? short_steps : short_steps + "; the last that was taken back: " + refused;
}

Json record_of_start(const FitStart& s) {
  Json json = common(s);
  json["cost"] = json_of(s.cost);
  json["cosine"] = json_of(s.cosine);
  json["places"] = json_of_all(s.places);
  return json;
}

Json record_of_start(const LeastStart& s) {
  Json json = common(s);
  json["value"] = json_of(s.value);
  return json;
}

bool read_start(const Json& record, FitStart& s) {
  try {
    read_common(record, s);
    s.cost = number_of(record.at("cost"));
    s.cosine = number_of(record.at("cosine"));
    read_all(record.at("places"), s.places);
    return true;
  } catch (const nlohmann::json::exception&) {
    return false;
  }
}

bool read_start(const Json& record, LeastStart& s) {
  try {
    read_common(record, s);
    s.value = number_of(record.at("value"));
    return true;
  } catch (const nlohmann::json::exception&) {
    return false;
  }
}

}  // namespace momenta
