/* two_balls.c: a case file, a sensor, a checkpoint, and errors as codes, in C. */
#include <calx/embed.h>
#include <stdio.h>

static int failed(const char* what) {
  fprintf(stderr, "%s: %s\n", what, calx_sim_error());
  return 1;
}

int main(int count, char** words) {
  calx_sim_options options = {0};
  calx_sim* sim = NULL;
  uint32_t sensor;
  double row[16];
  char digest[65];
  calx_sim_column position;
  if (count != 3) {
    fprintf(stderr, "usage: %s CASE.json FOLDER\n", words[0]);
    return 2;
  }
  options.struct_size = sizeof options;
  options.threads = 1;
  if (calx_sim_open(words[1], &options, &sim) != CALX_SIM_OK) return failed("open");
  if (calx_sim_run_until(sim, 0.1) != CALX_SIM_OK) return failed("run");
  if (calx_sim_sensor(sim, "centre of mass", &sensor) != CALX_SIM_OK) return failed("sensor");
  if (calx_sim_sample(sim, sensor, row, 16) != CALX_SIM_OK) return failed("sample");
  if (calx_sim_particles(sim, "position", &position) != CALX_SIM_OK) return failed("particles");
  if (calx_sim_save(sim, words[2]) != CALX_SIM_OK) return failed("save");
  if (calx_sim_digest(sim, digest) != CALX_SIM_OK) return failed("digest");
  printf("t = %.4f s, %lu particles, first column of the sensor (%s): %.6g\n%s\n", calx_sim_time(sim),
         (unsigned long)position.rows, calx_sim_sensor_column(sim, sensor, 0), row[0], digest);
  calx_sim_destroy(sim);
  /* A misspelt sensor is a code and a message, not an end of the program. */
  if (calx_sim_sensor(NULL, "centre", &sensor) == CALX_SIM_OK) return 1;
  return 0;
}
