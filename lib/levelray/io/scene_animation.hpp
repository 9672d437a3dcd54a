// What moves in a scene, at one frame.
#pragma once

#include "levelray/io/scene_file.hpp"
#include "levelray/render/camera.hpp"
#include "levelray/render/similarity.hpp"

namespace levelray {

// The value at `frame` of a curve through (frames[i], values[i]), frames rising, at least one. Before the
// first and after the last frame it rests at their values. Between them it is straight or, when `smooth`, a
// cubic per interval with the slopes of Fritsch and Butland 1984 ("A method for constructing local monotone
// piecewise cubic interpolants", SIAM J. Sci. Stat. Comput. 5(2), eq. 5) inside and 0 at the ends: velocity
// is continuous everywhere, and the curve never leaves the interval's two values.
double curve_at(const std::vector<double>& frames, const std::vector<double>& values, double frame,
                bool smooth);

// The film's camera. Each of eye, target, up and fov follows those keys that name it, component by component.
// Throws Error(usage), naming file, line and frame, where the camera looks nowhere.
CameraSettings camera_at(const SceneFile& scene, double frame);

// Translation component by component, scale by its logarithm, so that it stays positive and grows evenly.
// Rotation: when all keys turn around the same axis, the angle, over any number of turns; else between
// neighbours the shortest great arc (Shoemake 1985, "Animating rotation with quaternion curves", section 3.3)
// or, when smooth, the normalised curve of the quaternions' components.
Similarity placement_at(const TransformFile& transform, double frame);

} // namespace levelray
