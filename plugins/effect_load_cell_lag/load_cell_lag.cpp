// load_cell_lag.cpp: calx.load-cell-lag, a first-order lag.
#include <calx/instrument.hpp>
#include <cmath>

namespace {

const calx_field fields[] = {{"lag", "s", "time constant", 0, 1e9, 0, 0, 0}};

class LoadCellLag : public calx::instrument::Instrument {
 public:
  static const calx_descriptor descriptor;

  LoadCellLag(const calx_host*, const calx_config& c) : Instrument(4), lag_(calx::parameter(descriptor, c, "lag")) {}

  double show(double time, double value) override {
    double& begun = memory()[0];
    double& at = memory()[1];
    double& load = memory()[2];
    double& shown = memory()[3];
    const double h = time - at;
    if (begun > 0 && lag_ > 0 && h > 0) {
      // The load is a straight line between two samples; this solves lag y' = x - y along it.
      const double behind = lag_ * (value - load) / h, kept = std::exp(-h / lag_);
      shown = value - behind + (shown - load + behind) * kept;
    } else {
      shown = value;
    }
    begun = 1;
    at = time;
    load = value;
    return shown;
  }

 private:
  double lag_;
};

const calx_descriptor LoadCellLag::descriptor =
    calx::instrument::descriptor("calx.load-cell-lag", "Load-cell lag", "1.0.0", "Calx", "Apache-2.0",
                                 "A load cell that follows the load with a first-order lag.", fields);

}  // namespace

CALX_PLUGIN(LoadCellLag)
