// The child's side of limited_process.hpp: a process that limits itself, reads one file, and answers.
#pragma once

#include "levelray/io/reader_stream.hpp"

#include <cstdint>
#include <functional>
#include <string>

namespace levelray {

// Limits this process for good: no more address space than `max_memory` bytes beyond what it has now, no more
// CPU time than `seconds` (rounded up, and one), no written files, no core dumps, no open files but the
// standard streams, no new privileges, one thread; it dies with its parent. Then calls work(sink), which
// sends its answer, to standard output. Errors that `work` throws, and running out of memory, are answered
// with send_error. Ends the process without destructors, in which what a damaged file left behind may crash.
//
// Under address and thread sanitizers the address space is not limited, which their shadows need.
[[noreturn]] void serve_limited(const std::string& path, std::uint64_t max_memory, double seconds,
                                const std::function<void(const ByteSink&)>& work);

// Lowers the limit of the address space to `bytes` beyond what is in use now, if that is less.
void limit_memory_further(std::uint64_t bytes);

} // namespace levelray
