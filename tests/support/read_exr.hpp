// Reads an EXR file for a test: all channels as float, and the camera.
#pragma once

#include <ImathMatrix.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfInputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <map>
#include <string>
#include <vector>

namespace levelray::test {

struct ExrImage {
  int width = 0, height = 0;
  std::map<std::string, std::vector<float>> channels;
  Imath::M44d world_to_camera, world_to_ndc;
  std::string software;

  const std::vector<float>& at(const std::string& channel) const { return channels.at(channel); }
};

inline ExrImage read_exr(const std::string& path) {
  Imf::InputFile file(path.c_str());
  const Imath::Box2i window = file.header().dataWindow();
  ExrImage image;
  image.width = window.max.x + 1;
  image.height = window.max.y + 1;
  Imf::FrameBuffer frame_buffer;
  for (auto channel = file.header().channels().begin(); channel != file.header().channels().end();
       ++channel) {
    std::vector<float>& values = image.channels[channel.name()];
    values.resize(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
    frame_buffer.insert(channel.name(),
                        Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()), sizeof(float),
                                   sizeof(float) * static_cast<std::size_t>(image.width)));
  }
  file.setFrameBuffer(frame_buffer);
  file.readPixels(0, image.height - 1);
  if (Imf::hasWorldToCamera(file.header()))
    image.world_to_camera = Imath::M44d(Imf::worldToCamera(file.header()));
  if (Imf::hasWorldToNDC(file.header())) image.world_to_ndc = Imath::M44d(Imf::worldToNDC(file.header()));
  if (const auto* software = file.header().findTypedAttribute<Imf::StringAttribute>("software"))
    image.software = software->value();
  return image;
}

} // namespace levelray::test
