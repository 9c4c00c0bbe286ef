// load_cell_gain.cpp: calx.load-cell-gain, a wrong gain.
#include <calx/instrument.hpp>

namespace {

const calx_field fields[] = {{"error", "1", "relative error of the gain", -1, 1e3, 0, 0, 0}};

class LoadCellGain : public calx::instrument::Instrument {
 public:
  static const calx_descriptor descriptor;

  LoadCellGain(const calx_host*, const calx_config& c) : error_(calx::parameter(descriptor, c, "error")) {}

  double show(double, double value) override { return value * (1 + error_); }

 private:
  double error_;
};

const calx_descriptor LoadCellGain::descriptor =
    calx::instrument::descriptor("calx.load-cell-gain", "Load-cell gain error", "1.0.0", "Calx", "Apache-2.0",
                                 "A load cell or scale with a wrong gain.", fields);

}  // namespace

CALX_PLUGIN(LoadCellGain)
