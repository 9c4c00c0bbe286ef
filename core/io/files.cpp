#include "io/files.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>

#include "base/error.hpp"
#include "io/io.hpp"

namespace calx {

void throw_file_error(const std::string& action, const std::string& path, int error_number) {
  std::string message = "cannot " + action + " " + path + ": " + std::generic_category().message(error_number);
  if (error_number == ENOSPC || error_number == EDQUOT) message += "; free some space; what was written before is kept";
  if (error_number == EFBIG) message += "; raise the file size limit (ulimit -f); what was written before is kept";
  throw Error(Fault::files, message);
}

void make_folder(const std::string& dir) {
  if (dir.empty()) return;
  std::error_code code;
  std::filesystem::create_directories(dir, code);
  if (code) throw_file_error("create folder", dir, code.value());
}

void sync_folder_of(const std::string& path) {
  const std::string dir = std::filesystem::path(path).parent_path().string();
  const int descriptor = ::open(dir.empty() ? "." : dir.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;  // an unreadable folder cannot be synced; the rename itself is done
  ::fsync(descriptor);
  ::close(descriptor);
}

void rename_file(const std::string& from, const std::string& to) {
  if (::rename(from.c_str(), to.c_str()) != 0) throw_file_error("write", to, errno);
}

bool file_exists(const std::string& path) {
  struct stat info;
  return ::stat(path.c_str(), &info) == 0;
}

int write_all(int descriptor, const void* data, std::size_t size, std::uint64_t offset) {
  const char* bytes = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t done = ::pwrite(descriptor, bytes, size, static_cast<off_t>(offset));
    if (done < 0) {
      if (errno == EINTR) continue;
      return errno;
    }
    bytes += done;
    offset += static_cast<std::uint64_t>(done);
    size -= static_cast<std::size_t>(done);
  }
  return 0;
}

std::uint64_t checksum(const void* data, std::size_t size, std::uint64_t seed) {
  constexpr std::uint64_t prime = 0x100000001B3ull;
  const unsigned char* bytes = static_cast<const unsigned char*>(data);
  std::uint64_t sum = seed, word = 0;
  std::size_t at = 0;
  for (; at + sizeof word <= size; at += sizeof word) {
    std::memcpy(&word, bytes + at, sizeof word);
    sum = (sum ^ word) * prime;
  }
  word = 0;
  if (at < size) std::memcpy(&word, bytes + at, size - at);
  sum = (sum ^ word) * prime;
  return (sum ^ size) * prime;
}

std::string shortest_text(double value) {
  char buffer[40];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

NewFile::NewFile(const std::string& path) : path_(path), partial_(path + ".partial") {
  descriptor_ = ::open(partial_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor_ < 0) throw_file_error("write", path_, errno);
}

NewFile::~NewFile() {
  if (descriptor_ < 0) return;
  ::close(descriptor_);
  ::unlink(partial_.c_str());
}

void NewFile::write(const void* data, std::size_t size) {
  if (const int failure = write_all(descriptor_, data, size, size_)) throw_file_error("write", path_, failure);
  size_ += size;
}

void NewFile::commit(bool durable) {
  if (durable && ::fsync(descriptor_) != 0) throw_file_error("write", path_, errno);
  const int closed = ::close(descriptor_);
  const int failure = errno;
  descriptor_ = -1;
  if (closed != 0 || ::rename(partial_.c_str(), path_.c_str()) != 0) {
    const int reason = closed != 0 ? failure : errno;
    ::unlink(partial_.c_str());
    throw_file_error("write", path_, reason);
  }
  if (durable) sync_folder_of(path_);
}

void write_text_atomically(const std::string& path, const std::string& text) {
  NewFile file(path);
  file.write(text.data(), text.size());
  file.commit(true);
}

std::string read_text(const std::string& path) {
  errno = 0;
  std::ifstream in(path, std::ios::binary);
  if (!in) throw_file_error("read", path, errno ? errno : ENOENT);
  std::ostringstream out;
  out << in.rdbuf();
  // A folder opens, but gives no bytes.
  if (in.bad() || (out.fail() && in.peek() != std::char_traits<char>::eof())) throw_file_error("read", path, EIO);
  std::error_code code;
  if (std::filesystem::is_directory(path, code)) throw_file_error("read", path, EISDIR);
  return out.str();
}

}  // namespace calx
