#include <doctest/doctest.h>

#include <string>

#include "calx/host_log.h"
#include "measure/fake_world.hpp"

using namespace calx;

namespace {

const calx_field output[] = {{"mean_speed", "m/s", "", 0, 1, 0, 0, 0},
                             {"stress", "N/m^1.5", "", 0, 1, 0, 0, 0},
                             {"state", "calm|wild", "", 0, 1, 0, CALX_FIELD_CHOICE, 0},
                             {"share", "1", "", 0, 1, 0, 0, 0}};

struct Seen {
  std::vector<std::uint32_t> id;
  std::vector<double> x, radius;
  double time = 0;
  std::uint32_t size = 0;
};

calx_instance* instance_of(Seen& seen) { return reinterpret_cast<calx_instance*>(&seen); }

calx_status CALX_CALL look(calx_instance* self, const calx_host*, const calx_sensor_view* view, double* out) {
  Seen& seen = *reinterpret_cast<Seen*>(self);
  seen.id.assign(view->id, view->id + view->count);
  seen.x.assign(view->x, view->x + view->count);
  seen.radius.assign(view->radius, view->radius + view->count);
  seen.time = view->time;
  seen.size = view->struct_size;
  double momentum = 0, mass = 0;
  for (std::uint64_t k = 0; k < view->count; ++k) momentum += view->mass[k] * view->vz[k], mass += view->mass[k];
  out[0] = momentum / mass;
  for (int k = 1; k < 4; ++k) out[k] = k;
  return CALX_OK;
}

calx_status CALX_CALL give_up(calx_instance*, const calx_host* host, const calx_sensor_view*, double*) {
  if (!host->get_extension(host, CALX_HOST_LOG)) return CALX_E_INTERNAL;
  return host->fail(host, CALX_E_ARGUMENT, "no window to look at");
}

const int log_table = 0;
calx_host real_host() {
  calx_host host{};
  host.struct_size = sizeof host;
  host.name = "calx";
  host.get_extension = [](const calx_host*, const char* id) -> const void* {
    return std::string(id) == CALX_HOST_LOG ? &log_table : nullptr;
  };
  host.fail = [](const calx_host*, calx_status code, const char*) { return code; };
  return host;
}

}  // namespace

TEST_CASE("a plugin's columns carry its units and it sees particles by rising id") {
  FakeWorld world;
  for (int k = 0; k < 3; ++k) world.add_sphere({1.0 * k, 0, 0}, 0.01 * (k + 1), {0, 0, 2});
  world.swap_ranks(0, 2);
  std::swap(world.grains.scale[0], world.grains.scale[2]);
  world.now = 1.5;
  const calx_sensor table{sizeof(calx_sensor), CALX_ABI_DRAFT, output, 4, 0, &look};
  const calx_host host = real_host();
  Seen seen;
  const auto sensor =
      make_plugin_sensor(FakeWorld::settings_of("{}", "org.example.speed"), &table, instance_of(seen), &host);
  CHECK(sensor->name() == "probe");
  CHECK(sensor->kind() == "org.example.speed");
  CHECK(sensor->every() == 0.01);
  CHECK(sensor->columns() == std::vector<std::string>{"mean_speed_m_s", "stress_N_m1.5", "state_1", "share_1"});
  const auto row = sensor->sample(world);
  CHECK(row[0] == doctest::Approx(2));
  CHECK(row[3] == 3);
  CHECK(seen.id == std::vector<std::uint32_t>{0, 1, 2});
  CHECK(seen.x == std::vector<double>{0, 1, 2});
  CHECK(seen.radius[2] == doctest::Approx(0.03));
  CHECK(seen.time == 1.5);
  CHECK(seen.size == sizeof(calx_sensor_view));
}

TEST_CASE("a plugin that fails is named with its own words") {
  const FakeWorld world;
  const calx_sensor table{sizeof(calx_sensor), CALX_ABI_DRAFT, output, 4, 0, &give_up};
  const calx_host host = real_host();
  const auto sensor = make_plugin_sensor(FakeWorld::settings_of("{}", "org.example.speed"), &table, nullptr, &host);
  try {
    sensor->sample(world);
    FAIL("no error");
  } catch (const Error& e) {
    CHECK(e.fault() == Fault::plugin);
    CHECK(std::string(e.what()) ==
          "sensor \"probe\" (org.example.speed) failed at t = 0.000000 s: status -2, no window to look at");
  }
}
