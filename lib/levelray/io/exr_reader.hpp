// Foreign OpenEXR files.
#pragma once

#include "levelray/io/reader_stream.hpp"
#include "levelray/measure/picture.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace levelray {

struct ExrReadOptions {
  bool trust_input = false;                          // read in this process instead of a limited child
  std::uint64_t max_memory = std::uint64_t{8} << 30; // bytes, for the child and for the picture
  double timeout_seconds = 60;
};

struct ExrFile {
  Picture picture;
  std::vector<std::string> warnings;
};

// Reads the picture of a file: scan lines, or the full resolution of tiles; of several parts the first, with
// a warning. Values are as they are, NaN and infinities included. Throws Error(bad_input) for damaged or
// incomplete files, deep ones and subsampled channels, Error(limit) over memory or time, Error(failed) when
// the reader program (`levelray-exr-reader`, $LEVELRAY_EXR_READER) cannot be started.
ExrFile read_exr(const std::string& path, const ExrReadOptions& options = {});

// The same in this very process, on its own risk and memory; `reads` is called with the bytes needed beside
// those in use, before they are taken.
ExrFile read_exr_here(const std::string& path, std::uint64_t max_memory,
                      const std::function<void(std::uint64_t bytes)>& reads = {});

// What the reader process sends. The picture that is received is sound: windows within OpenEXR's limits, as
// many values as the window has pixels, at most `max_bytes` of them, names sorted and unique. Throws the
// Error that was sent, or Error(bad_input) naming `path` when the bytes make no sense.
void send_exr(const ByteSink& write, const ExrFile& file);
ExrFile receive_exr(const ByteSource& read, const std::string& path, std::uint64_t max_bytes);

} // namespace levelray
