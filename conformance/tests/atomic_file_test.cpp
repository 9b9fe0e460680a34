#include "conformance/compare/atomic_file.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <filesystem>

#include "conformance/tests/temporary_folder.h"

namespace edgecase::conformance {
namespace {

using testing::HasSubstr;

TEST(AtomicFile, ReplacesWholeFilesAndFollowsLinks) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_file_atomically(folder / "a", "one"));
  ASSERT_TRUE(write_file_atomically(folder / "a", "two"));
  std::filesystem::create_symlink(folder / "a", folder / "link");
  ASSERT_TRUE(write_file_atomically(folder / "link", "three"));
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_EQ(content_of(folder / "a"), "three");
  EXPECT_EQ(folder.files(), 2u);
  EXPECT_FALSE(write_file_atomically(folder / "", "x"));
  EXPECT_EQ(folder.files(), 2u);
}

TEST(AtomicFile, KeepsTheModeOfAnExistingFile) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_file_atomically(folder / "a", "one"));
  std::filesystem::permissions(folder / "a", std::filesystem::perms{0640});
  ASSERT_TRUE(write_file_atomically(folder / "a", "two"));
  EXPECT_EQ(std::filesystem::status(folder / "a").permissions(), std::filesystem::perms{0640});
  EXPECT_EQ(content_of(folder / "a"), "two");
}

TEST(AtomicFile, TakesTheLongestNameThatAFileCanHave) {
  const TemporaryFolder folder;
  const std::string name(255, 'n');
  ASSERT_TRUE(write_file_atomically(folder / name, "x"));
  EXPECT_EQ(content_of(folder / name), "x");
}

// As in `edgecase run --json /dev/stdout > file`: nothing that was printed before or after may be overwritten.
TEST(AtomicFile, StandsInOrderWithWhatIsPrinted) {
  const TemporaryFolder folder;
  std::fflush(stdout);
  const int saved = ::dup(STDOUT_FILENO);
  const int file = ::open((folder / "out").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
  ASSERT_EQ(::dup2(file, STDOUT_FILENO), STDOUT_FILENO);
  ::close(file);
  std::fputs("before ", stdout);
  const auto by_name = write_file_atomically("/dev/stdout", "one ");
  std::fputs("between ", stdout);
  const auto by_number = write_file_atomically("/dev/fd/1", "two ");
  std::fputs("after", stdout);
  std::fflush(stdout);
  ::dup2(saved, STDOUT_FILENO);
  ::close(saved);
  EXPECT_TRUE(by_name && by_number);
  EXPECT_EQ(content_of(folder / "out"), "before one between two after");
  EXPECT_FALSE(write_file_atomically("/dev/fd/9999", "x"));
}

// A limit on the size of files stands in for a full disk: the write fails part of the way.
TEST(AtomicFile, AFailedWriteLeavesTheOldFileAndNothingElse) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_file_atomically(folder / "a", "old"));
  const auto previous = std::signal(SIGXFSZ, SIG_IGN);
  rlimit limit{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &limit), 0);
  const rlimit small{1000, limit.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  const auto written = write_file_atomically(folder / "a", std::string(5000, 'n'));
  ::setrlimit(RLIMIT_FSIZE, &limit);
  std::signal(SIGXFSZ, previous);
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error().message, HasSubstr("/a: cannot write: File too large"));
  EXPECT_EQ(content_of(folder / "a"), "old");
  EXPECT_EQ(folder.files(), 1u);
}

}  // namespace
}  // namespace edgecase::conformance
