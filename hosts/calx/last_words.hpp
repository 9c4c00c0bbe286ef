// last_words.hpp: what the program says where a plugin ends it in the middle of a run, by a crash or by exit().
#pragma once
#include <string>

namespace calx {

/// While it lives, a crash and an exit() of this process are told on stderr, with what is left and what helps; an
/// exit() ends with exit code 4. One at a time.
class LastWords {
 public:
  explicit LastWords(const std::string& folder);  // of the run
  ~LastWords();
  LastWords(const LastWords&) = delete;
  LastWords& operator=(const LastWords&) = delete;
};

}  // namespace calx
