#include <momenta/dae/report/figure.h>

namespace momenta {
namespace {

std::vector<Figure> drawn_all(const std::vector<Chart>& charts, const Picture& picture,
                              const std::vector<Motion>& motions) {
  std::vector<Figure> figures;
  if (!picture.bodies.empty() && !motions.empty() && !motions.front().frames.empty())
    figures.push_back({"mechanism", mechanism_svg(picture, motions.front().frames.front())});
  for (const Chart& chart : charts) figures.push_back({chart.key, chart_svg(chart)});
  return figures;
}

}  // namespace

std::vector<Figure> figures_of_run(const StudyResult& study) {
  return drawn_all(charts_of_run(study.runs.front()), study.picture, study.motions);
}
std::vector<Figure> figures_of_study(const StudyResult& study) {
  return drawn_all(charts_of_study(study), study.picture, study.motions);
}

}  // namespace momenta
