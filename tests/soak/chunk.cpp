#include "soak/chunk.hpp"

#include "levelray/trace/all_hits.hpp"
#include "levelray/trace/certified_hit.hpp"
#include "levelray/trace/level_set.hpp"
#include "levelray/vdb/peer.hpp"
#include "soak/scene.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace levelray::test {

namespace {

class Judge {
 public:
  Judge(const LevelSet& level_set, const RayOracle& oracle, Tally& tally)
      : level_set_(level_set), oracle_(oracle), tally_(tally), voxel_(level_set.grid().transform.voxel_size) {
    const BlockGrid& grid = level_set.grid();
    for (const float v : grid.values) largest_ = std::max(largest_, std::fabs(static_cast<double>(v)));
  }

  // Returns what is wrong that must not be for `exact`, or "".
  const char* judge(const WorldRay& ray, const Hit& hit, bool is_exact) {
    const Tally before = slim();
    ray_ = &ray;
    truth_ = oracle_.ask(ray);
    compare(hit, is_exact);
    tally_.exactly += truth_.exactly;
    if (is_exact) {
      parity();
      certificate(hit);
    }
    const Tally after = slim();
    return after.leaks != before.leaks                             ? "leak"
           : after.phantoms != before.phantoms                     ? "phantom"
           : after.wrong != before.wrong                           ? "wrong surface"
           : after.bracket_violations != before.bracket_violations ? "bracket"
           : after.bound_violations != before.bound_violations     ? "bound"
           : after.parity_violations != before.parity_violations   ? "parity"
                                                                   : "";
  }
  const OracleAnswer& truth() const { return truth_; }

 private:
  Tally slim() const {
    Tally t;
    t.leaks = tally_.leaks, t.phantoms = tally_.phantoms, t.wrong = tally_.wrong;
    t.bracket_violations = tally_.bracket_violations, t.bound_violations = tally_.bound_violations;
    t.parity_violations = tally_.parity_violations;
    return t;
  }

  // The rounding that `exact` documents, as a value of f: 16 * 2^-53 M for the coefficients and as much for
  // evaluating them (bernstein.hpp), and what moving the ray to the box may do: some ten roundings of the
  // coordinates of each axis, where |df/dx| <= 2 M per voxel.
  double rounding() const {
    double distances = 0;
    const GridTransform& transform = level_set_.grid().transform;
    for (int a = 0; a < 3; ++a)
      distances = std::max({distances, std::fabs(ray_->origin[a]), std::fabs(transform.origin[a]),
                            std::fabs(ray_->origin[a] - transform.origin[a]) + 64 * voxel_});
    distances /= voxel_;
    return largest_ * (32 * 0x1p-53 + 3 * 2 * 10 * 0x1p-53 * distances);
  }
  double voxels(Real t) const {
    return static_cast<double>(std::fabs(t)) * (ray_->direction.length() / voxel_);
  }
  Real t_per_voxel() const { return Real(voxel_) / ray_->direction.length(); }

  // Whether f stays above -rounding (times the side) in [from, to]: whoever sees no hit there is right within
  // rounding; and whether it gets below +rounding: whoever sees one.
  bool may_be_clear(Real from, Real to) const {
    return oracle_.least(*ray_, side(), from, to) >= -rounding();
  }
  bool may_be_met(Real from, Real to) const { return oracle_.least(*ray_, side(), from, to) <= rounding(); }
  int side() const { return truth_.first_sign < 0 ? -1 : 1; }
  // The ray begins on the surface within rounding: its side is anyone's.
  bool begins_in_doubt() const {
    return truth_.first_sign == 0 || may_be_met(ray_->t_min, ray_->t_min + Real(1e-9) * t_per_voxel());
  }

  void compare(const Hit& hit, bool is_exact) {
    ++tally_.rays;
    const std::vector<OracleRoot>& roots = truth_.roots;
    tally_.hits += !roots.empty();
    if (roots.empty() && !hit) return;
    if (roots.empty()) {
      ++(may_be_met(ray_->t_min, ray_->t_max) ? tally_.doubtful : tally_.phantoms);
      return;
    }
    if (!hit) {
      ++(may_be_clear(ray_->t_min, ray_->t_max) || begins_in_doubt() ? tally_.doubtful : tally_.leaks);
      return;
    }
    const Real first = roots.front().t, off = std::fabs(hit.t - first);
    std::size_t nearest = 0;
    for (std::size_t i = 1; i < roots.size(); ++i)
      if (std::fabs(roots[i].t - hit.t) < std::fabs(roots[nearest].t - hit.t)) nearest = i;
    // `exact` is right to 10^-6 voxel, or it is at another place that rounding allows; the others may be off
    // by the length of a cell's chord.
    const double far = is_exact ? 1e-6 : 1.7320508075688774;
    if (voxels(off) <= far && (nearest == 0 || is_exact)) {
      tally_.add_error(voxels(off));
      return;
    }
    if (nearest > 0 && voxels(off) <= 1e-9) { // two roots as near as rounding
      tally_.add_error(voxels(off));
      return;
    }
    const Real little = Real(1e-6) * t_per_voxel();
    const bool allowed = begins_in_doubt() || (hit.t > first ? may_be_clear(ray_->t_min, hit.t - little)
                                                             : may_be_met(hit.t - little, hit.t + little));
    ++(allowed ? tally_.doubtful : tally_.wrong);
  }

  // The number of crossings is odd iff the true signs at the ends differ; an end within rounding of the
  // surface may count for either.
  void parity() {
    const EndSides sides = all_hits(level_set_, *ray_, places_);
    int crossings = 0;
    for (const SurfacePlace& place : places_) crossings += place.kind != PlaceKind::touch;
    const int first = truth_.first_sign, last = truth_.last_sign;
    const bool consistent =
        sides.last == 0 || sides.first == 0 || (crossings % 2 != 0) == (sides.first != sides.last);
    if (!consistent) {
      ++tally_.parity_violations;
      return;
    }
    if (first != 0 && last != 0 && (crossings % 2 != 0) != (first != last)) {
      const Real little = Real(1e-9) * t_per_voxel();
      const bool end_in_doubt =
          std::fabs(ray_->t_max) < 1e300 && may_be_met_either(ray_->t_max - little, ray_->t_max);
      tally_.parity_violations += !begins_in_doubt() && !end_in_doubt;
    }
  }
  bool may_be_met_either(Real from, Real to) const {
    return oracle_.least(*ray_, 1, from, to) <= rounding() &&
           oracle_.least(*ray_, -1, from, to) <= rounding();
  }

  void certificate(const Hit& hit) {
    const CertifiedHit certified = certify(level_set_, *ray_, hit);
    const std::vector<OracleRoot>& roots = truth_.roots;
    if (!hit) {
      // Proven to be clear up to clear_to, if the ray began where it was taken to begin.
      tally_.bound_violations += truth_.first_sign != 0 && !roots.empty() && !begins_in_doubt() &&
                                 roots.front().t + roots.front().error < Real(certified.clear_to);
      return;
    }
    if (certified.proof == Proof::graze) ++tally_.grazes;
    if (certified.proof == Proof::beginning) ++tally_.beginnings;
    if (certified.proof == Proof::refuted || certified.proof == Proof::miss) ++tally_.bound_violations;
    const int side = hit.from_inside ? -1 : 1;
    if (certified.proof == Proof::crossing) {
      ++tally_.certified;
      tally_.bracket_violations +=
          !(side * oracle_.sign_at(*ray_, certified.t_lo) > 0 &&
            side * oracle_.sign_at(*ray_, certified.t_hi) <= 0 && certified.t_lo < certified.t_hi &&
            certified.t_lo >= ray_->t_min && certified.t_hi <= ray_->t_max);
    }
    if (certified.proof == Proof::beginning)
      tally_.bracket_violations += side * oracle_.sign_at(*ray_, certified.t_hi) > 0;
    tally_.add_bound(std::min(voxels(certified.error), 1e6));
    // The first root of f times the side that the ray was taken to begin on; where its true beginning is on
    // the other side by less than rounding, that is the beginning.
    if (roots.empty()) {
      tally_.bound_violations += certified.proof == Proof::crossing;
      return;
    }
    Real first = roots.front().t, error = roots.front().error;
    if (truth_.first_sign != side) first = ray_->t_min, error = 0;
    if (certified.proof == Proof::graze && first > Real(certified.t_hi)) return;
    if (std::fabs(hit.t - first) + error <= Real(certified.error)) return;
    // By exact numbers, whose roots are known to 2^-58 of the way through a cell.
    const OracleAnswer exact = oracle_.ask(*ray_, true);
    first = ray_->t_min, error = 0;
    if (!exact.roots.empty() && exact.first_sign == side)
      first = exact.roots.front().t, error = exact.roots.front().error;
    const bool violated = !(std::fabs(hit.t - first) - error <= Real(certified.error));
    tally_.bound_violations += violated;
  }
  const LevelSet& level_set_;
  const RayOracle& oracle_;
  Tally& tally_;
  double voxel_, largest_ = 0;
  const WorldRay* ray_ = nullptr;
  OracleAnswer truth_;
  std::vector<SurfacePlace> places_;
};

} // namespace

namespace {

// Beyond the band: where OpenVDB's rays have to begin.
bool begins_beyond_band(const BlockGrid& grid, const WorldRay& ray) {
  const Vec3d p = grid.transform.to_voxel(ray.at(ray.t_min));
  Vec3i at;
  for (int a = 0; a < 3; ++a) at[a] = static_cast<int>(std::clamp(std::floor(p[a]), -1e8, 1e8));
  for (int c = 0; c < 8; ++c)
    if (grid.value(at.x + (c & 1), at.y + (c >> 1 & 1), at.z + (c >> 2)) != grid.background) return false;
  return true;
}

} // namespace

Tally run_chunk(const std::string& method, std::uint64_t seed, std::uint64_t chunk, bool verbose) {
  Tally tally;
  Random random(seed * 0x9E3779B97F4A7C15u + chunk);
  random.discard(8);
  const std::size_t shape = chunk % shape_kinds.size();
  const BlockGrid grid = random_shape(shape, random);
  const LevelSet level_set(grid);
  const RayOracle oracle(grid);
  RayMaker maker(level_set, oracle, random);
  std::vector<WorldRay> rays(rays_per_chunk);
  std::vector<std::size_t> kinds(rays_per_chunk);
  for (std::size_t i = 0; i < rays_per_chunk; ++i) rays[i] = maker.make(kinds[i] = maker.any_kind());

  std::vector<Hit> hits(rays_per_chunk);
  if (method == "openvdb") {
    // It has no notion of rays that begin inside.
    std::vector<WorldRay> applicable;
    for (const WorldRay& ray : rays)
      if (ray.t_min >= 0 && begins_beyond_band(grid, ray)) applicable.push_back(ray);
    rays = applicable;
    std::vector<PeerHit> found(rays.size());
    OpenVdbLevelSet::from_grid(grid).trace(rays, found);
    hits.resize(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
      hits[i].status = found[i].hit ? HitStatus::hit : HitStatus::miss;
      hits[i].t = found[i].t;
    }
  } else {
    closest_hits(level_set, rays, method, hits);
  }

  Judge judge(level_set, oracle, tally);
  int told = 0;
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (const char* what = judge.judge(rays[i], hits[i], method == "exact"); *what && verbose && told++ < 3) {
      const WorldRay& r = rays[i];
      std::fprintf(stderr,
                   "soak: %s, chunk %llu (%.*s), ray %zu (%.*s): o %a %a %a d %a %a %a t %a %a: hit %d t %a, "
                   "oracle %zu "
                   "roots, first %La\n",
                   what, static_cast<unsigned long long>(chunk), static_cast<int>(shape_kinds[shape].size()),
                   shape_kinds[shape].data(), i, static_cast<int>(ray_kinds[kinds[i]].size()),
                   ray_kinds[kinds[i]].data(), r.origin.x, r.origin.y, r.origin.z, r.direction.x,
                   r.direction.y, r.direction.z, r.t_min, r.t_max, int(bool(hits[i])), hits[i].t,
                   judge.truth().roots.size(),
                   judge.truth().roots.empty() ? 0.0L : judge.truth().roots.front().t);
    }
  return tally;
}

} // namespace levelray::test
