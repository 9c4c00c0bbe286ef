// blind_table.cpp: blind_table FIRST_SEED COUNT [THREADS] [BROKEN]: diagnoses studies and prints the table of goals,
// then a third as many studies made harder, then like causes until 60 effects were left undecided. Seeds below 100000
// are for development, seeds from 500000 for reporting.
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include "diagnosis/table.hpp"

namespace {

using namespace calx::diagnosis;

constexpr unsigned long long batch = 40;  // like causes between two looks at how many were left undecided
constexpr int enough_undecided = 60;

template <class TroubleOf>
std::vector<Outcome> run(unsigned long long first, unsigned long long count, unsigned long long threads, Broken broken,
                         TroubleOf trouble_of) {
  std::vector<Outcome> outcomes(count);
  std::vector<std::thread> pool;
  for (unsigned long long t = 0; t < threads; ++t)
    pool.emplace_back([&, t] {
      for (unsigned long long k = t; k < count; k += threads)
        outcomes[k] = diagnose_study(first + k, {}, broken, 1, trouble_of(k));
    });
  for (std::thread& thread : pool) thread.join();
  return outcomes;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: blind_table FIRST_SEED COUNT [THREADS] [BROKEN 0..5]\n");
    return 2;
  }
  const auto first = std::strtoull(argv[1], nullptr, 10);
  const auto count = std::strtoull(argv[2], nullptr, 10);
  const auto threads = argc > 3 ? std::strtoull(argv[3], nullptr, 10) : 1;
  const auto broken = static_cast<Broken>(argc > 4 ? std::atoi(argv[4]) : 0);
  const std::vector<Outcome> plain = run(first, count, threads, broken, [](auto) { return Trouble::none; });
  std::printf("%s\n", describe(plain).c_str());
  std::fflush(stdout);
  const std::vector<Outcome> hard = run(first + count, count / 3, threads, broken, trouble_of);
  std::printf("%s\n", describe_troubles(hard).c_str());
  std::fflush(stdout);
  std::vector<Outcome> like;
  for (auto at = first + count + count / 3; at < first + 3 * count; at += batch) {
    int undecided = 0;
    for (const Outcome& o : like) undecided += o.next.asked ? 1 : 0;
    if (undecided >= enough_undecided) break;
    const std::vector<Outcome> more = run(at, batch, threads, broken, [](auto) { return Trouble::like_causes; });
    like.insert(like.end(), more.begin(), more.end());
  }
  std::printf("%s\n%s\n%s", describe_next(like).c_str(), list_studies(plain).c_str(), list_studies(hard).c_str());
  return 0;
}
