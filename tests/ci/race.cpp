// race.cpp: the test of the thread sanitizer: barriers between loops are no race; with any argument two threads write
// one variable, which must be reported.
#include <cstdio>
#include <vector>

int main(int argc, char**) {
  std::vector<double> values(1000);
  int last = 0;
#pragma omp parallel num_threads(2)
  {
#pragma omp for schedule(dynamic, 1)
    for (int k = 0; k < 1000; ++k) values[static_cast<std::size_t>(k)] = k;
#pragma omp for schedule(static)
    for (int k = 0; k < 1000; ++k) {
      values[static_cast<std::size_t>(999 - k)] += 1;
      if (argc > 1) last = k;
    }
  }
  std::printf("%g %d\n", values[999], last);
}
