#include "base/log.hpp"

#include <spdlog/formatter.h>
#include <spdlog/logger.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/stdout_sinks.h>

#include <chrono>
#include <cstdio>
#include <ctime>
#include <memory>
#include <mutex>
#include <vector>

#include "base/error.hpp"

namespace calx {
namespace {

enum class Style { file, terminal, json };

spdlog::level::level_enum spdlog_level(LogLevel level) {
  switch (level) {
    case LogLevel::debug:
      return spdlog::level::debug;
    case LogLevel::info:
      return spdlog::level::info;
    case LogLevel::warning:
      return spdlog::level::warn;
    case LogLevel::error:
      break;
  }
  return spdlog::level::err;
}

const char* level_name(spdlog::level::level_enum level) {
  if (level >= spdlog::level::err) return "error";
  if (level == spdlog::level::warn) return "warning";
  return level == spdlog::level::info ? "info" : "debug";
}

/// 2026-01-31T12:00:00.123Z: UTC, so that logs of several machines can be laid side by side.
std::string iso_time(std::chrono::system_clock::time_point when) {
  const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(when.time_since_epoch()).count();
  const std::time_t seconds = static_cast<std::time_t>(ms / 1000);
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  char day[32], out[48];
  std::strftime(day, sizeof day, "%Y-%m-%dT%H:%M:%S", &parts);
  std::snprintf(out, sizeof out, "%s.%03dZ", day, static_cast<int>(ms % 1000));
  return out;
}

std::string json_text(const char* data, std::size_t size) {
  std::string out = "\"";
  for (std::size_t k = 0; k < size; ++k) {
    const unsigned char c = static_cast<unsigned char>(data[k]);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += data[k];
    } else if (c < 0x20) {
      char code[8];
      std::snprintf(code, sizeof code, "\\u%04x", c);
      out += code;
    } else {
      out += data[k];
    }
  }
  return out + "\"";
}

class LineFormatter : public spdlog::formatter {
 public:
  explicit LineFormatter(Style style) : style_(style) {}
  std::unique_ptr<spdlog::formatter> clone() const override { return std::make_unique<LineFormatter>(style_); }
  void format(const spdlog::details::log_msg& message, spdlog::memory_buf_t& out) override {
    const char* level = level_name(message.level);
    std::string line;
    if (style_ == Style::json) {
      line = "{\"time\":\"" + iso_time(message.time) + "\",\"level\":\"" + level +
             "\",\"message\":" + json_text(message.payload.data(), message.payload.size()) + "}";
    } else {
      if (style_ == Style::file) line = iso_time(message.time) + " " + level + " ";
      if (style_ == Style::terminal && message.level >= spdlog::level::warn) line = std::string(level) + ": ";
      line.append(message.payload.data(), message.payload.size());
    }
    line += '\n';
    out.append(line.data(), line.data() + line.size());
  }

 private:
  Style style_;
};

void add_sink(std::vector<spdlog::sink_ptr>& sinks, spdlog::sink_ptr sink, Style style, LogLevel level) {
  sink->set_formatter(std::make_unique<LineFormatter>(style));
  sink->set_level(spdlog_level(level));
  sinks.push_back(std::move(sink));
}

struct OpenLog {
  std::mutex mutex;
  std::shared_ptr<spdlog::logger> logger;
};
OpenLog& the_log() {
  static OpenLog log;
  return log;
}

}  // namespace

void open_log(const LogSettings& settings) {
  std::vector<spdlog::sink_ptr> sinks;
  try {
    if (!settings.file.empty())
      add_sink(sinks, std::make_shared<spdlog::sinks::basic_file_sink_mt>(settings.file, !settings.append), Style::file,
               settings.file_level);
  } catch (const spdlog::spdlog_ex& e) {
    throw Error(Fault::files, settings.file + ": the run log cannot be written; " + e.what());
  }
  if (settings.to_stderr)
    add_sink(sinks, std::make_shared<spdlog::sinks::stderr_sink_mt>(),
             settings.json_lines ? Style::json : Style::terminal, settings.stderr_level);
  auto logger = std::make_shared<spdlog::logger>("calx", sinks.begin(), sinks.end());
  logger->set_level(spdlog::level::debug);
  logger->flush_on(spdlog::level::debug);
  // The result files meet a full disk too and report it properly; spdlog would print on its own.
  logger->set_error_handler([](const std::string&) {});
  const std::lock_guard<std::mutex> lock(the_log().mutex);
  the_log().logger = std::move(logger);
}

void close_log() {
  const std::lock_guard<std::mutex> lock(the_log().mutex);
  the_log().logger.reset();
}

void log_line(LogLevel level, const std::string& text) noexcept {
  try {
    std::shared_ptr<spdlog::logger> logger;
    {
      const std::lock_guard<std::mutex> lock(the_log().mutex);
      logger = the_log().logger;
    }
    if (logger) logger->log(spdlog_level(level), spdlog::string_view_t(text.data(), text.size()));
  } catch (...) {  // out of memory while formatting a line; the run matters more
  }
}

}  // namespace calx
