#include <momenta/dae/output/part_file.h>
#include <momenta/dae/output/trajectory_file.h>

#ifdef MOMENTA_HDF5
#include <fcntl.h>
#include <hdf5.h>
#include <unistd.h>
#endif

#include <algorithm>
#include <system_error>
#include <utility>

namespace momenta {

#ifdef MOMENTA_HDF5

namespace {

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
  /// False when the rest could not be written.
  bool reset() { return id_ < 0 || close_(std::exchange(id_, -1)) >= 0; }

 private:
  hid_t id_ = -1;
  herr_t (*close_)(hid_t) = nullptr;
};

bool write_text(hid_t at, const std::string& name, const std::string& text) {
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose), space(H5Screate(H5S_SCALAR), H5Sclose);
  if (!type || !space || H5Tset_size(type.id(), std::max<std::size_t>(1, text.size())) < 0 ||
      H5Tset_cset(type.id(), H5T_CSET_UTF8) < 0 || H5Tset_strpad(type.id(), H5T_STR_NULLPAD) < 0)
    return false;
  const Handle attribute(
      H5Acreate2(at, name.c_str(), type.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  return attribute && H5Awrite(attribute.id(), type.id(), text.c_str()) >= 0;
}

constexpr std::size_t most_numbers = 1 << 21;  // numbers of a chunk of all columns: 16 MB
constexpr hsize_t most_rows = 4096, least_rows = 16;

/// HDF5 1.10 does not survive a failed write: the file can neither be closed nor read, and the
/// library crashes at exit. So room is reserved before each chunk, behind the file's content, and
/// enough to close it.
class Hdf5Trajectory final : public TrajectoryFile {
 public:
  Hdf5Trajectory(std::filesystem::path file, const std::vector<std::string>& columns,
                 const std::vector<std::pair<std::string, std::string>>& texts)
      : path_(std::move(file)), part_(path_) {
    part_ += ".part";
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // messages are this program's own
    std::error_code failure;
    if (path_.has_parent_path()) std::filesystem::create_directories(path_.parent_path(), failure);
    if (failure)
      fail("cannot make the directory: " + failure.message());
    else
      make(columns, texts);
  }

  ~Hdf5Trajectory() override {
    columns_.clear();
    file_.reset();
    if (descriptor_ >= 0) ::close(descriptor_);
    if (finished_) return;
    std::error_code ignored;
    std::filesystem::remove(part_, ignored);
  }

  bool write(const std::vector<double>& row) override {
    if (!problem_.empty()) return false;
    for (std::size_t i = 0; i < held_.size(); ++i) held_[i].push_back(row[i]);
    return (written_ + held_.front().size()) % chunk_ != 0 || flush();
  }

  bool flush() override {
    return problem_.empty() && (write_held() || fail("samples cannot be written"));
  }

  bool finish(const std::string& summary) override {
    if (!file_ || descriptor_ < 0) return false;
    bool whole = write_text(file_.id(), "summary", summary);
    for (Handle& column : columns_) whole = column.reset() && whole;
    hsize_t size = 0;
    whole = H5Fflush(file_.id(), H5F_SCOPE_GLOBAL) >= 0 &&
            H5Fget_filesize(file_.id(), &size) >= 0 && whole;
    whole = file_.reset() && whole;
    // Removes reserved room, and no more: else the file could not be opened.
    whole = whole && ::ftruncate(descriptor_, static_cast<off_t>(size)) == 0 &&
            Handle(H5Fopen(part_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
    if (!whole) return fail("cannot be closed");
    if (const auto trouble = put_in_place(part_, path_)) return fail(*trouble);
    finished_ = true;
    return true;
  }

 private:
  void make(const std::vector<std::string>& columns,
            const std::vector<std::pair<std::string, std::string>>& texts) {
    // Attributes with texts of any length: format 1.8.
    const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    H5Pset_libver_bounds(access.id(), H5F_LIBVER_V18, H5F_LIBVER_V18);
    file_ = Handle(H5Fcreate(part_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.id()), H5Fclose);
    chunk_ = std::clamp<hsize_t>(most_numbers / std::max<std::size_t>(1, columns.size()),
                                 least_rows, most_rows);
    held_.resize(columns.size());
    std::size_t texts_size = 0;
    for (const auto& [name, text] : texts) texts_size += name.size() + text.size();
    descriptor_ = ::open(part_.c_str(), O_RDWR | O_CLOEXEC);
    if (!file_ || descriptor_ < 0) {
      fail("cannot be written");
      return;
    }
    if (!take_room(texts_size)) return;
    const Handle group(H5Gcreate2(file_.id(), "trajectory", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                       H5Gclose);
    if (!group) {
      fail("cannot be written");
      return;
    }
    const hsize_t none = 0, any = H5S_UNLIMITED;
    const Handle space(H5Screate_simple(1, &none, &any), H5Sclose);
    const Handle layout(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    const Handle link(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
    // Chunks are written whole, and need no cache.
    const Handle keeping(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose);
    H5Pset_chunk_cache(keeping.id(), 0, 0, H5D_CHUNK_CACHE_W0_DEFAULT);
    H5Pset_chunk(layout.id(), 1, &chunk_);
    H5Pset_create_intermediate_group(link.id(), 1);  // names of joints may hold a "/"
    std::string labels;
    for (const std::string& label : columns) {
      const std::size_t bracket = label.rfind(" [");
      const std::string unit = label.substr(bracket + 2, label.size() - bracket - 3);
      columns_.emplace_back(H5Dcreate2(group.id(), label.substr(0, bracket).c_str(), H5T_IEEE_F64LE,
                                       space.id(), link.id(), layout.id(), keeping.id()),
                            H5Dclose);
      if (!columns_.back() || !write_text(columns_.back().id(), "unit", unit)) {
        fail("the column '" + label + "' cannot be made");
        return;
      }
      labels += label + "\n";
    }
    bool all = write_text(group.id(), "columns", labels);
    for (const auto& [name, text] : texts) all = all && write_text(file_.id(), name, text);
    if (!all || H5Fflush(file_.id(), H5F_SCOPE_GLOBAL) < 0) fail("cannot be written");
  }

  bool fail(const std::string& what) {
    if (problem_.empty()) problem_ = path_.string() + ": " + what;
    return false;
  }

  /// Room for a chunk of every column with HDF5's notes on it, `more` bytes, and the summary.
  bool take_room(std::size_t more) {
    constexpr hsize_t of_file = 1 << 17, of_column = 1 << 12;
    hsize_t size = 0;
    if (H5Fget_filesize(file_.id(), &size) < 0) return fail("cannot be written");
    const hsize_t room = of_file + more + held_.size() * (of_column + 8 * chunk_);
    const int error =
        ::posix_fallocate(descriptor_, static_cast<off_t>(size), static_cast<off_t>(room));
    return error == 0 || fail(std::generic_category().message(error));
  }

  bool write_held() {
    const hsize_t count = held_.front().size(), whole = written_ + count;
    if (count == 0) return true;
    if (!take_room(0)) return false;
    const Handle memory(H5Screate_simple(1, &count, nullptr), H5Sclose);
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      if (H5Dset_extent(columns_[i].id(), &whole) < 0) return false;
      const Handle space(H5Dget_space(columns_[i].id()), H5Sclose);
      if (H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, &written_, nullptr, &count, nullptr) <
              0 ||
          H5Dwrite(columns_[i].id(), H5T_NATIVE_DOUBLE, memory.id(), space.id(), H5P_DEFAULT,
                   held_[i].data()) < 0)
        return false;
      held_[i].clear();
    }
    if (H5Fflush(file_.id(), H5F_SCOPE_GLOBAL) < 0) return false;
    written_ = whole;
    return true;
  }

  std::filesystem::path path_, part_;
  Handle file_;
  std::vector<Handle> columns_;
  hsize_t chunk_ = most_rows, written_ = 0;
  std::vector<std::vector<double>> held_;  ///< by column, up to a chunk
  int descriptor_ = -1;                    ///< the same file, to reserve room
  bool finished_ = false;
};

}  // namespace

bool writes_hdf5() {
  return true;
}

std::unique_ptr<TrajectoryFile> hdf5_trajectory(
    std::filesystem::path file, const std::vector<std::string>& columns,
    const std::vector<std::pair<std::string, std::string>>& texts) {
  return std::make_unique<Hdf5Trajectory>(std::move(file), columns, texts);
}

#else

bool writes_hdf5() {
  return false;
}
std::unique_ptr<TrajectoryFile> hdf5_trajectory(
    std::filesystem::path, const std::vector<std::string>&,
    const std::vector<std::pair<std::string, std::string>>&) {
  return nullptr;
}

#endif

}  // namespace momenta
