// faults.hpp: what is wrong with a triangle mesh, and the same mesh without what cannot serve as a wall.
#ifndef FAULTS_HPP
#define FAULTS_HPP
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

struct Fault {
  size_t count = 0;
  double first[3] = {0, 0, 0};  // m, middle of the first edge or triangle
};

struct CheckedMesh {
  std::vector<double> xyz;      // welded vertices, m
  std::vector<uint32_t> index;  // without degenerate and duplicate triangles
  Fault open, degenerate, duplicate, inverted, non_manifold;
  /// "3 open edges (first at (0.1, 0, 0.2) m), ..."; empty when sound.
  std::string describe() const;
};

/// corners: nine coordinates a triangle, m. Vertices nearer to each other than 2.5e-7 of the size are one: STL files
/// hold single-precision numbers, which round to 6e-8 of their value.
CheckedMesh check_mesh(const std::vector<double>& corners);

#endif
