// Results read back: run.h5 by the library of its format and by the snippets of the documentation,
// where their interpreters are installed.

#include "dae/app/program.h"
#include "equations/tolerance.h"

#ifdef MOMENTA_WITH_HDF5
#include <hdf5.h>
#endif
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstring>
#include <sstream>
#include <vector>

namespace momenta::golden::dae_read_results {
namespace {

class Results : public Program {
 protected:
  /// Columns of trajectory.csv by label; empty cells are NaN.
  static std::vector<std::pair<std::string, std::vector<double>>> csv_columns(
      const fs::path& file) {
    std::istringstream in(text_of(file));
    std::vector<std::pair<std::string, std::vector<double>>> columns;
    std::string line, cell;
    std::getline(in, line);
    for (std::istringstream cells(line); std::getline(cells, cell, ',');)
      columns.push_back({cell, {}});
    while (std::getline(in, line)) {
      std::istringstream cells(line + ",");
      for (auto& column : columns) {
        std::getline(cells, cell, ',');
        column.second.push_back(cell.empty() ? std::nan("") : std::strtod(cell.c_str(), nullptr));
      }
    }
    return columns;
  }
  std::string run(const std::string& scene, const std::string& data, const std::string& more) {
    const fs::path out = folder_ / data;
    const Outcome o = call("run '" + scene + "' --quiet --data " + data + " " + more + " --out '" +
                           out.string() + "'");
    EXPECT_EQ(o.status, 0) << o.err;
    return out.string();
  }
  /// What a snippet prints; skips the test where `interpreter` is not there.
  static std::string printed(const std::string& command) {
    return equations::output_of(command + " 2>&1");
  }
  static bool answers(const std::string& command) {
    return std::system((command + " >/dev/null 2>&1").c_str()) == 0;  // NOLINT: this test's own
  }
  static std::string snippet(const std::string& name) {
    return " '" MOMENTA_SOURCE_DIR "/docs/how-to/snippets/" + name + "' ";
  }
};

/// 101 samples of the four-bar, its largest change of energy as the snippets print it.
std::string expected_line(const std::vector<double>& energy) {
  double largest = 0;
  for (const double e : energy) largest = equations::larger(largest, std::abs(e - energy.front()));
  char text[120];
  std::snprintf(text, sizeof text, "largest change of energy %.3g J", largest);
  return text;
}

TEST_F(Results, AreReadBySnippetsFromCsv) {
  const std::string out = run(example("four_bar"), "csv", "--end 1 --samples 100");
  std::vector<double> energy;
  for (const auto& [name, values] : csv_columns(out + "/trajectory.csv"))
    if (name == "energy [J]") energy = values;
  ASSERT_EQ(energy.size(), 101u);
  const std::string expected = "101 samples to 1 s, " + expected_line(energy), file = "'" + out;
  int tried = 0;
  if (answers("/usr/bin/python3 -c 'import numpy'")) {
    ++tried;
    EXPECT_EQ(printed("/usr/bin/python3" + snippet("read_csv.py") + file + "/trajectory.csv'"),
              expected + "\n");
    EXPECT_EQ(printed("/usr/bin/python3" + snippet("read_summary.py") + file + "/summary.json'")
                  .rfind("momentum done position drift ", 0),
              0u);
  }
  if (answers("command -v octave-cli")) {
    ++tried;
    EXPECT_EQ(printed("octave-cli --no-init-file --quiet" + snippet("read_csv.m") + file +
                      "/trajectory.csv'"),
              expected + "\n");
  }
  if (answers("command -v Rscript")) {
    ++tried;
    EXPECT_EQ(printed("Rscript --vanilla" + snippet("read_csv.R") + file + "/trajectory.csv'"),
              expected + "\n");
  }
  if (tried == 0) GTEST_SKIP() << "neither numpy nor Octave nor R is installed";
}

#ifdef MOMENTA_WITH_HDF5

std::vector<double> dataset(hid_t file, const std::string& name) {
  const hid_t data = H5Dopen2(file, name.c_str(), H5P_DEFAULT);
  if (data < 0) return {};
  const hid_t space = H5Dget_space(data);
  hsize_t size = 0;
  H5Sget_simple_extent_dims(space, &size, nullptr);
  std::vector<double> values(size);
  H5Dread(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  H5Sclose(space);
  H5Dclose(data);
  return values;
}
std::string attribute(hid_t at, const std::string& object, const std::string& name) {
  const hid_t a = H5Aopen_by_name(at, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
  if (a < 0) return "";
  const hid_t type = H5Aget_type(a);
  std::string text(H5Tget_size(type), '\0');
  H5Aread(a, type, text.data());
  H5Tclose(type);
  H5Aclose(a);
  return text;
}

TEST_F(Results, OfHdf5AreThoseOfTheCsvBitForBit) {
  // More samples than a chunk of rows; energy not measured with drives; loops, balls, markers.
  for (const auto& [scene, more] : {std::pair{"four_bar", "--end 1 --samples 9000"},
                                    {"driven", "--end 1 --samples 100"},
                                    {"spatial_slider_crank", "--end 0.1 --samples 50"},
                                    {"free_body", "--samples 20"}}) {
    const auto columns = csv_columns(run(example(scene), "csv", more) + "/trajectory.csv");
    const std::string out = run(example(scene), "hdf5", more);
    EXPECT_FALSE(fs::exists(out + "/run.h5.part"));
    EXPECT_FALSE(fs::exists(out + "/trajectory.csv"));
    const hid_t file = H5Fopen((out + "/run.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    ASSERT_GE(file, 0);
    std::string labels;
    for (const auto& [label, values] : columns) {
      labels += label + "\n";
      const std::string name = "trajectory/" + label.substr(0, label.rfind(" ["));
      const std::vector<double> read = dataset(file, name);
      ASSERT_EQ(read.size(), values.size()) << label;
      for (std::size_t i = 0; i < values.size(); ++i)
        if (!(std::isnan(read[i]) && std::isnan(values[i]))) {
          ASSERT_EQ(std::memcmp(&read[i], &values[i], sizeof(double)), 0) << label << " " << i;
        }
      EXPECT_EQ(" [" + attribute(file, name, "unit") + "]", label.substr(label.rfind(" [")));
    }
    EXPECT_EQ(attribute(file, "trajectory", "columns"), labels);
    EXPECT_EQ(nlohmann::json::parse(attribute(file, "/", "summary"))["status"], "done");
    EXPECT_EQ(nlohmann::json::parse(attribute(file, "/", "settings"))["form"], "momentum");
    EXPECT_NE(attribute(file, "/", "scene").find("[[body]]"), std::string::npos);
    EXPECT_TRUE(nlohmann::json::parse(attribute(file, "/", "environment")).contains("versions"));
    H5Fclose(file);
  }
}

TEST_F(Results, OfHdf5AreReadBySnippets) {
  const std::string out = run(example("four_bar"), "hdf5", "--end 1 --samples 100");
  const hid_t file = H5Fopen((out + "/run.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  const std::string expected = expected_line(dataset(file, "trajectory/energy"));
  H5Fclose(file);
  int tried = 0;
  if (answers("/usr/bin/python3 -c 'import h5py'")) {
    ++tried;
    const std::string text =
        printed("/usr/bin/python3" + snippet("read_hdf5.py") + "'" + out + "/run.h5'");
    EXPECT_EQ(text.rfind("101 samples to 1 s, ", 0), 0u) << text;
    EXPECT_NE(text.find(", done\n" + expected + "\n"), std::string::npos) << text;
  }
  if (answers("command -v octave-cli")) {
    ++tried;
    EXPECT_EQ(printed("octave-cli --no-init-file --quiet" + snippet("read_hdf5.m") + "'" + out +
                      "/run.h5'"),
              "101 samples to 1 s, " + expected + "\n");
  }
  if (tried == 0) GTEST_SKIP() << "neither h5py nor Octave is installed";
}

TEST_F(Results, OfAStoppedRunKeepItsSamples) {
  const std::string out = (folder_ / "stopped").string();
  const Outcome o =
      call("run '" + example("n_four_bar") +
           "' --quiet --data hdf5 --end 1000 --samples 100000 --cpu-limit 2 --out '" + out + "'");
  EXPECT_EQ(o.status, 1) << o.err;
  const hid_t file = H5Fopen((out + "/run.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  const std::vector<double> t = dataset(file, "trajectory/t");
  const auto summary = nlohmann::json::parse(attribute(file, "/", "summary"));
  H5Fclose(file);
  EXPECT_EQ(summary["status"], "time limit");
  ASSERT_GT(t.size(), 1u);
  EXPECT_LE(t.back(), summary["stopped_at"].get<double>());
  EXPECT_GT(t.back(), summary["stopped_at"].get<double>() - 0.02);
}

TEST_F(Results, WithoutRoomKeepWholeChunks) {
  const fs::path out = folder_ / "limited";
  // Files of at most 1.5 MB: three chunks of 4096 rows and 15 columns.
  const Outcome o =
      call("run '" + example("four_bar") +
               "' --quiet --data hdf5 --end 100 --samples 100000 --out '" + out.string() + "'",
           "/dev/null", "ulimit -f 3000; ");
  EXPECT_EQ(o.status, 1);
  EXPECT_NE(o.err.find("run.h5: File too large"), std::string::npos) << o.err;
  EXPECT_FALSE(fs::exists(out / "run.h5.part"));
  const hid_t file = H5Fopen((out / "run.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  const std::vector<double> t = dataset(file, "trajectory/t"), q = dataset(file, "trajectory/C.q");
  const auto told = nlohmann::json::parse(attribute(file, "/", "summary"));
  H5Fclose(file);
  ASSERT_GT(t.size(), 0u);
  EXPECT_EQ(t.size() % 4096, 0u);
  EXPECT_EQ(q.size(), t.size());
  EXPECT_NEAR(t.back(), static_cast<double>(t.size() - 1) * 1e-3, 1e-12);
  EXPECT_NE(q.back(), 0);
  const auto summary = nlohmann::json::parse(text_of(out / "summary.json"));
  EXPECT_EQ(summary["status"], "failed");
  EXPECT_NE(summary["reason"].get<std::string>().find("File too large"), std::string::npos);
  EXPECT_EQ(told, summary);
}

TEST_F(Results, OfAKilledRunKeepWholeChunks) {
  const fs::path out = folder_ / "killed";
  // Chunks of 4096 rows of all columns are 0.6 MB; the first rows are written before one is full.
  const std::string command =
      program() + "run '" + example("four_bar") +
      "' --quiet --data hdf5 --end 100000 --samples 9000000 --out '" + out.string() +
      "' & pid=$!; before=0; for i in $(seq 3000); do now=$(stat -c %s '" + out.string() +
      "/run.h5.part' 2>/dev/null || echo 0); "
      // Not while it writes a chunk: two equal sizes.
      "[ $now -gt 4000000 ] && [ $now -eq $before ] && break; "
      "before=$now; sleep 0.01; done; "
      "kill -9 $pid; wait $pid 2>/dev/null";
  ASSERT_NE(std::system(command.c_str()), 0);  // NOLINT: the command is this test's own
  EXPECT_FALSE(fs::exists(out / "run.h5"));
  const hid_t file = H5Fopen((out / "run.h5.part").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  const std::vector<double> t = dataset(file, "trajectory/t");
  H5Fclose(file);
  ASSERT_GE(t.size(), 4096u);
  EXPECT_EQ(t.size() % 4096, 0u);
  EXPECT_NEAR(t[4095], 4095 * 100000.0 / 9000000, 1e-9);
}

TEST_F(Results, OfHdf5AreRefusedWithoutAPlace) {
  expect_refused("run '" + example("four_bar") + "' --data hdf5", "expected --out DIR for run.h5");
  const fs::path taken = write("taken", "");
  const Outcome o = call("run '" + example("four_bar") + "' --end 0.1 --quiet --data hdf5 --out '" +
                         taken.string() + "/x'");
  EXPECT_EQ(o.status, 1);
  EXPECT_NE(o.err.find("cannot make the directory"), std::string::npos) << o.err;
}

#else

TEST_F(Results, OfHdf5AreRefusedByABuildWithoutIt) {
  expect_refused("run '" + example("four_bar") + "' --data hdf5 --out '" + folder_.string() + "/x'",
                 "this program was built without HDF5");
  EXPECT_FALSE(fs::exists(folder_ / "x"));
}

#endif

}  // namespace
}  // namespace momenta::golden::dae_read_results
