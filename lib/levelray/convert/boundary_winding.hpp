// The winding number of the caps: what tells the winding number of an open mesh from the integer of the
// closed one.
#pragma once

#include "levelray/convert/voxel_mesh.hpp"

#include <vector>

namespace levelray {

// w(mesh, p) = w(mesh and caps, p) - w(caps, p): the first term is an integer that crossings count exactly,
// the second a sum over a few triangles. So the generalised winding number (Jacobson et al. 2013) of an open
// mesh costs no tree over its triangles.
//
// Sums over many caps go through a tree of clusters that far points see as one dipole (Barill et al. 2018,
// order 1), but unlike theirs with a rigorous bound of what that leaves out, so that a caller can tell when a
// decision needs the direct sum.
class BoundaryWinding {
 public:
  explicit BoundaryWinding(const VoxelMesh& mesh);

  bool empty() const { return caps_.empty(); }

  // Whether there are so many caps that direct sums would take minutes: soups of thousands of unconnected
  // triangles.
  bool many() const { return caps_.size() > 3000; }

  // w(caps, p) lies in [value - error, value + error]; p in voxel space.
  struct Estimate {
    double value = 0, error = 0;
  };
  // A cluster is seen as a dipole when that errs by less than `accepted` full angles; the errors are summed.
  Estimate estimate(const Vec3d& p, double accepted = 0.01) const;
  // The direct sum, in double.
  double exact(const Vec3d& p) const;

  // An upper bound of |w(caps, q) - w(caps, center)| over q with |q - center| <= radius, where no cap lies in
  // the convex set of interest.
  //
  // w(caps) is the scalar potential of a unit current along the caps' boundary, so |grad w| <= 1/(4 pi)
  // integral |dl| / d^2 (Biot & Savart); d >= distance of the edge from the centre - radius. Infinite when an
  // edge is nearer than that.
  double variation(const Vec3d& center, double radius) const;

 private:
  // A subtree over items begin .. end-1 (caps, or edges): a ball around them, and their sums.
  struct Cluster {
    Vec3d center{0, 0, 0};
    double radius = 0;
    Vec3d dipole{0, 0, 0}; // caps: sum of area vectors
    double size = 0;       // caps: sum of areas; edges: sum of lengths
    std::uint32_t begin = 0, end = 0;
    std::uint32_t skip =
        0; // index of the next cluster that is not below this one: clusters are in depth-first order
    bool leaf = false;
  };
  struct Cap {
    Vec3d corner[3];
  };
  struct Edge {
    Vec3d corner[2];
  };
  template <class Item>
  static void build(std::vector<Item>& items, std::uint32_t begin, std::uint32_t end,
                    std::vector<Cluster>& clusters);

  std::vector<Cap> caps_;
  std::vector<Edge> edges_;
  std::vector<Cluster> cap_clusters_, edge_clusters_;
};

} // namespace levelray
