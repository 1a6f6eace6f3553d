#include <momenta/dae/report/atomic_write.h>
#include <momenta/dae/report/trajectory_file.h>

#ifdef MOMENTA_HDF5
#include <hdf5.h>
#endif

#include <algorithm>
#include <utility>

namespace momenta {

#ifdef MOMENTA_HDF5

namespace {

/// A handle of HDF5 with the function that closes it.
class Handle {
 public:
  Handle() = default;
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Handle() { reset(); }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle& operator=(Handle&& other) noexcept {
    reset();
    id_ = std::exchange(other.id_, -1);
    close_ = other.close_;
    return *this;
  }
  explicit operator bool() const { return id_ >= 0; }
  hid_t id() const { return id_; }
  /// False when what was still to be written could not be.
  bool reset() { return id_ < 0 || close_(std::exchange(id_, -1)) >= 0; }

 private:
  hid_t id_ = -1;
  herr_t (*close_)(hid_t) = nullptr;
};

/// A text as an attribute.
bool write_text(hid_t at, const std::string& name, const std::string& text) {
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose), space(H5Screate(H5S_SCALAR), H5Sclose);
  if (!type || !space || H5Tset_size(type.id(), std::max<std::size_t>(1, text.size())) < 0 ||
      H5Tset_cset(type.id(), H5T_CSET_UTF8) < 0 || H5Tset_strpad(type.id(), H5T_STR_NULLPAD) < 0)
    return false;
  const Handle attribute(
      H5Acreate2(at, name.c_str(), type.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  return attribute && H5Awrite(attribute.id(), type.id(), text.c_str()) >= 0;
}

constexpr std::size_t most_held = 1 << 21;  // numbers of a chunk of all columns: 16 MB
constexpr hsize_t most_rows = 4096, least_rows = 16;

}  // namespace

struct TrajectoryFile::Open {
  Handle file;
  std::vector<Handle> columns;
  hsize_t chunk = most_rows, written = 0;
  std::vector<std::vector<double>> held;  ///< by column, up to a chunk

  bool flush() {
    const hsize_t count = held.front().size(), whole = written + count;
    if (count == 0) return true;
    const Handle memory(H5Screate_simple(1, &count, nullptr), H5Sclose);
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (H5Dset_extent(columns[i].id(), &whole) < 0) return false;
      const Handle space(H5Dget_space(columns[i].id()), H5Sclose);
      if (H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, &written, nullptr, &count, nullptr) < 0 ||
          H5Dwrite(columns[i].id(), H5T_NATIVE_DOUBLE, memory.id(), space.id(), H5P_DEFAULT,
                   held[i].data()) < 0)
        return false;
      held[i].clear();
    }
    written = whole;
    return H5Fflush(file.id(), H5F_SCOPE_GLOBAL) >= 0;
  }
};

bool writes_hdf5() {
  return true;
}

TrajectoryFile::TrajectoryFile(std::filesystem::path file, const std::vector<std::string>& columns,
                               const Texts& texts)
    : file_(std::move(file)), part_(file_), open_(std::make_unique<Open>()) {
  part_ += ".part";
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // sentences are this program's own
  std::error_code failure;
  if (file_.has_parent_path()) std::filesystem::create_directories(file_.parent_path(), failure);
  if (failure) {
    fail("cannot make the directory: " + failure.message());
    return;
  }
  Open& o = *open_;
  // Texts of any length as attributes: format 1.8.
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_libver_bounds(access.id(), H5F_LIBVER_V18, H5F_LIBVER_V18);
  o.file = Handle(H5Fcreate(part_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.id()), H5Fclose);
  const Handle group(
      o.file ? H5Gcreate2(o.file.id(), "trajectory", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT) : -1,
      H5Gclose);
  if (!group) {
    fail("cannot be written");
    return;
  }
  o.chunk = std::clamp<hsize_t>(most_held / std::max<std::size_t>(1, columns.size()), least_rows,
                                most_rows);
  o.held.resize(columns.size());
  const hsize_t none = 0, any = H5S_UNLIMITED;
  const Handle space(H5Screate_simple(1, &none, &any), H5Sclose);
  const Handle layout(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  const Handle link(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  // Chunks are written whole: nothing of them need be kept.
  const Handle keeping(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose);
  H5Pset_chunk_cache(keeping.id(), 0, 0, H5D_CHUNK_CACHE_W0_DEFAULT);
  H5Pset_chunk(layout.id(), 1, &o.chunk);
  H5Pset_create_intermediate_group(link.id(), 1);  // names of joints may hold a "/"
  std::string labels;
  for (const std::string& label : columns) {
    const std::size_t bracket = label.rfind(" [");
    const std::string unit = label.substr(bracket + 2, label.size() - bracket - 3);
    o.columns.emplace_back(H5Dcreate2(group.id(), label.substr(0, bracket).c_str(), H5T_IEEE_F64LE,
                                      space.id(), link.id(), layout.id(), keeping.id()),
                           H5Dclose);
    if (!o.columns.back() || !write_text(o.columns.back().id(), "unit", unit)) {
      fail("the column '" + label + "' cannot be made");
      return;
    }
    labels += label + "\n";
  }
  bool all = write_text(group.id(), "columns", labels);
  for (const auto& [name, text] : texts) all = all && write_text(o.file.id(), name, text);
  if (!all || H5Fflush(o.file.id(), H5F_SCOPE_GLOBAL) < 0) fail("cannot be written");
}

TrajectoryFile::~TrajectoryFile() {
  if (!open_) return;
  open_.reset();
  std::error_code ignored;
  std::filesystem::remove(part_, ignored);
}

bool TrajectoryFile::fail(const std::string& what) {
  if (problem_.empty()) problem_ = file_.string() + ": " + what;
  return false;
}

bool TrajectoryFile::write(const std::vector<double>& row) {
  if (!problem_.empty()) return false;
  Open& o = *open_;
  for (std::size_t i = 0; i < o.held.size(); ++i) o.held[i].push_back(row[i]);
  return o.held.front().size() < o.chunk || o.flush() || fail("samples cannot be written");
}

bool TrajectoryFile::finish(const std::string& summary) {
  if (!problem_.empty()) return false;
  Open& o = *open_;
  bool whole = o.flush() && write_text(o.file.id(), "summary", summary);
  for (Handle& column : o.columns) whole = column.reset() && whole;
  whole = o.file.reset() && whole;
  if (!whole) return fail("the last samples cannot be written");
  if (const auto problem = put_in_place(part_, file_)) return fail(*problem);
  open_.reset();
  return true;
}

#else

struct TrajectoryFile::Open {};

bool writes_hdf5() {
  return false;
}
TrajectoryFile::TrajectoryFile(std::filesystem::path file, const std::vector<std::string>&,
                               const Texts&)
    : file_(std::move(file)) {
  fail("this program was built without HDF5");
}
TrajectoryFile::~TrajectoryFile() = default;
bool TrajectoryFile::fail(const std::string& what) {
  problem_ = file_.string() + ": " + what;
  return false;
}
bool TrajectoryFile::write(const std::vector<double>&) {
  return false;
}
bool TrajectoryFile::finish(const std::string&) {
  return false;
}

#endif

}  // namespace momenta
