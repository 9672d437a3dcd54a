// How rays are spared work. None of it changes a picture, but for the AOVs that count the work.
#pragma once

#include "levelray/trace/trace.hpp"

namespace levelray {

struct Acceleration {
  Traversal traversal = Traversal::leaps;
  ShadowScheme shadow = ShadowScheme::boxes;
  int occluder_steps = 12; // of ShadowScheme::occluder, 0 .. 1000000
  int minmax = 0; // buffer cells along each side of the image, up to 4096, that bound primary rays; 0: none
};

} // namespace levelray
