// SPDX-License-Identifier: MIT
// calx/servo.hpp: optional C++11 helper for servo plugins; header only. Writes the tables calx.servo/1 and calx.state/1
// of a class whose whole state is an array of numbers.
#ifndef CALX_SERVO_HPP
#define CALX_SERVO_HPP
#include <calx/rigid_motion.hpp>

namespace calx {
namespace rigid {

/// Base of a servo plugin with `count` numbers of state, all 0 at the start.
template <uint32_t count>
class Servo : public Instance {
 public:
  virtual void pose(calx_pose& out) const noexcept = 0;  // out: the pose of rest at the origin, to fill in
  /// Goes on by one step; see servo.h. Throws ConfigError to end the run.
  virtual void advance(const calx_servo_view& view) = 0;
  virtual double top_speed(double radius) const noexcept = 0;
  virtual double reach() const noexcept = 0;

  const void* get_interface(const char* id) const override {
    static const calx_servo servo = {sizeof(calx_servo), CALX_ABI_DRAFT, &pose_of,
                                     &advance_of,        &top_speed_of,  &reach_of};
    static const calx_state state = {sizeof(calx_state), CALX_ABI_DRAFT, state_schema, 0, &save, &load};
    if (std::strcmp(id, CALX_SERVO) == 0) return &servo;
    return std::strcmp(id, CALX_STATE) == 0 ? &state : 0;
  }

 protected:
  double state_[count] = {};

 private:
  static const uint32_t state_schema = 1;
  static Servo& self_of(calx_instance* self) noexcept { return *static_cast<Servo*>(self); }
  static const Servo& self_of(const calx_instance* self) noexcept { return *static_cast<const Servo*>(self); }

  static calx_status CALX_CALL pose_of(const calx_instance* self, calx_pose* out) noexcept {
    *out = calx_pose();
    out->quaternion[0] = 1;
    self_of(self).pose(*out);
    return CALX_OK;
  }
  static calx_status CALX_CALL advance_of(calx_instance* self, const calx_host* host,
                                          const calx_servo_view* view) noexcept {
    return guard(host, [&] { self_of(self).advance(*view); });
  }
  static double CALX_CALL top_speed_of(const calx_instance* self, double r) noexcept {
    return self_of(self).top_speed(r);
  }
  static double CALX_CALL reach_of(const calx_instance* self) noexcept { return self_of(self).reach(); }

  // Numbers as they lie in memory: little-endian on every machine Calx runs on.
  static calx_status CALX_CALL save(const calx_instance* self, const calx_stream* stream) noexcept {
    const double* numbers = self_of(self).state_;
    return stream->write(stream, numbers, sizeof(double) * count) == int64_t(sizeof(double) * count) ? CALX_OK
                                                                                                     : CALX_E_IO;
  }
  static calx_status CALX_CALL load(calx_instance* self, const calx_stream* stream, uint32_t written_by) noexcept {
    if (written_by != state_schema) return CALX_E_STATE;
    double numbers[count];
    unsigned char* to = reinterpret_cast<unsigned char*>(numbers);
    for (uint64_t done = 0; done < sizeof numbers;) {
      const int64_t got = stream->read(stream, to + done, sizeof numbers - done);
      if (got <= 0) return CALX_E_STATE;
      done += uint64_t(got);
    }
    unsigned char more;
    if (stream->read(stream, &more, 1) != 0) return CALX_E_STATE;
    for (uint32_t k = 0; k < count; ++k)
      if (!std::isfinite(numbers[k])) return CALX_E_STATE;
    std::memcpy(self_of(self).state_, numbers, sizeof numbers);
    return CALX_OK;
  }
};

}  // namespace rigid
}  // namespace calx
#endif
