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
void flushToDisk(const fs::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) failTo("open", path);
  const bool done = ::fsync(file) == 0;
  ::close(file);
  if (!done) failTo("write", path);
}

/// A name that no other writing has, in this process or another.
fs::path partOf(const fs::path& path) {
  static std::atomic<unsigned> writings{0};
  return path.string() + ".part" + std::to_string(::getpid()) + "-" + std::to_string(writings++);
}

}  // namespace

void failTo(const std::string& what, const fs::path& path) {
  throw std::runtime_error("cannot " + what + " " + path.string() + ": " +
                           std::system_category().message(errno));
}

std::ifstream openToRead(const fs::path& path) {
  if (fs::exists(path) && !fs::is_regular_file(path)) {
    throw std::runtime_error("cannot read " + path.string() + ": not a file");
  }
  std::ifstream in(path, std::ios::binary);
  if (!in) failTo("read", path);
  return in;
}

void replaceFile(const fs::path& path, const std::function<void(std::ostream&)>& write) {
  if (fs::exists(path) && !fs::is_regular_file(path)) {
    throw std::runtime_error("cannot write " + path.string() + ": not a file");
  }
  const fs::path part = partOf(path);
  try {
    std::ofstream out(part, std::ios::binary | std::ios::trunc);
    if (!out) failTo("write", part);
    write(out);
    out.close();
    if (!out) failTo("write", part);
    flushToDisk(part);
    fs::rename(part, path);
  } catch (...) {
    std::error_code ignored;
    fs::remove(part, ignored);
    throw;
  }
  flushToDisk(path.has_parent_path() ? path.parent_path() : ".");
}

}  // namespace spherical_springs::core
