// What compositing programs do with P: they project it through the file's own matrix.
#include "levelray/io/exr_writer.hpp"
#include "levelray/render/render_image.hpp"
#include "support/catch.hpp"
#include "support/read_exr.hpp"
#include "support/temporary_folder.hpp"
#include "support/trace_fixtures.hpp"

#include <cmath>
#include <fstream>

using namespace levelray;
using namespace levelray::test;

TEST_CASE("P of a file projects through the file's worldToNDC to the pixel's centre, for ten cameras") {
  const unsigned seed = 12;
  CAPTURE(seed);
  RandomRays random(seed);
  const TemporaryFolder folder;
  const BlockGrid grid = torus_grid(9, 3);
  const Vec3d centre(-3.2, 1.3, 0.6); // of the torus
  for (int i = 0; i < 10; ++i) {
    CAPTURE(i);
    RenderOptions options;
    CameraSettings& camera = options.camera;
    camera.eye = centre + random.direction() * random.uniform(14, 60);
    camera.target = centre + random.direction() * 5.0;
    camera.up = random.direction();
    camera.fov_degrees = random.uniform(8, 110);
    camera.width = 40 + static_cast<int>(random.uniform(0, 200));
    camera.height = 40 + static_cast<int>(random.uniform(0, 200));
    options.ground = i % 2 == 1;
    options.samples = i % 3 == 0 ? 4 : 1; // P is of the pixel's centre all the same
    options.aovs = {"P", "Z", "id"};
    const Image image = render_image(grid, options).image;
    const Camera lens(camera);
    const std::string path = folder / "p.exr";
    const std::string bytes = encode_exr(image, {&lens, "", ""});
    std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));

    const ExrImage file = read_exr(path);
    REQUIRE((file.width == camera.width && file.height == camera.height));
    int projected = 0;
    double worst = 0, worst_depth = 0;
    for (int y = 0; y < file.height; ++y)
      for (int x = 0; x < file.width; ++x) {
        const auto at = static_cast<std::size_t>(y * file.width + x);
        if (!(file.at("Z")[at] < 1e29f)) continue;
        ++projected;
        const Vec3d p(file.at("P.X")[at], file.at("P.Y")[at], file.at("P.Z")[at]);
        Vec3d ndc, in_camera;
        file.world_to_ndc.multVecMatrix(p, ndc);
        file.world_to_camera.multVecMatrix(p, in_camera);
        worst = std::max(worst, std::hypot(ndc.x * file.width - (x + 0.5), ndc.y * file.height - (y + 0.5)));
        worst_depth = std::max(worst_depth, std::fabs(in_camera.z / file.at("Z")[at] - 1));
      }
    CHECK(projected > 100);
    // The promise is 0.01 pixel. P and the matrix are rounded to 24 bits: coordinates up to 70 from the
    // origin are off by 2^-24 * 70 = 4e-6 each, seen from 2 and more away in an image whose height of 240
    // pixels spans 0.14 times the distance at least: a few 4e-6 / (2 * 0.14) * 240 = 0.0036 pixel.
    CHECK(worst < 0.01);
    CHECK(worst_depth < 1e-5); // Z is the depth along the view axis, also rounded
  }
}

TEST_CASE("ids are written as unsigned integers and read back exactly") {
  Image image{3, 1, {}};
  for (const char* name : {"R", "G", "B", "A"}) image.add(name);
  image.add("id") = {0, 7, static_cast<float>(largest_id)};
  const TemporaryFolder folder;
  const std::string path = folder / "id.exr", bytes = encode_exr(image, {});
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  Imf::InputFile file(path.c_str());
  REQUIRE(file.header().channels().findChannel("id"));
  CHECK(file.header().channels().findChannel("id")->type == Imf::UINT);
  unsigned ids[3] = {1, 1, 1};
  Imf::FrameBuffer frame_buffer;
  frame_buffer.insert("id",
                      Imf::Slice(Imf::UINT, reinterpret_cast<char*>(ids), sizeof(unsigned), sizeof ids));
  file.setFrameBuffer(frame_buffer);
  file.readPixels(0, 0);
  CHECK((ids[0] == 0 && ids[1] == 7 && ids[2] == largest_id));
}
