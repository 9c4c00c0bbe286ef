// Junk in any place of a case ends in a message of ours or in a case, never in another exception or a crash.
#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "base/random.hpp"
#include "cases.hpp"
#include "config/config.hpp"

using namespace calx;
using Json = nlohmann::ordered_json;

namespace {

// True when the case is read; a message must name the file it comes from.
bool is_read(const std::string& text, const std::string& what) {
  try {
    parse_case(text, "case.json");
    return true;
  } catch (const Error& e) {
    CHECK_MESSAGE(std::string(e.what()).compare(0, 9, "case.json") == 0, e.what());
    CHECK_MESSAGE(std::string(e.what()).find("json.exception") == std::string::npos, e.what());
  } catch (const std::exception& e) {
    FAIL_CHECK(what << ": " << e.what());
  }
  return false;
}

void every_place(const Json& j, const std::string& pointer, std::vector<std::string>& out) {
  if (!pointer.empty()) out.push_back(pointer);
  if (j.is_structured())
    for (const auto& item : j.items()) {
      std::string key = item.key();
      for (std::size_t at = 0; (at = key.find('/', at)) != std::string::npos; at += 2) key.replace(at, 1, "~1");
      every_place(item.value(), pointer + "/" + key, out);
    }
}

}  // namespace

TEST_CASE("a value of any wrong type in any place is refused by a message or makes sense") {
  const Json whole = Json::parse(full_case(), nullptr, true, true);
  std::vector<std::string> places;
  every_place(whole, "", places);
  REQUIRE(places.size() > 300);
  int read = 0;
  for (const std::string& place : places)
    for (const char* junk :
         {"null", "true", "-1", "1e300", "\"x\"", "\"\"", "[]", "{}", "[{}]", "{\"value\": 1, \"unit\": \"A\"}"}) {
      Json changed = whole;
      changed[Json::json_pointer(place)] = Json::parse(junk);
      read += is_read(changed.dump(), place + " = " + junk);
    }
  // Most junk is refused; what is read are numbers within range and free keys of plugins.
  CHECK(read < static_cast<int>(places.size()) * 3);
}

TEST_CASE("any key taken away is refused by a message or makes sense") {
  const Json whole = Json::parse(full_case(), nullptr, true, true);
  std::vector<std::string> places;
  every_place(whole, "", places);
  for (const std::string& place : places) {
    Json changed = whole;
    const Json::json_pointer p(place);
    Json& parent = changed[p.parent_pointer()];
    if (parent.is_object())
      parent.erase(p.back());
    else
      parent.erase(static_cast<std::size_t>(std::stoul(p.back())));
    is_read(changed.dump(), place + " erased");
  }
}

TEST_CASE("bytes changed at random are refused by a message or make sense") {
  const std::uint64_t seed = 20240611;
  INFO("seed " << seed);
  Random random(seed, 0);
  const std::string whole = full_case();
  for (int k = 0; k < 2000; ++k) {
    std::string text = whole;
    for (int n = 0; n < 3; ++n) {
      const std::size_t at = static_cast<std::size_t>(random.uniform() * static_cast<double>(text.size()));
      const char byte = static_cast<char>(random.bits() & 255);
      if (random.uniform() < 0.3)
        text.erase(at, 1);
      else
        text[at] = random.uniform() < 0.5 ? byte : "{}[]\",:0-e"[random.bits() % 10];
    }
    is_read(text, "draw " + std::to_string(k));
  }
}
