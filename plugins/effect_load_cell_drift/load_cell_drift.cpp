// load_cell_drift.cpp: calx.load-cell-drift, gain and zero that drift with time.
#include <calx/instrument.hpp>

namespace {

const calx_field fields[] = {
    {"gain_rate", "1/s", "change of the gain per time", -1e3, 1e3, 0, 0, 0},
    {"zero_rate", "kg/s", "change of the zero per time, in the SI unit of the column per second", -1e9, 1e9, 0, 0, 0}};

class LoadCellDrift : public calx::instrument::Instrument {
 public:
  static const calx_descriptor descriptor;

  LoadCellDrift(const calx_host*, const calx_config& c)
      : gain_rate_(calx::parameter(descriptor, c, "gain_rate")),
        zero_rate_(calx::parameter(descriptor, c, "zero_rate")) {}

  double show(double time, double value) override { return value * (1 + gain_rate_ * time) + zero_rate_ * time; }

 private:
  double gain_rate_, zero_rate_;
};

const calx_descriptor LoadCellDrift::descriptor =
    calx::instrument::descriptor("calx.load-cell-drift", "Load-cell drift", "1.0.0", "Calx", "Apache-2.0",
                                 "A load cell whose gain and zero drift with time.", fields);

}  // namespace

CALX_PLUGIN(LoadCellDrift)
