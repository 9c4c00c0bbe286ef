// nozzle_lip.cpp: calx.nozzle-lip, a flat ring that stands into a vertical bore.
#include <calx/shape.hpp>

namespace {

const calx_field fields[] = {{"x", "m", "axis of the bore, x", -1e6, 1e6, 0, 0, 0},
                             {"y", "m", "axis of the bore, y", -1e6, 1e6, 0, 0, 0},
                             {"z", "m", "height of the ring (assumption)", -1e6, 1e6, 0.306, 0, 0},
                             {"bore_radius", "m", "radius of the bore (assumption)", 1e-9, 1e6, 0.018, 0, 0},
                             {"width", "m", "how far the ring stands into the bore", 1e-9, 1e6, 0.003, 0, 0}};

class NozzleLip : public calx::shape::Shape {
 public:
  static const calx_descriptor descriptor;

  NozzleLip(const calx_host*, const calx_config& c)
      : bore_(calx::parameter(descriptor, c, "bore_radius")), width_(calx::parameter(descriptor, c, "width")) {
    const char* const axes[] = {"x", "y", "z"};
    for (int k = 0; k < 3; ++k) origin_[k] = calx::parameter(descriptor, c, axes[k]);
    if (width_ >= bore_)
      throw calx::ConfigError("width: " + std::to_string(width_) + " m closes the bore of radius " +
                              std::to_string(bore_) + " m; give less");
  }

  calx_status send(const calx_shape_sink* sink) const override {
    const double up[3] = {0, 0, 1}, r_z[] = {bore_ - width_, 0, bore_, 0};
    return sink->revolution(sink, origin_, up, 2, r_z, 0);
  }

 private:
  double origin_[3], bore_, width_;
};

const calx_descriptor NozzleLip::descriptor =
    calx::shape::descriptor("calx.nozzle-lip", "Lip at the nozzle", "1.0.0", "Calx", "Apache-2.0",
                            "A ring that stands into the bore at the nozzle's end: a burr, a gasket, a step.", fields);

}  // namespace

CALX_PLUGIN(NozzleLip)
