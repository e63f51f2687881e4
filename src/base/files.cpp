#include "base/files.h"

#include <fcntl.h>
#include <pwd.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <stdexcept>
#include <system_error>
#include <vector>

namespace spherical_springs::core {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void throwLastFault() {
  throw fs::filesystem_error("", std::error_code(errno, std::system_category()));
}

/// Whether `reason`, an error number, says that the file system does not know how to flush.
bool meansNoFlushing(int reason) {
  return reason == EINVAL || reason == ENOTSUP || reason == ENOSYS;
}

/// Puts a directory's list of names on the disk, where the system lets it: everybody sees the names
/// already, so no answer is a failure.
void flushNames(const fs::path& directory) {
  const int file = ::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file < 0) return;
  ::fsync(file);
  ::close(file);
}

/// Returns the home directory of a user; empty: who runs this.
fs::path homeOf(const std::string& user) {
  std::vector<char> memory(1 << 14);
  ::passwd entry{}, *found = nullptr;
  if (user.empty()) {
    ::getpwuid_r(::getuid(), &entry, memory.data(), memory.size(), &found);
  } else {
    ::getpwnam_r(user.c_str(), &entry, memory.data(), memory.size(), &found);
  }
  if (found == nullptr) {
    throw std::invalid_argument("there is no user " + quoted(user) +
                                ", whose home directory '~' would stand for");
  }
  return entry.pw_dir;
}

fs::path directoryOf(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : ".";
}

/// A file beside another whose place it is to take, under a short name that nothing else has. It is
/// gone in the end unless it has taken that place.
class Part {
 public:
  explicit Part(const fs::path& target)
      : target_(target), replaces_(::stat(target.c_str(), &replaced_) == 0) {
    static std::atomic<unsigned> parts{0};
    constexpr ::mode_t kMine = 0600, kEverybodys = 0666;  // the latter less the umask
    constexpr int kMostTries = 1000;
    for (int i = 0; file_ < 0; ++i) {
      path_ = directoryOf(target) / ("spherical_springs.part" + std::to_string(::getpid()) + "-" +
                                     std::to_string(parts++));
      file_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC,
                     replaces_ ? kMine : kEverybodys);
      if (file_ < 0 && (errno != EEXIST || i == kMostTries)) throwLastFault();
    }
  }
  ~Part() {
    ::close(file_);
    if (!in_place_) ::unlink(path_.c_str());
  }
  Part(const Part&) = delete;
  Part& operator=(const Part&) = delete;

  void write(const std::function<void(std::ostream&)>& write) const {
    std::ofstream out(path_, std::ios::binary);
    if (!out) throwLastFault();
    write(out);
    out.close();
    if (!out) throwLastFault();
  }

  void takePlace() {
    if (replaces_) keepOwnerAndPermissions();
    if (::fsync(file_) != 0 && !meansNoFlushing(errno)) throwLastFault();
    fs::rename(path_, target_);
    in_place_ = true;
  }

 private:
  /// As far as the system lets it: a user cannot give files to others.
  void keepOwnerAndPermissions() const {
    constexpr ::uid_t kAsItIs = -1;
    constexpr ::mode_t kPermissions = 0777;
    static_cast<void>(::fchown(file_, replaced_.st_uid, replaced_.st_gid) == 0 ||
                      ::fchown(file_, kAsItIs, replaced_.st_gid) == 0);
    ::fchmod(file_, replaced_.st_mode & kPermissions);
  }

  fs::path target_, path_;
  struct stat replaced_;
  bool replaces_;
  int file_ = -1;
  bool in_place_ = false;
};

bool isThereAndNoFile(const fs::path& path) {
  return fs::exists(path) && !fs::is_regular_file(path);
}

}  // namespace

void failTo(const std::string& what, const fs::path& path) {
  throw std::runtime_error("cannot " + what + " " + onOneLine(path) + ": " +
                           std::system_category().message(errno));
}

fs::path linksFollowed(fs::path path) {
  constexpr int kMostLinks = 40;  // as Linux has it
  for (int links = 0; fs::is_symlink(fs::symlink_status(path)); ++links) {
    if (links == kMostLinks) {
      throw fs::filesystem_error("", path,
                                 std::make_error_code(std::errc::too_many_symbolic_link_levels));
    }
    path = path.parent_path() / fs::read_symlink(path);
  }
  return path;
}

std::ifstream openToRead(const fs::path& path) {
  if (orFailTo("read", path, [&] { return isThereAndNoFile(path); })) {
    throw std::runtime_error("cannot read " + onOneLine(path) + ": not a file");
  }
  std::ifstream in(path, std::ios::binary);
  if (!in) failTo("read", path);
  return in;
}

fs::path homeExpanded(const std::string& path) {
  if (path.empty() || path.front() != '~') return path;
  const std::size_t end = std::min(path.find('/'), path.size());
  const std::string user = path.substr(1, end - 1);
  const char* home = std::getenv("HOME");  // NOLINT(concurrency-mt-unsafe): nobody sets it
  const fs::path directory = user.empty() && home != nullptr ? home : homeOf(user);
  return directory / path.substr(std::min(end + 1, path.size()));
}

void replaceFile(const fs::path& path, const std::function<void(std::ostream&)>& write) {
  orFailTo("write", path, [&] {
    const fs::path target = linksFollowed(path);
    if (isThereAndNoFile(target)) {
      throw std::runtime_error("cannot write " + onOneLine(path) + ": not a file");
    }
    const fs::path directory = directoryOf(target);  // nothing may fail once the file is there
    Part part(target);
    part.write(write);
    part.takePlace();
    flushNames(directory);
  });
}

}  // namespace spherical_springs::core
