// The trade of error for time and memory, a row for each configuration.
#pragma once

#include "levelray/measure/error_statistics.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace levelray {

// One configuration: a resolution with an intersector, or with a normal scheme.
struct TradeRow {
  int resolution = 0; // 0: the only one
  std::string method;
  bool is_normals = false;
  ErrorStatistics error;  // of hits: distance from the surface in world units; of normals: degrees
  std::uint64_t lost = 0; // leaks, phantoms and wrong surfaces against the grid's own surface, of all rays
  double ns = 0, megabytes = 0; // per random ray, or per hit
  bool in_front = false; // no other of its kind is better in one of error (mean), losses, time, memory and
                         // at least as good in the others
};

// Finds out `in_front`.
void mark_front(std::vector<TradeRow>& rows);

} // namespace levelray
