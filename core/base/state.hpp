// state.hpp: how modules write and read their part of a checkpoint without knowing the file format.
// Names are paths ("particles/position"); each name is written once. io/ implements both over HDF5.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace calx {

class StateWriter {
 public:
  virtual ~StateWriter() = default;
  virtual void put(const std::string& name, const double* data, std::size_t count, const std::string& unit) = 0;
  virtual void put(const std::string& name, const std::uint32_t* data, std::size_t count) = 0;
  virtual void put(const std::string& name, const std::uint64_t* data, std::size_t count) = 0;
  virtual void put(const std::string& name, const std::uint8_t* data, std::size_t count) = 0;
  virtual void put_text(const std::string& name, const std::string& text) = 0;
  void put_number(const std::string& name, double value, const std::string& unit) { put(name, &value, 1, unit); }
  void put_count(const std::string& name, std::uint64_t value) { put(name, &value, 1); }
};

/// Every get throws Error(Fault::files) naming the file and the dataset when it is missing or of another type.
class StateReader {
 public:
  virtual ~StateReader() = default;
  virtual bool has(const std::string& name) const = 0;
  virtual std::vector<double> get_doubles(const std::string& name) const = 0;
  virtual std::vector<std::uint32_t> get_u32(const std::string& name) const = 0;
  virtual std::vector<std::uint64_t> get_u64(const std::string& name) const = 0;
  virtual std::vector<std::uint8_t> get_u8(const std::string& name) const = 0;
  virtual std::string get_text(const std::string& name) const = 0;
  double get_number(const std::string& name) const { return get_doubles(name).at(0); }
  std::uint64_t get_count(const std::string& name) const { return get_u64(name).at(0); }
};

}  // namespace calx
