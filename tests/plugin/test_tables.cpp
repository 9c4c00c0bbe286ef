// Each way a table of a plugin can break the contract is found and named.
#include <doctest/doctest.h>

#include <limits>

#include "plugin/tables.hpp"

using namespace calx;

namespace {

calx_field field(const char* name, std::uint32_t flags = 0) { return {name, "m", "a length", 0.0, 2.0, 1.0, flags, 0}; }

std::string fault(const std::vector<calx_field>& rows, bool users_write = true) {
  return field_table_fault("given", rows.data(), static_cast<std::uint32_t>(rows.size()), users_write);
}

void CALX_CALL no_eval(const calx_block_f64*) {}

calx_contact_law law() {
  calx_contact_law t{};
  t.struct_size = sizeof t;
  t.draft = CALX_ABI_DRAFT;
  t.eval_f64 = no_eval;
  return t;
}

std::string fault(const calx_contact_law& t) { return interface_fault(CALX_CONTACT_LAW, &t); }

}  // namespace

TEST_CASE("a sound field table has no fault") {
  CHECK(fault({field("kn"), field("mu_2")}) == "");
  CHECK(fault({field("r_x", CALX_VEC(3)), field("r_y", CALX_VEC(3)), field("r_z", CALX_VEC(3)), field("k")}) == "");
  calx_field open = field("k");
  open.highest = std::numeric_limits<double>::infinity();
  CHECK(fault({open}) == "");
  calx_field choice = {"shape", "box|tube|cone", "form", 0, 2, 1, CALX_FIELD_CHOICE, 0};
  CHECK(fault({choice}) == "");
  CHECK(field_table_fault("given", nullptr, 0, true) == "");
}

TEST_CASE("faults of a field table name table, row and rule") {
  CHECK(fault({field("Kn")}) ==
        "its given table row 0 is called \"Kn\"; names begin with a lower-case letter and go on with those, digits and "
        "_");
  CHECK(fault({field("kn"), field(nullptr)}).find("its given table row 1 is called \"\";") == 0);
  CHECK(fault({field("kn"), field("kn")}) == "its given table has two rows called \"kn\"");
  CHECK(field_table_fault("state", nullptr, 2, false) == "its state table is null but announces 2 rows");
  CHECK(fault(std::vector<calx_field>(65, field("kn"))) == "its given table has 65 rows; 64 are allowed");
  calx_field f = field("kn");
  f.preset = std::numeric_limits<double>::quiet_NaN();
  CHECK(fault({f}) == "its given table row \"kn\" has a preset that is not finite");
  f.preset = 3;
  CHECK(fault({f}) == "its given table row \"kn\" does not keep lowest <= preset <= highest");
  f = field("kn");
  f.unit = nullptr;
  CHECK(fault({f}) == "its given table row \"kn\" has no unit; write \"1\" for none");
  f = field("kn");
  f.doc = "";
  CHECK(fault({f}) == "its given table row \"kn\" has no meaning (doc)");
  f = field("n", CALX_FIELD_INTEGER);
  f.preset = 0.5;
  CHECK(fault({f}) == "its given table row \"n\" is whole but its preset is not");
  f = {"shape", "box|tube|cone", "form", 0, 1, 1, CALX_FIELD_CHOICE, 0};
  CHECK(fault({f}) == "its given table row \"shape\" offers 3 names, so its range must be 0 to 2 and its preset whole");
}

TEST_CASE("a vector is three rows, one after the other, with the names users can write") {
  const std::uint32_t v = CALX_VEC(1);
  CHECK(fault({field("r_x", v), field("r_y", v)}) ==
        "its given table row \"r_x\" opens a vector group that is not three rows, one after the other");
  CHECK(fault({field("r_x", v), field("r_y", v), field("k"), field("r_z", v)}).find("not three rows") !=
        std::string::npos);
  CHECK(fault({field("tx", v), field("ty", v), field("tz", v)}) ==
        "its given table row \"tx\" opens a vector group whose rows are not called NAME_x, NAME_y, NAME_z");
  CHECK(fault({field("tx", v), field("ty", v), field("tz", v)}, false) == "");  // history: nobody writes it
}

TEST_CASE("faults of a contact law's table") {
  const calx_field rows[] = {field("kn"), field("gn")};
  CHECK(fault(law()) == "");
  calx_contact_law t = law();
  t.draft = 3;
  CHECK(fault(t) ==
        "its table calx.contact-law/1 was built against draft 3, this host speaks the released one of "
        "ABI 1.0: rebuild it");
  t = law();
  t.struct_size = 96;
  CHECK(fault(t) == "its table calx.contact-law/1 has 96 bytes, ABI 1.0 needs " +
                        std::to_string(sizeof(calx_contact_law)) + ": rebuild it");
  t = law();
  t.eval_f64 = nullptr;
  CHECK(fault(t) == "its table calx.contact-law/1 lacks eval_f64");
  t = law();
  t.state_count = 1;
  CHECK(fault(t) == "its state table is null but announces 1 rows");
  t = law();
  t.pair = rows;
  t.pair_count = 2;
  CHECK(fault(t) == "it has no derive, so its given and pair tables must be the same, but they have 0 and 2 rows");
  t.given = rows;
  t.given_count = 2;
  CHECK(fault(t) == "");
  t.needs = 1u << 15;
  CHECK(fault(t) == "it needs an input column this host does not have (needs = 32768, known are 15 bits)");
}

TEST_CASE("a law text must be the one the functions were compiled from") {
  calx_contact_law t = law();
  t.symbol = "spring";
  t.dialect = 1;
  t.source = "abc";
  t.source_size = 3;
  // SHA-256 of "abc", FIPS 180-2 appendix B.1.
  const std::string hash = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
  t.source_sha256 = hash.c_str();
  CHECK(fault(t) == "");
  t.source = "abd";
  CHECK(fault(t).find("but it was compiled from " + hash) != std::string::npos);
  t.dialect = 2;
  CHECK(fault(t) == "its law text is written in dialect 2, this host reads dialect 1");
  t = law();
  t.source_size = 3;
  CHECK(fault(t) == "its table calx.contact-law/1 lacks source");
}

TEST_CASE("faults of the other kinds") {
  calx_motion motion{};
  motion.struct_size = sizeof motion;
  motion.draft = CALX_ABI_DRAFT;
  CHECK(interface_fault(CALX_MOTION, &motion) == "its table calx.motion/1 lacks pose");
  calx_geometry geometry{};
  geometry.struct_size = sizeof geometry;
  geometry.draft = CALX_ABI_DRAFT;
  CHECK(interface_fault(CALX_GEOMETRY, &geometry) == "its table calx.geometry/1 lacks build");
  calx_sensor sensor{};
  sensor.struct_size = sizeof sensor;
  sensor.draft = CALX_ABI_DRAFT;
  sensor.sample = [](calx_instance*, const calx_host*, const calx_sensor_view*, double*) -> calx_status { return 0; };
  CHECK(interface_fault(CALX_SENSOR, &sensor) == "its output table is empty");
  calx_state state{};
  state.struct_size = sizeof state;
  state.draft = CALX_ABI_DRAFT;
  CHECK(interface_fault(CALX_STATE, &state) == "its table calx.state/1 lacks save");
  calx_servo servo{};
  servo.struct_size = sizeof servo;
  servo.draft = CALX_ABI_DRAFT;
  CHECK(interface_fault(CALX_SERVO, &servo) == "its table calx.servo/1 lacks pose");
  CHECK(interface_fault(CALX_MOTION, nullptr) == "it has no table calx.motion/1");
}

TEST_CASE("history that survives separation needs a reach") {
  const calx_field row = {"wet", "1", "1 while wet", 0, 1, 0, CALX_FIELD_KEEP_APART, 0};
  calx_contact_law t = law();
  t.state = &row;
  t.state_count = 1;
  CHECK(fault(t) == "its history \"wet\" survives separation, but it has no reach, up to which it could");
  t.reach = [](const double*, double, double) { return 1e-3; };
  CHECK(fault(t) == "");
}

TEST_CASE("a descriptor may be larger than that of ABI 1.0, but not smaller") {
  calx_descriptor d{};
  d.id = d.kind = d.name = d.version = d.vendor = d.license = d.summary = "x";
  for (const std::uint32_t size : {96u, 104u, 4096u}) {
    d.struct_size = size;
    CHECK(descriptor_fault(d) == "");
  }
  d.struct_size = 88;
  CHECK(descriptor_fault(d) == "a descriptor has 88 bytes, ABI 1.0 needs 96");
}
