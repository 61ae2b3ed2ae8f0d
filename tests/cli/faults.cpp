// Fails one call of a program that this library is preloaded into: LD_PRELOAD=...,
// SINEW_FAULT=KIND:N fails the N-th call of its kind, from 1, and every later one if N ends with
// '+'.
//   open    opening a file to write           EACCES
//   write   writing to a file                 ENOSPC, after half of the bytes
//   sync    fsync                             EIO
//   rename  rename                            EIO
//   memory  malloc of 16 KiB and more         no memory
#include <dlfcn.h>
#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

const char* kind = nullptr;
long at = 0;          // the call that fails
bool onward = false;  // and all later ones
std::atomic<long> calls{0};

__attribute__((constructor)) void read_fault() {
  const char* fault = std::getenv("SINEW_FAULT");
  const char* colon = fault != nullptr ? std::strchr(fault, ':') : nullptr;
  if (colon == nullptr) return;
  char* end = nullptr;
  at = std::strtol(colon + 1, &end, 10);
  onward = *end == '+';
  kind = fault;
}

bool fails(const char* what) {
  const std::size_t length = std::strlen(what);
  if (kind == nullptr || std::strncmp(kind, what, length) != 0 || kind[length] != ':') return false;
  const long n = ++calls;
  return n == at || (onward && n > at);
}

// The function of this name that the program would have called.
template <typename Function>
Function* real(Function*, const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" {

FILE* fopen(const char* path, const char* mode) {
  if (mode[0] != 'r' && fails("open")) {
    errno = EACCES;
    return nullptr;
  }
  return real(fopen, "fopen")(path, mode);
}

int open(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const int mode = (flags & O_CREAT) != 0 ? va_arg(arguments, int) : 0;
  va_end(arguments);
  if ((flags & O_ACCMODE) != O_RDONLY && fails("open")) {
    errno = EACCES;
    return -1;
  }
  return real(open, "open")(path, flags, mode);
}

// Standard output and error are no files of the run.
ssize_t write(int file, const void* bytes, size_t count) {
  if (file > 2 && fails("write")) {
    errno = ENOSPC;
    return -1;
  }
  return real(write, "write")(file, bytes, count);
}

size_t fwrite(const void* bytes, size_t size, size_t count, FILE* file) {
  if (file != stdout && file != stderr && fails("write")) {
    const size_t half = real(fwrite, "fwrite")(bytes, size, count / 2, file);
    errno = ENOSPC;
    return half;
  }
  return real(fwrite, "fwrite")(bytes, size, count, file);
}

int fsync(int file) {
  if (fails("sync")) {
    errno = EIO;
    return -1;
  }
  return real(fsync, "fsync")(file);
}

int rename(const char* from, const char* to) noexcept {
  if (fails("rename")) {
    errno = EIO;
    return -1;
  }
  return real(rename, "rename")(from, to);
}

// dlsym() allocates: glibc's other name of malloc needs none.
void* __libc_malloc(size_t);  // NOLINT: its name
void* malloc(size_t size) noexcept {
  if (size >= 16384 && fails("memory")) {
    errno = ENOMEM;
    return nullptr;
  }
  return __libc_malloc(size);
}
}
