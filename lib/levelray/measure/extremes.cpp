#include "levelray/measure/extremes.hpp"

#include "levelray/core/error.hpp"
#include "levelray/core/parallel.hpp"

#include <cmath>
#include <ctime>

namespace levelray {

const char* verdict_name(ExtremeVerdict verdict) {
  return verdict == ExtremeVerdict::green ? "green" : verdict == ExtremeVerdict::refused ? "refused" : "red";
}

ExtremeOutcome ExtremeTally::outcome() const {
  ExtremeOutcome outcome;
  outcome.cases = cases_;
  outcome.worst = worst_;
  outcome.unit = unit_;
  outcome.detail = example_;
  if (outcome.detail.empty() && cases_ == 0) outcome.detail = "no case was tried";
  if (outcome.detail.empty() && !std::isfinite(worst_)) outcome.detail = "an error is no number";
  if (!outcome.detail.empty()) outcome.verdict = ExtremeVerdict::red;
  return outcome;
}

ExtremeOutcome expect_refusal(const std::string& text, const std::function<void()>& work) {
  ExtremeOutcome outcome;
  outcome.cases = 1;
  outcome.verdict = ExtremeVerdict::red;
  outcome.detail = "was not refused; expected: " + text;
  try {
    work();
  } catch (const Error& error) {
    outcome.detail = error.what();
    if (outcome.detail.find(text) != std::string::npos)
      outcome.verdict = ExtremeVerdict::refused;
    else
      outcome.detail = "refused with other words than \"" + text + "\": " + outcome.detail;
  }
  return outcome;
}

std::vector<ExtremeRow> extreme_rows() {
  std::vector<ExtremeRow> rows;
  for (const auto& group :
       {extreme_ray_rows, extreme_cell_rows, extreme_grid_rows, extreme_shape_rows, extreme_mesh_rows,
        extreme_system_rows, extreme_invariant_rows, extreme_oracle_rows})
    for (ExtremeRow& row : group()) rows.push_back(std::move(row));
  return rows;
}

ExtremeResult run_extreme(const ExtremeRow& row, const ExtremeSettings& settings) {
  check_cancel();
  const auto now = [] {
    timespec time{};
    ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec) * 1e-9;
  };
  ExtremeResult result{row.group, row.name, row.expected, {}, 0};
  const double start = now();
  try {
    result.outcome = row.run(settings);
  } catch (const Cancelled&) {
    throw;
  } catch (const TimeUp&) {
    throw;
  } catch (const std::exception& error) {
    result.outcome.verdict = ExtremeVerdict::red;
    result.outcome.detail = std::string("threw: ") + error.what();
  }
  result.seconds = now() - start;
  return result;
}

} // namespace levelray
