// Files that are replaced: what is told of a save is what has happened, links lead where they lead,
// and permissions stay.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstdarg>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "base/files.h"

namespace {

/// Error numbers that the system answers instead of doing what it is asked; 0: none.
struct Faults {
  int opening_a_directory = 0, flushing_a_directory = 0, flushing_a_file = 0;
} faults;

bool isDirectory(const struct stat& status) { return S_ISDIR(status.st_mode); }

int failWith(int fault) {
  errno = fault;
  return -1;
}

}  // namespace

// The C library's own, but for the faults.
extern "C" int open(const char* path, int flags, ...) {
  std::va_list rest;
  va_start(rest, flags);
  const int mode = (flags & O_CREAT) != 0 ? va_arg(rest, int) : 0;
  va_end(rest);
  struct stat status;
  if (faults.opening_a_directory != 0 && ::stat(path, &status) == 0 && isDirectory(status)) {
    return failWith(faults.opening_a_directory);
  }
  return static_cast<int>(::syscall(SYS_openat, AT_FDCWD, path, flags, mode));
}

extern "C" int fsync(int file) {
  struct stat status;
  const bool known = ::fstat(file, &status) == 0;
  const int fault =
      known && isDirectory(status) ? faults.flushing_a_directory : faults.flushing_a_file;
  return fault != 0 ? failWith(fault) : static_cast<int>(::syscall(SYS_fsync, file));
}

namespace spherical_springs::core {
namespace {

namespace fs = std::filesystem;

class ReplacedFiles : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(directory_); }
  void TearDown() override {
    faults = {};
    fs::remove_all(directory_);
  }

  static void replace(const fs::path& path, const std::string& text) {
    replaceFile(path, [&](std::ostream& out) { out << text; });
  }

  static std::string faultOf(const fs::path& path) {
    try {
      replace(path, "new");
    } catch (const std::runtime_error& fault) {
      return fault.what();
    }
    return "none";
  }

  static std::string contentOf(const fs::path& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
  }

  static unsigned modeOf(const fs::path& path) {
    return static_cast<unsigned>(fs::status(path).permissions());
  }

  std::ptrdiff_t entries() const { return std::distance(fs::directory_iterator(directory_), {}); }

  const fs::path directory_ =
      fs::temp_directory_path() / ("spherical_springs_files_" + std::to_string(::getpid()));
  const fs::path path_ = directory_ / "file";
};

TEST_F(ReplacedFiles, AreThereWhereTheirDirectoryCannotBeRead) {
  faults.opening_a_directory = EACCES;  // as a user, of a directory of mode 300
  EXPECT_EQ(faultOf(path_), "none");
  EXPECT_EQ(contentOf(path_), "new");
}

TEST_F(ReplacedFiles, AreThereWhateverFlushingTheirDirectoryAnswers) {
  for (const int fault : {EINVAL, ENOTSUP, ENOSYS, EROFS, EBADF, EIO}) {
    faults.flushing_a_directory = fault;
    replace(path_, "old");
    EXPECT_EQ(faultOf(path_), "none") << fault;
    EXPECT_EQ(contentOf(path_), "new") << fault;
  }
}

TEST_F(ReplacedFiles, AreThereWhereFilesCannotBeFlushed) {
  for (const int fault : {EINVAL, ENOTSUP, ENOSYS}) {
    faults.flushing_a_file = fault;
    replace(path_, "old");
    EXPECT_EQ(faultOf(path_), "none") << fault;
    EXPECT_EQ(contentOf(path_), "new") << fault;
  }
}

TEST_F(ReplacedFiles, StayAsTheyWereWhereTheDiskFails) {
  replace(path_, "old");
  for (const int fault : {EIO, ENOSPC, EDQUOT}) {
    faults.flushing_a_file = fault;
    const std::string reason = std::system_category().message(fault);
    EXPECT_EQ(faultOf(path_), "cannot write " + path_.string() + ": " + reason);
    EXPECT_EQ(contentOf(path_), "old");
    EXPECT_EQ(entries(), 1) << "something is left beside";
  }
}

TEST_F(ReplacedFiles, StayAsTheyWereWhereTheWriterFails) {
  replace(path_, "old");
  EXPECT_THROW(replaceFile(path_,
                           [](std::ostream& out) {
                             out << "half";
                             throw std::length_error("a fault");
                           }),
               std::length_error);
  EXPECT_EQ(contentOf(path_), "old");
  EXPECT_EQ(entries(), 1) << "something is left beside";
}

TEST_F(ReplacedFiles, AreThoseThatLinksLeadTo) {
  const fs::path elsewhere = directory_ / "elsewhere";
  fs::create_directory(elsewhere);
  replace(elsewhere / "file", "old");
  fs::create_symlink("elsewhere/file", directory_ / "relative");
  fs::create_symlink(elsewhere / "file", directory_ / "absolute");
  fs::create_symlink("../relative", elsewhere / "link_to_link");
  fs::create_directory_symlink("elsewhere", directory_ / "folder");
  for (const fs::path& link :
       {directory_ / "relative", directory_ / "absolute", elsewhere / "link_to_link",
        directory_ / "folder" / "link_to_link"}) {
    replace(link, link.string());
    EXPECT_TRUE(fs::is_symlink(link)) << link;
    EXPECT_EQ(contentOf(elsewhere / "file"), link.string());
  }
  EXPECT_FALSE(fs::is_symlink(elsewhere / "file"));
  EXPECT_EQ(entries(), 4) << "something is left beside";
}

TEST_F(ReplacedFiles, AreMadeWhereLinksLeadToNothing) {
  fs::create_symlink("file", directory_ / "link");
  replace(directory_ / "link", "new");
  EXPECT_TRUE(fs::is_symlink(directory_ / "link"));
  EXPECT_FALSE(fs::is_symlink(path_));
  EXPECT_EQ(contentOf(path_), "new");

  const fs::path lost = directory_ / "lost";
  fs::create_symlink("missing/file", lost);
  EXPECT_EQ(faultOf(lost), "cannot write " + lost.string() + ": No such file or directory");
  EXPECT_TRUE(fs::is_symlink(lost));
}

TEST_F(ReplacedFiles, AreRefusedWhereLinksGoRoundInCircles) {
  const fs::path self = directory_ / "self", one = directory_ / "one", other = directory_ / "other";
  fs::create_symlink("self", self);
  fs::create_symlink("other", one);
  fs::create_symlink("one", other);
  for (const fs::path& link : {self, one, other}) {
    EXPECT_EQ(faultOf(link),
              "cannot write " + link.string() + ": Too many levels of symbolic links");
    EXPECT_TRUE(fs::is_symlink(link));
  }
  EXPECT_EQ(entries(), 3) << "something is left beside";
}

TEST_F(ReplacedFiles, AreNoDirectoriesOrDevicesBehindLinks) {
  fs::create_directory(directory_ / "folder");
  fs::create_directory_symlink("folder", directory_ / "link_to_folder");
  fs::create_symlink("/dev/null", directory_ / "link_to_device");
  for (const char* name : {"link_to_folder", "link_to_device"}) {
    EXPECT_EQ(faultOf(directory_ / name),
              "cannot write " + (directory_ / name).string() + ": not a file");
  }
}

TEST_F(ReplacedFiles, KeepTheirPermissions) {
  for (const unsigned mode : {0600u, 0640u, 0444u, 0755u, 0666u}) {
    fs::remove(path_);
    replace(path_, "old");
    fs::permissions(path_, fs::perms(mode));
    replace(path_, "new");
    EXPECT_EQ(modeOf(path_), mode);
    EXPECT_EQ(contentOf(path_), "new");
  }
}

TEST_F(ReplacedFiles, ThatAreNewHaveThePermissionsOfTheUmask) {
  const mode_t before = ::umask(027);
  replace(path_, "new");
  ::umask(before);
  EXPECT_EQ(modeOf(path_), 0640u);
}

TEST_F(ReplacedFiles, KeepOwnerAndGroup) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root can give files away";
  constexpr ::uid_t kOwner = 12345;
  constexpr ::gid_t kGroup = 23456;
  replace(path_, "old");
  ASSERT_EQ(::chown(path_.c_str(), kOwner, kGroup), 0);
  fs::permissions(path_, fs::perms(0640));
  replace(path_, "new");
  struct stat status;
  ASSERT_EQ(::stat(path_.c_str(), &status), 0);
  EXPECT_EQ(status.st_uid, kOwner);
  EXPECT_EQ(status.st_gid, kGroup);
  EXPECT_EQ(modeOf(path_), 0640u);
}

TEST_F(ReplacedFiles, MayHaveNamesAsLongAsTheSystemTakes) {
  constexpr std::size_t kLongest = 255;
  for (const std::size_t length : {std::size_t(230), std::size_t(248), kLongest}) {
    const fs::path path = directory_ / std::string(length, 'x');
    EXPECT_EQ(faultOf(path), "none") << length;
    EXPECT_EQ(contentOf(path), "new") << length;
    fs::remove(path);
  }
  const fs::path too_long = directory_ / std::string(kLongest + 1, 'x');
  EXPECT_EQ(faultOf(too_long), "cannot write " + too_long.string() + ": File name too long");
}

TEST_F(ReplacedFiles, DoNotTakeThePlaceOfWhatHasTheNameOfAPart) {
  // Left behind by a process of the same number that was killed, or put there to be followed.
  const fs::path precious = directory_ / "precious";
  replace(precious, "precious");
  std::string part;
  replaceFile(path_, [&](std::ostream& out) {
    for (const auto& entry : fs::directory_iterator(directory_)) {
      if (entry.path() != precious) part = entry.path().filename().string();
    }
    out << "new";
  });
  const std::size_t dash = part.rfind('-');
  ASSERT_NE(dash, std::string::npos) << part;
  const unsigned long number = std::stoul(part.substr(dash + 1));
  for (unsigned long next = number + 1; next < number + 4; ++next) {
    fs::create_symlink("precious", directory_ / (part.substr(0, dash + 1) + std::to_string(next)));
  }
  replace(path_, "newer");
  EXPECT_EQ(contentOf(path_), "newer");
  EXPECT_EQ(contentOf(precious), "precious");
  EXPECT_EQ(entries(), 5) << "something is left beside";
}

}  // namespace
}  // namespace spherical_springs::core
