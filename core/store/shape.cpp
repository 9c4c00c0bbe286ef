// shape.cpp: volume, centre of mass, principal axes and moments of a union of spheres.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "store/particles.hpp"

namespace calx {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Moments of a body of unit density: volume, first moments, second moments about the origin.
struct Moments {
  double v = 0;
  Eigen::Vector3d s = Eigen::Vector3d::Zero();
  Eigen::Matrix3d q = Eigen::Matrix3d::Zero();  // integral of x x^T
};

/// Integral of t^n over [a, b].
double power_integral(double a, double b, int n) { return (std::pow(b, n + 1) - std::pow(a, n + 1)) / (n + 1); }

/// The part of a sphere of radius r, centre at height z0, between heights a and b, turned about the z axis: volume,
/// first moment along z, second moment along z, and second moment along x (= along y).
void slab(double r, double z0, double a, double b, double& v, double& sz, double& qzz, double& qxx) {
  a = std::max(a, z0 - r) - z0;
  b = std::min(b, z0 + r) - z0;
  if (b <= a) return;
  // Disc of squared radius p(t) = r^2 - t^2 at t = z - z0: area pi p, second moment pi p^2 / 4.
  const double i0 = power_integral(a, b, 0), i1 = power_integral(a, b, 1), i2 = power_integral(a, b, 2),
               i3 = power_integral(a, b, 3), i4 = power_integral(a, b, 4), r2 = r * r;
  const double p0 = kPi * (r2 * i0 - i2), p1 = kPi * (r2 * i1 - i3), p2 = kPi * (r2 * i2 - i4);
  v += p0;
  sz += p1 + z0 * p0;
  qzz += p2 + 2 * z0 * p1 + z0 * z0 * p0;
  qxx += kPi / 4 * (r2 * r2 * i0 - 2 * r2 * i2 + i4);
}

/// Exact moments of the union of two spheres (EPAM.md section 5, generalised to unequal radii).
Moments pair_moments(const Shape::Member& a, const Shape::Member& b, Eigen::Vector3d& axis) {
  const Vec3 d = b.at - a.at;
  const double c = norm(d);
  axis = Eigen::Vector3d(d.x, d.y, d.z) / c;
  // Heights along the line of centres from a; the plane of intersection parts the union into two slabs.
  const double plane = (c * c + a.radius * a.radius - b.radius * b.radius) / (2 * c);
  double v = 0, sz = 0, qzz = 0, qxx = 0;
  slab(a.radius, 0, -a.radius, std::min(plane, a.radius), v, sz, qzz, qxx);
  slab(b.radius, c, std::max(plane, c - b.radius), c + b.radius, v, sz, qzz, qxx);
  Moments m;
  const Eigen::Vector3d o(a.at.x, a.at.y, a.at.z);
  m.v = v;
  const Eigen::Vector3d local = sz * axis;
  m.s = local + v * o;
  m.q = qxx * (Eigen::Matrix3d::Identity() - axis * axis.transpose()) + qzz * axis * axis.transpose() +
        local * o.transpose() + o * local.transpose() + v * o * o.transpose();
  return m;
}

/// Moments by lines along z through a 600 x 600 grid of midpoints, exact along each line: relative error about 1e-5.
Moments grid_moments(const std::vector<Shape::Member>& spheres) {
  constexpr int kLines = 600;
  Box box;
  for (const auto& s : spheres) {
    const Vec3 r{s.radius, s.radius, s.radius};
    box.add(s.at - r);
    box.add(s.at + r);
  }
  const double hx = (box.hi.x - box.lo.x) / kLines, hy = (box.hi.y - box.lo.y) / kLines, w = hx * hy;
  Moments m;
  std::vector<std::pair<double, double>> spans;
  for (int iy = 0; iy < kLines; ++iy) {
    for (int ix = 0; ix < kLines; ++ix) {
      const double x = box.lo.x + (ix + 0.5) * hx, y = box.lo.y + (iy + 0.5) * hy;
      spans.clear();
      for (const auto& s : spheres) {
        const double h2 = s.radius * s.radius - (x - s.at.x) * (x - s.at.x) - (y - s.at.y) * (y - s.at.y);
        if (h2 > 0) spans.emplace_back(s.at.z - std::sqrt(h2), s.at.z + std::sqrt(h2));
      }
      std::sort(spans.begin(), spans.end());
      double end = -1e300;
      for (const auto& span : spans) {
        const double a = std::max(span.first, end), b = span.second;
        if (b <= a) continue;
        end = b;
        const double l = w * (b - a), z1 = w * (b * b - a * a) / 2, z2 = w * (b * b * b - a * a * a) / 3;
        m.v += l;
        m.s += Eigen::Vector3d(x * l, y * l, z1);
        m.q(0, 0) += x * x * l;
        m.q(1, 1) += y * y * l;
        m.q(2, 2) += z2;
        m.q(0, 1) += x * y * l;
        m.q(0, 2) += x * z1;
        m.q(1, 2) += y * z1;
      }
    }
  }
  m.q(1, 0) = m.q(0, 1);
  m.q(2, 0) = m.q(0, 2);
  m.q(2, 1) = m.q(1, 2);
  return m;
}

Quat quaternion(const Eigen::Matrix3d& m) {
  const Eigen::Quaterniond q(m);
  return normalized(Quat{q.w(), q.x(), q.y(), q.z()});
}

/// True when every sphere can be reached from the first over touching spheres. Centres drawn at the sum of the radii
/// touch whatever rounding made of them.
bool connected(const std::vector<Shape::Member>& spheres) {
  std::vector<std::size_t> todo{0};
  std::vector<bool> seen(spheres.size(), false);
  seen[0] = true;
  std::size_t reached = 1;
  while (!todo.empty()) {
    const auto a = spheres[todo.back()];
    todo.pop_back();
    for (std::size_t k = 0; k < spheres.size(); ++k) {
      if (seen[k] || norm(spheres[k].at - a.at) > (a.radius + spheres[k].radius) * (1 + 1e-9)) continue;
      seen[k] = true;
      ++reached;
      todo.push_back(k);
    }
  }
  return reached == spheres.size();
}

}  // namespace

Shape make_shape(const std::string& name, const std::vector<Shape::Member>& spheres) {
  if (spheres.empty()) throw std::invalid_argument("a shape needs at least one sphere");
  for (const auto& s : spheres)
    if (!(s.radius > 0)) throw std::invalid_argument("a sphere's radius must be above 0");
  if (!connected(spheres)) throw std::invalid_argument("the spheres of a shape must touch or overlap");

  Shape shape;
  shape.name = name;
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  Moments m;
  const bool pair = spheres.size() == 2 && norm(spheres[1].at - spheres[0].at) > 0;
  if (spheres.size() == 1) {
    const double r = spheres[0].radius;
    m.v = 4.0 / 3 * kPi * r * r * r;
    const Eigen::Vector3d o(spheres[0].at.x, spheres[0].at.y, spheres[0].at.z);
    m.s = m.v * o;
    m.q = m.v * (r * r / 5 * Eigen::Matrix3d::Identity() + o * o.transpose());
  } else if (pair) {
    Eigen::Vector3d axis;
    m = pair_moments(spheres[0], spheres[1], axis);
    // z along the line of centres; x is any perpendicular, chosen without a jump near the coordinate axes.
    const Eigen::Vector3d help = std::abs(axis.x()) < 0.9 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
    const Eigen::Vector3d y = axis.cross(help).normalized();
    axes.col(0) = y.cross(axis);
    axes.col(1) = y;
    axes.col(2) = axis;
  } else {
    m = grid_moments(spheres);
  }
  const Eigen::Vector3d centre = m.s / m.v;
  const Eigen::Matrix3d q = m.q - m.v * centre * centre.transpose();
  const Eigen::Matrix3d tensor = q.trace() * Eigen::Matrix3d::Identity() - q;
  if (spheres.size() > 2 || (spheres.size() == 2 && !pair)) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(tensor);
    axes = solver.eigenvectors();
    if (axes.determinant() < 0) axes.col(2) = -axes.col(2);
  }
  const Eigen::Matrix3d principal = axes.transpose() * tensor * axes;
  shape.volume = m.v;
  shape.inertia = {principal(0, 0), principal(1, 1), principal(2, 2)};
  if (spheres.size() == 1) shape.inertia.y = shape.inertia.z = shape.inertia.x;
  shape.centre = {centre.x(), centre.y(), centre.z()};
  shape.frame = spheres.size() == 1 ? Quat{} : quaternion(axes);
  shape.equal_radius = std::cbrt(3 * m.v / (4 * kPi));
  for (const auto& s : spheres) {
    const Vec3 at = spheres.size() == 1 ? Vec3{} : rotate(conjugate(shape.frame), s.at - shape.centre);
    shape.members.push_back({at, s.radius});
    shape.bound = std::max(shape.bound, norm(at) + s.radius);
  }
  return shape;
}

}  // namespace calx
