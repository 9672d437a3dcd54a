// Meshes made for measuring: sound ones, and what can be wrong with a mesh. Outward where nothing else is
// said.
#pragma once

#include "levelray/mesh/triangle_mesh.hpp"

namespace levelray {

TriangleMesh tetrahedron_mesh();
// The faces' two triangles each in the order -x +x -y +y -z +z.
TriangleMesh box_mesh(const Vec3d& min = Vec3d(0, 0, 0), const Vec3d& max = Vec3d(1, 1, 1));
// Around z, n by m quads.
TriangleMesh torus_mesh(std::uint32_t n, std::uint32_t m, double big = 1, double small = 0.4);
// n by m quads between poles on z.
TriangleMesh ball_mesh(std::uint32_t n, std::uint32_t m, double radius);
// A strip of n quads that closes with a half turn.
TriangleMesh moebius_mesh(std::uint32_t n);

TriangleMesh joined_meshes(TriangleMesh a, const TriangleMesh& b);
TriangleMesh moved_mesh(TriangleMesh mesh, const Vec3d& by, double scale = 1);
TriangleMesh without_triangles(TriangleMesh mesh, std::size_t first, std::size_t count);
TriangleMesh inverted_mesh(TriangleMesh mesh);
TriangleMesh turned_faces(TriangleMesh mesh, int every); // the first of every so many

// A torus with five holes of one or two triangles.
TriangleMesh with_five_holes();
// torus_mesh(16, 8) with triangles that are points and segments beside its own.
TriangleMesh with_degenerates();
// A box whose upper face has a fan around a point 1e-12 from its edge: closed, with slivers.
TriangleMesh with_slivers();
// A box of 1 x 0.8 x 0.6 whose upper face meets the sides' edges in vertices that those do not have.
TriangleMesh with_t_junctions();
// On the vertical edge at (1, 1).
TriangleMesh boxes_with_a_common_edge();

} // namespace levelray
