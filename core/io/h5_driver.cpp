#include "io/h5_driver.hpp"

#include <hdf5.h>

#include <mutex>
#include <new>

#include "io/staged_file.hpp"

namespace calx {
namespace {

/// HDF5 hands this object back as H5FD_t*, its first member.
struct Driven {
  H5FD_t pub;
  StagedFile* file;
  haddr_t end_of_space;
};

Driven* driven(H5FD_t* f) { return reinterpret_cast<Driven*>(f); }
const Driven* driven(const H5FD_t* f) { return reinterpret_cast<const Driven*>(f); }

H5FD_t* open_file(const char*, unsigned, hid_t access, haddr_t) {
  const void* info = H5Pget_driver_info(access);
  if (info == nullptr) return nullptr;
  Driven* d = new (std::nothrow) Driven{};
  if (d == nullptr) return nullptr;
  d->file = *static_cast<StagedFile* const*>(info);
  return &d->pub;
}

herr_t close_file(H5FD_t* f) {
  delete driven(f);
  return 0;
}

herr_t query(const H5FD_t*, unsigned long* flags) {
  if (flags != nullptr) {
    *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
             H5FD_FEAT_AGGREGATE_SMALLDATA;
  }
  return 0;
}

haddr_t get_end_of_space(const H5FD_t* f, H5FD_mem_t) { return driven(f)->end_of_space; }

herr_t set_end_of_space(H5FD_t* f, H5FD_mem_t, haddr_t end) {
  driven(f)->end_of_space = end;
  return 0;
}

haddr_t get_end_of_file(const H5FD_t* f, H5FD_mem_t) { return driven(f)->file->size(); }

herr_t read_file(H5FD_t* f, H5FD_mem_t, hid_t, haddr_t at, size_t count, void* out) {
  return driven(f)->file->read(at, count, out) ? 0 : -1;
}

herr_t write_file(H5FD_t* f, H5FD_mem_t, hid_t, haddr_t at, size_t count, const void* data) {
  try {
    StagedFile& file = *driven(f)->file;
    file.write(at, count, data);
    if (at + count > file.size()) file.set_size(at + count);
    return 0;
  } catch (const std::bad_alloc&) {
    return -1;
  }
}

herr_t truncate_file(H5FD_t* f, hid_t, hbool_t) {
  driven(f)->file->set_size(driven(f)->end_of_space);
  return 0;
}

hid_t register_driver() {
  H5FD_class_t c{};
#if H5_VERSION_GE(1, 13, 2)
  c.version = H5FD_CLASS_VERSION;
  c.value = static_cast<H5FD_class_value_t>(511);  // of the range 256..511 kept for private drivers
#endif
  c.name = "calx_staged";
  c.maxaddr = static_cast<haddr_t>(1) << 62;
  c.fc_degree = H5F_CLOSE_STRONG;
  c.fapl_size = sizeof(StagedFile*);
  c.open = open_file;
  c.close = close_file;
  c.query = query;
  c.get_eoa = get_end_of_space;
  c.set_eoa = set_end_of_space;
  c.get_eof = get_end_of_file;
  c.read = read_file;
  c.write = write_file;
  c.truncate = truncate_file;
  const H5FD_mem_t map[H5FD_MEM_NTYPES] = H5FD_FLMAP_DICHOTOMY;
  for (int k = 0; k < H5FD_MEM_NTYPES; ++k) c.fl_map[k] = map[k];
  return H5FDregister(&c);
}

}  // namespace

std::int64_t h5_access_through(StagedFile& file) {
  static std::mutex registering;
  const std::lock_guard<std::mutex> lock(registering);
  static hid_t driver = -1;
  // An embedding program may close and reopen the HDF5 library, which forgets drivers.
  if (driver < 0 || H5Iget_type(driver) != H5I_VFL) driver = register_driver();
  if (driver < 0) return -1;
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  StagedFile* info = &file;
  if (access >= 0 && H5Pset_driver(access, driver, &info) < 0) {
    H5Pclose(access);
    return -1;
  }
  return access;
}

}  // namespace calx
