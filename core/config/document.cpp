#include "config/document.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "base/error.hpp"
#include "base/nearest.hpp"
#include "base/units.hpp"

namespace calx {
namespace fs = std::filesystem;

std::string pointer_token(const std::string& key) {
  std::string out = "/";
  for (const char c : key) out += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
  return out;
}

std::string pointer_token(std::size_t index) { return "/" + std::to_string(index); }

std::string shown(const Json& value) {
  if (value.is_object()) return "an object";
  if (value.is_array()) return "a list of " + std::to_string(value.size()) + (value.size() == 1 ? " value" : " values");
  if (value.is_number_float()) return format_number(value.get<double>());
  std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (text.size() > 80) text = text.substr(0, 76) + "...\"";
  return text;
}

namespace {

// Pointer of the place a parser callback stands at, and the keys each open object has had.
class Place {
 public:
  bool operator()(int, Json::parse_event_t event, Json& parsed) {
    using E = Json::parse_event_t;
    if (event == E::key) {
      Level& level = levels_.back();
      level.key = parsed.get<std::string>();
      if (!level.keys.insert(level.key).second && duplicate.empty()) duplicate = pointer();
    } else if (event == E::object_start || event == E::array_start) {
      levels_.push_back({event == E::array_start, 0, "", {}});
    } else {
      if (event == E::object_end || event == E::array_end) levels_.pop_back();
      if (!levels_.empty() && levels_.back().is_array) ++levels_.back().index;
    }
    return true;
  }
  std::string duplicate;

 private:
  struct Level {
    bool is_array;
    std::size_t index;
    std::string key;
    std::set<std::string> keys;
  };
  std::string pointer() const {
    std::string out;
    for (const Level& l : levels_) out += l.is_array ? pointer_token(l.index) : pointer_token(l.key);
    return out;
  }
  std::vector<Level> levels_;
};

std::string line_and_column(const std::string& text, std::size_t byte) {
  const std::size_t end = std::min(byte > 0 ? byte - 1 : 0, text.size());
  const std::size_t line =
      1 + static_cast<std::size_t>(std::count(text.begin(), text.begin() + static_cast<long>(end), '\n'));
  const std::size_t start = end == 0 ? std::string::npos : text.rfind('\n', end - 1);
  const std::size_t column = start == std::string::npos ? end + 1 : end - start;
  return "line " + std::to_string(line) + " column " + std::to_string(column);
}

// "unexpected '}'; expected string literal" out of the library's long text, with a hint for common slips.
std::string syntax_reason(const std::string& what, const std::string& text, std::size_t byte) {
  std::string reason = what;
  const std::size_t colon = reason.find(": ");
  if (colon != std::string::npos) reason = reason.substr(colon + 2);
  const std::size_t dash = reason.find(" - ");
  if (reason.compare(0, 12, "syntax error") == 0 && dash != std::string::npos) reason = reason.substr(dash + 3);
  const std::size_t last = reason.find("; last read: '");
  if (last != std::string::npos) {
    const std::size_t end = reason.find('\'', last + 14);
    const std::string rest = end == std::string::npos ? "" : reason.substr(end + 1);
    reason = reason.substr(0, last) + rest;
  }
  if (reason.find("unexpected '}'") != std::string::npos || reason.find("unexpected ']'") != std::string::npos)
    return reason + "; is there a comma too many before it?";
  // The word at the place of the error.
  std::size_t begin = std::min(byte > 0 ? byte - 1 : 0, text.size());
  std::size_t end = begin;
  const auto letter = [&](std::size_t at) {
    return at < text.size() && std::isalpha(static_cast<unsigned char>(text[at]));
  };
  while (begin > 0 && letter(begin - 1)) --begin;
  while (letter(end)) ++end;
  std::string word = text.substr(begin, end - begin);
  for (char& c : word) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (word == "nan" || word == "inf" || word == "infinity")
    reason += "; JSON has no NaN or infinity, give a finite number";
  return reason;
}

}  // namespace

Json parse_json(const std::string& text, const std::string& file, const std::string& pointer) {
  const std::string where = file + (pointer.empty() ? "" : " " + pointer);
  Place place;
  Json out;
  try {
    out = Json::parse(
        text, [&](int depth, Json::parse_event_t event, Json& parsed) { return place(depth, event, parsed); }, true,
        true);
  } catch (const Json::parse_error& e) {
    throw Error(Fault::settings, where + " " + line_and_column(text, e.byte) + ": not valid JSON; " +
                                     syntax_reason(e.what(), text, e.byte));
  } catch (const Json::out_of_range& e) {
    const std::string what = e.what();
    throw Error(Fault::settings, where + ": not valid JSON; " + what.substr(what.find("] ") + 2) +
                                     "; numbers must lie within +-1.797e308");
  }
  if (!place.duplicate.empty())
    throw Error(Fault::settings,
                file + " " + pointer + place.duplicate + ": this key stands twice in its object; keep one of them");
  return out;
}

std::string read_text_file(const std::string& path) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) throw Error(Fault::files, path + ": is a folder; a file is needed");
  std::ifstream in(path, std::ios::binary);
  if (!in) throw Error(Fault::files, path + ": cannot be read; " + std::strerror(errno));
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

Document::Document(const std::string& text, const std::string& file,
                   const std::vector<std::pair<std::string, std::string>>& overrides)
    : file_(file) {
  std::vector<std::string> chain{fs::weakly_canonical(fs::absolute(file)).string()};
  root_ = load(text, file, chain);
  for (const auto& o : overrides) apply(o.first, o.second);
  folder_ = fs::absolute(file).parent_path().lexically_normal().string();
  const auto start = root_.find("relative_to");
  if (start != root_.end()) {
    if (!start->is_string()) fail("/relative_to", shown(*start) + " is not text; must be the path of a folder");
    folder_ = absolute_path(start->get<std::string>());
  }
}

Document::Document(const Parameters& parameters, const std::string& file)
    : file_(file), folder_(parameters.folder), root_(parse_json(parameters.json, file, parameters.pointer)) {
  if (folder_.empty()) folder_ = fs::absolute(file).parent_path().lexically_normal().string();
}

Json Document::load(const std::string& text, const std::string& file, std::vector<std::string>& chain) {
  Json own = parse_json(text, file);
  if (!own.is_object()) throw Error(Fault::settings, file + ": holds " + shown(own) + "; a case is one JSON object");
  sources_.emplace_back(file, own);
  const auto found = own.find("extends");
  if (found == own.end()) return own;
  const std::string at = file + " /extends: ";
  if (!found->is_string())
    throw Error(Fault::settings, at + shown(*found) + " is not text; must be the path of a case");
  const std::string name = found->get<std::string>();
  const fs::path path = fs::path(file).parent_path() / name;
  const std::string canonical = fs::weakly_canonical(fs::absolute(path)).string();
  if (std::find(chain.begin(), chain.end(), canonical) != chain.end())
    throw Error(Fault::settings,
                at + "\"" + name + "\" leads back to itself; a chain of cases must end in one that extends none");
  chain.push_back(canonical);
  std::string base_text;
  try {
    base_text = read_text_file(path.string());
  } catch (const Error& e) {
    throw Error(e.fault(), at + e.what());
  }
  Json base = load(base_text, path.string(), chain);
  own.erase("extends");
  base.merge_patch(own);
  return base;
}

// Missing objects on the way are made, so that /output/frames_every works in a case without "output"; a slip in a key
// is found later as an unknown key.
void Document::apply(const std::string& pointer, const std::string& value) {
  const auto refuse = [&](const std::string& why) {
    throw Error(Fault::settings, "--set " + pointer + "=" + value + ": " + why);
  };
  if (pointer.empty() || pointer[0] != '/') refuse("the name must be a JSON pointer such as /time/end");
  Json given = Json::parse(value, nullptr, false);
  if (given.is_discarded()) given = value;
  Json::json_pointer path;
  try {
    path = Json::json_pointer(pointer);
  } catch (const Json::exception&) {
    refuse("\"~\" in a JSON pointer is written ~0, \"/\" is written ~1");
  }
  // Walk down by hand for messages that say which step of the pointer fails.
  Json *here = &root_, *parent = nullptr;
  std::string done;
  std::vector<std::string> tokens;
  for (Json::json_pointer p = path; !p.empty(); p = p.parent_pointer()) tokens.insert(tokens.begin(), p.back());
  for (const std::string& token : tokens) {
    if (here->is_null()) *here = Json::object();
    parent = here;
    if (here->is_array()) {
      const bool digits =
          !token.empty() && token.size() < 10 && token.find_first_not_of("0123456789") == std::string::npos;
      const std::size_t index = token == "-" ? here->size() : digits ? std::stoul(token) : here->size() + 1;
      if (index > here->size() || (index == here->size() && token != "-"))
        refuse(done + " is a list of " + std::to_string(here->size()) + "; \"" + token +
               "\" must be an index from 0, or - to append");
      if (index == here->size()) here->push_back(nullptr);
      here = &(*here)[index];
    } else if (here->is_object()) {
      here = &(*here)[token];
    } else {
      refuse(done + " is " + shown(*here) + ", which has no \"" + token + "\" inside");
    }
    done += pointer_token(token);
  }
  if (!given.is_null())
    *here = std::move(given);
  else if (parent->is_object())  // as in RFC 7396, null takes the key away
    parent->erase(tokens.back());
  else
    refuse("an entry of a list cannot be taken away; give the whole list");
  overridden_.push_back(pointer);
}

std::string Document::absolute_path(const std::string& path) const {
  return (fs::path(folder_) / path).lexically_normal().string();
}

std::string Document::file_of(const std::string& pointer) const {
  for (const std::string& p : overridden_)
    if (pointer == p || pointer.compare(0, p.size() + 1, p + "/") == 0) return "--set";
  const Json::json_pointer place(pointer);
  for (const auto& source : sources_)
    if (source.second.contains(place)) return source.first;
  // An object that an override made on its way.
  for (const std::string& p : overridden_)
    if (p.compare(0, pointer.size() + 1, pointer + "/") == 0) return "--set";
  return file_;
}

void Document::fail(const std::string& pointer, const std::string& what) const {
  throw Error(Fault::settings, file_of(pointer) + " " + (pointer.empty() ? "/" : pointer) + ": " + what);
}

std::string Document::resolved() const {
  Json out = root_;
  for (const auto& d : defaults_) out[Json::json_pointer(d.first)] = d.second;
  out["relative_to"] = folder_;
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace calx
