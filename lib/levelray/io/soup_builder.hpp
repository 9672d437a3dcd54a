// What all mesh readers do with the vertices and polygons they find: check, triangulate, count, remark.
#pragma once

#include "levelray/io/mesh_reader.hpp"
#include "levelray/io/mesh_source.hpp"
#include "levelray/io/polygon_triangulation.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace levelray {

inline constexpr std::size_t max_polygon_corners = 65535;

// Collects a mesh. Places (`at`) point into the source. Every function may throw Error(limit) when the mesh
// becomes larger than options.max_memory, and Cancelled.
class SoupBuilder {
 public:
  SoupBuilder(MeshSource& source, const MeshReadOptions& options);

  MeshSource& source() noexcept { return source_; }
  const MeshReadOptions& options() const noexcept { return options_; }
  std::uint64_t vertex_count() const noexcept { return mesh_.vertices.size(); }

  // Makes room; the numbers must have been checked against the file's size.
  void reserve(std::uint64_t vertices, std::uint64_t triangles);

  // Throws Error(bad_input) for NaN and infinities, unless bad ones are to be dropped. Turns -0 into 0.
  void add_vertex(double x, double y, double z, const char* at);

  // Corners are vertex indices from 0; those of vertices still to come are looked up at the end. Corners that
  // repeat their neighbour are removed; polygons with fewer than three corners are skipped and counted.
  void add_polygon(const std::vector<std::uint64_t>& corners, const char* at);
  // A triangle of vertices that are there; dropped without a remark when it repeats one (strips do).
  void add_strip_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);

  // A remark for the user: one line.
  void warn(const std::string& text) { warnings_.push_back(text); }
  // What the file holds instead, for the message when there are no faces: "12 line elements".
  void set_other_content(const std::string& text) { other_content_ = text; }
  // The file ends too early: throws, or with options.salvage remarks that the rest is used.
  void truncated(const char* at, const std::string& reason);

  // Checks indices, drops what is to be dropped, writes the remarks. Throws Error(bad_input) without faces.
  MeshFile finish(const std::string& format, const std::string& format_name);

 private:
  struct Count {
    std::uint64_t number = 0;
    const char* first = nullptr;
    void add(const char* at) {
      if (number++ == 0) first = at;
    }
  };
  struct Deferred { // a polygon with a vertex that was not there yet
    const char* at;
    std::size_t first_corner;
  };

  void add_known_polygon(const char* at);
  void push_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);
  bool is_bad(std::uint32_t vertex) const;
  void look_around(); // limits and cancellation, now and then
  void add_deferred();
  void drop_bad_vertices();
  void write_remarks();
  void remark(const Count& count, const char* one, const char* many);

  MeshSource& source_;
  const MeshReadOptions& options_;
  TriangleMesh mesh_;
  std::vector<std::string> warnings_;
  std::string other_content_;
  std::vector<Deferred> deferred_;
  std::vector<std::uint64_t> deferred_corners_;
  std::uint32_t until_look_ = 0;

  std::vector<std::uint32_t> corners_; // scratch of add_polygon
  std::vector<Vec3d> points_;
  std::vector<Triangle> pieces_;
  PolygonTriangulator triangulator_;

  Count bad_vertices_, dropped_faces_, lost_faces_, short_faces_, repeated_corners_, not_planar_, not_simple_;
  double largest_deviation_ = 0;
  bool cut_ = false; // truncated, and salvaged
};

} // namespace levelray
