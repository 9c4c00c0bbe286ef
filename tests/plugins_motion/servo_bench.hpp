// servo_bench.hpp: a servo plugin pushing a spring, step by step, and its state to bytes and back.
#pragma once
#include <algorithm>
#include <cstring>
#include <vector>

#include "loaded_plugin.hpp"

namespace calx_test {

class LoadedServo : public LoadedPlugin {
 public:
  LoadedServo(const std::string& library, const std::string& id, const std::map<std::string, double>& given,
              const std::string& json)
      : LoadedPlugin(library, id, given, json),
        servo_(table<calx_servo>(CALX_SERVO)),
        state_(table<calx_state>(CALX_STATE)) {
    CHECK(std::string(descriptor().kind) == CALX_SERVO);
  }
  const calx_servo* servo() const { return servo_; }
  calx_pose pose() const {
    calx_pose p;
    REQUIRE(servo_->pose(instance(), &p) == CALX_OK);
    return p;
  }
  /// One step of dt under the force given along x; the status of advance.
  calx_status advance(double force, double dt = 1e-3) {
    time_ += dt;
    const calx_servo_view view = {sizeof(calx_servo_view), 0, time_, dt, {force, 0, 0}, {0, 0, 0}};
    return servo_->advance(instance(), host(), &view);
  }
  double time() const { return time_; }
  void set_time(double time) { time_ = time; }

  std::vector<unsigned char> save() const {
    Stream s;
    REQUIRE(state_->save(instance(), &s.table) == CALX_OK);
    return s.bytes;
  }
  /// most: bytes the stream hands out at once.
  calx_status load(const std::vector<unsigned char>& bytes, std::uint64_t most = 1000, std::uint32_t schema = 1) {
    Stream s;
    s.bytes = bytes;
    s.most = most;
    return state_->load(instance(), &s.table, schema);
  }

 private:
  struct Stream {
    Stream() {
      table.struct_size = sizeof table;
      table.self = this;
      table.write = [](const calx_stream* t, const void* from, std::uint64_t size) -> std::int64_t {
        auto& to = static_cast<Stream*>(t->self)->bytes;
        to.insert(to.end(), static_cast<const unsigned char*>(from), static_cast<const unsigned char*>(from) + size);
        return static_cast<std::int64_t>(size);
      };
      table.read = [](const calx_stream* t, void* to, std::uint64_t size) -> std::int64_t {
        Stream& s = *static_cast<Stream*>(t->self);
        const std::uint64_t n = std::min<std::uint64_t>({size, s.most, s.bytes.size() - s.at});
        if (n > 0) std::memcpy(to, s.bytes.data() + s.at, n);
        s.at += n;
        return static_cast<std::int64_t>(n);
      };
    }
    calx_stream table{};
    std::vector<unsigned char> bytes;
    std::size_t at = 0;
    std::uint64_t most = 1000;
  };
  const calx_servo* servo_;
  const calx_state* state_;
  double time_ = 0;
};

/// Half way saved, given back to a fresh servo in pieces of 3 bytes, gone on with: the same bits. push: one step.
template <class Make, class Push>
void check_saved_state(const Make& make, const Push& push, int steps) {
  auto straight = make();
  for (int k = 0; k < steps; ++k) push(*straight);
  const std::vector<unsigned char> bytes = straight->save();
  auto resumed = make();
  REQUIRE(resumed->load(bytes, 3) == CALX_OK);
  CHECK(resumed->save() == bytes);
  resumed->set_time(straight->time());
  for (int k = 0; k < steps; ++k) {
    push(*straight);
    push(*resumed);
    const calx_pose a = straight->pose(), b = resumed->pose();
    REQUIRE(std::memcmp(&a, &b, sizeof a) == 0);
  }
  // Cut, too long, of another schema, not a number.
  std::vector<unsigned char> cut(bytes.begin(), bytes.end() - 1), more = bytes, junk = bytes;
  more.push_back(0);
  std::fill(junk.begin(), junk.begin() + 8, 0xFF);
  const calx_pose before = resumed->pose();
  CHECK(resumed->load(cut) == CALX_E_STATE);
  CHECK(resumed->load(more) == CALX_E_STATE);
  CHECK(resumed->load(junk) == CALX_E_STATE);
  CHECK(resumed->load(bytes, 1000, 2) == CALX_E_STATE);
  const calx_pose after = resumed->pose();
  CHECK(std::memcmp(&before, &after, sizeof before) == 0);
}

}  // namespace calx_test
