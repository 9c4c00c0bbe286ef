// files.hpp: how this module puts bytes on disk: whole files that appear at once or not at all.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>

namespace calx {

/// Error(Fault::files): "cannot <action> <path>: <reason of error_number>".
[[noreturn]] void throw_file_error(const std::string& action, const std::string& path, int error_number);

/// The folder and its parents, if missing.
void make_folder(const std::string& dir);
/// Makes a rename in the folder of path survive a power failure.
void sync_folder_of(const std::string& path);
void rename_file(const std::string& from, const std::string& to);
bool file_exists(const std::string& path);
/// Writes all bytes at the offset; 0, or the errno of the failure.
int write_all(int descriptor, const void* data, std::size_t size, std::uint64_t offset);

/// 64-bit FNV-1a (Fowler, Noll, Vo) taken over 8-byte little-endian words, the last one padded with zeros: finds cut
/// and altered data; not a defence against intent.
std::uint64_t checksum(const void* data, std::size_t size, std::uint64_t seed = 0xCBF29CE484222325ull);

/// A number as text that reads back to the same bits, whatever the locale.
std::string shortest_text(double value);

/// A file written under a temporary name in the same folder; commit() renames it over path. Destroyed without commit,
/// it leaves nothing.
class NewFile {
 public:
  explicit NewFile(const std::string& path);
  ~NewFile();
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;
  void write(const void* data, std::size_t size);
  /// durable: the file survives a power failure from here on.
  void commit(bool durable);

 private:
  std::string path_, partial_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

}  // namespace calx
