// fake_state.hpp: a checkpoint in memory.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/state.hpp"

namespace calx {

class FakeState : public StateWriter, public StateReader {
 public:
  using StateWriter::put;
  void put(const std::string& name, const double* data, std::size_t count, const std::string&) override {
    doubles_[name].assign(data, data + count);
  }
  void put(const std::string& name, const std::uint32_t* data, std::size_t count) override {
    u32_[name].assign(data, data + count);
  }
  void put(const std::string& name, const std::uint64_t* data, std::size_t count) override {
    u64_[name].assign(data, data + count);
  }
  void put(const std::string& name, const std::uint8_t* data, std::size_t count) override {
    u8_[name].assign(data, data + count);
  }
  void put_text(const std::string& name, const std::string& text) override { text_[name] = text; }

  bool has(const std::string& name) const override {
    return doubles_.count(name) || u32_.count(name) || u8_.count(name);
  }
  std::vector<double> get_doubles(const std::string& name) const override { return get(doubles_, name); }
  std::vector<std::uint32_t> get_u32(const std::string& name) const override { return get(u32_, name); }
  std::vector<std::uint64_t> get_u64(const std::string& name) const override { return get(u64_, name); }
  std::vector<std::uint8_t> get_u8(const std::string& name) const override { return get(u8_, name); }
  std::string get_text(const std::string& name) const override { return get(text_, name); }

 private:
  template <class Map>
  static typename Map::mapped_type get(const Map& map, const std::string& name) {
    const auto it = map.find(name);
    if (it == map.end()) throw Error(Fault::files, "no dataset " + name);
    return it->second;
  }
  std::map<std::string, std::vector<double>> doubles_;
  std::map<std::string, std::vector<std::uint32_t>> u32_;
  std::map<std::string, std::vector<std::uint64_t>> u64_;
  std::map<std::string, std::vector<std::uint8_t>> u8_;
  std::map<std::string, std::string> text_;
};

}  // namespace calx
