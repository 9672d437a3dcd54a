// Frames that are meshes, or foreign level sets, to convert.
#pragma once

#include "input.hpp"
#include "levelray/vdb/vdb_file.hpp"
#include "sequence.hpp"

namespace levelray {

class MeshFrames : public FrameSource {
 public:
  // Everything must outlive this.
  MeshFrames(const InputOptions& input, const ConversionOptions& conversion, const VdbWriteOptions& write)
      : input_(input), conversion_(conversion), write_(write) {}

  const char* verb() const override { return "converted"; }
  std::string settings(int frame) const override;
  std::shared_ptr<const LoadedFrame> load(const std::vector<std::string>& paths, std::uint64_t memory,
                                          double seconds) const override;
  std::uint64_t making_bytes() const override { return 0; }
  MadeFrame make(int frame, std::shared_ptr<const LoadedFrame> loaded,
                 const std::vector<std::string>& outputs,
                 const std::function<void(double)>& progress) const override;

 private:
  const InputOptions& input_;
  const ConversionOptions& conversion_;
  const VdbWriteOptions& write_;
};

} // namespace levelray
