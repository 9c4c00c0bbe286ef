// staged_file.hpp: a file whose changes take effect together at commit() or not at all.
// Under HDF5 it gives what HDF5 alone does not: a full disk or a kill in the middle of a write leaves the file as it
// was. New bytes go to disk behind the old end at once; changes to old bytes (some 4 KiB pages of HDF5 metadata per
// frame) wait in memory, then go through a journal file beside the path.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace calx {

class StagedFile {
 public:
  enum class Mode { create, update, read };
  /// name: what error messages call the file. Throws Error(Fault::files).
  StagedFile(const std::string& path, Mode mode, const std::string& name);
  /// Without commit: a created file is deleted, an updated one is as it was.
  ~StagedFile();
  StagedFile(const StagedFile&) = delete;
  StagedFile& operator=(const StagedFile&) = delete;

  /// Bytes beyond the end read as zero. False on an I/O error.
  bool read(std::uint64_t at, std::size_t count, void* out);
  /// A failure is remembered in error(), and this and all later writes stay in memory, so that the library above can
  /// finish in order before the failure is reported.
  void write(std::uint64_t at, std::size_t count, const void* data);
  std::uint64_t size() const { return size_; }
  void set_size(std::uint64_t size) { size_ = size; }
  int error() const { return error_; }
  /// Throws what error() holds, if anything.
  void check() const;
  /// Everything commit() needs is on disk: from here the change takes effect even if this process dies.
  void prepare();
  /// Prepares and completes the change. durable: the content survives a power failure, not only the end of the process.
  void commit(bool durable);

 private:
  using Page = std::vector<unsigned char>;
  void stage(std::uint64_t at, std::size_t count, const unsigned char* data);
  bool read_disk(std::uint64_t at, std::size_t count, unsigned char* out);
  bool load_journal();
  void write_journal() const;
  void apply_pages();

  std::string path_, journal_, name_;
  Mode mode_;
  int descriptor_ = -1, error_ = 0;
  bool prepared_ = false;
  std::uint64_t size_ = 0;               // as the writer sees it
  std::uint64_t old_size_ = 0;           // on disk at opening
  std::uint64_t direct_from_ = 0;        // writes from here on go straight to disk
  std::map<std::uint64_t, Page> pages_;  // by page number
};

}  // namespace calx
