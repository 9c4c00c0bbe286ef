// Checkpoints: one HDF5 file with a dataset per put(), root attributes schema, calx_version, dataset_count, checksum
// and, last of all, complete. A file without the marker, or whose checksum differs, is damaged and never read.
#include <unistd.h>

#include <utility>

#include "base/error.hpp"
#include "io/creator.hpp"
#include "io/files.hpp"
#include "io/h5_file.hpp"
#include "io/io.hpp"

namespace calx {
namespace {

/// Rises when older checkpoints can no longer be read.
constexpr std::uint64_t schema = 1;
constexpr char file_name[] = "checkpoint.h5", previous_name[] = "checkpoint.previous.h5";

/// Independent of the order in which datasets are written or listed.
std::uint64_t dataset_checksum(const std::string& name, const void* data, std::size_t size) {
  return checksum(data, size, checksum(name.data(), name.size()));
}

class H5StateWriter : public StateWriter {
 public:
  explicit H5StateWriter(H5File& file) : file_(file) {}

  using StateWriter::put;
  void put(const std::string& name, const double* data, std::size_t count, const std::string& unit) override {
    add(name, H5Type::f64, data, count, sizeof *data, unit);
  }
  void put(const std::string& name, const std::uint32_t* data, std::size_t count) override {
    add(name, H5Type::u32, data, count, sizeof *data, "");
  }
  void put(const std::string& name, const std::uint64_t* data, std::size_t count) override {
    add(name, H5Type::u64, data, count, sizeof *data, "");
  }
  void put(const std::string& name, const std::uint8_t* data, std::size_t count) override {
    add(name, H5Type::u8, data, count, sizeof *data, "");
  }
  void put_text(const std::string& name, const std::string& text) override {
    check_new(name);
    file_.write_text(name, text);
    note(name, text.data(), text.size());
  }
  void finish() {
    file_.set_counts("/", "schema", {schema});
    file_.set_text("/", "calx_version", creator_version);
    file_.set_counts("/", "dataset_count", {count_});
    file_.set_counts("/", "checksum", {sum_});
    file_.set_counts("/", "complete", {1});
  }

 private:
  void check_new(const std::string& name) const {
    if (file_.has(name)) throw Error(Fault::files, file_.name() + ": dataset \"" + name + "\" is written twice");
  }
  void add(const std::string& name, H5Type type, const void* data, std::size_t count, std::size_t width,
           const std::string& unit) {
    check_new(name);
    file_.write(name, type, data, {count}, unit);
    note(name, data, count * width);
  }
  void note(const std::string& name, const void* data, std::size_t size) {
    sum_ += dataset_checksum(name, data, size);
    ++count_;
  }
  H5File& file_;
  std::uint64_t count_ = 0, sum_ = 0;
};

class H5StateReader : public StateReader {
 public:
  explicit H5StateReader(const std::string& path) : file_(path, H5File::Mode::read) { verify(); }

  bool has(const std::string& name) const override { return file_.has(name); }
  std::vector<double> get_doubles(const std::string& name) const override { return file_.read<double>(name); }
  std::vector<std::uint32_t> get_u32(const std::string& name) const override { return file_.read<std::uint32_t>(name); }
  std::vector<std::uint64_t> get_u64(const std::string& name) const override { return file_.read<std::uint64_t>(name); }
  std::vector<std::uint8_t> get_u8(const std::string& name) const override { return file_.read<std::uint8_t>(name); }
  std::string get_text(const std::string& name) const override { return file_.read_text(name); }

 private:
  void verify() const {
    if (!file_.has_attribute("/", "complete")) throw Error(Fault::files, file_.name() + ": not a complete checkpoint");
    const std::uint64_t found = file_.count("/", "schema");
    if (found != schema) {
      throw Error(Fault::files, file_.name() + ": checkpoint schema " + std::to_string(found) + ", written by calx " +
                                    file_.text("/", "calx_version") + "; this is calx " + creator_version +
                                    " and reads schema " + std::to_string(schema));
    }
    const std::vector<std::string> names = file_.datasets();
    const std::uint64_t count = file_.count("/", "dataset_count");
    if (names.size() != count) {
      throw Error(Fault::files,
                  file_.name() + ": " + std::to_string(names.size()) + " datasets instead of " + std::to_string(count));
    }
    std::uint64_t sum = 0;
    for (const std::string& name : names) {
      const std::vector<unsigned char> bytes = file_.bytes(name);
      sum += dataset_checksum(name, bytes.data(), bytes.size());
    }
    if (sum != file_.count("/", "checksum")) throw Error(Fault::files, file_.name() + ": the checksum does not match");
  }
  H5File file_;
};

}  // namespace

void write_checkpoint(const std::string& dir, const std::function<void(StateWriter&)>& save) {
  make_folder(dir);
  const std::string path = dir + "/" + file_name, previous = dir + "/" + previous_name, partial = path + ".partial";
  {
    H5File file(partial, H5File::Mode::create, path);
    H5StateWriter writer(file);
    save(writer);
    writer.finish();
    file.commit(true);
  }
  try {
    if (file_exists(path)) {
      // A second name for the older one first, so that there is a checkpoint.h5 at every moment. Where the file system
      // has no links, the older one stands under its second name only between the two renames.
      const std::string second = previous + ".partial";
      ::unlink(second.c_str());
      const bool linked = ::link(path.c_str(), second.c_str()) == 0;
      rename_file(linked ? second : path, previous);
    }
    rename_file(partial, path);
  } catch (...) {
    ::unlink(partial.c_str());
    throw;
  }
  sync_folder_of(path);
}

std::unique_ptr<StateReader> read_checkpoint(const std::string& dir, std::string* note) {
  std::string reasons;
  for (const char* name : {file_name, previous_name}) {
    const std::string path = dir + "/" + name;
    if (!file_exists(path)) {
      reasons += (reasons.empty() ? "" : "; ") + path + ": no such file";
      continue;
    }
    try {
      auto reader = std::make_unique<H5StateReader>(path);
      if (note != nullptr) *note = reasons.empty() ? "" : reasons + "; the checkpoint before it, " + path + ", is used";
      return reader;
    } catch (const Error& error) {
      reasons += (reasons.empty() ? "" : "; ") + std::string(error.what());
    }
  }
  throw Error(Fault::files,
              "no checkpoint to resume from in " + dir + ": " + reasons + "; run without --resume to start anew");
}

}  // namespace calx
