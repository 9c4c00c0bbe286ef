// nozzle_port.cpp: everything between rotary valve and canister, calx.nozzle-port, one piece a part, so that each has
// its own motion. x to the right, y along the rotor axis and the gates' travel, z up, m.
//
// Chute and pipe meet, and pipe and nozzle meet, on the plane that halves the angle between their axes (a mitre joint),
// so that round bores of equal radius fit exactly: on that plane both are the same ellipse, a circle seen from above.
#include <algorithm>
#include <calx/shape.hpp>
#include <cmath>
#include <vector>

namespace {

const double turn = 6.28318530717958648;
enum Piece { chute, pipe, nozzle, port, nozzle_gate, port_gate };

// Presets: one consistent set of dimensions; each is an assumption, since the publication gives none.
const calx_field fields[] = {
    {"piece", "chute|pipe|nozzle|port|nozzle-gate|port-gate", "which part this is", 0, 5, 0,
     CALX_FIELD_CHOICE | CALX_FIELD_REQUIRED, 0},
    {"bore_radius", "m", "radius of pipe, nozzle and port (assumption)", 1e-9, 1e6, 0.018, 0, 0},
    {"chute_width", "m", "width of the chute's upper end along x (assumption)", 1e-9, 1e6, 0.0442, 0, 0},
    {"chute_depth", "m", "depth of the chute's upper end along y (assumption)", 1e-9, 1e6, 0.040, 0, 0},
    {"rotor_z", "m", "height of the rotor axis above the chute (assumption)", -1e6, 1e6, 0.535, 0, 0},
    {"rotor_bore", "m", "radius of the rotor housing on which the chute begins (assumption)", 1e-9, 1e6, 0.0255, 0, 0},
    {"edge_setback", "m", "height of the rounded or bevelled port edges, made by the rotor housing", 0, 1, 0.0008, 0,
     0},
    {"pipe_top_x", "m", "end of the chute's and begin of the pipe's axis, x (assumption)", -1e6, 1e6, 0.0577,
     CALX_VEC(1), 0},
    {"pipe_top_y", "m", "end of the chute's and begin of the pipe's axis, y", -1e6, 1e6, 0, CALX_VEC(1), 0},
    {"pipe_top_z", "m", "end of the chute's and begin of the pipe's axis, z (assumption)", -1e6, 1e6, 0.480,
     CALX_VEC(1), 0},
    {"pipe_bottom_x", "m", "end of the pipe's axis, on the nozzle's axis, x", -1e6, 1e6, 0, CALX_VEC(2), 0},
    {"pipe_bottom_y", "m", "end of the pipe's axis, on the nozzle's axis, y", -1e6, 1e6, 0, CALX_VEC(2), 0},
    {"pipe_bottom_z", "m", "end of the pipe's axis, z (assumption: 30 degrees from vertical)", -1e6, 1e6, 0.380,
     CALX_VEC(2), 0},
    {"parting_z", "m", "parting plane of nozzle and collar (assumption)", -1e6, 1e6, 0.306, 0, 0},
    {"rim_radius", "m", "outer radius of collar and nozzle lip (assumption)", 1e-9, 1e6, 0.024, 0, 0},
    {"collar_height", "m", "height of the collar, from the parting plane down (assumption)", 1e-9, 1e6, 0.006, 0, 0},
    {"port_bottom_z", "m", "lower end of the port, the lid's underside (assumption)", -1e6, 1e6, 0.260, 0, 0},
    {"gate_thickness", "m", "thickness of both gates (assumption)", 1e-9, 1e6, 0.002, 0, 0},
    {"gate_gap", "m", "gap left between a shut gate's tip and the far wall (assumption: no grain of 2.5 mm passes)", 0,
     1e6, 0.002, 0, 0},
    {"gate_width", "m", "width of both gates along x (assumption)", 1e-9, 1e6, 0.044, 0, 0},
    {"gate_length", "m", "length of both gates along y (assumption)", 1e-9, 1e6, 0.044, 0, 0},
    {"retracted", "m", "how far a gate stands back from shut, along -y, before any motion; 0 is shut (assumption)", 0,
     1e6, 0.040, 0, 0},
    {"facets", "1", "facets round chute and pipe", 8, 1000, 72, CALX_FIELD_INTEGER, 0}};

struct Point {
  double x, y, z;
};

class NozzlePort : public calx::shape::Shape {
 public:
  static const calx_descriptor descriptor;

  NozzlePort(const calx_host*, const calx_config& c) {
    const auto get = [&](const char* name) { return calx::parameter(descriptor, c, name); };
    piece_ = static_cast<int>(get("piece"));
    bore_ = get("bore_radius");
    half_width_ = get("chute_width") / 2;
    half_depth_ = get("chute_depth") / 2;
    rotor_z_ = get("rotor_z");
    rotor_bore_ = get("rotor_bore");
    edge_setback_ = get("edge_setback");
    top_ = Point{get("pipe_top_x"), get("pipe_top_y"), get("pipe_top_z")};
    bottom_ = Point{get("pipe_bottom_x"), get("pipe_bottom_y"), get("pipe_bottom_z")};
    parting_ = get("parting_z");
    rim_ = get("rim_radius");
    collar_ = get("collar_height");
    port_bottom_ = get("port_bottom_z");
    gate_thickness_ = get("gate_thickness");
    gate_gap_ = get("gate_gap");
    gate_half_width_ = get("gate_width") / 2;
    gate_length_ = get("gate_length");
    retracted_ = get("retracted");
    facets_ = static_cast<int>(get("facets"));
    check();
    // Normal of the mitre planes: halves the angle between pipe and vertical.
    const double dx = bottom_.x - top_.x, dy = bottom_.y - top_.y, dz = top_.z - bottom_.z;
    const double length = std::sqrt(dx * dx + dy * dy + dz * dz);
    slope_x_ = dx / (dz + length);
    slope_y_ = dy / (dz + length);
  }

  calx_status send(const calx_shape_sink* sink) const override {
    switch (piece_) {
      case chute:
        return send_chute(sink);
      case pipe:
        return send_pipe(sink);
      case nozzle:
        return send_nozzle(sink);
      case port:
        return send_port(sink);
      case nozzle_gate:
        return send_gate(sink, parting_);
      default:
        return send_gate(sink, parting_ - collar_ - gate_thickness_);
    }
  }

 private:
  void check() const {
    const auto fail = [](const std::string& what, double value, const std::string& wanted) {
      throw calx::ConfigError(what + ": " + std::to_string(value) + " m " + wanted);
    };
    if (top_.z <= bottom_.z) fail("pipe_bottom", bottom_.z, "is not below pipe_top; powder must fall");
    if (half_width_ >= rotor_bore_)
      fail("chute_width", 2 * half_width_, "does not fit on rotor_bore; give less than twice it");
    // An inclined mitre lifts one side of the joint by at most the bore radius.
    if (piece_ == chute && top_.z + bore_ >= rotor_z_ - rotor_bore_)
      fail("pipe_top", top_.z, "is too near to the rotor for a chute; lower it");
    if (bottom_.z - bore_ <= parting_)
      fail("pipe_bottom", bottom_.z, "is too near to parting_z for a nozzle; raise it");
    if (rim_ <= bore_) fail("rim_radius", rim_, "is not above bore_radius");
    if (parting_ - collar_ <= port_bottom_) fail("collar_height", collar_, "reaches below port_bottom_z");
    if (gate_gap_ >= 2 * bore_) fail("gate_gap", gate_gap_, "leaves the bore open; give less than twice bore_radius");
    if (gate_length_ <= gate_thickness_) fail("gate_length", gate_length_, "is not above gate_thickness");
  }

  /// A point on a mitre joint at the horizontal offset given from its axis.
  Point mitre(const Point& axis, double x, double y) const {
    return Point{axis.x + x, axis.y + y, axis.z + slope_x_ * x + slope_y_ * y};
  }

  /// Strips between rings of equal count, upper rings first; a quad with coinciding ends becomes one triangle.
  static calx_status send_rings(const calx_shape_sink* sink, const std::vector<std::vector<Point>>& rings) {
    calx::shape::Triangles all;
    for (const std::vector<Point>& ring : rings)
      for (const Point& p : ring) all.corner(p.x, p.y, p.z);
    const uint32_t n = static_cast<uint32_t>(rings[0].size());
    const auto apart = [&](uint32_t a, uint32_t b) { return std::fabs(all.height(a) - all.height(b)) > 1e-6; };
    for (uint32_t r = 0; r + 1 < rings.size(); ++r)
      for (uint32_t k = 0; k < n; ++k) {
        const uint32_t a = r * n + k, b = r * n + (k + 1) % n, c = b + n, d = a + n;
        if (apart(a, d)) all.triangle(a, d, c);
        if (apart(b, c)) all.triangle(a, c, b);
      }
    return all.send(sink);
  }

  calx_status send_chute(const calx_shape_sink* sink) const {
    // Rulings at equal angles, through the rectangle's corners, and close to them on the side walls, whose upper rim
    // steps down from the port's corner there.
    std::vector<double> angles, own;
    const double corner = std::atan2(half_depth_, half_width_), close = 0.01;
    for (const double a : {corner, turn / 2 - corner, turn / 2 + corner, turn - corner}) own.push_back(a);
    for (const double a : {corner - close, turn / 2 - corner + close, turn / 2 + corner - close, turn - corner + close})
      own.push_back(a);
    for (int k = 0; k < facets_; ++k) {
      const double a = turn * k / facets_;
      if (std::none_of(own.begin(), own.end(), [&](double b) { return std::fabs(a - b) < close; })) angles.push_back(a);
    }
    angles.insert(angles.end(), own.begin(), own.end());
    std::sort(angles.begin(), angles.end());
    std::vector<Point> upper, lower;
    for (const double a : angles) {
      lower.push_back(mitre(top_, bore_ * std::cos(a), bore_ * std::sin(a)));
      upper.push_back(chute_begin(std::cos(a), std::sin(a)));
    }
    return send_rings(sink, {upper, lower});
  }

  /// Where the ruling in the direction (cx, cy) seen from above begins: over the ends of the port on the arc of the
  /// rotor bore, along its sides below the port's edge.
  Point chute_begin(double cx, double cy) const {
    const double to_side = half_width_ / std::max(std::fabs(cx), 1e-12);
    const double to_end = half_depth_ / std::max(std::fabs(cy), 1e-12);
    const double s = std::min(to_side, to_end), x = s * cx;
    const bool beside = to_side < to_end * (1 - 1e-9);
    const double below = std::sqrt(rotor_bore_ * rotor_bore_ - x * x) + (beside ? edge_setback_ : 0);
    return Point{top_.x + x, top_.y + s * cy, rotor_z_ - below};
  }

  double nozzle_top() const { return bottom_.z - bore_ * std::sqrt(slope_x_ * slope_x_ + slope_y_ * slope_y_); }

  calx_status send_pipe(const calx_shape_sink* sink) const {
    std::vector<Point> begin, end, below;
    for (int k = 0; k < facets_; ++k) {
      const double x = bore_ * std::cos(turn * k / facets_), y = bore_ * std::sin(turn * k / facets_);
      begin.push_back(mitre(top_, x, y));
      end.push_back(mitre(bottom_, x, y));
      below.push_back(Point{bottom_.x + x, bottom_.y + y, nozzle_top()});
    }
    return send_rings(sink, {begin, end, below});
  }

  calx_status send_nozzle(const calx_shape_sink* sink) const {
    const double origin[3] = {bottom_.x, bottom_.y, 0}, up[3] = {0, 0, 1};
    const double r_z[] = {bore_, nozzle_top(), bore_, parting_, rim_, parting_};
    return sink->revolution(sink, origin, up, 3, r_z, 0);
  }

  calx_status send_port(const calx_shape_sink* sink) const {
    const double origin[3] = {bottom_.x, bottom_.y, 0}, up[3] = {0, 0, 1};
    const double foot = parting_ - collar_;
    const double r_z[] = {bore_, port_bottom_, bore_, foot, bore_, parting_, rim_, parting_, rim_, foot, bore_, foot};
    return sink->revolution(sink, origin, up, 6, r_z, 0);
  }

  /// A plate whose tip is bevelled by 45 degrees, sharp below, so that it lifts the grains before it.
  calx_status send_gate(const calx_shape_sink* sink, double z) const {
    const double tip = bottom_.y + bore_ - gate_gap_ - retracted_, back = tip - gate_length_;
    const double y[4] = {back, tip, tip - gate_thickness_, back};  // below rear, below tip, above tip, above rear
    const double zs[4] = {z, z, z + gate_thickness_, z + gate_thickness_};
    calx::shape::Triangles all;
    for (int k = 0; k < 8; ++k)
      all.corner(bottom_.x + (k < 4 ? -gate_half_width_ : gate_half_width_), y[k % 4], zs[k % 4]);
    for (uint32_t k = 0; k < 4; ++k) all.quad(k, (k + 1) % 4, (k + 1) % 4 + 4, k + 4);
    const uint32_t ends[] = {0, 1, 2, 0, 2, 3, 4, 6, 5, 4, 7, 6};
    for (uint32_t k = 0; k < 12; k += 3) all.triangle(ends[k], ends[k + 2], ends[k + 1]);
    return all.send(sink);
  }

  int piece_, facets_;
  double bore_, half_width_, half_depth_, rotor_z_, rotor_bore_, edge_setback_, parting_, rim_, collar_, port_bottom_;
  double gate_thickness_, gate_gap_, gate_half_width_, gate_length_, retracted_;
  double slope_x_, slope_y_;  // rise of the mitre planes along x and y
  Point top_, bottom_;
};

const calx_descriptor NozzlePort::descriptor = calx::shape::descriptor(
    "calx.nozzle-port", "Nozzle and port", "1.0.0", "Calx", "Apache-2.0",
    "Outlet chute, inclined pipe, nozzle, port with collar, and their two slide gates, one piece a part.", fields);

}  // namespace

CALX_PLUGIN(NozzlePort)
