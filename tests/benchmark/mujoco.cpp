// Rows mujoco/<what>/<file>: MuJoCo on those MJCF files of robots.cpp that it reads, beside
// momenta's own rows of the same run; counter ns_per_evaluation. Contacts are off, controls zero.
// Meshes and pictures are left out, whose files need not be there: nothing that moves depends on
// them where inertias are written.
//
//   forward   mj_forward: accelerations at the start, rates sin 1, sin 2, … as robots.cpp has them
//   step      mj_step from that state, by the file's integrator
//
// The label says how many rates there are and how many rows of equalities, limits and frictions.
// Closed loops are springs there (soft equalities), solved to the file's tolerance.

#include <benchmark/benchmark.h>
#include <mujoco/mujoco.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "nanoseconds.h"
#include "robot_files.h"

namespace momenta {
namespace {

struct Delete {
  void operator()(mjModel* m) const { mj_deleteModel(m); }
  void operator()(mjData* d) const { mj_deleteData(d); }
};

void leave_out_meshes(tinyxml2::XMLElement& element) {
  for (tinyxml2::XMLElement* e = element.FirstChildElement(); e != nullptr;) {
    tinyxml2::XMLElement* next = e->NextSiblingElement();
    const std::string name = e->Name();
    const bool of_file =
        (name == "mesh" || name == "texture" || name == "hfield" || name == "skin") &&
        e->Attribute("file") != nullptr;
    if (of_file || (name == "geom" && e->Attribute("mesh") != nullptr)) {
      element.DeleteChild(e);
    } else {
      if (name == "material") e->DeleteAttribute("texture");
      leave_out_meshes(*e);
    }
    e = next;
  }
}

/// Null with the reason in `error`.
mjModel* load(const std::filesystem::path& file, std::string& error) {
  tinyxml2::XMLDocument document;
  if (document.LoadFile(file.c_str()) != tinyxml2::XML_SUCCESS || !document.RootElement()) {
    error = document.ErrorStr();
    return nullptr;
  }
  leave_out_meshes(*document.RootElement());
  tinyxml2::XMLPrinter text;
  document.Print(&text);
  // as a file in memory: its list is large
  const auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  const int size = text.CStrSize() - 1;  // without the end of a string
  mj_makeEmptyFileVFS(files.get(), "model.xml", size);
  std::copy_n(text.CStr(), size, static_cast<char*>(files->filedata[0]));
  char reason[300] = "";
  mjModel* model = mj_loadXML("model.xml", files.get(), reason, sizeof reason);
  mj_deleteVFS(files.get());
  error = reason;
  std::replace(error.begin(), error.end(), '\n', ' ');
  return model;
}

void evaluate(benchmark::State& state, const std::filesystem::path& file, bool step) {
  std::string error;
  const std::unique_ptr<mjModel, Delete> model(load(file, error));
  if (!model) return state.SkipWithError(error.c_str());
  model->opt.disableflags |= mjDSBL_CONTACT;
  const std::unique_ptr<mjData, Delete> data(mj_makeData(model.get()));
  mj_resetData(model.get(), data.get());
  const std::vector<mjtNum> q(data->qpos, data->qpos + model->nq),
      warm(static_cast<std::size_t>(model->nv), 0.0);
  std::vector<mjtNum> u(static_cast<std::size_t>(model->nv));
  for (std::size_t i = 0; i < u.size(); ++i) u[i] = std::sin(static_cast<double>(i + 1));
  for (auto _ : state) {
    std::copy(q.begin(), q.end(), data->qpos);
    std::copy(u.begin(), u.end(), data->qvel);
    // its solver starts anew: no solution of the same state is at hand
    std::copy(warm.begin(), warm.end(), data->qacc_warmstart);
    if (step)
      mj_step(model.get(), data.get());
    else
      mj_forward(model.get(), data.get());
    benchmark::DoNotOptimize(data->qacc);
  }
  state.SetLabel(std::to_string(model->nv) + " rates, " + std::to_string(data->nefc) + " rows");
  benchmark_models::count_nanoseconds(state, "ns_per_evaluation", 1);
}

}  // namespace

void register_mujoco() {
  for (const std::filesystem::path& file : robot_files()) {
    if (file.extension() != ".xml") continue;
    for (const bool step : {false, true})
      benchmark::RegisterBenchmark(
          (std::string("mujoco/") + (step ? "step/" : "forward/") + short_name(file)).c_str(),
          [file, step](benchmark::State& state) { evaluate(state, file, step); });
  }
}

}  // namespace momenta
