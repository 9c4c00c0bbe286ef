// stress.cpp: kind "stress": normal and shear stress on "parts", mean over the time steps since the row before.
//
// Keys: see stress_probe.hpp. Columns: normal_Pa (compression positive), shear_Pa, ratio_1 (shear / normal).
#include <cmath>
#include <limits>

#include "measure/kinds.hpp"
#include "measure/stress_probe.hpp"

namespace calx {

namespace {

class StressSensor : public Sensor {
 public:
  explicit StressSensor(SensorOptions& options) : probe_(options) {}
  std::vector<std::string> columns() const override { return {"normal_Pa", "shear_Pa", "ratio_1"}; }
  bool wants_every_step() const override { return true; }

  void step(const WorldView& world) override {
    const StressState now = probe_.state(world);
    normal_ += now.normal;
    shear_ += now.shear;
    steps_ += 1;
  }
  std::vector<double> sample(const WorldView& world) override {
    if (steps_ == 0) step(world);
    const double normal = normal_ / steps_, shear = shear_ / steps_;
    normal_ = shear_ = steps_ = 0;
    probe_.weigh(world);
    return {normal, shear, normal > 0 ? shear / normal : std::numeric_limits<double>::quiet_NaN()};
  }

  void save(StateWriter& out, const std::string& prefix) const override {
    const double numbers[] = {normal_, shear_, steps_, probe_.below()};
    out.put(prefix + "/sums", numbers, 4, "Pa,Pa,1,N");
  }
  void load(const StateReader& in, const std::string& prefix) override {
    const std::vector<double> numbers = in.get_doubles(prefix + "/sums");
    normal_ = numbers.at(0);
    shear_ = numbers.at(1);
    steps_ = numbers.at(2);
    probe_.set_below(numbers.at(3));
  }

 private:
  StressProbe probe_;
  double normal_ = 0, shear_ = 0, steps_ = 0;  // sums since the last row
};

}  // namespace

std::unique_ptr<Sensor> make_stress_sensor(SensorOptions& options) { return std::make_unique<StressSensor>(options); }

}  // namespace calx
