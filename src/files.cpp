#include "files.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <stdexcept>
#include <system_error>

namespace spherical_springs::core {
namespace {

namespace fs = std::filesystem;

/// Puts what was written to a file, or to a directory's list of names, on the disk.
/// @param whose the file that it is written for
void flushToDisk(const fs::path& path, const fs::path& whose) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  const bool done = file >= 0 && ::fsync(file) == 0;
  const int reason = errno;
  if (file >= 0) ::close(file);
  errno = reason;
  if (!done) failTo("write", whose);
}

/// A name that no other writing has, in this process or another.
fs::path partOf(const fs::path& path) {
  static std::atomic<unsigned> writings{0};
  return path.string() + ".part" + std::to_string(::getpid()) + "-" + std::to_string(writings++);
}

void writePart(const fs::path& part, const fs::path& path,
               const std::function<void(std::ostream&)>& write) {
  std::ofstream out(part, std::ios::binary | std::ios::trunc);
  if (!out) failTo("write", path);
  write(out);
  out.close();
  if (!out) failTo("write", path);
  flushToDisk(part, path);
  fs::rename(part, path);
}

bool isThereAndNoFile(const fs::path& path) {
  return fs::exists(path) && !fs::is_regular_file(path);
}

}  // namespace

void failTo(const std::string& what, const fs::path& path) {
  throw std::runtime_error("cannot " + what + " " + onOneLine(path) + ": " +
                           std::system_category().message(errno));
}

std::ifstream openToRead(const fs::path& path) {
  if (orFailTo("read", path, [&] { return isThereAndNoFile(path); })) {
    throw std::runtime_error("cannot read " + onOneLine(path) + ": not a file");
  }
  std::ifstream in(path, std::ios::binary);
  if (!in) failTo("read", path);
  return in;
}

void replaceFile(const fs::path& path, const std::function<void(std::ostream&)>& write) {
  if (orFailTo("write", path, [&] { return isThereAndNoFile(path); })) {
    throw std::runtime_error("cannot write " + onOneLine(path) + ": not a file");
  }
  const fs::path part = partOf(path);
  try {
    orFailTo("write", path, [&] { writePart(part, path, write); });
  } catch (...) {
    std::error_code ignored;
    fs::remove(part, ignored);
    throw;
  }
  flushToDisk(path.has_parent_path() ? path.parent_path() : ".", path);
}

}  // namespace spherical_springs::core
