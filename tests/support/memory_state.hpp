// memory_state.hpp: a checkpoint in memory, with the promises of StateWriter and StateReader kept strictly.
#pragma once
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/state.hpp"

namespace calx {

class MemoryState : public StateWriter, public StateReader {
 public:
  void put(const std::string& name, const double* data, std::size_t count, const std::string& unit) override {
    claim(name);
    units[name] = unit;
    doubles[name].assign(data, data + count);
  }
  void put(const std::string& name, const std::uint32_t* data, std::size_t count) override {
    claim(name);
    u32[name].assign(data, data + count);
  }
  void put(const std::string& name, const std::uint64_t* data, std::size_t count) override {
    claim(name);
    u64[name].assign(data, data + count);
  }
  void put(const std::string& name, const std::uint8_t* data, std::size_t count) override {
    claim(name);
    u8[name].assign(data, data + count);
  }
  void put_text(const std::string& name, const std::string& value) override {
    claim(name);
    text[name] = value;
  }

  bool has(const std::string& name) const override {
    return doubles.count(name) + u32.count(name) + u64.count(name) + u8.count(name) + text.count(name) > 0;
  }
  std::vector<double> get_doubles(const std::string& name) const override { return get(doubles, name); }
  std::vector<std::uint32_t> get_u32(const std::string& name) const override { return get(u32, name); }
  std::vector<std::uint64_t> get_u64(const std::string& name) const override { return get(u64, name); }
  std::vector<std::uint8_t> get_u8(const std::string& name) const override { return get(u8, name); }
  std::string get_text(const std::string& name) const override { return get(text, name); }

  std::map<std::string, std::vector<double>> doubles;
  std::map<std::string, std::vector<std::uint32_t>> u32;
  std::map<std::string, std::vector<std::uint64_t>> u64;
  std::map<std::string, std::vector<std::uint8_t>> u8;
  std::map<std::string, std::string> text, units;

 private:
  void claim(const std::string& name) {
    if (has(name)) throw std::logic_error("state written twice: " + name);
  }
  template <class T>
  static T get(const std::map<std::string, T>& from, const std::string& name) {
    const auto found = from.find(name);
    if (found == from.end()) throw Error(Fault::files, "memory: dataset " + name + " is missing or of another type");
    return found->second;
  }
};

}  // namespace calx
