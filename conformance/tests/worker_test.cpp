// Workers that crash, hang, leave, refuse and chatter, and what the program makes of it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <bit>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "conformance/subjects/worker_subject.h"

namespace edgecase::conformance {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

// First x of the first triangle; see misbehaving_worker.cpp.
constexpr float kAbort = 900;
constexpr float kHang = 901;
constexpr float kExit = 902;
constexpr float kRefuse = 903;
constexpr float kChatter = 904;

WorkerCommand misbehaving(std::vector<std::string> arguments = {}) {
  return {EDGECASE_MISBEHAVING_WORKER, std::move(arguments), {}, std::chrono::seconds(20)};
}

std::unique_ptr<Subject> started(WorkerCommand command = misbehaving()) {
  auto subject = WorkerSubject::start("misbehaving", std::move(command));
  EXPECT_TRUE(subject) << subject.error().message;
  return subject ? std::move(*subject) : nullptr;
}

constexpr Extent kShortRows{8, 8};
constexpr Extent kLongRows{33, 4};

Scene scene_of(const std::vector<float>& first_x, Extent target = kShortRows) {
  Scene scene;
  scene.setting.target = target;
  for (const float x : first_x) scene.triangles.push_back(Triangle{{{x, 0}, {1, 0}, {0, 1}}});
  return scene;
}

// What each 64-bit word of triangle i's mask is.
std::uint64_t word_of(const Scene& scene, std::size_t i) {
  const std::uint64_t bits = std::bit_cast<std::uint32_t>(scene.triangles[i][0].x);
  return scene.setting.target == kShortRows ? bits : bits << 32 | bits;
}

void expect_draws(Subject& subject, const Scene& scene) {
  MaskBatch masks;
  const auto result = subject.draw(scene, masks);
  ASSERT_TRUE(result) << result.error().message;
  ASSERT_EQ(masks.size(), scene.triangles.size());
  for (std::size_t i = 0; i < masks.size(); ++i) {
    ASSERT_THAT(masks[i], testing::Each(word_of(scene, i))) << i;
  }
}

std::string error_of(Subject& subject, const Scene& scene) {
  MaskBatch masks;
  const auto result = subject.draw(scene, masks);
  EXPECT_FALSE(result);
  if (result) return "";
  EXPECT_EQ(result.error().kind, ErrorKind::subject);
  EXPECT_EQ(result.error().message.find('\n'), std::string::npos);
  return result.error().message;
}

TEST(Worker, TellsWhatTheDriverSays) {
  const auto subject = started();
  ASSERT_NE(subject, nullptr);
  const SubjectInfo& info = subject->info();
  EXPECT_EQ(info.name, "misbehaving");
  EXPECT_EQ(info.device, "misbehaving");
  EXPECT_EQ(info.rules, (Rules{4, SnapRounding::truncate}));
  EXPECT_THAT(info.sample_counts, testing::ElementsAre(1, 2));
  EXPECT_EQ(info.max_target, 64);
  EXPECT_EQ(info.max_coordinate, 1024);
  expect_draws(*subject, scene_of({1, 2, 3}));
  EXPECT_EQ(subject->driver_seconds(), 0.25);
}

// Masks of 32 bytes in buffers of 4,096: 128 triangles a draw.
TEST(Worker, SplitsBatchesByTheDriversBuffer) {
  const auto subject = started();
  ASSERT_NE(subject, nullptr);
  for (const Extent& target : {kShortRows, kLongRows}) {
    for (const std::size_t count : {0U, 1U, 127U, 128U, 129U, 1000U}) {
      std::vector<float> first_x(count);
      for (std::size_t i = 0; i < count; ++i) first_x[i] = static_cast<float>(i % 800);
      const double before = subject->driver_seconds();
      expect_draws(*subject, scene_of(first_x, target));
      EXPECT_EQ(subject->driver_seconds() - before, 0.25 * static_cast<double>((count + 127) / 128)) << count;
    }
  }
}

// In one draw and in several, where the masks have to be put together.
TEST(Worker, MasksInPlaceAreThoseThatItWouldCopy) {
  const auto subject = started();
  ASSERT_NE(subject, nullptr);
  for (const Extent& target : {kShortRows, kLongRows}) {
    for (const std::size_t count : {0U, 1U, 128U, 129U, 260U}) {
      std::vector<float> first_x(count);
      for (std::size_t i = 0; i < count; ++i) first_x[i] = static_cast<float>(count + i);
      const Scene scene = scene_of(first_x, target);
      MaskBatch scratch;
      const auto masks = subject->draw_in_place(scene, scratch);
      ASSERT_TRUE(masks) << masks.error().message;
      ASSERT_EQ(masks->size(), count);
      EXPECT_EQ(masks->have_short_rows(), 0 < count && count <= 128 && target == kShortRows);
      EXPECT_EQ(scratch.size(), count <= 128 ? 0 : count);
      MaskBatch whole;
      for (std::size_t i = 0; i < count; ++i) {
        ASSERT_THAT(masks->whole(i, 1, whole)[0], testing::Each(word_of(scene, i))) << i;
      }
      const MaskBatchView all = masks->whole(whole);
      ASSERT_EQ(all.size(), count);
      for (std::size_t i = 0; i < count; ++i) ASSERT_THAT(all[i], testing::Each(word_of(scene, i))) << i;
    }
  }
}

TEST(Worker, CrashNamesSignalTrianglesAndLastWordsAndIsOvercome) {
  const auto subject = started();
  ASSERT_NE(subject, nullptr);
  std::vector<float> first_x(200, 5);
  first_x[128] = kAbort;
  for (int round = 0; round < 3; ++round) {
    expect_draws(*subject, scene_of({1, 2}));
    const std::string error = error_of(*subject, scene_of(first_x));
    EXPECT_THAT(error,
                StartsWith("misbehaving: drawing triangles 128 to 199 of 200, the driver died of signal SIGABRT"));
    EXPECT_THAT(error, HasSubstr("the driver's own complaint in two lines"));
  }
  expect_draws(*subject, scene_of({1, 2}));
}

TEST(Worker, HangIsEndedAfterTheTimeLimit) {
  WorkerCommand command = misbehaving();
  command.time_limit = std::chrono::milliseconds(300);
  const auto subject = started(command);
  ASSERT_NE(subject, nullptr);
  const auto start = std::chrono::steady_clock::now();
  EXPECT_THAT(error_of(*subject, scene_of({kHang})), HasSubstr("the driver gave no answer within 0.3 s and was ended"));
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
  expect_draws(*subject, scene_of({1}));
}

TEST(Worker, LeavingInsideADrawIsAnError) {
  const auto subject = started();
  ASSERT_NE(subject, nullptr);
  EXPECT_THAT(error_of(*subject, scene_of({kExit})), HasSubstr("the driver ended by itself with status 0"));
  expect_draws(*subject, scene_of({1}));
}

TEST(Worker, ADriversRefusalIsAnError) {
  const auto subject = started();
  ASSERT_NE(subject, nullptr);
  EXPECT_EQ(error_of(*subject, scene_of({kRefuse})), "misbehaving: will not");
  expect_draws(*subject, scene_of({1}));
}

TEST(Worker, ChatterDoesNotBlock) {
  const auto subject = started();
  ASSERT_NE(subject, nullptr);
  for (int round = 0; round < 3; ++round) expect_draws(*subject, scene_of({kChatter}));
}

TEST(Worker, FailuresWhileOpening) {
  const auto absent = WorkerSubject::start("a", misbehaving({"absent"}));
  ASSERT_FALSE(absent);
  EXPECT_EQ(absent.error().kind, ErrorKind::absent);
  EXPECT_EQ(absent.error().message, "a: no such driver");

  const auto abort = WorkerSubject::start("b", misbehaving({"abort"}));
  ASSERT_FALSE(abort);
  EXPECT_EQ(abort.error().kind, ErrorKind::subject);
  EXPECT_THAT(abort.error().message, StartsWith("b: while it was opened, the driver died of signal SIGABRT"));

  WorkerCommand slow = misbehaving({"hang"});
  slow.time_limit = std::chrono::milliseconds(100);
  const auto hang = WorkerSubject::start("c", slow);
  ASSERT_FALSE(hang);
  EXPECT_THAT(hang.error().message, HasSubstr("gave no answer within 0.1 s"));

  const auto missing = WorkerSubject::start("d", {"/nonexistent/worker", {}, {}, std::chrono::seconds(1)});
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().kind, ErrorKind::absent);
  EXPECT_THAT(missing.error().message, HasSubstr("cannot start the worker program /nonexistent/worker"));
}

TEST(Worker, EnvironmentIsReplacedForTheWorkerOnly) {
  setenv("EDGECASE_TEST_VARIABLE", "program's", 1);
  WorkerCommand command = misbehaving({"environment"});
  command.environment = {"EDGECASE_TEST_VARIABLE=worker's"};
  EXPECT_NE(started(command), nullptr);
  EXPECT_STREQ(std::getenv("EDGECASE_TEST_VARIABLE"), "program's");
}

// A program that is killed in the middle of a draw leaves no hung worker behind.
TEST(Worker, DiesWithTheProgram) {
  const std::string pid_file = testing::TempDir() + "edgecase_worker_pid_" + std::to_string(getpid());
  prctl(PR_SET_CHILD_SUBREAPER, 1);  // the orphaned worker becomes our child, so that we see it end
  const pid_t program = fork();
  if (program == 0) {
    const auto subject = started(misbehaving({"", pid_file}));
    MaskBatch masks;
    (void)subject->draw(scene_of({kHang}), masks);
    _exit(1);
  }
  pid_t worker = 0;
  for (int attempt = 0; attempt < 1000 && worker == 0; ++attempt) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    std::ifstream(pid_file) >> worker;
  }
  unlink(pid_file.c_str());
  ASSERT_GT(worker, 0);
  kill(program, SIGKILL);
  ASSERT_EQ(waitpid(program, nullptr, 0), program);
  pid_t ended = 0;
  for (int attempt = 0; attempt < 1000 && ended == 0; ++attempt) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    ended = waitpid(worker, nullptr, WNOHANG);
  }
  EXPECT_EQ(ended, worker);
}

}  // namespace
}  // namespace edgecase::conformance
