#include "io/h5_file.hpp"

#include <hdf5.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "base/error.hpp"
#include "io/h5_driver.hpp"
#include "io/staged_file.hpp"

namespace calx {
namespace {

static_assert(sizeof(hid_t) == sizeof(std::int64_t), "h5_driver.hpp passes a hid_t as std::int64_t");

/// Silences HDF5 on this thread for one call; an embedding program keeps its own setting.
class Quiet {
 public:
  Quiet() {
    H5Eget_auto2(H5E_DEFAULT, &handler_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~Quiet() { H5Eset_auto2(H5E_DEFAULT, handler_, data_); }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

 private:
  H5E_auto2_t handler_ = nullptr;
  void* data_ = nullptr;
};

class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  Handle& operator=(Handle&&) = delete;
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

hid_t memory_type(H5Type type) {
  switch (type) {
    case H5Type::f64:
      return H5T_NATIVE_DOUBLE;
    case H5Type::f32:
      return H5T_NATIVE_FLOAT;
    case H5Type::u64:
      return H5T_NATIVE_UINT64;
    case H5Type::u32:
      return H5T_NATIVE_UINT32;
    case H5Type::u8:
      return H5T_NATIVE_UINT8;
  }
  return -1;
}

hid_t file_type(H5Type type) {
  switch (type) {
    case H5Type::f64:
      return H5T_IEEE_F64LE;
    case H5Type::f32:
      return H5T_IEEE_F32LE;
    case H5Type::u64:
      return H5T_STD_U64LE;
    case H5Type::u32:
      return H5T_STD_U32LE;
    case H5Type::u8:
      return H5T_STD_U8LE;
  }
  return -1;
}

const char* type_name(H5Type type) {
  switch (type) {
    case H5Type::f64:
      return "64-bit real numbers";
    case H5Type::f32:
      return "32-bit real numbers";
    case H5Type::u64:
      return "64-bit counts";
    case H5Type::u32:
      return "32-bit counts";
    case H5Type::u8:
      return "bytes";
  }
  return "";
}

/// The innermost message of HDF5's error stack.
std::string hdf5_reason() {
  std::string reason;
  H5Ewalk2(
      H5E_DEFAULT, H5E_WALK_UPWARD,
      [](unsigned n, const H5E_error2_t* e, void* out) -> herr_t {
        if (n == 0 && e->desc != nullptr) *static_cast<std::string*>(out) = e->desc;
        return 0;
      },
      &reason);
  return reason.empty() ? "the HDF5 library gives no reason" : reason;
}

std::string rooted(const std::string& path) { return path.empty() || path[0] != '/' ? "/" + path : path; }

Handle text_type(std::size_t length) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, std::max<std::size_t>(1, length));
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return type;
}

Handle with_groups() {
  Handle list(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(list, 1);
  return list;
}

Handle simple_space(const H5File::Sizes& sizes) {
  const std::vector<hsize_t> dims(sizes.begin(), sizes.end());
  return {H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr), H5Sclose};
}

}  // namespace

struct H5File::Impl {
  std::string name;
  StagedFile staged;
  hid_t file = -1;

  Impl(const std::string& path, Mode mode, const std::string& shown)
      : name(shown.empty() ? path : shown),
        staged(path,
               mode == Mode::read     ? StagedFile::Mode::read
               : mode == Mode::update ? StagedFile::Mode::update
                                      : StagedFile::Mode::create,
               name) {}

  [[noreturn]] void fail(const std::string& what) const {
    staged.check();
    throw Error(Fault::files, name + ": " + what + " (" + hdf5_reason() + ")");
  }
  void need(bool good, const std::string& what) const {
    if (!good || staged.error() != 0) fail(what);
  }
  Handle dataset(const std::string& path) const {
    Handle set(H5Dopen2(file, rooted(path).c_str(), H5P_DEFAULT), H5Dclose);
    if (set < 0) throw Error(Fault::files, name + ": no dataset \"" + path + "\"");
    return set;
  }
  bool exists(const std::string& path) const {
    const std::string full = rooted(path);
    if (full == "/") return true;
    for (std::size_t at = full.find('/', 1);; at = full.find('/', at + 1)) {
      if (H5Lexists(file, full.substr(0, at).c_str(), H5P_DEFAULT) <= 0) return false;
      if (at == std::string::npos) return true;
    }
  }
  Handle object(const std::string& path, bool make) const {
    if (make && !exists(path)) {
      Handle group(H5Gcreate2(file, rooted(path).c_str(), with_groups(), H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
      need(group >= 0, "cannot create group \"" + path + "\"");
    }
    Handle out(H5Oopen(file, rooted(path).c_str(), H5P_DEFAULT), H5Oclose);
    if (out < 0) throw Error(Fault::files, name + ": nothing named \"" + path + "\"");
    return out;
  }
  Sizes sizes_of(hid_t set) const {
    const Handle space(H5Dget_space(set), H5Sclose);
    const int rank = H5Sget_simple_extent_ndims(space);
    std::vector<hsize_t> dims(static_cast<std::size_t>(std::max(rank, 0)));
    H5Sget_simple_extent_dims(space, dims.data(), nullptr);
    return {dims.begin(), dims.end()};
  }
  void attribute(const std::string& path, const std::string& attribute, hid_t type, hid_t space,
                 const void* data) const {
    const Handle on = object(path, true);
    if (H5Aexists(on, attribute.c_str()) > 0) H5Adelete(on, attribute.c_str());
    const Handle a(H5Acreate2(on, attribute.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    need(a >= 0 && H5Awrite(a, type, data) >= 0, "cannot write attribute \"" + attribute + "\" of \"" + path + "\"");
  }
  Handle open_attribute(hid_t on, const std::string& path, const std::string& attribute) const {
    Handle a(H5Aopen(on, attribute.c_str(), H5P_DEFAULT), H5Aclose);
    if (a < 0) throw Error(Fault::files, name + ": \"" + path + "\" has no attribute \"" + attribute + "\"");
    return a;
  }
};

H5File::H5File(const std::string& path, Mode mode, const std::string& name)
    : impl_(std::make_unique<Impl>(path, mode, name)) {
  const Quiet quiet;
  const Handle access(h5_access_through(impl_->staged), H5Pclose);
  impl_->need(access >= 0, "HDF5 refuses the file driver");
  impl_->file = mode == Mode::create
                    ? H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access)
                    : H5Fopen(path.c_str(), mode == Mode::read ? H5F_ACC_RDONLY : H5F_ACC_RDWR, access);
  impl_->need(impl_->file >= 0, "not a readable HDF5 file");
}

H5File::~H5File() {
  const Quiet quiet;
  if (impl_->file >= 0) H5Fclose(impl_->file);
}

void H5File::commit(bool durable) {
  const Quiet quiet;
  const bool flushed = H5Fflush(impl_->file, H5F_SCOPE_GLOBAL) >= 0;
  const bool closed = H5Fclose(impl_->file) >= 0;
  impl_->file = -1;
  impl_->need(flushed && closed, "cannot write");
  impl_->staged.commit(durable);
}

const std::string& H5File::name() const { return impl_->name; }

void H5File::write(const std::string& path, H5Type type, const void* data, const Sizes& sizes,
                   const std::string& unit) {
  const Quiet quiet;
  {
    const Handle set(H5Dcreate2(impl_->file, rooted(path).c_str(), file_type(type), simple_space(sizes), with_groups(),
                                H5P_DEFAULT, H5P_DEFAULT),
                     H5Dclose);
    impl_->need(set >= 0, "cannot create dataset \"" + path + "\"");
    const bool any = std::find(sizes.begin(), sizes.end(), 0u) == sizes.end();
    if (any) {
      impl_->need(H5Dwrite(set, memory_type(type), H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0,
                  "cannot write dataset \"" + path + "\"");
    }
  }
  if (!unit.empty()) set_text(path, "unit", unit);
}

void H5File::write_text(const std::string& path, const std::string& text) {
  const Quiet quiet;
  const Handle type = text_type(text.size());
  const Handle space(H5Screate(text.empty() ? H5S_NULL : H5S_SCALAR), H5Sclose);
  const Handle set(H5Dcreate2(impl_->file, rooted(path).c_str(), type, space, with_groups(), H5P_DEFAULT, H5P_DEFAULT),
                   H5Dclose);
  impl_->need(set >= 0, "cannot create dataset \"" + path + "\"");
  if (text.empty()) return;
  impl_->need(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()) >= 0,
              "cannot write dataset \"" + path + "\"");
}

void H5File::create_growing(const std::string& path, H5Type type, const Sizes& row, bool varying,
                            const std::string& unit) {
  // A chunk of a varying row: 1024 entries waste at most some 40 KiB per frame of a small run, and keep the index of a
  // large one short. Fixed rows are a few numbers each; 64 of them share a chunk.
  constexpr hsize_t varying_chunk = 1024, fixed_chunk = 64;
  const Quiet quiet;
  std::vector<hsize_t> dims{0}, most{H5S_UNLIMITED}, chunk{varying ? 1 : fixed_chunk};
  for (std::size_t k = 0; k < row.size(); ++k) {
    const bool grows = varying && k == 0;
    dims.push_back(grows ? 0 : row[k]);
    most.push_back(grows ? H5S_UNLIMITED : row[k]);
    chunk.push_back(grows ? varying_chunk : row[k]);
  }
  {
    const Handle space(H5Screate_simple(static_cast<int>(dims.size()), dims.data(), most.data()), H5Sclose);
    const Handle plan(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_chunk(plan, static_cast<int>(chunk.size()), chunk.data());
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::uint64_t none = std::numeric_limits<std::uint64_t>::max();
    if (type == H5Type::f64 || type == H5Type::f32) {
      H5Pset_fill_value(plan, H5T_NATIVE_DOUBLE, &nan);
    } else {
      H5Pset_fill_value(plan, memory_type(type), &none);
    }
    const Handle set(
        H5Dcreate2(impl_->file, rooted(path).c_str(), file_type(type), space, with_groups(), plan, H5P_DEFAULT),
        H5Dclose);
    impl_->need(set >= 0, "cannot create dataset \"" + path + "\"");
  }
  if (!unit.empty()) set_text(path, "unit", unit);
}

void H5File::append(const std::string& path, H5Type type, const void* row, const Sizes& row_sizes) {
  const Quiet quiet;
  const Handle set = impl_->dataset(path);
  const Sizes old = impl_->sizes_of(set);
  impl_->need(old.size() == row_sizes.size() + 1, "dataset \"" + path + "\" has another shape");
  std::vector<hsize_t> dims{old[0] + 1}, start{old[0]}, part{1};
  for (std::size_t k = 0; k < row_sizes.size(); ++k) {
    dims.push_back(std::max(old[k + 1], row_sizes[k]));
    start.push_back(0);
    part.push_back(row_sizes[k]);
  }
  impl_->need(H5Dset_extent(set, dims.data()) >= 0, "cannot extend dataset \"" + path + "\"");
  if (std::find(part.begin(), part.end(), 0u) != part.end()) return;
  const Handle there(H5Dget_space(set), H5Sclose);
  const Handle here(H5Screate_simple(static_cast<int>(part.size()), part.data(), nullptr), H5Sclose);
  H5Sselect_hyperslab(there, H5S_SELECT_SET, start.data(), nullptr, part.data(), nullptr);
  impl_->need(H5Dwrite(set, memory_type(type), here, there, H5P_DEFAULT, row) >= 0,
              "cannot write dataset \"" + path + "\"");
}

void H5File::truncate(const std::string& path, std::uint64_t rows) {
  const Quiet quiet;
  const Handle set = impl_->dataset(path);
  const Sizes old = impl_->sizes_of(set);
  if (old.empty() || old[0] <= rows) return;
  std::vector<hsize_t> dims(old.begin(), old.end());
  dims[0] = rows;
  impl_->need(H5Dset_extent(set, dims.data()) >= 0, "cannot shorten dataset \"" + path + "\"");
}

void H5File::link(const std::string& existing, const std::string& path) {
  const Quiet quiet;
  impl_->need(H5Lcreate_hard(impl_->file, rooted(existing).c_str(), impl_->file, rooted(path).c_str(), with_groups(),
                             H5P_DEFAULT) >= 0,
              "cannot link \"" + path + "\"");
}

bool H5File::has(const std::string& path) const {
  const Quiet quiet;
  return impl_->exists(path);
}

H5File::Sizes H5File::sizes(const std::string& path) const {
  const Quiet quiet;
  return impl_->sizes_of(impl_->dataset(path));
}

std::size_t H5File::count(const std::string& path) const {
  const Sizes s = sizes(path);
  return std::accumulate(s.begin(), s.end(), std::size_t{1}, std::multiplies<>());
}

std::size_t H5File::row_size(const std::string& path, std::uint64_t count) const {
  Sizes s = sizes(path);
  if (s.size() > 1) s[1] = std::min<std::uint64_t>(s[1], count);
  return s.empty() ? 0 : std::accumulate(s.begin() + 1, s.end(), std::size_t{1}, std::multiplies<>());
}

void H5File::read_all(const std::string& path, H5Type type, void* out) const {
  const Quiet quiet;
  const Handle set = impl_->dataset(path);
  const Handle stored(H5Dget_type(set), H5Tclose);
  if (H5Tequal(stored, file_type(type)) <= 0) {
    throw Error(Fault::files, impl_->name + ": dataset \"" + path + "\" does not hold " + type_name(type));
  }
  const Sizes sizes = impl_->sizes_of(set);
  if (std::find(sizes.begin(), sizes.end(), 0u) != sizes.end()) return;
  impl_->need(H5Dread(set, memory_type(type), H5S_ALL, H5S_ALL, H5P_DEFAULT, out) >= 0,
              "cannot read dataset \"" + path + "\"");
}

void H5File::read_part(const std::string& path, H5Type type, std::uint64_t row, std::uint64_t count, void* out) const {
  const Quiet quiet;
  const Handle set = impl_->dataset(path);
  const Sizes sizes = impl_->sizes_of(set);
  if (sizes.empty() || row >= sizes[0]) {
    throw Error(Fault::files, impl_->name + ": dataset \"" + path + "\" has no row " + std::to_string(row));
  }
  std::vector<hsize_t> start(sizes.size(), 0), part(sizes.begin(), sizes.end());
  start[0] = row;
  part[0] = 1;
  if (part.size() > 1) part[1] = std::min<hsize_t>(part[1], count);
  if (std::find(part.begin(), part.end(), 0u) != part.end()) return;
  const Handle there(H5Dget_space(set), H5Sclose);
  const Handle here(H5Screate_simple(static_cast<int>(part.size()), part.data(), nullptr), H5Sclose);
  H5Sselect_hyperslab(there, H5S_SELECT_SET, start.data(), nullptr, part.data(), nullptr);
  impl_->need(H5Dread(set, memory_type(type), here, there, H5P_DEFAULT, out) >= 0,
              "cannot read dataset \"" + path + "\"");
}

std::string H5File::read_text(const std::string& path) const {
  const Quiet quiet;
  const Handle set = impl_->dataset(path);
  const Handle type(H5Dget_type(set), H5Tclose);
  const Handle space(H5Dget_space(set), H5Sclose);
  const H5S_class_t kind = H5Sget_simple_extent_type(space);
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0 || (kind != H5S_SCALAR && kind != H5S_NULL)) {
    throw Error(Fault::files, impl_->name + ": dataset \"" + path + "\" does not hold text");
  }
  if (kind == H5S_NULL) return "";
  std::string text(H5Tget_size(type), '\0');
  impl_->need(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, &text[0]) >= 0, "cannot read dataset \"" + path + "\"");
  return text;
}

std::vector<std::string> H5File::datasets() const {
  const Quiet quiet;
  std::vector<std::string> names, out;
  const herr_t done = H5Lvisit(
      impl_->file, H5_INDEX_NAME, H5_ITER_INC,
      [](hid_t, const char* name, const H5L_info_t*, void* list) -> herr_t {
        static_cast<std::vector<std::string>*>(list)->push_back(name);
        return 0;
      },
      &names);
  impl_->need(done >= 0, "cannot list the datasets");
  for (std::string& name : names) {
    const Handle object(H5Oopen(impl_->file, rooted(name).c_str(), H5P_DEFAULT), H5Oclose);
    impl_->need(object >= 0, "cannot open \"" + name + "\"");
    if (H5Iget_type(object) == H5I_DATASET) out.push_back(std::move(name));
  }
  std::sort(out.begin(), out.end());
  return out;
}

std::vector<std::string> H5File::members(const std::string& group) const {
  const Quiet quiet;
  std::vector<std::string> names;
  if (!impl_->exists(group)) return names;
  const Handle on = impl_->object(group, false);
  const herr_t done = H5Literate(
      on, H5_INDEX_NAME, H5_ITER_INC, nullptr,
      [](hid_t, const char* name, const H5L_info_t*, void* list) -> herr_t {
        static_cast<std::vector<std::string>*>(list)->push_back(name);
        return 0;
      },
      &names);
  impl_->need(done >= 0, "cannot list group \"" + group + "\"");
  return names;
}

std::vector<unsigned char> H5File::bytes(const std::string& path) const {
  const Quiet quiet;
  const Handle set = impl_->dataset(path);
  const Handle type(H5Dget_type(set), H5Tclose);
  const Handle space(H5Dget_space(set), H5Sclose);
  const hssize_t entries = H5Sget_simple_extent_npoints(space);
  std::vector<unsigned char> out(static_cast<std::size_t>(std::max<hssize_t>(0, entries)) * H5Tget_size(type));
  if (out.empty() || H5Sget_simple_extent_type(space) == H5S_NULL) return {};
  impl_->need(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, out.data()) >= 0,
              "cannot read dataset \"" + path + "\"");
  return out;
}

void H5File::set_text(const std::string& path, const std::string& attribute, const std::string& text) {
  const Quiet quiet;
  const Handle type = text_type(text.size());
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  impl_->attribute(path, attribute, type, space, text.c_str());
}

void H5File::set_texts(const std::string& path, const std::string& attribute, const std::vector<std::string>& texts) {
  if (texts.empty()) return;
  const Quiet quiet;
  std::size_t longest = 1;
  for (const std::string& t : texts) longest = std::max(longest, t.size());
  std::string packed(longest * texts.size(), '\0');
  for (std::size_t k = 0; k < texts.size(); ++k) texts[k].copy(&packed[k * longest], longest);
  impl_->attribute(path, attribute, text_type(longest), simple_space({texts.size()}), packed.data());
}

void H5File::set_counts(const std::string& path, const std::string& attribute,
                        const std::vector<std::uint64_t>& values) {
  const Quiet quiet;
  const Handle space = values.size() == 1 ? Handle(H5Screate(H5S_SCALAR), H5Sclose) : simple_space({values.size()});
  impl_->attribute(path, attribute, H5T_NATIVE_UINT64, space, values.data());
}

bool H5File::has_attribute(const std::string& path, const std::string& attribute) const {
  const Quiet quiet;
  return impl_->exists(path) && H5Aexists(impl_->object(path, false), attribute.c_str()) > 0;
}

std::string H5File::text(const std::string& path, const std::string& attribute) const {
  const Quiet quiet;
  const Handle on = impl_->object(path, false);
  const Handle a = impl_->open_attribute(on, path, attribute);
  const Handle type(H5Aget_type(a), H5Tclose);
  impl_->need(H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0,
              "attribute \"" + attribute + "\" of \"" + path + "\" is not text");
  std::string out(H5Tget_size(type), '\0');
  impl_->need(H5Aread(a, type, &out[0]) >= 0, "cannot read attribute \"" + attribute + "\" of \"" + path + "\"");
  return out.substr(0, out.find('\0'));
}

std::uint64_t H5File::count(const std::string& path, const std::string& attribute) const {
  const Quiet quiet;
  const Handle on = impl_->object(path, false);
  const Handle a = impl_->open_attribute(on, path, attribute);
  const Handle space(H5Aget_space(a), H5Sclose);
  std::uint64_t out = 0;
  impl_->need(H5Sget_simple_extent_npoints(space) == 1 && H5Aread(a, H5T_NATIVE_UINT64, &out) >= 0,
              "cannot read attribute \"" + attribute + "\" of \"" + path + "\"");
  return out;
}

}  // namespace calx
