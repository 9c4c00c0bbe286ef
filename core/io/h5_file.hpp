// h5_file.hpp: an HDF5 file as this module uses it: paths, plain numbers, units; every failure an Error(Fault::files).
// Changes take effect at commit() (see staged_file.hpp). HDF5's own messages go into ours, never to the terminal.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace calx {

enum class H5Type { f64, f32, u64, u32, u8 };
template <class T>
struct H5TypeOf;
template <>
struct H5TypeOf<double> {
  static constexpr H5Type value = H5Type::f64;
};
template <>
struct H5TypeOf<float> {
  static constexpr H5Type value = H5Type::f32;
};
template <>
struct H5TypeOf<std::uint64_t> {
  static constexpr H5Type value = H5Type::u64;
};
template <>
struct H5TypeOf<std::uint32_t> {
  static constexpr H5Type value = H5Type::u32;
};
template <>
struct H5TypeOf<std::uint8_t> {
  static constexpr H5Type value = H5Type::u8;
};

class H5File {
 public:
  using Sizes = std::vector<std::uint64_t>;
  enum class Mode { create, update, read };

  /// name: what messages call the file; empty: its path.
  H5File(const std::string& path, Mode mode, const std::string& name = "");
  /// Drops what was not committed.
  ~H5File();
  H5File(const H5File&) = delete;
  H5File& operator=(const H5File&) = delete;
  /// Closes the file; nothing may follow.
  void commit(bool durable);
  const std::string& name() const;

  /// Groups on the way are made. A path stands for "/path".
  void write(const std::string& path, H5Type type, const void* data, const Sizes& sizes, const std::string& unit = "");
  void write_text(const std::string& path, const std::string& text);
  /// A dataset that grows along its first axis. varying: along its second, too, the rest of each row being filled with
  /// NaN or the largest integer.
  void create_growing(const std::string& path, H5Type type, const Sizes& row, bool varying, const std::string& unit);
  void append(const std::string& path, H5Type type, const void* row, const Sizes& row_sizes);
  void truncate(const std::string& path, std::uint64_t rows);
  /// A second name for the same dataset.
  void link(const std::string& existing, const std::string& path);

  bool has(const std::string& path) const;
  Sizes sizes(const std::string& path) const;
  /// Whole dataset; numbers of another type or width are refused.
  template <class T>
  std::vector<T> read(const std::string& path) const {
    std::vector<T> out(count(path));
    read_all(path, H5TypeOf<T>::value, out.data());
    return out;
  }
  /// One row (first axis), of its second axis the first `count` entries, all of the others; numbers are converted.
  template <class T>
  std::vector<T> read_row(const std::string& path, std::uint64_t row, std::uint64_t count) const {
    std::vector<T> out(row_size(path, count));
    read_part(path, H5TypeOf<T>::value, row, count, out.data());
    return out;
  }
  std::string read_text(const std::string& path) const;
  /// Paths of all datasets below the root, each once, in alphabetical order.
  std::vector<std::string> datasets() const;
  /// Names of the groups and datasets directly in a group, in alphabetical order.
  std::vector<std::string> members(const std::string& group) const;
  /// Raw bytes of a dataset, as stored on a little-endian machine.
  std::vector<unsigned char> bytes(const std::string& path) const;

  /// Attributes of a group or dataset; groups are made.
  void set_text(const std::string& path, const std::string& attribute, const std::string& text);
  void set_texts(const std::string& path, const std::string& attribute, const std::vector<std::string>& texts);
  void set_counts(const std::string& path, const std::string& attribute, const std::vector<std::uint64_t>& values);
  bool has_attribute(const std::string& path, const std::string& attribute) const;
  std::string text(const std::string& path, const std::string& attribute) const;
  std::uint64_t count(const std::string& path, const std::string& attribute) const;

 private:
  std::size_t count(const std::string& path) const;
  std::size_t row_size(const std::string& path, std::uint64_t count) const;
  void read_all(const std::string& path, H5Type type, void* out) const;
  void read_part(const std::string& path, H5Type type, std::uint64_t row, std::uint64_t count, void* out) const;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace calx
