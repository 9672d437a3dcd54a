// Loaded before a program (LD_PRELOAD), makes one of its calls of the system fail: LEVELRAY_TEST_FAIL is
// "fsync 2 5" for the second fsync to fail with error 5. Standard streams are left alone.
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <sys/types.h>
#include <sys/uio.h>

namespace {

struct Plan {
  char call[16] = "";
  int number = 0, error = 0;
  Plan() {
    const char* text = std::getenv("LEVELRAY_TEST_FAIL");
    if (text) std::sscanf(text, "%15s %d %d", call, &number, &error);
  }
};

bool fails(const char* call) {
  static const Plan plan;
  static std::atomic<int> calls{0};
  if (std::strcmp(plan.call, call) != 0 || ++calls != plan.number) return false;
  errno = plan.error;
  return true;
}

template <class Function>
Function real(const char* name) {
  return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

} // namespace

extern "C" {

ssize_t write(int file, const void* bytes, size_t count) {
  static const auto call = real<ssize_t (*)(int, const void*, size_t)>("write");
  return file > 2 && fails("write") ? -1 : call(file, bytes, count);
}
ssize_t writev(int file, const iovec* pieces, int count) {
  static const auto call = real<ssize_t (*)(int, const iovec*, int)>("writev");
  return file > 2 && fails("write") ? -1 : call(file, pieces, count);
}
ssize_t read(int file, void* bytes, size_t count) {
  static const auto call = real<ssize_t (*)(int, void*, size_t)>("read");
  return file > 2 && fails("read") ? -1 : call(file, bytes, count);
}
int fsync(int file) {
  static const auto call = real<int (*)(int)>("fsync");
  return fails("fsync") ? -1 : call(file);
}
int rename(const char* from, const char* to) noexcept {
  static const auto call = real<int (*)(const char*, const char*)>("rename");
  return fails("rename") ? -1 : call(from, to);
}
int close(int file) {
  static const auto call = real<int (*)(int)>("close");
  if (file <= 2 || !fails("close")) return call(file);
  const int error = errno; // the file is closed all the same, as on Linux
  call(file);
  errno = error;
  return -1;
}

} // extern "C"
