// Looking ahead for the inside before looking at cells.
//
// Source: Jamriska 2010, section 7. Ours differs in checking what the shortcut needs (accel/occluders.hpp),
// and in taking an edge through which a ray goes for a first surface block, because the plain walk may look
// at the blocks beside it.
#pragma once

#include "levelray/accel/occluders.hpp"
#include "levelray/accel/plain_walk.hpp"

namespace levelray {

enum class Ahead {
  nothing, // the ray meets no surface block
  inside,  // it meets an inside block, so it crosses the surface
  unknown  // it meets surface blocks, and no inside one within the steps allowed: walk on from `restart`
};

// Goes through the ray's blocks, one by one, until it has been inside or taken `most_steps` more from the
// first surface block. `restart` comes as the ray's beginning and leaves as the place where a plain walk has
// to begin that shall miss nothing; `begun` says whether that is behind the beginning. Adds a count per
// block.
inline Ahead look_ahead(const Occluders& occluders, int most_steps, walk::BlockSteps& restart, bool& begun,
                        std::uint32_t& count) {
  walk::BlockSteps steps = restart;
  bool met_surface = false, moved = false;
  int further = 0;
  for (;;) {
    ++count;
    if (occluders.inside(steps.entry()) >> steps.bit() & 1) return Ahead::inside;
    if (!met_surface && steps.on_surface()) {
      met_surface = true;
      restart = steps, begun = moved;
    }
    if (met_surface && further++ >= most_steps) return Ahead::unknown;
    int tied;
    if (!steps.next_planes(tied)) break;
    if (!met_surface && (tied & (tied - 1))) {
      met_surface = true;
      restart = steps, begun = moved;
    }
    if (!steps.cross(tied)) break;
    moved = true;
  }
  return met_surface ? Ahead::unknown : Ahead::nothing;
}

} // namespace levelray
