#include "acceleration_options.hpp"

#include "names.hpp"

namespace levelray {

namespace {

const std::vector<std::string> primary_names{"dda", "minmax"};

} // namespace

void AccelerationOptions::add_to(CLI::App& command, const std::string& group) {
  command
      .add_option("--primary", primary,
                  "How camera rays find where to begin: " + join(primary_names) + " (min/max buffers)")
      ->capture_default_str()
      ->type_name("NAME")
      ->group(group);
  command.add_option("--minmax", minmax, "Cells along each side of the min/max buffers")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str()
      ->type_name("N")
      ->group(group);
  command
      .add_option("--traversal", traversal,
                  "How rays go through the grid: " + join(traversal_names()) + " (the paper's, step by step)")
      ->capture_default_str()
      ->type_name("NAME")
      ->group(group);
  command
      .add_option("--shadow", shadow,
                  "How shadow rays use the inside of closed surfaces: " + join(shadow_scheme_names()) +
                      " (plain: not at all; occluder: the paper's way)")
      ->capture_default_str()
      ->type_name("NAME")
      ->group(group);
  command
      .add_option("--occluder-steps", occluder_steps,
                  "Blocks that --shadow occluder looks at behind the first with surface")
      ->check(CLI::Range(0, 1000000))
      ->capture_default_str()
      ->type_name("N")
      ->group(group);
}

Acceleration AccelerationOptions::resolve() const {
  find_name("--primary", primary, primary_names);
  Acceleration acceleration;
  acceleration.minmax = primary == "minmax" ? minmax : 0;
  acceleration.traversal = static_cast<Traversal>(find_name("--traversal", traversal, traversal_names()));
  acceleration.shadow = static_cast<ShadowScheme>(find_name("--shadow", shadow, shadow_scheme_names()));
  acceleration.occluder_steps = occluder_steps;
  return acceleration;
}

Json AccelerationOptions::json() const {
  return {{"primary", primary},
          {"minmax", minmax},
          {"traversal", traversal},
          {"shadow", shadow},
          {"occluder_steps", occluder_steps}};
}

} // namespace levelray
