#include "machine.hpp"

#include <cstdlib>
#include <fstream>
#include <thread>

namespace levelray {

Json machine_json() {
  std::string processor = "unknown";
  std::ifstream cpuinfo("/proc/cpuinfo");
  for (std::string line; std::getline(cpuinfo, line);)
    if (line.starts_with("model name") && line.find(": ") != std::string::npos) {
      processor = line.substr(line.find(": ") + 2);
      break;
    }
  double load = 0;
  const bool known = ::getloadavg(&load, 1) == 1;
#ifdef __clang__
  const std::string compiler = __VERSION__;
#else
  const std::string compiler = "gcc " __VERSION__;
#endif
  return {{"processor", processor},
          {"hardware_threads", std::thread::hardware_concurrency()},
          {"compiler", compiler},
          {"flags", LEVELRAY_BUILD_FLAGS},
          {"load_average", known ? Json(load) : Json(nullptr)}};
}

} // namespace levelray
