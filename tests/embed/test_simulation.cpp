// Simulations behind the C functions: the bits of the engine, states, threads, callbacks, errors as codes.
#include <doctest/doctest.h>

#include <filesystem>
#include <thread>

#include "cases.hpp"
#include "sim/whole_case.hpp"

using calx::embed::Failure;
using calx::embed::Simulation;

namespace {

std::string digest_after(std::uint64_t steps, int threads) {
  Simulation sim = Simulation::from_text(falling_grains(200), with_plugins(threads));
  sim.step(steps);
  return sim.digest();
}

/// The code of what the call throws, its message in text.
template <class Call>
std::int32_t code_of(const Call& call, std::string& text) {
  try {
    call();
  } catch (const Failure& e) {
    text = e.what();
    return e.code();
  }
  return CALX_SIM_OK;
}

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("The same bits as the engine, for any number of threads") {
  calx::SimulationOptions options;
  options.threads = 2;
  options.plugin_path = {CALX_PLUGIN_DIR};
  calx::Simulation engine(calx::whole_case(calx::parse_case(falling_grains(200), "case")), options);
  for (int k = 0; k < 2000; ++k) engine.step();
  CHECK(digest_after(2000, 1) == engine.digest());
  CHECK(digest_after(2000, 3) == engine.digest());
  CHECK(digest_after(1999, 1) != engine.digest());
}

TEST_CASE("Several simulations at once, each on its own thread, disturb each other in no bit") {
  const std::string alone = digest_after(1500, 1);
  std::string found[3];
  std::thread threads[3];
  for (int k = 0; k < 3; ++k) threads[k] = std::thread([&found, k] { found[k] = digest_after(1500, k + 1); });
  for (auto& t : threads) t.join();
  for (const std::string& one : found) CHECK(one == alone);
}

TEST_CASE("A saved state goes on to the same bits") {
  const std::string folder = (std::filesystem::temp_directory_path() / "calx_embed_state").string();
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  Simulation first = Simulation::from_text(falling_grains(200), with_plugins());
  first.step(700);
  first.save(folder);
  first.step(800);
  Simulation second = Simulation::from_text(falling_grains(200), with_plugins(2));
  second.load_state(folder);
  CHECK(second.steps() == 700);
  second.step(800);
  CHECK(second.digest() == first.digest());
  std::string text;
  CHECK(code_of([&] { second.load_state(folder + "/none"); }, text) == CALX_SIM_FILES);
  std::filesystem::remove_all(folder);
}

TEST_CASE("Time: steps, until a time, until an event, to the end") {
  const std::string events = R"(, "events": {"landed": {"when": {"count": {"at_least": 20,
      "region": {"box": {"min": [-0.04, -0.04, 0], "max": [0.04, 0.04, 0.015]}}}}}})";
  Simulation sim = Simulation::from_text(falling_grains(20, "", events), with_plugins());
  sim.step(3);
  CHECK(sim.steps() == 3);
  sim.run_until(0.01);
  CHECK(std::abs(sim.time() - 0.01) <= 0.5 * sim.time_step());
  CHECK_FALSE(sim.run_until_event("landed", 0.02));
  CHECK(sim.run_until_event("landed", 1));
  const double landed = sim.time();
  CHECK(landed < 0.3);
  CHECK(sim.run_until_event("landed", 1));  // has fired: goes nowhere
  CHECK(sim.time() == landed);
  sim.run_until(5);
  CHECK(sim.finished());
  CHECK(std::abs(sim.time() - 0.3) <= sim.time_step());
  std::string text;
  CHECK(code_of([&] { sim.run_until_event("landet", 1); }, text) == CALX_SIM_USAGE);
  CHECK(holds(text, "landet"));
}

TEST_CASE("Callbacks see each step, may stop, and their exceptions come out of the stepping call") {
  Simulation sim = Simulation::from_text(falling_grains(20), with_plugins());
  std::vector<std::string> messages;
  sim.on_message([&](const char* text) { messages.push_back(text); });
  int calls = 0;
  sim.on_step(10, [&](Simulation& s) {
    CHECK(s.steps() % 10 == 0);
    return ++calls == 5;
  });
  std::string text;
  CHECK(code_of([&] { sim.step(1000); }, text) == CALX_SIM_STOPPED);
  CHECK(sim.steps() == 50);
  REQUIRE(messages.size() == 1);
  CHECK(holds(messages[0], "source \"powder\" has delivered"));
  sim.on_step(1, [](Simulation& s) {
    s.step();  // not from a callback
    return 0;
  });
  CHECK(code_of([&] { sim.step(); }, text) == CALX_SIM_USAGE);
  CHECK(holds(text, "callback cannot step"));
  sim.on_step(1, [](Simulation&) -> int { throw std::out_of_range("mine"); });
  CHECK_THROWS_AS(sim.step(), std::out_of_range);
  sim.on_step(0, nullptr);
  sim.step();
}

TEST_CASE("What is wrong comes back as a code with a message, and nothing ends the program") {
  std::string text;
  const auto made = [&](const std::string& json) {
    return code_of([&] { Simulation::from_text(json, with_plugins()); }, text);
  };
  CHECK(made("{") == CALX_SIM_CASE);
  CHECK(made(falling_grains(20, "", R"(, "gravitty": 3)")) == CALX_SIM_CASE);
  CHECK(holds(text, "/gravitty"));
  CHECK(holds(text, "did you mean \"gravity\""));
  CHECK(made(falling_grains(2, R"({"name": "floor", "geometry": "calx.plain", "material": "grain"})")) ==
        CALX_SIM_PLUGIN);
  CHECK(holds(text, "did you mean \"calx.plane\""));
  CHECK(code_of([&] { Simulation::from_file("/nowhere/case.json", with_plugins()); }, text) == CALX_SIM_FILES);
  CHECK(holds(text, "/nowhere/case.json"));
  auto options = with_plugins();
  options.set = {"time/end=1"};
  CHECK(code_of([&] { Simulation::from_text(falling_grains(2), options); }, text) == CALX_SIM_USAGE);
  CHECK(holds(text, "/json/pointer=value"));
  options = with_plugins();
  options.precision = "single";
  CHECK(code_of([&] { Simulation::from_text(falling_grains(2), options); }, text) == CALX_SIM_USAGE);

  calx_sim* sim = nullptr;
  CHECK(calx_sim_create(nullptr, nullptr, &sim) == CALX_SIM_USAGE);
  calx_sim_options none = {};
  CHECK(calx_sim_create("{}", &none, &sim) == CALX_SIM_USAGE);
  CHECK(holds(calx_sim_error(), "struct_size"));
  CHECK(calx_sim_step(nullptr, 1) == CALX_SIM_USAGE);
  CHECK(sim == nullptr);
  calx_sim_destroy(nullptr);
}

TEST_CASE("Numbers that go wrong are reported and the simulation stays to be looked at") {
  // A step 50 times too long for these grains is refused by the guards, not by a crash.
  Simulation sim = Simulation::from_text(falling_grains(100, "", R"(, "overlap_limit": 0.01)"), with_plugins());
  std::string text;
  CHECK(code_of([&] { sim.run_until(0.3); }, text) == CALX_SIM_NUMERICS);
  CHECK(holds(text, "run stopped at t ="));
  CHECK(sim.particle_count() == 100);
}
