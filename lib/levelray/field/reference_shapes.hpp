// The one list of shapes with known answers, which tests and measurements run over.
//
// Each is about one unit long, lies off the origin and off every lattice, and is turned unless its name says
// that it is not. A resolution of N means voxels of 1/N: at 32 the slab is 0.8 voxels thick, the shell 1.2,
// and the thin torus' tube has a radius of 1.
#pragma once

#include "levelray/core/methods.hpp"
#include "levelray/field/capsule.hpp"
#include "levelray/field/cone.hpp"
#include "levelray/field/gyroid.hpp"
#include "levelray/field/oriented_box.hpp"
#include "levelray/field/shell.hpp"
#include "levelray/field/sphere.hpp"
#include "levelray/field/torus.hpp"

namespace levelray {

namespace shapes {

inline const Vec3d place(0.0137, -0.0241, 0.0312);
inline const Vec3d tilt = Vec3d(0.42, 0.31, 0.85).normalized();

struct Ball : Sphere {
  static constexpr std::string_view name = "sphere", source = "radius 0.5";
  Ball() : Sphere{place, 0.5} {}
};
struct FatTorus : Torus {
  static constexpr std::string_view name = "torus", source = "radius 0.35, tube 0.15";
  FatTorus() : Torus{Frame::along(place, tilt), 0.35, 0.15} {}
};
struct ThinTorus : Torus {
  static constexpr std::string_view name = "thin-torus", source = "radius 0.46, tube 1/32";
  ThinTorus() : Torus{Frame::along(place, tilt), 0.46, 0.03125} {}
};
struct AlignedBox : OrientedBox {
  static constexpr std::string_view name = "box", source = "1 x 0.62 x 0.44, along the axes";
  AlignedBox() : OrientedBox{Frame{place}, Vec3d(0.5, 0.31, 0.22)} {}
};
struct TurnedBox : OrientedBox {
  static constexpr std::string_view name = "rotated-box", source = "0.8 x 0.56 x 0.4, turned";
  TurnedBox() : OrientedBox{Frame::along(place, tilt), Vec3d(0.4, 0.28, 0.2)} {}
};
struct Slab : OrientedBox {
  static constexpr std::string_view name = "slab", source = "0.8 x 0.8 x 1/40, turned";
  Slab() : OrientedBox{Frame::along(place, tilt), Vec3d(0.4, 0.4, 0.0125)} {}
};
struct HollowBall : Shell {
  static constexpr std::string_view name = "shell", source = "radius 0.48, 0.0375 thick";
  HollowBall() : Shell{place, 0.48, 0.0375} {}
};
struct GyroidSheet : Gyroid {
  static constexpr std::string_view name = "gyroid",
                                    source = "Schoen 1970, 2.4 periods, sheet of about 0.05, cut by a ball";
  GyroidSheet() : Gyroid{place, 0.5, 15, 0.55} {}
};
struct RoundCone : Cone {
  static constexpr std::string_view name = "cone", source = "height 0.8, radius 0.35, capped";
  RoundCone() : Cone{Frame::along(place, tilt), 0.8, 0.35} {}
};
struct RoundedRod : Capsule {
  static constexpr std::string_view name = "capsule", source = "length 0.76, radius 0.18, with its ends";
  RoundedRod() : Capsule{Frame::along(place, tilt), 0.2, 0.18} {}
};

} // namespace shapes

using ReferenceShapes =
    std::tuple<shapes::Ball, shapes::FatTorus, shapes::ThinTorus, shapes::AlignedBox, shapes::TurnedBox,
               shapes::Slab, shapes::HollowBall, shapes::GyroidSheet, shapes::RoundCone, shapes::RoundedRod>;

} // namespace levelray
