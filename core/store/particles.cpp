// particles.cpp: insertion, removal, reordering and saving of particles.
#include "store/particles.hpp"

#include "base/error.hpp"

namespace calx {
namespace {

template <class T>
void take(Column<T>& column, const std::vector<std::uint32_t>& order) {
  Column<T> old;
  old.swap(column);
  column.resize(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) column[k] = old[order[k]];
}

/// Sphere numbers of the particles in the order given.
std::vector<std::uint32_t> sphere_order(const Particles& p, const std::vector<std::uint32_t>& order) {
  std::vector<std::uint32_t> out;
  out.reserve(p.member.size());
  for (const auto k : order)
    for (std::uint32_t s = p.first_sphere[k]; s < p.first_sphere[k + 1]; ++s) out.push_back(s);
  return out;
}

}  // namespace

double Particles::kinetic_energy(std::size_t p) const {
  const Record& b = body[p];
  const Vec3 i = inertia(p), w = rotate(conjugate(turn[p]), spin(b));
  return 0.5 * b.m * norm2(velocity(b)) + 0.5 * (i.x * w.x * w.x + i.y * w.y * w.y + i.z * w.z * w.z);
}

std::size_t Particles::insert(std::uint32_t shape_index, std::uint32_t material_index, double s, const Vec3& x,
                              const Quat& q, const Vec3& v, const Vec3& w) {
  const Shape& sh = shapes[shape_index];
  const double m = density[material_index] * sh.volume * s * s * s;
  Record b{x.x, x.y, x.z, sh.bound * s, v.x, v.y, v.z, m, w.x, w.y, w.z, 0};
  const std::size_t rank = body.size();
  body.push_back(b);
  turn.push_back(q);
  if (keeps_wrench) wrench.push_back({});
  id.push_back(next_id++);
  shape.push_back(shape_index);
  material.push_back(material_index);
  scale.push_back(s);
  body[rank].aux = sh.single() ? 1 / inertia(rank).x : 0;
  if (first_sphere.empty()) first_sphere.push_back(0);
  const auto first = first_sphere.back();
  first_sphere.push_back(first + static_cast<std::uint32_t>(sh.members.size()));
  for (const auto& member_of : sh.members) {
    sphere_id.push_back(next_sphere_id++);
    if (!has_clumps) continue;
    Record r = b;
    r.r = member_of.radius * s;
    member.push_back(r);
    owner.push_back(static_cast<std::uint32_t>(rank));
  }
  if (has_clumps) refresh_members(rank, rank + 1);
  return rank;
}

void Particles::remove(const std::vector<std::uint8_t>& mark) {
  std::vector<std::uint32_t> order;
  for (std::uint32_t k = 0; k < count(); ++k)
    if (!mark[k]) order.push_back(k);
  permute(order);
}

void Particles::permute(const std::vector<std::uint32_t>& order) {
  std::vector<std::uint32_t> spheres;
  if (has_clumps) spheres = sphere_order(*this, order);
  take(body, order);
  take(turn, order);
  if (keeps_wrench) take(wrench, order);
  take(id, order);
  take(shape, order);
  take(material, order);
  take(scale, order);
  take(sphere_id, has_clumps ? spheres : order);
  first_sphere.resize(order.size() + 1);
  first_sphere[0] = 0;
  for (std::size_t k = 0; k < order.size(); ++k)
    first_sphere[k + 1] = first_sphere[k] + static_cast<std::uint32_t>(shapes[shape[k]].members.size());
  if (!has_clumps) return;
  take(member, spheres);
  owner.resize(spheres.size());
  for (std::uint32_t k = 0; k < order.size(); ++k)
    for (std::uint32_t s = first_sphere[k]; s < first_sphere[k + 1]; ++s) owner[s] = k;
}

void Particles::refresh_members(std::size_t first, std::size_t last) {
  for (std::size_t p = first; p < last; ++p) {
    const Record& b = body[p];
    const Shape& sh = shapes[shape[p]];
    std::uint32_t s = first_sphere[p];
    for (const auto& at : sh.members) {
      const Vec3 arm = rotate(turn[p], scale[p] * at.at), v = cross(spin(b), arm);
      Record& m = member[s++];
      m.x = b.x + arm.x;
      m.y = b.y + arm.y;
      m.z = b.z + arm.z;
      m.vx = b.vx + v.x;
      m.vy = b.vy + v.y;
      m.vz = b.vz + v.z;
      m.wx = b.wx;
      m.wy = b.wy;
      m.wz = b.wz;
    }
  }
}

void Particles::save(StateWriter& out) const {
  const auto* records = reinterpret_cast<const double*>(body.data());
  out.put("particles/body", records, body.size() * 12, "m,m/s,kg,rad/s");
  out.put("particles/turn", reinterpret_cast<const double*>(turn.data()), turn.size() * 4, "1");
  out.put("particles/wrench", reinterpret_cast<const double*>(wrench.data()), wrench.size() * 6, "N,N*m");
  out.put("particles/scale", scale.data(), scale.size(), "1");
  out.put("particles/id", id.data(), id.size());
  out.put("particles/shape", shape.data(), shape.size());
  out.put("particles/material", material.data(), material.size());
  out.put("particles/sphere_id", sphere_id.data(), sphere_id.size());
  out.put_count("particles/next_id", next_id);
  out.put_count("particles/next_sphere_id", next_sphere_id);
}

void Particles::load(const StateReader& in) {
  const auto records = in.get_doubles("particles/body"), turns = in.get_doubles("particles/turn"),
             wrenches = in.get_doubles("particles/wrench"), scales = in.get_doubles("particles/scale");
  const auto ids = in.get_u32("particles/id"), shape_numbers = in.get_u32("particles/shape"),
             materials = in.get_u32("particles/material"), sphere_ids = in.get_u32("particles/sphere_id");
  const std::size_t n = ids.size();
  body.resize(n);
  turn.resize(n);
  wrench.resize(keeps_wrench ? n : 0);
  for (std::size_t k = 0; k < n; ++k) {
    const double* b = records.data() + 12 * k;
    body[k] = {b[0], b[1], b[2], b[3], b[4], b[5], b[6], b[7], b[8], b[9], b[10], b[11]};
    const double* q = turns.data() + 4 * k;
    turn[k] = {q[0], q[1], q[2], q[3]};
  }
  if (keeps_wrench && wrenches.size() != 6 * n)
    throw Error(Fault::files,
                "checkpoint: it was written by another integrator; verlet needs the forces of its last step");
  for (std::size_t k = 0; k < wrench.size(); ++k) {
    const double* w = wrenches.data() + 6 * k;
    wrench[k] = {w[0], w[1], w[2], w[3], w[4], w[5]};
  }
  scale.assign(scales.begin(), scales.end());
  id.assign(ids.begin(), ids.end());
  shape.assign(shape_numbers.begin(), shape_numbers.end());
  material.assign(materials.begin(), materials.end());
  sphere_id.assign(sphere_ids.begin(), sphere_ids.end());
  next_id = static_cast<std::uint32_t>(in.get_count("particles/next_id"));
  next_sphere_id = static_cast<std::uint32_t>(in.get_count("particles/next_sphere_id"));
  first_sphere.assign(n + 1, 0);
  for (std::size_t k = 0; k < n; ++k)
    first_sphere[k + 1] = first_sphere[k] + static_cast<std::uint32_t>(shapes[shape[k]].members.size());
  member.clear();
  owner.clear();
  if (!has_clumps) return;
  member.resize(first_sphere[n]);
  owner.resize(first_sphere[n]);
  for (std::uint32_t k = 0; k < n; ++k) {
    std::uint32_t s = first_sphere[k];
    for (const auto& at : shapes[shape[k]].members) {
      owner[s] = k;
      member[s].r = at.radius * scale[k];
      member[s++].m = body[k].m;
    }
  }
  refresh_members(0, n);
}

}  // namespace calx
