// What the suites over analytic shapes share.
#pragma once

#include "levelray/measure/sampled_shape.hpp"
#include "measure_document.hpp"
#include "measure_suites.hpp"

namespace levelray {

// Checked. Throws Error(usage).
AnalyticSettings analytic_settings(const MeasureOptions& options);
// As the document's options.
Json analytic_options_json(const AnalyticSettings& settings);

// "3 leaks, 1 phantom"; empty where nothing is lost.
std::string faults_text(const Confusion& confusion);

// Tables of hits begin alike: where it was measured, by which method (`title`: what those are called), and
// the confusion of its rays, with `unresolved` also those that sampling does not resolve; then `more`.
std::vector<Column> hit_columns(const std::string& title, bool unresolved, const std::vector<Column>& more);
Json::array_t hit_row(const Sampling& at, const std::string& method, const Confusion& confusion,
                      bool unresolved, const Json::array_t& more);

// One log-log plot per shape of the curves of a quantity.
Json convergence_plots(const std::vector<Convergence>& curves, const std::string& quantity,
                       const std::string& what);

} // namespace levelray
