// What Jamriska 2010 prints in Tables 1 to 4, the one copy of it: 512x512 pixels, 4 threads of two Xeon E5440
// (2.83 GHz); steps and tests in thousands, times in milliseconds, savings in percent of the first time.
#pragma once

#include <string_view>

namespace levelray {

inline constexpr int printed_image_size = 512;

// Tables 1 and 2, columns. `method` is our name.
struct PrintedMethod {
  std::string_view method, title;
  int samples, interpolations; // Table 1 has no samples: 0
  double ms;
};

// Two interpolations are printed for the midpoint; as section 4.2 describes the method it needs none.
inline constexpr PrintedMethod printed_table_1[] = {
    {"midpoint", "midpoint", 0, 2, 8.0},
    {"false-position-1", "1 iteration of false position", 0, 2, 8.4},
    {"false-position-4", "4 iterations of false position", 0, 5, 11.2}};

inline constexpr PrintedMethod printed_table_2[] = {
    {"analytic", "analytic derivative", 8, 0, 7.1},
    {"difference-of-interpolations", "difference of interpolations", 16, 3, 9.5},
    {"interpolation-of-differences", "interpolation of differences", 24, 1, 8.4}};

// Tables 3 and 4, a row of each.
inline constexpr int printed_minmax[] = {256, 128, 64};   // the buffers of Table 3
inline constexpr int printed_occluder_steps[] = {12, 32}; // n of Table 4

struct PrintedRow {
  std::string_view model;
  int voxels[3], resolution; // along x, y (up) and z; of the longest side
  // Table 3: without, and with each buffer.
  double primary_steps[4], primary_ms[4], primary_saved[3];
  // Table 4: plain, and with each n.
  double shadow_steps[3], shadow_tests[3], shadow_ms[3], shadow_saved[2];
};

// clang-format off
inline constexpr PrintedRow printed_rows[] = {
    {"bunny", {128, 128, 100}, 128,
     {5733, 2885, 3009, 3247}, {35.0, 28.6, 27.7, 28.3}, {18, 21, 19},
     {7639, 8259, 8876}, {529, 348, 320}, {66.4, 59.4, 59.7}, {10.5, 10.1}},
    {"bunny", {256, 256, 200}, 256,
     {8915, 2982, 3186, 3502}, {45.0, 33.1, 32.3, 32.2}, {27, 28, 29},
     {11153, 11663, 12360}, {542, 345, 294}, {82.8, 72.8, 71.6}, {12.2, 13.6}},
    {"bunny", {512, 508, 400}, 512,
     {15538, 3056, 3330, 4287}, {69.9, 51.1, 47.2, 50.0}, {27, 33, 28},
     {18586, 19137, 20106}, {472, 292, 232}, {123.4, 108.9, 106.6}, {11.7, 13.6}},
    {"dragon", {128, 92, 60}, 128,
     {4264, 2444, 2538, 2699}, {28.8, 24.7, 23.9, 24.2}, {14, 17, 16},
     {6694, 8145, 8548}, {426, 365, 342}, {56.6, 56.7, 56.7}, {-0.2, -0.2}},
    {"dragon", {256, 184, 116}, 256,
     {6265, 2536, 2674, 2902}, {35.2, 28.1, 27.3, 27.4}, {20, 22, 22},
     {9708, 10791, 11731}, {433, 333, 285}, {68.6, 64.7, 64.5}, {5.7, 6.0}},
    {"dragon", {512, 364, 232}, 512,
     {10435, 2411, 2620, 3260}, {50.4, 38.3, 35.7, 37.5}, {24, 29, 26},
     {15881, 16693, 17550}, {377, 264, 197}, {96.5, 87.0, 84.4}, {9.9, 12.5}},
    {"buddha", {56, 128, 56}, 128,
     {3089, 2225, 2301, 2409}, {23.8, 22.1, 21.4, 21.6}, {7, 10, 9},
     {734, 1015, 1030}, {104, 100, 100}, {16.6, 17.9, 17.9}, {-7.9, -8.3}},
    {"buddha", {108, 256, 108}, 256,
     {4146, 2467, 2568, 2740}, {28.0, 25.8, 25.9, 25.3}, {8, 8, 10},
     {1110, 1471, 1620}, {116, 107, 106}, {19.7, 21.2, 21.8}, {-7.6, -10.4}},
    {"buddha", {212, 512, 212}, 512,
     {6028, 2360, 2552, 2973}, {34.2, 33.9, 31.7, 32.5}, {1, 7, 5},
     {1581, 1963, 2295}, {96, 84, 78}, {24.6, 26.0, 26.6}, {-5.9, -8.2}},
};
// clang-format on

// The row of a model at a resolution, or null.
inline const PrintedRow* printed_row(std::string_view model, int resolution) {
  for (const PrintedRow& row : printed_rows)
    if (row.model == model && row.resolution == resolution) return &row;
  return nullptr;
}

} // namespace levelray
