#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cmath>
#include <filesystem>

#include "base/error.hpp"
#include "io/files.hpp"
#include "io/io.hpp"

namespace calx {
namespace {

/// As %.9g in the C locale, whatever the locale of an embedding program.
void append_number(std::string& line, double value) {
  if (std::isnan(value)) {
    line += "nan";
    return;
  }
  char buffer[32];
  line.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, 9).ptr);
}

/// Length of the leading part of text that is a header and whole rows up to the time given.
std::size_t kept_length(const std::string& text, std::size_t header, double resume_at) {
  // Nine digits may round a time up; half a unit of the ninth digit is 5e-9 at most, relative.
  const double last = resume_at + 5e-9 * std::fabs(resume_at);
  std::size_t kept = header;
  while (kept < text.size()) {
    const std::size_t end = text.find('\n', kept);
    if (end == std::string::npos) break;
    double time = 0;
    const auto parsed = std::from_chars(text.data() + kept, text.data() + end, time);
    if (parsed.ec != std::errc() || time > last) break;
    kept = end + 1;
  }
  return kept;
}

/// Values of the last row in the first size bytes of text, without its time.
std::vector<double> last_row(const std::string& text, std::size_t header, std::size_t size) {
  std::vector<double> out;
  if (size <= header) return out;
  const char* at = text.data() + text.rfind('\n', size - 2) + 1;
  const char* end = text.data() + size - 1;
  while (at < end) {
    double value = 0;
    const auto parsed = std::from_chars(at, end, value);
    if (parsed.ec != std::errc()) return {};
    out.push_back(value);
    at = parsed.ptr + 1;
  }
  if (!out.empty()) out.erase(out.begin());
  return out;
}

}  // namespace

struct SeriesFile::Impl {
  std::string path;
  std::size_t column_count = 0;
  int descriptor = -1;
  std::uint64_t size = 0;
  std::vector<double> last;

  ~Impl() {
    if (descriptor >= 0) ::close(descriptor);
  }
  /// A row that fails half-way is taken back.
  void add(const std::string& line) {
    if (const int failure = write_all(descriptor, line.data(), line.size(), size)) {
      const int cut = ::ftruncate(descriptor, static_cast<off_t>(size));
      throw_file_error(cut == 0 ? "write" : "write or cut", path, failure);
    }
    size += line.size();
  }
};

SeriesFile::SeriesFile(const std::string& path, const std::vector<std::string>& columns, double resume_at)
    : impl_(std::make_unique<Impl>()) {
  std::string header = "time_s";
  for (const std::string& c : columns) header += "," + c;
  header += "\n";
  impl_->path = path;
  impl_->column_count = columns.size();
  make_folder(std::filesystem::path(path).parent_path().string());

  if (resume_at >= 0 && file_exists(path)) {
    const std::string text = read_text(path);
    const std::size_t end = text.find('\n');
    if (end != std::string::npos) {
      if (text.compare(0, end + 1, header) != 0) {
        throw Error(Fault::files, path + ": the columns are \"" + text.substr(0, end) +
                                      "\", but the case now gives \"" + header.substr(0, header.size() - 1) +
                                      "\"; resume with the same sensors, or move the file away");
      }
      impl_->size = kept_length(text, end + 1, resume_at);
      impl_->last = last_row(text, end + 1, impl_->size);
    }
  }
  impl_->descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
  if (impl_->descriptor < 0 || ::ftruncate(impl_->descriptor, static_cast<off_t>(impl_->size)) != 0) {
    throw_file_error("write", path, errno);
  }
  if (impl_->size == 0) impl_->add(header);
}

SeriesFile::~SeriesFile() = default;

const std::vector<double>& SeriesFile::last_values() const { return impl_->last; }

void SeriesFile::write(double time, const std::vector<double>& values) {
  if (values.size() != impl_->column_count) {
    throw Error(Fault::files, impl_->path + ": a row of " + std::to_string(values.size()) + " values for " +
                                  std::to_string(impl_->column_count) + " columns at t = " + shortest_text(time) +
                                  " s");
  }
  std::string line;
  append_number(line, time);
  for (const double v : values) {
    line += ',';
    append_number(line, v);
  }
  line += '\n';
  impl_->add(line);
}

}  // namespace calx
