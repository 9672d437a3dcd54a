// The tables of the suite `paper`.
#pragma once

#include "levelray/measure/paper_trends.hpp"
#include "options.hpp"

#include <string>
#include <vector>

namespace levelray {

// What Tables 3 and 4 are measured on.
struct PaperSubject {
  std::string name, file, source; // no file: missing, or a substitute
  bool substitute = false, closed = true, turned = false;
  std::size_t triangles = 0;
};

// The paper's own. Printed figures are left out where they belong to another picture or model.
Json paper_table_1(const PaperTorus& torus, int image_size);
Json paper_table_2(const PaperTorus& torus, int image_size);
Json paper_table_3(const std::vector<PaperRow>& rows, int image_size);
Json paper_table_4(const std::vector<PaperRow>& rows, int image_size);

// What stands in no table of the paper.
Json paper_trend_table(const std::vector<PaperTrend>& trends);
Json paper_hit_table(const std::vector<PaperTorus>& tori);
Json paper_normal_table(const std::vector<PaperTorus>& tori);
Json paper_trade_plot(const std::vector<PaperTorus>& tori, bool normals);
Json paper_way_table(const std::vector<PaperRow>& rows, bool shadows);
Json paper_subject_table(const std::vector<PaperSubject>& subjects);

} // namespace levelray
