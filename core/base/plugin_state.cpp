// plugin_state.cpp: streams of calx.state/1 over a vector of bytes.
#include "base/plugin_state.hpp"

#include <algorithm>
#include <cstring>

#include "base/error.hpp"

namespace calx {
namespace {

struct Bytes {
  std::vector<std::uint8_t> all;
  std::size_t at = 0;  // read so far
};

// Out of memory must not leave as an exception through the plugin's frames.
std::int64_t CALX_CALL write_bytes(const calx_stream* stream, const void* bytes, std::uint64_t size) noexcept {
  try {
    auto& all = static_cast<Bytes*>(stream->self)->all;
    const auto* from = static_cast<const std::uint8_t*>(bytes);
    all.insert(all.end(), from, from + size);
    return static_cast<std::int64_t>(size);
  } catch (...) {
    return -1;
  }
}

std::int64_t CALX_CALL read_bytes(const calx_stream* stream, void* bytes, std::uint64_t size) noexcept {
  Bytes& b = *static_cast<Bytes*>(stream->self);
  const std::size_t n = std::min<std::size_t>(size, b.all.size() - b.at);
  if (n > 0) std::memcpy(bytes, b.all.data() + b.at, n);
  b.at += n;
  return static_cast<std::int64_t>(n);
}

std::int64_t CALX_CALL no_write(const calx_stream*, const void*, std::uint64_t) noexcept { return -1; }
std::int64_t CALX_CALL no_read(const calx_stream*, void*, std::uint64_t) noexcept { return 0; }

}  // namespace

void save_plugin_state(const calx_state& table, const calx_instance* instance, StateWriter& out,
                       const std::string& name, const std::string& who) {
  Bytes bytes;
  const calx_stream stream = {sizeof(calx_stream), 0, &bytes, &write_bytes, &no_read};
  const calx_status status = table.save(instance, &stream);
  if (status < 0)
    throw Error(Fault::plugin, who + ": the plugin cannot save its state, status " + std::to_string(status));
  out.put(name + "/bytes", bytes.all.data(), bytes.all.size());
  out.put_count(name + "/schema", table.schema);
}

void load_plugin_state(const calx_state& table, calx_instance* instance, const StateReader& in, const std::string& name,
                       const std::string& who) {
  Bytes bytes;
  bytes.all = in.get_u8(name + "/bytes");
  const auto schema = static_cast<std::uint32_t>(in.get_count(name + "/schema"));
  const calx_stream stream = {sizeof(calx_stream), 0, &bytes, &no_write, &read_bytes};
  const calx_status status = table.load(instance, &stream, schema);
  if (status < 0)
    throw Error(Fault::files, name + ": " + who + " does not take back the state in the checkpoint (schema " +
                                  std::to_string(schema) + ", the plugin has " + std::to_string(table.schema) +
                                  ", status " + std::to_string(status) + "); resume with the plugin that wrote it");
}

}  // namespace calx
