// Vector, box and matrix types: Imath's, under the names the rest of levelray uses.
#pragma once

#include <ImathBox.h>
#include <ImathMatrix.h>
#include <ImathVec.h>

namespace levelray {

using Vec3d = Imath::V3d;
using Vec3f = Imath::V3f;
using Vec3i = Imath::V3i;
using Box3d = Imath::Box3d;
using Box3i = Imath::Box3i;
using Matrix44d = Imath::M44d;

} // namespace levelray
