// Reading foreign files in a process of its own, because other people's readers may crash, hang or eat memory
// on bad files. The parent's side; the child's is limited_child.hpp.
#pragma once

#include "levelray/io/reader_stream.hpp"

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace levelray {

// One of our reader programs.
struct ReaderProgram {
  const char* name;     // "levelray-vdb-reader"
  const char* variable; // environment variable that may hold its path
  const char* reads;    // for messages: ".vdb files"
};

// Starts the program with `arguments`, FILE = `path` among them, and calls receive(source), which reads its
// answer. It is searched at the environment variable's path, beside the running program, in
// ../libexec/levelray, ../lib/levelray, ../lib and ../../lib from there, and where it is installed.
//
// The program inherits no open files but the pipe, no blocked signals, and is in a process group of its own;
// it limits itself, and is killed when this returns or throws. Throws Error(bad_input) when it crashed,
// Error(limit) when the answer took longer than `timeout_seconds`, Error(failed) when it cannot be found or
// started, Cancelled; what `receive` throws passes through.
void read_in_process(const ReaderProgram& program, const std::vector<std::string>& arguments,
                     const std::string& path, double timeout_seconds,
                     const std::function<void(const ByteSource&)>& receive);

// Throws Error(bad_input) "path: reason" for what is missing, a folder, no regular file, unreadable, empty,
// or does not begin with `magic`: "not an OpenVDB file". `kind` names it with its article.
void check_first_bytes(const std::string& path, std::string_view magic, const std::string& kind);

} // namespace levelray
