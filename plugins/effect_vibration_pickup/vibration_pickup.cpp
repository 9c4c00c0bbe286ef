// vibration_pickup.cpp: calx.vibration-pickup, a harmonic disturbance.
#include <calx/instrument.hpp>
#include <cmath>

namespace {

const calx_field fields[] = {
    {"amplitude", "kg", "amplitude of the disturbance, in the SI unit of the column", 0, 1e9, 0, 0, 0},
    {"frequency", "1/s", "its frequency", 0, 1e9, 5, 0, 0},
    {"phase", "rad", "its phase at t = 0", -7, 7, 0, 0, 0}};

class VibrationPickup : public calx::instrument::Instrument {
 public:
  static const calx_descriptor descriptor;

  VibrationPickup(const calx_host*, const calx_config& c)
      : amplitude_(calx::parameter(descriptor, c, "amplitude")),
        frequency_(calx::parameter(descriptor, c, "frequency")),
        phase_(calx::parameter(descriptor, c, "phase")) {}

  double show(double time, double value) override {
    const double turns = frequency_ * time;
    return value + amplitude_ * std::sin(6.283185307179586 * (turns - std::floor(turns)) + phase_);
  }

 private:
  double amplitude_, frequency_, phase_;
};

const calx_descriptor VibrationPickup::descriptor =
    calx::instrument::descriptor("calx.vibration-pickup", "Vibration pick-up", "1.0.0", "Calx", "Apache-2.0",
                                 "A load cell that hears a motor or a vibrator.", fields);

}  // namespace

CALX_PLUGIN(VibrationPickup)
