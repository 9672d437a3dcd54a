// What the suites over analytic shapes share.
#pragma once

#include "levelray/measure/sampled_shape.hpp"
#include "measure_suites.hpp"

namespace levelray {

// Checked. Throws Error(usage).
AnalyticSettings analytic_settings(const MeasureOptions& options);
// As the document's options.
Json analytic_options_json(const AnalyticSettings& settings);

// "3 leaks, 1 phantom"; empty where nothing is lost.
std::string faults_text(const Confusion& confusion);

// One log-log plot per shape of the curves of a quantity.
Json convergence_plots(const std::vector<Convergence>& curves, const std::string& quantity,
                       const std::string& what);

} // namespace levelray
