#include "sample_run.hpp"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <vector>

#include "io/io.hpp"
#include "sample_world.hpp"

namespace calx_test {
namespace {

const char* const summary_text = R"({
 "title": "Canister fill, standard operation", "status": "done", "time": 23.5, "steps": 3884297, "particles": 7500,
 "mass": {"inserted": 2.7285, "inserted_count": 7500, "inside": 2.7285, "inside_count": 7500, "removed": 0.0, "removed_count": 0,
          "requested": 2.7285, "delivered": 2.7285, "regions": {"hopper": 0.5457, "canister": 2.1828}},
 "sensors": {
  "canister mass": {"kind": "mass", "columns": ["mass_kg", "particles_1", "centre_x_m", "centre_y_m", "centre_z_m"], "every": 0.01, "last": {"mass_kg": 2.1828}},
  "dose": {"kind": "cycle-mass", "columns": ["cycle_1", "mass_kg", "total_kg"], "every": 0.1, "last": {}},
  "nozzle flow": {"kind": "flow", "columns": ["mass_kg", "rate_kg_s", "particles_1"], "every": 0.05, "last": {}},
  "rotor load": {"kind": "part-load", "columns": [], "every": 0.01, "last": {}},
  "energy": {"kind": "energy", "columns": [], "every": 0.05, "last": {}},
  "ledger": {"kind": "mass-ledger", "columns": [], "every": 0.5, "last": {}},
  "pile": {"kind": "angle-of-repose", "columns": [], "every": 1.0, "last": {}},
  "bed": {"kind": "height-map", "columns": [], "every": 1.0, "last": {}},
  "contacts <all>": {"kind": "coordination", "columns": [], "every": 0.1, "last": {}},
  "residue": {"kind": "residue", "columns": ["mass_kg", "particles_1"], "every": 0.1, "last": {}}},
 "energy": {"kinetic_translation": 0.02, "friction": 5.1, "remainder": 0.0184, "work_done": 11.6},
 "wall_seconds": 18211.4, "particle_steps_per_second": 1600000, "time_step": 6.05e-06,
 "step_limits": [
  {"name": "Rayleigh", "where": "calcine, smallest sphere 1.25 mm, 10 % of 60.5 us", "seconds": 6.05e-06, "binds": true},
  {"name": "Hertz contact", "where": "calcine, impact at 3.2 m/s", "seconds": 2.1e-05, "binds": false},
  {"name": "EPAM unloading", "where": "calcine-steel, slope k2", "seconds": 9.4e-06, "binds": false},
  {"name": "motion", "where": "rotor tip 0.39 m/s", "seconds": 3.1e-04, "binds": false}],
 "provenance": {"calx": "0.1.0", "git": "0123abc", "abi": "1.0", "case_sha256": "9f2c1b7e4d", "seed": 1, "device": "cpu",
  "precision": "double", "threads": 16,
  "plugins": [{"id": "calx.epam", "version": "1.0.0", "sha256": "5b1f0c2d", "vendor": "Calx"},
              {"id": "calx.rotary-valve", "version": "1.0.0", "sha256": "77aa10ce", "vendor": "Calx"}]},
 "assumptions": ["rotor outer radius 25 mm: not in the paper, chosen so that 40 cycles give 2.197 kg",
  "particle density 2017 kg/m3: from the bulk density 1210 kg/m3 and a solid fraction of 0.60",
  "shear modulus 10 MPa instead of that of alumina: stiffness reduced, overlaps stay below 1 %",
  "process pipe inclined 30 deg from vertical: the assumed cause of the preferential filling"],
 "deviations": [{"figure": "mass after 40 cycles", "value": 2.1828, "reference": 2.197, "unit": "kg", "source": "paper, measured"},
  {"figure": "residue on the port", "value": 0.00521, "reference": 0.006, "unit": "kg", "source": "paper, measured"}],
 "events": [{"name": "settled", "time": 0.31}, {"name": "valve open", "time": 0.6}, {"name": "cycles done", "time": 23.0}]
})";

const char* const case_text = R"({"calx": 1, "title": "Canister fill, standard operation", "gravity": [0, 0, -9.81],
 "time": {"integrator": "verlet", "rayleigh_fraction": 0.1, "end": 23.5}, "seed": 1,
 "materials": {"calcine": {"density": 2017, "young": 2.5e7, "poisson": 0.25}, "steel": {"density": 7850, "young": 2e8, "poisson": 0.3}},
 "assumptions": ["</script><b>not markup</b>"]})";

class Csv {
 public:
  Csv(const std::string& path, const char* header) : file_(path) { file_ << header << "\n"; }
  void row(const std::vector<double>& cells) {
    for (std::size_t k = 0; k < cells.size(); ++k) {
      char text[40];
      std::snprintf(text, sizeof text, "%.9g", cells[k]);
      file_ << (k ? "," : "") << text;
    }
    file_ << "\n";
  }

 private:
  std::ofstream file_;
};

double noise() {
  static std::uint64_t state = 11;
  state = state * 6364136223846793005ull + 1442695040888963407ull;
  return static_cast<double>(state >> 11) / 4503599627370496.0 - 1;
}

void write_series(const std::string& dir, const SampleWorld& world, double every) {
  const double nan = std::nan("");
  Csv mass(dir + "canister mass.csv", "time_s,mass_kg,particles_1,centre_x_m,centre_y_m,centre_z_m");
  Csv dose(dir + "dose.csv", "time_s,cycle_1,mass_kg,total_kg,mean_kg,sd_kg,slope_kg,intercept_kg,r2_1");
  Csv flow(dir + "nozzle flow.csv", "time_s,mass_kg,rate_kg_s,particles_1,forward_kg,backward_kg");
  Csv load(dir + "rotor load.csv",
           "time_s,force_x_N,force_y_N,force_z_N,torque_x_N_m,torque_y_N_m,torque_z_N_m,power_W");
  Csv energy(
      dir + "energy.csv",
      "time_s,kinetic_translation_J,kinetic_rotation_J,gravity_J,elastic_J,friction_J,damping_J,plastic_J,wall_work_J,"
      "force_work_J,inserted_J,removed_J,remainder_J,work_done_J,remainder_share_1");
  Csv ledger(dir + "ledger.csv",
             "time_s,inserted_1,inserted_kg,inside_1,inside_kg,lost_1,lost_kg,in_hopper_1,in_hopper_kg,in_canister_1,"
             "in_canister_kg,elsewhere_1,elsewhere_kg,requested_kg,delivered_kg,imbalance_1");
  Csv pile(dir + "pile.csv",
           "time_s,angle_deg,sd_deg,left_deg,left_sd_deg,right_deg,right_sd_deg,sectors_1,bins_1,apex_x_m,apex_y_m,"
           "apex_z_m");
  Csv contacts(dir + "contacts _all_.csv",
               "time_s,coordination_1,coordination_carrying_1,rattlers_1,contacts_1,overlap_mean_1,overlap_max_1");
  Csv residue(dir + "residue.csv", "time_s,mass_kg,particles_1");
  double before = 0, total = 0, cycle = 0, gained = 0;
  for (int k = 0; k * every < sample_end; ++k) {
    const double t = k * every, m = world.canister_mass(t), done = m / sample_mass;
    const bool turning = t > sample_start && t < sample_start + sample_cycles * sample_period;
    const double speed = turning ? std::fabs(world.rotor_angle(t + 1e-3) - world.rotor_angle(t)) / 1e-3 : 0;
    mass.row({t, m, std::round(6000 * done), m > 0 ? -0.012 * done : nan, m > 0 ? 0.0005 * noise() : nan,
              m > 0 ? 0.055 * done : nan});
    load.row({t, 2 * noise(), 0.2 * noise(), -6 + noise(), 0.002 * noise(),
              speed > 0 ? 0.11 + 0.03 * noise() : 0.01 * noise(), 0.002 * noise(), speed * 0.11});
    if (k % 5 == 0) {
      flow.row({t, m, (m - before) / (5 * every), 6000 * done, m, 0});
      before = m;
      const double falling = turning ? 0.05 + 0.01 * noise() : 0.002;
      energy.row({t, falling, 0.1 * falling, 12 - 9.5 * done, 0.03, 5.2 * done, 3.1 * done, 1.25 * done, 0.4 * done, 0,
                  0, 0, 0.0184 * done, 0.01 + 11.6 * done, 0.0016});
    }
    if (turning && t - sample_start >= (cycle + 1) * sample_period) {
      ++cycle;
      gained = m - total;
      total = m;
    }
    if (k % 10 == 0) {
      dose.row({t, cycle, gained, total, nan, nan, nan, nan, nan});
      contacts.row({t, 4.6 + 0.3 * done, 4.9 + 0.2 * done, 0.08, 21000 * (0.2 + done), 0.0031 + 0.0004 * noise(),
                    0.012 + 0.004 * noise()});
      residue.row({t, done > 0.9 ? 0.00521 : 0, done > 0.9 ? 236.0 : 0.0});
    }
    if (k % 50 == 0) {
      const double landed = std::round(6000 * done);
      ledger.row({t, 7500, 2.7285, 7500, 2.7285, 0, 0, 7500 - landed, 2.7285 - m, landed, m, 0, 0, 2.7285, 2.7285, 0});
    }
    if (k % 100 == 0) {
      const bool flank = done > 0.2;
      pile.row({t, flank ? 39.6 + noise() : nan, 1.3, flank ? 38.4 + noise() : nan, 1.1, flank ? 41.2 + noise() : nan,
                1.6, 8, 120, -0.03, 0, 0.115 * done});
    }
  }
}

std::string text_of(double v) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", v);
  return std::isfinite(v) ? text : "null";
}

std::string fields_text() {
  const int n = 40;
  const double cell = 0.005;
  const auto height = [](double x, double y) {
    return x * x + y * y > 0.01 ? std::nan("")
                                : std::max(0.004, 0.117 - 0.84 * std::sqrt((x + 0.03) * (x + 0.03) + y * y));
  };
  std::string map, section_x, section_y, ring_x, ring_y;
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const double x = -0.1 + (i + 0.5) * cell, y = -0.1 + (j + 0.5) * cell;
      map += (map.empty() ? "" : ",") + text_of(height(x, y) + 0.001 * noise());
      if (j == n / 2) {
        section_x += (i ? "," : "") + text_of(x);
        section_y += (i ? "," : "") + text_of(height(x, 0));
      }
    }
  }
  for (int k = 0; k < n / 2; ++k) {
    const double r = (k + 0.5) * cell;
    ring_x += (k ? "," : "") + text_of(r);
    ring_y += (k ? "," : "") + text_of(0.5 * (height(r, 0) + height(-r, 0)));
  }
  return "{\"fields\":[{\"sensor\":\"bed\",\"name\":\"height\",\"unit\":\"m\",\"nx\":40,\"ny\":40,\"origin\":[-0.1,-0."
         "1,0],\"cell\":0.005,\"values\":[" +
         map +
         "]}],\"curves\":[{\"sensor\":\"bed\",\"name\":\"section\",\"x_name\":\"x_m\",\"y_name\":\"height_m\",\"x\":[" +
         section_x + "],\"y\":[" + section_y +
         "]},{\"sensor\":\"bed\",\"name\":\"azimuthal mean\",\"x_name\":\"radius_m\",\"y_name\":\"height_m\",\"x\":[" +
         ring_x + "],\"y\":[" + ring_y + "]}]}";
}

}  // namespace

void write_sample_run(const std::string& dir, const SampleOptions& options) {
  namespace fs = std::filesystem;
  fs::create_directories(dir + "/series");
  std::ofstream(dir + "/summary.json") << summary_text;
  std::ofstream(dir + "/case.json") << case_text;
  std::ofstream(dir + "/fields.json") << fields_text();
  SampleWorld world(options.grains);
  write_series(dir + "/series/", world, options.sample_every);
  if (!(options.frames_every > 0)) return;
  calx::FrameWriter writer(dir, true, -1);
  for (int k = 0; k * options.frames_every < sample_end; ++k) {
    world.at(k * options.frames_every);
    writer.write(world);
  }
}

}  // namespace calx_test
