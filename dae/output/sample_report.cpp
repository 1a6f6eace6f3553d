#include <momenta/core/text/number_text.h>
#include <momenta/dae/output/csv.h>
#include <momenta/dae/output/figure.h>
#include <momenta/dae/output/json.h>
#include <momenta/dae/output/page.h>
#include <momenta/dae/output/sample_report.h>

#include <algorithm>
#include <cmath>

namespace momenta {
namespace {

/// "q05" for 0.05
std::string quantile_name(double p) {
  const auto percent = static_cast<int>(std::lround(100 * p));
  return (percent < 10 ? "q0" : "q") + std::to_string(percent);
}
/// "5 %"
std::string percent_of(double p) {
  return compact(100 * p, 3) + " %";
}

const char* kind_of(const SampleSettings& s) {
  return s.kind == SampleSettings::Kind::random  ? "random"
         : s.kind == SampleSettings::Kind::latin ? "latin"
                                                 : "sobol";
}

std::string how_sampled(const SweepRequest& request) {
  const SampleSettings& s = request.sample->settings();
  const std::string kind = s.kind == SampleSettings::Kind::random  ? "random points"
                           : s.kind == SampleSettings::Kind::latin ? "points of a Latin hypercube"
                                                                   : "points of a Sobol sequence";
  std::string text = std::to_string(s.points) + " " + kind + ", seed " + std::to_string(s.seed);
  if (s.indices)
    text += ", each in " + std::to_string(request.sample->cases_of_a_point()) +
            " cases for the indices";
  text += ".\n";
  for (const Varied& v : request.varied) text += v.place + ": " + v.distribution.words() + "\n";
  return text;
}

std::vector<std::vector<std::string>> statistics_rows(const SweepStatistics& all) {
  std::vector<std::vector<std::string>> rows{{"quantity", "cases", "mean", "deviation", "least"}};
  for (const double p : told_quantiles) rows[0].push_back(percent_of(p));
  rows[0].emplace_back("greatest");
  for (const QuantityStatistics& q : all.quantities) {
    const Summary& s = q.summary;
    rows.push_back({q.name, std::to_string(s.count), compact(s.mean, 5), compact(s.deviation, 3),
                    compact(s.least, 5)});
    for (const double x : s.quantiles) rows.back().push_back(compact(x, 5));
    rows.back().push_back(compact(s.greatest, 5));
  }
  return rows;
}

std::string with_error(double x, double error) {
  return std::isnan(x) ? "-" : fixed(x, 3) + " ± " + fixed(error, 3);
}

/// Rows of indices; empty without any.
std::vector<std::vector<std::string>> index_rows(const SweepRequest& request,
                                                 const SweepStatistics& all) {
  std::vector<std::vector<std::string>> rows;
  for (const QuantityStatistics& q : all.quantities)
    for (std::size_t i = 0; i < q.indices.of.size(); ++i) {
      if (rows.empty()) rows.push_back({"quantity", "of", "first order", "total", "rows"});
      const SobolIndex& index = q.indices.of[i];
      rows.push_back({i == 0 ? q.name : "", request.varied[i].place,
                      with_error(index.first, index.first_error),
                      with_error(index.total, index.total_error),
                      i == 0 ? std::to_string(q.indices.rows) : ""});
    }
  return rows;
}

Json summary_json(const Summary& s) {
  Json json = {{"count", s.count},
               {"mean", number_or_null(s.mean)},
               {"deviation", number_or_null(s.deviation)},
               {"least", number_or_null(s.least)}};
  for (std::size_t i = 0; i < told_quantiles.size(); ++i)
    json[quantile_name(told_quantiles[i])] = number_or_null(s.quantiles[i]);
  json["greatest"] = number_or_null(s.greatest);
  return json;
}

Json numbers(const std::vector<Summary>& all, const std::function<double(const Summary&)>& of) {
  Json list = Json::array();
  for (const Summary& s : all) list.push_back(number_or_null(of(s)));
  return list;
}

Chart chart_of(const SweepCurve& curve) {
  Chart chart;
  chart.key = curve.name;
  chart.title = curve.label;
  chart.x_title = "t [s]";
  chart.y_title = curve.label;
  const auto add = [&](const std::string& name, int colour, std::vector<double> dash,
                       const std::function<double(const Summary&)>& of) {
    Curve line;
    line.name = name;
    line.x = curve.times;
    for (const Summary& s : curve.at) line.y.push_back(of(s));
    line.sign.colour = colour;
    line.sign.dash = std::move(dash);
    chart.curves.push_back(std::move(line));
  };
  for (std::size_t i = 0; i < told_quantiles.size(); ++i) {
    const bool outer = i == 0 || i + 1 == told_quantiles.size();
    add(percent_of(told_quantiles[i]), outer ? 6 : 0,
        told_quantiles[i] == 0.5 ? std::vector<double>{} : std::vector<double>{4, 3},
        [i](const Summary& s) { return s.quantiles[i]; });
  }
  add("mean", 1, {}, [](const Summary& s) { return s.mean; });
  return chart;
}

}  // namespace

std::string statistics_csv(const SweepRequest& request, const SweepStatistics& all) {
  std::vector<std::string> cells{"quantity", "count", "mean", "deviation", "least"};
  for (const double p : told_quantiles) cells.push_back(quantile_name(p));
  cells.emplace_back("greatest");
  if (request.sample && request.sample->settings().indices)
    for (const Varied& v : request.varied)
      for (const char* what : {" first", " first error", " total", " total error"})
        cells.push_back(csv_cell(v.place + what));
  std::string text = csv_line(cells);
  for (const QuantityStatistics& q : all.quantities) {
    const Summary& s = q.summary;
    cells = {csv_cell(q.name), std::to_string(s.count), round_trip(s.mean), round_trip(s.deviation),
             round_trip(s.least)};
    for (const double x : s.quantiles) cells.push_back(round_trip(x));
    cells.push_back(round_trip(s.greatest));
    for (const SobolIndex& index : q.indices.of)
      for (const double x : {index.first, index.first_error, index.total, index.total_error})
        cells.push_back(round_trip(x));
    text += csv_line(cells);
  }
  return text;
}

std::string curves_csv(const SweepStatistics& all) {
  std::vector<std::string> cells{"t [s]"};
  // Curves have all times of the first finished case.
  for (const SweepCurve& curve : all.curves) {
    for (const char* what : {" mean", " deviation"}) cells.push_back(csv_cell(curve.name + what));
    for (const double p : told_quantiles)
      cells.push_back(csv_cell(curve.name + " " + quantile_name(p)));
  }
  std::string text = csv_line(cells);
  const std::size_t times = all.curves.empty() ? 0 : all.curves.front().times.size();
  for (std::size_t k = 0; k < times; ++k) {
    cells = {round_trip(all.curves.front().times[k])};
    for (const SweepCurve& curve : all.curves) {
      cells.push_back(round_trip(curve.at[k].mean));
      cells.push_back(round_trip(curve.at[k].deviation));
      for (const double x : curve.at[k].quantiles) cells.push_back(round_trip(x));
    }
    text += csv_line(cells);
  }
  return text;
}

Json sample_json(const SweepRequest& request, const SweepStatistics& all) {
  const SampleSettings& s = request.sample->settings();
  Json json;
  json["sampling"] = {
      {"kind", kind_of(s)}, {"points", s.points}, {"seed", s.seed}, {"indices", s.indices}};
  json["statistics"] = Json::object();
  for (const QuantityStatistics& q : all.quantities) {
    Json& entry = json["statistics"][q.name] = summary_json(q.summary);
    if (q.indices.of.empty()) continue;
    entry["index_rows"] = q.indices.rows;
    for (std::size_t i = 0; i < q.indices.of.size(); ++i) {
      const SobolIndex& index = q.indices.of[i];
      entry["indices"][request.varied[i].place] = {
          {"first", number_or_null(index.first)},
          {"first_error", number_or_null(index.first_error)},
          {"total", number_or_null(index.total)},
          {"total_error", number_or_null(index.total_error)}};
    }
  }
  json["along_time"] = Json::object();
  for (const SweepCurve& curve : all.curves) {
    Json& entry = json["along_time"][curve.name];
    entry = {{"column", curve.label}, {"other_times", curve.others}, {"t", curve.times}};
    entry["mean"] = numbers(curve.at, [](const Summary& x) { return x.mean; });
    entry["deviation"] = numbers(curve.at, [](const Summary& x) { return x.deviation; });
    for (std::size_t i = 0; i < told_quantiles.size(); ++i)
      entry[quantile_name(told_quantiles[i])] =
          numbers(curve.at, [i](const Summary& x) { return x.quantiles[i]; });
  }
  return json;
}

std::string sample_table(const SweepRequest& request, const SweepStatistics& all) {
  std::string text = how_sampled(request) + "\n" + in_columns(statistics_rows(all));
  const auto indices = index_rows(request, all);
  if (!indices.empty())
    text += "\nParts of the variance, each with its sampling error (bootstrap):\n\n" +
            in_columns(indices);
  for (const SweepCurve& curve : all.curves)
    if (curve.others > 0)
      text += "\n" + curve.name + " along time: without " + std::to_string(curve.others) +
              " cases whose times are others.\n";
  return text + "\n";
}

std::string sample_page(const SweepRequest& request, const SweepStatistics& all,
                        const std::vector<SweepCase>& cases, const Environment& environment,
                        const std::string& command) {
  const auto finished = static_cast<std::size_t>(std::count_if(
      cases.begin(), cases.end(), [](const SweepCase& c) { return c.status == "done"; }));
  std::string main = section("What is varied", preformatted(how_sampled(request)));
  for (const SweepCurve& curve : all.curves)
    if (!curve.times.empty())
      main += section(curve.label + " along time", drawn(chart_svg(chart_of(curve))));
  main += section("Statistics", preformatted(in_columns(statistics_rows(all))));
  const auto indices = index_rows(request, all);
  if (!indices.empty()) main += section("Parts of the variance", preformatted(in_columns(indices)));
  const std::string answer =
      std::to_string(finished) + " of " + std::to_string(cases.size()) + " cases are done.";
  return plain_page(request.file.empty() ? "Sample" : request.file, "sample", answer,
                    main + how_section(environment, command));
}

}  // namespace momenta
