// The texts of calx plugin list, describe and schema.
#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "base/sha256.hpp"
#include "plugin/plugin.hpp"
#include "scratch.hpp"

using namespace calx;

namespace {
const std::string spring_folder = CALX_TEST_PLUGIN_DIR;
}

TEST_CASE("list shows usable plugins, refused ones with the reason, and the folders") {
  Scratch scratch;
  scratch.write("x.plugin.json", "{");
  CHECK(plugin_list_text({spring_folder, scratch.path()}) ==
        "plugins\n"
        "  org.example.spring  1.0.0  calx.contact-law/1  Linear spring, dashpot and Coulomb slider.\n"
        "\nrefused\n  " +
            scratch.path("x.plugin.json") + ": bad manifest " + scratch.path("x.plugin.json") +
            ": is not JSON: error at byte 2\n\nfolders searched, in this order\n  " + spring_folder + "\n  " +
            scratch.path() + "\n");
  CHECK(plugin_list_text({}) == "no plugin found\n\nfolders searched, in this order\n");
}

TEST_CASE("describe tells every table of a contact law") {
  const std::string library = spring_folder + "/spring.so";
  CHECK(plugin_describe_text("org.example.spring", {spring_folder}) ==
        "org.example.spring 1.0.0\n"
        "Linear spring, dashpot and Coulomb slider.\n"
        "\n"
        "  name     Spring\n"
        "  kind     calx.contact-law/1\n"
        "  vendor   Example\n"
        "  license  MIT\n"
        "  library  " +
            library +
            "\n"
            "  sha256   " +
            sha256_file(library) +
            "\n"
            "\n"
            "material properties, once per material\n"
            "  name      unit  range   preset  meaning\n"
            "  moisture  1     0 .. 1  0       mass of water per mass of solid\n"
            "\n"
            "parameters of a pair of materials\n"
            "  name  unit  range       preset  meaning\n"
            "  kn    N/m   0 .. 1e+09  10000   normal stiffness\n"
            "  gn    kg/s  0 .. 1e+06  0.1     normal damping coefficient of the dry pair\n"
            "  kt    N/m   0 .. 1e+09  8000    tangential stiffness\n"
            "  mu    1     0 .. 10     0.5     sliding friction\n"
            "\n"
            "pair values the law reads, derived from those\n"
            "  name  unit  range       preset  meaning\n"
            "  kn    N/m   0 .. 1e+09  10000   normal stiffness\n"
            "  gn    kg/s  0 .. 1e+06  0.1     normal damping, raised by moisture\n"
            "  kt    N/m   0 .. 1e+09  8000    tangential stiffness\n"
            "  mu    1     0 .. 10     0.5     sliding friction\n"
            "\n"
            "contact history\n"
            "  name  unit  range    preset  meaning\n"
            "  tx    m     -1 .. 1  0       tangential spring, x [changes sign with i and j] [vector 1]\n"
            "  ty    m     -1 .. 1  0       tangential spring, y [changes sign with i and j] [vector 1]\n"
            "  tz    m     -1 .. 1  0       tangential spring, z [changes sign with i and j] [vector 1]\n"
            "\n"
            "reads overlap nx ny nz vx vy vz\n"
            "acts only while touching\n"
            "exact: the same bits on every backend\n");
}

TEST_CASE("an unknown or refused id is answered with what is known") {
  CHECK(message_of([] { plugin_describe_text("org.example.sprang", {spring_folder}); }) ==
        "no plugin org.example.sprang found in " + spring_folder + "; did you mean \"org.example.spring\"?");
  CHECK(message_of([] {
          plugin_describe_text("NO.SUCH.ID", {spring_folder, "/nowhere"});
        }) == "no plugin NO.SUCH.ID found in " + spring_folder +
                  ", /nowhere; name its folder with --plugin-path; calx plugin list shows those found");
  CHECK(message_of([] { plugin_describe_text("a.b", {}); }) ==
        "no plugin a.b found in any folder; name its folder with --plugin-path; calx plugin list shows those found");
  Scratch scratch;
  scratch.write("x.plugin.json", manifest("test.x", "x.so"));
  CHECK(message_of([&] { plugin_schema_text("test.x", {scratch.path()}); }) ==
        "plugin test.x refused: bad manifest " + scratch.path("x.plugin.json") + " /library: " + scratch.path("x.so") +
            " does not exist");
}

TEST_CASE("the schema of a law holds its pair values") {
  const auto schema = nlohmann::json::parse(plugin_schema_text("org.example.spring", {spring_folder}));
  CHECK(schema["title"] == "parameters of org.example.spring 1.0.0");
  for (const char* name : {"kn", "gn", "kt", "mu"}) CHECK(schema["properties"].contains(name));
  CHECK(schema["properties"].size() == 4);
}
