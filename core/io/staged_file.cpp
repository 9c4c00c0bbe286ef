#include "io/staged_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>

#include "io/files.hpp"
#include "io/io.hpp"

namespace calx {
namespace {

constexpr std::uint64_t page_size = 4096;
constexpr char journal_magic[] = "CALXJNL1";

void append_u64(std::string& out, std::uint64_t value) { out.append(reinterpret_cast<const char*>(&value), 8); }

std::uint64_t u64_at(const std::string& in, std::size_t at) {
  std::uint64_t value;
  std::memcpy(&value, in.data() + at, 8);
  return value;
}

}  // namespace

StagedFile::StagedFile(const std::string& path, Mode mode, const std::string& name)
    : path_(path), journal_(path + ".journal"), name_(name), mode_(mode) {
  const int flags = mode == Mode::read ? O_RDONLY : mode == Mode::update ? O_RDWR : O_RDWR | O_CREAT | O_TRUNC;
  descriptor_ = ::open(path.c_str(), flags | O_CLOEXEC, 0666);
  if (descriptor_ < 0) throw_file_error(mode == Mode::read ? "read" : "write", name_, errno);
  if (mode == Mode::create) {
    ::unlink(journal_.c_str());
    return;
  }
  struct stat info;
  if (::fstat(descriptor_, &info) != 0) {
    const int failure = errno;
    ::close(descriptor_);
    throw_file_error("read", name_, failure);
  }
  size_ = static_cast<std::uint64_t>(info.st_size);
  try {
    if (load_journal() && mode == Mode::update) apply_pages();
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
  old_size_ = size_;
  direct_from_ = (old_size_ + page_size - 1) / page_size * page_size;
}

StagedFile::~StagedFile() {
  if (!prepared_ && mode_ == Mode::update && ::ftruncate(descriptor_, static_cast<off_t>(old_size_)) != 0) {
    // The bytes behind the old end are not referred to by anything before it; the file reads as it was.
  }
  ::close(descriptor_);
  if (!prepared_ && mode_ == Mode::create) ::unlink(path_.c_str());
}

bool StagedFile::read_disk(std::uint64_t at, std::size_t count, unsigned char* out) {
  while (count > 0) {
    const ssize_t done = ::pread(descriptor_, out, count, static_cast<off_t>(at));
    if (done < 0) {
      if (errno == EINTR) continue;
      return false;
    }
    if (done == 0) break;
    at += static_cast<std::uint64_t>(done);
    out += done;
    count -= static_cast<std::size_t>(done);
  }
  std::memset(out, 0, count);
  return true;
}

bool StagedFile::read(std::uint64_t at, std::size_t count, void* out) {
  unsigned char* bytes = static_cast<unsigned char*>(out);
  if (!read_disk(at, count, bytes)) return false;
  const std::uint64_t end = at + count;
  for (auto page = pages_.lower_bound(at / page_size); page != pages_.end() && page->first * page_size < end; ++page) {
    const std::uint64_t start = page->first * page_size;
    const std::uint64_t lo = std::max(at, start), hi = std::min(end, start + page_size);
    std::memcpy(bytes + (lo - at), page->second.data() + (lo - start), hi - lo);
  }
  return true;
}

void StagedFile::stage(std::uint64_t at, std::size_t count, const unsigned char* data) {
  const std::uint64_t end = at + count;
  while (at < end) {
    const std::uint64_t number = at / page_size, start = number * page_size;
    const std::uint64_t hi = std::min(end, start + page_size);
    Page& page = pages_[number];
    if (page.empty()) {
      page.resize(page_size);
      if (!read_disk(start, page_size, page.data()) && error_ == 0) error_ = errno;
    }
    std::memcpy(page.data() + (at - start), data, hi - at);
    data += hi - at;
    at = hi;
  }
}

void StagedFile::write(std::uint64_t at, std::size_t count, const void* data) {
  const unsigned char* bytes = static_cast<const unsigned char*>(data);
  if (at < direct_from_) {
    const std::size_t staged = static_cast<std::size_t>(std::min<std::uint64_t>(count, direct_from_ - at));
    stage(at, staged, bytes);
    at += staged;
    bytes += staged;
    count -= staged;
  }
  if (count == 0) return;
  if (const int failure = write_all(descriptor_, bytes, count, at)) {
    if (error_ == 0) error_ = failure;
    direct_from_ = std::numeric_limits<std::uint64_t>::max();
    stage(at, count, bytes);
  }
}

void StagedFile::check() const {
  if (error_ != 0) throw_file_error("write", name_, error_);
}

bool StagedFile::load_journal() {
  if (!file_exists(journal_)) return false;
  const std::string text = read_text(journal_);
  const std::size_t head = 24;
  if (text.size() < head + 8 || text.compare(0, 8, journal_magic) != 0) return false;
  const std::uint64_t count = u64_at(text, 16);
  if (count > text.size() || text.size() != head + count * (8 + page_size) + 8) return false;
  if (u64_at(text, text.size() - 8) != checksum(text.data(), text.size() - 8)) return false;
  size_ = u64_at(text, 8);
  for (std::uint64_t k = 0; k < count; ++k) {
    const std::size_t at = head + k * (8 + page_size);
    const char* bytes = text.data() + at + 8;
    pages_[u64_at(text, at)].assign(bytes, bytes + page_size);
  }
  return true;
}

void StagedFile::write_journal() const {
  std::string text(journal_magic, 8);
  append_u64(text, size_);
  append_u64(text, pages_.size());
  for (const auto& [number, page] : pages_) {
    append_u64(text, number);
    text.append(reinterpret_cast<const char*>(page.data()), page_size);
  }
  append_u64(text, checksum(text.data(), text.size()));
  NewFile file(journal_);
  file.write(text.data(), text.size());
  file.commit(false);
}

void StagedFile::apply_pages() {
  for (const auto& [number, page] : pages_) {
    const std::uint64_t start = number * page_size;
    if (start >= size_) continue;
    const std::size_t count = static_cast<std::size_t>(std::min(page_size, size_ - start));
    if (const int failure = write_all(descriptor_, page.data(), count, start))
      throw_file_error("write", name_, failure);
  }
  if (::ftruncate(descriptor_, static_cast<off_t>(size_)) != 0) throw_file_error("write", name_, errno);
  pages_.clear();
  ::unlink(journal_.c_str());
}

void StagedFile::prepare() {
  check();
  if (mode_ == Mode::update && !pages_.empty()) write_journal();
  prepared_ = true;
}

void StagedFile::commit(bool durable) {
  prepare();
  try {
    apply_pages();
    if (durable && ::fsync(descriptor_) != 0) throw_file_error("write", name_, errno);
  } catch (...) {
    // A new file is worth nothing in part; the journal of an old one stands, and the next opening completes it.
    if (mode_ == Mode::create) prepared_ = false;
    throw;
  }
}

}  // namespace calx
