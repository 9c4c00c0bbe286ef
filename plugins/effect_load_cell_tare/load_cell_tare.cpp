// load_cell_tare.cpp: calx.load-cell-tare, a constant error of the zero.
#include <calx/instrument.hpp>

namespace {

const calx_field fields[] = {
    {"offset", "kg", "added to every reading, in the SI unit of the column", -1e9, 1e9, 0, 0, 0}};

class LoadCellTare : public calx::instrument::Instrument {
 public:
  static const calx_descriptor descriptor;

  LoadCellTare(const calx_host*, const calx_config& c) : offset_(calx::parameter(descriptor, c, "offset")) {}

  double show(double, double value) override { return value + offset_; }

 private:
  double offset_;
};

const calx_descriptor LoadCellTare::descriptor = calx::instrument::descriptor(
    "calx.load-cell-tare", "Load-cell tare", "1.0.0", "Calx", "Apache-2.0", "A constant error of the zero.", fields);

}  // namespace

CALX_PLUGIN(LoadCellTare)
