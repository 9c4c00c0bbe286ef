// particles.hpp: particles (rigid clumps) and their spheres as arrays of cache-line records.
// Particles stand in rank order (sorted by cell at each list rebuild); ids are given at insertion and kept for life.
// Spheres of one particle are consecutive, in the order of the particles. Typical: 1e4 to 1e7 particles, each record
// read and written every step.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "base/column.hpp"
#include "base/state.hpp"
#include "base/vec3.hpp"

namespace calx {

/// One sphere as the pair loop sees it, or one particle as the integrator sees it (r: bounding radius, m). 96 bytes.
struct Record {
  double x, y, z, r;     // m
  double vx, vy, vz, m;  // m/s; kg, mass of the whole particle
  double wx, wy, wz;     // rad/s, world frame
  double aux;            // particle of one sphere: 1 / moment of inertia, 1/(kg m^2); else unused
};
inline Vec3 position(const Record& b) { return {b.x, b.y, b.z}; }
inline Vec3 velocity(const Record& b) { return {b.vx, b.vy, b.vz}; }
inline Vec3 spin(const Record& b) { return {b.wx, b.wy, b.wz}; }

/// Force, N, and torque, N m, about the centre of the sphere or particle, world frame.
struct Wrench {
  double fx = 0, fy = 0, fz = 0, tx = 0, ty = 0, tz = 0;
  Wrench& operator+=(const Wrench& b) {
    fx += b.fx, fy += b.fy, fz += b.fz, tx += b.tx, ty += b.ty, tz += b.tz;
    return *this;
  }
};
inline Vec3 force_of(const Wrench& w) { return {w.fx, w.fy, w.fz}; }
inline Vec3 torque_of(const Wrench& w) { return {w.tx, w.ty, w.tz}; }
inline Wrench wrench_of(const Vec3& f, const Vec3& t) { return {f.x, f.y, f.z, t.x, t.y, t.z}; }

/// A shape of scale 1 in its principal frame, centre of mass at the origin.
struct Shape {
  std::string name;
  struct Member {
    Vec3 at;  // m
    double radius = 0;
  };
  std::vector<Member> members;
  double volume = 0;        // m^3, of the union
  Vec3 inertia;             // m^5, principal moments for unit density
  double bound = 0;         // m, radius of the enclosing sphere about the centre of mass
  double equal_radius = 0;  // m, of the sphere of equal volume
  Quat frame;               // turns the principal frame into the frame the user drew the shape in
  Vec3 centre;              // m, centre of mass in the user's frame
  bool single() const { return members.size() == 1; }
};

/// Volume, centre of mass, principal axes and moments of a union of spheres. One sphere and two overlapping or touching
/// spheres: closed form (EPAM.md section 5, generalised to unequal radii). More: a deterministic quadrature, relative
/// error below 1e-4. Throws std::invalid_argument for no sphere, a radius <= 0 or two spheres that do not touch and are
/// not joined by others.
Shape make_shape(const std::string& name, const std::vector<Shape::Member>& spheres);

struct Particles {
  // One row per particle, rank order.
  Column<Record> body;
  Column<Quat> turn;                                        // principal frame to world
  Column<Wrench> wrench;                                    // sums of the last step; empty unless keeps_wrench
  Column<std::uint32_t> id, shape, material, first_sphere;  // first_sphere has count()+1 entries
  Column<double> scale;
  // One row per sphere. When every shape is a single sphere the spheres are the bodies and this array is empty.
  Column<Record> member;
  Column<std::uint32_t> owner;      // rank of the sphere's particle
  Column<std::uint32_t> sphere_id;  // kept for life
  std::vector<Shape> shapes;
  std::vector<double> density;  // kg/m^3, per material
  bool has_clumps = false;
  bool keeps_wrench = false;  // verlet needs the sums of the step before
  std::uint32_t next_id = 0, next_sphere_id = 0;

  std::size_t count() const { return body.size(); }
  std::size_t sphere_count() const { return has_clumps ? member.size() : body.size(); }
  Record* spheres() { return has_clumps ? member.data() : body.data(); }
  const Record* spheres() const { return has_clumps ? member.data() : body.data(); }
  std::uint32_t owner_of(std::size_t sphere) const {
    return has_clumps ? owner[sphere] : static_cast<std::uint32_t>(sphere);
  }
  double mass(std::size_t p) const { return body[p].m; }
  double equal_radius(std::size_t p) const { return shapes[shape[p]].equal_radius * scale[p]; }
  /// Principal moments of particle p, kg m^2.
  Vec3 inertia(std::size_t p) const {
    const double s = scale[p], s2 = s * s;
    return (density[material[p]] * s2 * s2 * s) * shapes[shape[p]].inertia;
  }
  double kinetic_energy(std::size_t p) const;  // J, translation and rotation

  /// Appends one particle; its spheres follow. Returns its rank.
  std::size_t insert(std::uint32_t shape, std::uint32_t material, double scale, const Vec3& x, const Quat& turn,
                     const Vec3& v, const Vec3& w);
  /// Removes the particles marked, keeping the order of the others.
  void remove(const std::vector<std::uint8_t>& mark);
  /// New rank k takes the particle that had rank order[k].
  void permute(const std::vector<std::uint32_t>& order);
  /// Puts member spheres where the bodies are.
  void refresh_members(std::size_t first, std::size_t last);

  void save(StateWriter& out) const;
  void load(const StateReader& in);
};

}  // namespace calx
