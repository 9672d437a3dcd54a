// Which shells bound material and which bound a void, and which of them are inside out.
#pragma once

#include "levelray/mesh/edge_table.hpp"

namespace levelray {

struct Shell {
  double volume =
      0;        // signed, as the triangles are oriented; open ones capped towards their boundary's centroid
  int sign = 0; // of the volume; 0 where it is no more than rounding, or an open shell is more of a sheet
                // than a body
  bool open = false; // its oriented boundary is not empty
  bool turn = false; // has to be turned
  Box3d bounds;
};

// Measures each shell of a mesh whose triangles carry shell labels (find_shells) and decides which to turn.
//
// The oriented mesh says of each point how many shells wind around it. Shells are looked at from the
// outermost in: a shell that would make the number inside of it negative, given the shells that it lies in,
// is turned, and all that lies inside of it with it, since the input's statement about those is relative (an
// inverted hollow body turns as a whole). A shell that lies in no other is so turned when its volume is
// negative; an inverted shell inside a body is a cavity and stays.
//
// `repaired` names shells with clashes: their direction is the area majority's, not the input's word, so they
// do not turn with what they lie in.
std::vector<Shell> measure_shells(const TriangleMesh& mesh, const EdgeTable& edges,
                                  const std::vector<std::uint32_t>& shell_of, std::uint32_t shell_count,
                                  const std::vector<bool>& repaired);

} // namespace levelray
