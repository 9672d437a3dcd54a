// The suite `paper` as a document: Tables 1 to 4 of Jamriska 2010 with its rows and columns, each printed
// figure behind ours, and whether the paper's claims hold.
#include "levelray/convert/mesh_to_grid.hpp"
#include "levelray/core/error.hpp"
#include "levelray/intersect/intersectors.hpp"
#include "levelray/io/mesh_reader.hpp"
#include "levelray/measure/paper_trends.hpp"
#include "levelray/measure/study_scene.hpp"
#include "measure_analytic.hpp"
#include "measure_document.hpp"
#include "measure_paper_tables.hpp"
#include "measure_suites.hpp"
#include "paper_models.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>

namespace levelray {

namespace {

constexpr int table_torus = 32; // "a low resolution"; the paper does not say which

struct Settings : PaperSettings {
  std::vector<int> resolutions{128, 256, 512};
};

// Says on a terminal what is being done: "dragon at 512 (6 of 9): rays 40%".
class Stages {
 public:
  Stages(Progress& progress, std::size_t count) : progress_(progress), count_(count) {}
  void begin(const std::string& what) {
    what_ = fmt::format("{} ({} of {})", what, ++at_, count_);
    progress_.begin("", 0, "");
  }
  PaperProgress part(const char* doing) {
    return [this, doing](double done) {
      progress_.show(fmt::format("{}: {} {:.0f}%", what_, doing, 100 * done));
    };
  }

 private:
  Progress& progress_;
  std::size_t count_, at_ = 0;
  std::string what_;
};

Vec3i voxels_of(const Box3d& box, double voxel_size) {
  const Vec3d size = (box.max - box.min) / voxel_size;
  return Vec3i(static_cast<int>(std::lround(size.x)), static_cast<int>(std::lround(size.y)),
               static_cast<int>(std::lround(size.z)));
}

void add_failures(Json& failures, const std::vector<PaperTorus>& tori, const std::vector<PaperRow>& rows) {
  for (const PaperTorus& torus : tori)
    for (const PaperMethod& m : torus.intersectors)
      if (m.method == Exact::name && m.shape.lost())
        failures.push_back(fmt::format("{}: torus at {}: {}, more than sampling explains", m.method,
                                       torus.at.resolution, faults_text(m.shape)));
  for (const PaperRow& row : rows)
    for (const bool shadows : {false, true})
      for (const PaperWay& way :
           row.scene ? (shadows ? row.scene->shadow : row.scene->primary) : std::vector<PaperWay>())
        if (way.different)
          failures.push_back(fmt::format("{} at {}: {} ({} rays): {} that differ from the plain traversal's",
                                         row.model, row.resolution, way.name, shadows ? "shadow" : "primary",
                                         counted(way.different, "answer", "answers")));
}

// Whether the model's z points up, not its y as in the paper: then its proportions are nearer to the printed
// ones when it is turned.
bool lies_down(const Box3d& box, const std::string& model) {
  const Vec3d size = box.max - box.min;
  const PrintedRow* printed = nullptr;
  for (const PrintedRow& row : printed_rows)
    if (row.model == model) printed = &row;
  if (!printed) return false;
  const auto off = [&](double x, double y, double z) {
    const auto difference = [&](double side, int voxels) {
      return std::fabs(side - static_cast<double>(voxels) / printed->resolution);
    };
    return difference(x, printed->voxels[0]) + difference(y, printed->voxels[1]) +
           difference(z, printed->voxels[2]);
  };
  return off(size.x, size.z, size.y) < off(size.x, size.y, size.z);
}

// Measures a model of the paper's, or of ours, at all resolutions.
template <class GridAt>
void add_rows(std::vector<PaperRow>& rows, const PaperSubject& subject, const Box3d& bounds,
              const Settings& settings, Stages& stages, GridAt&& grid_at) {
  const Vec3d size = bounds.max - bounds.min;
  const double longest = std::max({size.x, size.y, size.z});
  for (const int resolution : settings.resolutions) {
    stages.begin(fmt::format("{} at {}", subject.name, resolution));
    PaperRow row;
    row.model = subject.name, row.resolution = resolution, row.substitute = subject.substitute;
    const BlockGrid grid = grid_at(resolution, longest / resolution);
    row.voxels = voxels_of(bounds, grid.transform.voxel_size);
    row.scene = measure_paper_scene(grid, bounds.min.y, settings, stages.part("rays"));
    rows.push_back(row);
  }
}

void measure_model(std::vector<PaperRow>& rows, PaperSubject& subject, const MeasureOptions& options,
                   const Settings& settings, Stages& stages) {
  try {
    TriangleMesh read = centred_unit_mesh(read_mesh(subject.file, options.input.mesh_options()).mesh);
    subject.turned = lies_down(read.bounds(), subject.name);
    if (subject.turned)
      for (Vec3d& v : read.vertices) v = Vec3d(v.x, v.z, -v.y);
    const PreparedMesh mesh = prepare_mesh(read);
    subject.triangles = mesh.report.triangles, subject.closed = mesh.report.closed;
    add_rows(rows, subject, mesh.report.bounds, settings, stages, [&](int, double voxel_size) {
      ConvertOptions convert;
      convert.voxel_size = voxel_size, convert.half_width_voxels = settings.half_width_voxels;
      convert.max_memory = options.input.memory_limit();
      const PaperProgress part = stages.part("converting");
      convert.progress = [part](const char*, double done) { part(done); };
      return mesh_to_grid(mesh, convert).grid;
    });
  } catch (const Error& error) { // may not know the file's name
    const std::string text = error.what();
    throw Error(error.kind(), text.find(subject.file) == std::string::npos
                                  ? printable(subject.file, 300) + ": " + text
                                  : text);
  }
}

std::vector<PaperSubject> subjects_of(const MeasureOptions& options, Json& findings) {
  std::vector<PaperSubject> subjects;
  if (options.models.empty()) {
    for (const char* shape : {"torus", "gyroid"})
      subjects.push_back({fmt::format("{} (substitute)", shape), "", "a shape of levelray's own", true});
    findings.push_back(
        "without --models DIR, Tables 3 and 4 are of substitutes, shapes of levelray's own; they "
        "have nothing to do with the printed figures, which are of the Stanford bunny, dragon "
        "and happy buddha");
    return subjects;
  }
  std::string missing;
  std::size_t found = 0;
  for (const PaperModel& model : find_paper_models(options.models)) {
    subjects.push_back({model.name, model.path, model.source});
    if (!model.path.empty()) {
      ++found;
      continue;
    }
    missing += (missing.empty() ? "" : ", ") + model.name;
    findings.push_back(fmt::format("{} is missing in {}; it is at {}", model.name,
                                   printable(options.models, 200), model.source));
  }
  if (!found)
    throw Error(ErrorKind::bad_input, "--models " + printable(options.models, 200) + ": no " + missing +
                                          " there, by any usual name; they are at "
                                          "graphics.stanford.edu/data/3Dscanrep");
  return subjects;
}

} // namespace

void measure_paper(const MeasureOptions& options, Progress& progress, Json& document) {
  Settings settings;
  if (!options.resolutions.empty())
    settings.resolutions = parse_counts("--resolution", options.resolutions, 8, 4096);
  settings.image_size = options.size, settings.repetitions = options.repeat;
  settings.half_width_voxels = band_voxels(options);
  std::vector<PaperSubject> subjects = subjects_of(options, document["findings"]);

  std::vector<int> torus_resolutions{table_torus};
  for (const int n : settings.resolutions)
    if (n != table_torus) torus_resolutions.push_back(n);
  Stages stages(progress, torus_resolutions.size() + subjects.size() * settings.resolutions.size());
  std::vector<PaperTorus> tori;
  for (const int n : torus_resolutions) {
    stages.begin(fmt::format("torus at {}", n));
    tori.push_back(measure_paper_torus(n, settings, stages.part("rays")));
  }
  std::vector<PaperRow> rows;
  const std::vector<Reference> shapes = all_references();
  for (PaperSubject& subject : subjects)
    if (subject.substitute) {
      const auto shape = std::find_if(shapes.begin(), shapes.end(), [&](const Reference& r) {
        return subject.name.starts_with(r.name + " ");
      });
      add_rows(rows, subject, shape->bounds, settings, stages, [&](int resolution, double) {
        return shape->grid(1.0 / resolution, settings.half_width_voxels);
      });
    } else if (!subject.file.empty()) {
      measure_model(rows, subject, options, settings, stages);
    } else {
      for (const int resolution : settings.resolutions) {
        PaperRow row;
        row.model = subject.name, row.resolution = resolution;
        rows.push_back(row);
      }
    }

  document["title"] = "levelray measure: Tables 1 to 4 of Jamriska 2010";
  document["options"] = {{"models", options.models},
                         {"resolution", settings.resolutions},
                         {"size", settings.image_size},
                         {"band_voxels", settings.half_width_voxels},
                         {"repeat", settings.repetitions}};
  add_failures(document["failures"], tori, rows);
  document["notes"] = {
      "Ondrej Jamriska, Interactive Ray Tracing of Distance Fields, 2010: his printed figures stand behind "
      "ours, "
      "in columns called paper. They are of 512x512 pixels on two Xeon E5440 (2.83 GHz, 4 threads, wall "
      "clock, "
      "with simple shading); ours are one thread's processor time, hits and normals without shading. So "
      "times "
      "compare by their ratios and savings only. Where the camera, the lights and the ground are, the paper "
      "does not say.",
      "As in the paper, blocks have 4x4x4 samples, intersections are of false-position-1 and normals of "
      "interpolation-of-differences unless they are what is compared, and rays walk block by block and cell "
      "by "
      "cell (plain). All ways of a table give the same answers to the last bit, which is looked at before "
      "any "
      "time is taken.",
      "Times are medians, of works in turns; what is saved is the median of what is saved within a "
      "repetition. "
      "Buffers are built in the time that is told."};
  document["sections"].push_back(
      {{"id", "claims"},
       {"title", "The paper's claims"},
       {"text",
        "What the paper says of its tables. In k of n: so many of its figures go the way that ours go."},
       {"plots", Json::array()},
       {"tables", {paper_trend_table(paper_trends(tori.front(), rows, settings.image_size))}}});
  document["sections"].push_back(
      {{"id", "section-1"},
       {"title", "Table 1"},
       {"text",
        fmt::format("A torus of {0} voxels, in a picture of {1}x{1} pixels. Interpolations are those in the "
                    "cell of the hit. The marks are labelled with the torus' resolution.",
                    table_torus, settings.image_size)},
       {"plots", {paper_trade_plot(tori, false)}},
       {"tables", {paper_table_1(tori.front(), settings.image_size), paper_hit_table(tori)}}});
  document["sections"].push_back(
      {{"id", "section-2"},
       {"title", "Table 2"},
       {"text", "The same torus; samples and interpolations are those of a normal. A jump is by how many "
                "degrees the normal "
                "turns more, or less, between neighbouring pixels than the torus' own does."},
       {"plots", {paper_trade_plot(tori, true)}},
       {"tables", {paper_table_2(tori.front(), settings.image_size), paper_normal_table(tori)}}});
  document["sections"].push_back(
      {{"id", "section-3"},
       {"title", "Table 3"},
       {"text",
        "A primary ray per pixel. Steps are blocks and, in blocks with surface, cells; in thousands. Leaps "
        "over empty space are ours."},
       {"plots", Json::array()},
       {"tables", {paper_table_3(rows, settings.image_size), paper_way_table(rows, false)}}});
  document["sections"].push_back(
      {{"id", "section-4"},
       {"title", "Table 4"},
       {"text",
        "Shadow rays towards five lights, from the object and the ground under it. n: the blocks that a ray "
        "looks ahead for the inside. Boxes of the inside, and leaps, are ours."},
       {"plots", Json::array()},
       {"tables", {paper_table_4(rows, settings.image_size), paper_way_table(rows, true)}}});
  document["sections"].push_back({{"id", "subjects"},
                                  {"title", "Models"},
                                  {"text", "What Tables 3 and 4 are measured on."},
                                  {"plots", Json::array()},
                                  {"tables", {paper_subject_table(subjects)}}});
}

} // namespace levelray
