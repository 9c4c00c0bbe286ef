// push.cpp: the servo that abi/README.md shows, whole.
#include <calx/servo.hpp>

namespace {

class Push : public calx::rigid::Servo<2> {  // state_[0]: way, state_[1]: speed
 public:
  static const calx_descriptor descriptor;
  Push(const calx_host*, const calx_config&) {}
  void advance(const calx_servo_view& view) override {  // along x with 5 N, against a dashpot of 100 kg/s
    state_[1] = (5 + view.force[0]) / 100;
    state_[0] += state_[1] * view.dt;
  }
  void pose(calx_pose& out) const noexcept override { out.displacement[0] = state_[0], out.velocity[0] = state_[1]; }
  double top_speed(double) const noexcept override { return 0.05; }
  double reach() const noexcept override { return 0.1; }
};

const calx_descriptor Push::descriptor = {sizeof(calx_descriptor),
                                          0,
                                          "org.example.push",
                                          CALX_SERVO,
                                          "Push",
                                          "1.0.0",
                                          "Example",
                                          "MIT",
                                          "Pushes along x with 5 N.",
                                          0,
                                          0,
                                          0,
                                          0,
                                          0};

}  // namespace

CALX_PLUGIN(Push)
