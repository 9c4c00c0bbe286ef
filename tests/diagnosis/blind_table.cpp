// blind_table.cpp: blind_table FIRST_SEED COUNT [BROKEN]: diagnoses studies and prints the table of goals. Seeds below
// 100000 are for development, seeds from 500000 for reporting.
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include "diagnosis/table.hpp"

int main(int argc, char** argv) {
  using namespace calx::diagnosis;
  if (argc < 3) {
    std::fprintf(stderr, "usage: blind_table FIRST_SEED COUNT [THREADS] [BROKEN 0..5]\n");
    return 2;
  }
  const auto first = std::strtoull(argv[1], nullptr, 10);
  const auto count = std::strtoull(argv[2], nullptr, 10);
  const auto threads = argc > 3 ? std::strtoull(argv[3], nullptr, 10) : 1;
  const auto broken = static_cast<Broken>(argc > 4 ? std::atoi(argv[4]) : 0);
  std::vector<Outcome> outcomes(count);
  std::vector<std::thread> pool;
  for (unsigned long long t = 0; t < threads; ++t)
    pool.emplace_back([&, t] {
      for (unsigned long long k = t; k < count; k += threads) outcomes[k] = diagnose_study(first + k, {}, broken);
    });
  for (std::thread& thread : pool) thread.join();
  std::printf("%s\n%s", describe(outcomes).c_str(), list_studies(outcomes).c_str());
  return 0;
}
