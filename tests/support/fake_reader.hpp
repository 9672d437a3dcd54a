// A shell script in the place of a reader program, to see what its parent makes of it.
#pragma once

#include "support/temporary_folder.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace levelray::test {

// For a scope. `variable`: LEVELRAY_VDB_READER or LEVELRAY_EXR_READER.
class FakeReader {
 public:
  FakeReader(const char* variable, const TemporaryFolder& dir, const std::string& script)
      : variable_(variable) {
    const std::string path = dir / "reader";
    std::ofstream(path) << "#!/bin/sh\n" << script << "\n";
    std::filesystem::permissions(path, std::filesystem::perms::owner_all);
    if (const char* old = std::getenv(variable_)) old_ = old;
    ::setenv(variable_, path.c_str(), 1);
  }
  ~FakeReader() {
    if (old_.empty())
      ::unsetenv(variable_);
    else
      ::setenv(variable_, old_.c_str(), 1);
  }
  FakeReader(const FakeReader&) = delete;
  FakeReader& operator=(const FakeReader&) = delete;

 private:
  const char* variable_;
  std::string old_;
};

} // namespace levelray::test
