// on_device.hpp: a step of the engine on a device. Lists are built by the host; contacts, sums, integration, guards and
// ledgers run on the device, with the bits of the host. Private to step/.
#pragma once
#include <memory>
#include <vector>

#include "compute/device.hpp"
#include "step/engine_detail.hpp"

namespace calx {

struct Engine::OnDevice {
  /// fast: a * b + c may be contracted, and the bits are the device's own.
  OnDevice(std::unique_ptr<Device> device, Engine& engine, bool fast);
  ~OnDevice();
  /// First half of a step of verlet; fills the work of gravity of chunks, and says whether lists are stale.
  void drift(double dt);
  /// Contacts at the poses of the parts, sums and integration; fills the engine's results of chunks.
  void step(double t, double dt);
  /// Brings particles and history to the host, once for each step at most.
  void fetch();
  /// The host's particles and lists count from now on; they travel before the next step.
  void host_changed() {
    current_ = false;
    fetched_ = true;
  }
  const Device& device() const { return *device_; }
  std::size_t memory_bytes() const;

 private:
  struct Numbers;
  struct Memory;
  void build(bool fast);
  void send_lists();
  void send_shapes();
  void send_particles();
  void send_pairs();
  void send_walls();
  void send_chunks();
  void send_parts();
  void take_results();
  void launch_integration(const Numbers& n);
  std::size_t result_width() const { return kSums + 6 * engine_.parts.size(); }
  Numbers numbers(double t, double dt) const;

  /// Numbers of a chunk before the loads on parts; see fold.h.
  static constexpr std::size_t kSums = 14;

  std::unique_ptr<Device> device_;
  Engine& engine_;
  std::unique_ptr<Memory> memory_;
  bool current_ = false;  // the device holds the host's lists
  bool fetched_ = true;   // the host holds the device's particles
};

}  // namespace calx
