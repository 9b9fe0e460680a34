#include "conformance/subjects/worker_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <string_view>

namespace edgecase::conformance {
namespace {

// Chatter beyond this is thrown away after each draw.
constexpr off_t kMaxLogBytes = 1 << 20;
constexpr std::size_t kShownLogBytes = 400;

tl::unexpected<Error> failure(std::string message) {
  return tl::unexpected(Error{ErrorKind::subject, std::move(message)});
}

std::string how_it_ended(int status) {
  if (WIFSIGNALED(status)) {
    const char* name = sigabbrev_np(WTERMSIG(status));
    return fmt::format("died of signal {}{}", name == nullptr ? "" : "SIG",
                       name == nullptr ? std::to_string(WTERMSIG(status)) : name);
  }
  return fmt::format("ended by itself with status {}", WEXITSTATUS(status));
}

// Our environment with `changes` laid over it.
std::vector<std::string> environment_with(const std::vector<std::string>& changes) {
  std::vector<std::string> result = changes;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view existing(*entry);
    const std::string_view assignment = existing.substr(0, existing.find('=') + 1);
    const bool replaced =
        std::ranges::any_of(changes, [&](const std::string& change) { return change.starts_with(assignment); });
    if (!replaced) result.emplace_back(existing);
  }
  return result;
}

std::vector<char*> pointers_to(std::vector<std::string>& strings) {
  std::vector<char*> result;
  for (std::string& s : strings) result.push_back(s.data());
  result.push_back(nullptr);
  return result;
}

// A descriptor above those the worker expects, so that dup2 in the child overwrites none that is still needed.
int moved_up(int descriptor) {
  const int moved = fcntl(descriptor, F_DUPFD_CLOEXEC, kWorkerMemory + 1);
  close(descriptor);
  return moved;
}

}  // namespace

tl::expected<std::unique_ptr<WorkerProcess>, Error> WorkerProcess::start(const WorkerCommand& command) {
  std::unique_ptr<WorkerProcess> worker(new WorkerProcess);
  auto memory = SharedMemory::create();
  if (!memory) return tl::unexpected(memory.error());
  worker->memory_ = std::move(*memory);
  worker->log_ = memfd_create("edgecase-worker-log", MFD_CLOEXEC);
  int sockets[2] = {-1, -1};
  if (worker->log_ < 0 || socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, sockets) != 0) {
    return failure(fmt::format("cannot connect to a worker process: {}", std::strerror(errno)));
  }
  fcntl(worker->log_, F_SETFL, O_APPEND);
  worker->socket_ = sockets[0];
  const int theirs = moved_up(sockets[1]);
  const int their_memory = fcntl(worker->memory_.descriptor(), F_DUPFD_CLOEXEC, kWorkerMemory + 1);

  std::vector<std::string> arguments = command.arguments;
  arguments.insert(arguments.begin(), command.program);
  std::vector<std::string> environment = environment_with(command.environment);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, worker->log_, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, worker->log_, STDERR_FILENO);
  posix_spawn_file_actions_adddup2(&actions, theirs, kWorkerSocket);
  posix_spawn_file_actions_adddup2(&actions, their_memory, kWorkerMemory);
  const int spawned = posix_spawn(&worker->pid_, command.program.c_str(), &actions, nullptr,
                                  pointers_to(arguments).data(), pointers_to(environment).data());
  posix_spawn_file_actions_destroy(&actions);
  close(theirs);
  close(their_memory);
  if (spawned != 0) {
    worker->pid_ = -1;
    return tl::unexpected(Error{ErrorKind::absent, fmt::format("cannot start the worker program {}: {}",
                                                               command.program, std::strerror(spawned))});
  }
  if (auto received = worker->receive(&worker->hello_, sizeof worker->hello_, command.time_limit); !received) {
    return failure(fmt::format("while it was opened, the driver {}", received.error().message));
  }
  if (const WorkerStatus& status = worker->hello_.status; !status.ok) {
    return tl::unexpected(Error{status.kind, std::string(status.message.view())});
  }
  return worker;
}

WorkerProcess::~WorkerProcess() {
  if (pid_ > 0) end(true);
  if (socket_ >= 0) close(socket_);
  if (log_ >= 0) close(log_);
}

tl::expected<DrawReply, Error> WorkerProcess::draw(const DrawRequest& request, std::chrono::milliseconds time_limit) {
  if (pid_ < 0) return failure("is not running");
  if (struct stat log{}; fstat(log_, &log) == 0 && log.st_size > kMaxLogBytes && ftruncate(log_, 0) != 0) {
    return failure(fmt::format("wrote a log that cannot be cut: {}", std::strerror(errno)));
  }
  if (send(socket_, &request, sizeof request, MSG_NOSIGNAL) < 0) return failure(end(false));
  DrawReply reply;
  if (auto received = receive(&reply, sizeof reply, time_limit); !received) return tl::unexpected(received.error());
  return reply;
}

tl::expected<void, Error> WorkerProcess::receive(void* message, std::size_t size,
                                                 std::chrono::milliseconds time_limit) {
  const auto deadline = std::chrono::steady_clock::now() + time_limit;
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now()).count();
    pollfd waiting{socket_, POLLIN, 0};
    const int ready = poll(&waiting, 1, static_cast<int>(std::clamp<long>(left, 0, 1'000'000'000)));
    if (ready < 0 && errno == EINTR) continue;
    if (ready == 0) {
      const std::string said = last_words();
      end(true);
      return failure(fmt::format("gave no answer within {:.1f} s and was ended{}",
                                 std::chrono::duration<double>(time_limit).count(), said));
    }
    // A worker that died has closed its end: nothing is read.
    const ssize_t received = recv(socket_, message, size, 0);
    if (received < 0 && errno == EINTR) continue;
    if (received != static_cast<ssize_t>(size)) return failure(end(false));
    return {};
  }
}

std::string WorkerProcess::end(bool kill) {
  if (kill) ::kill(pid_, SIGKILL);
  int status = 0;
  while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  pid_ = -1;
  return how_it_ended(status) + last_words();
}

std::string WorkerProcess::last_words() const {
  struct stat log {};
  if (fstat(log_, &log) != 0 || log.st_size == 0) return "";
  std::string text(std::min<std::size_t>(static_cast<std::size_t>(log.st_size), kShownLogBytes), '\0');
  const ssize_t got = pread(log_, text.data(), text.size(), log.st_size - static_cast<off_t>(text.size()));
  text.resize(static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
  while (!text.empty() && text.back() == '\n') text.pop_back();
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  }
  return text.empty() ? "" : fmt::format("; its last words: {}", text);
}

}  // namespace edgecase::conformance
