// log.hpp: the log of a run: a text file beside the results and, for programs, lines on stderr.
// Silent until a program opens it, because the engine is also a library. A few lines a second at most, so each line is
// flushed: a killed run keeps its log.
#pragma once
#include <string>

namespace calx {

enum class LogLevel { debug, info, warning, error };

struct LogSettings {
  std::string file;                      // path of the run log; empty: none
  bool append = false;                   // keep what the file holds, as a resumed run does
  LogLevel file_level = LogLevel::info;  // lines below it are dropped
  bool to_stderr = false;
  LogLevel stderr_level = LogLevel::info;
  bool json_lines = false;  // stderr: one JSON object a line, {"time": ISO 8601 in UTC, "level": ..., "message": ...}
};

/// Opens the process's log, closing the one before. Throws Error(Fault::files) when the file cannot be written. [any]
void open_log(const LogSettings& settings);

/// Back to silence. [any]
void close_log();

/// One line, UTF-8. Never throws: a full disk must not end a run through its log. [any]
void log_line(LogLevel level, const std::string& text) noexcept;

inline void log_debug(const std::string& text) noexcept { log_line(LogLevel::debug, text); }
inline void log_info(const std::string& text) noexcept { log_line(LogLevel::info, text); }
inline void log_warning(const std::string& text) noexcept { log_line(LogLevel::warning, text); }
inline void log_error(const std::string& text) noexcept { log_line(LogLevel::error, text); }

}  // namespace calx
