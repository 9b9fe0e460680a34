// A worker process as the program sees it: started, spoken to, and explained when it dies.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "conformance/scene/error.h"
#include "conformance/subjects/shared_memory.h"
#include "conformance/subjects/worker_protocol.h"

namespace edgecase::conformance {

/// How a worker is started.
struct WorkerCommand {
  std::string program;                   ///< path of the executable
  std::vector<std::string> arguments;    ///< after the program's name
  std::vector<std::string> environment;  ///< NAME=VALUE, in addition to or instead of what this process has
  /// For each answer of the worker; a draw gets more, by its size.
  std::chrono::milliseconds time_limit{60'000};
};

/// One process. Its standard output and standard error, where drivers chatter, go to a memory file of which only the
/// last lines are shown, and only in errors. Destruction ends it.
class WorkerProcess {
 public:
  /// Starts the process and waits for its WorkerHello.
  static tl::expected<std::unique_ptr<WorkerProcess>, Error> start(const WorkerCommand& command);
  ~WorkerProcess();
  WorkerProcess(const WorkerProcess&) = delete;
  WorkerProcess& operator=(const WorkerProcess&) = delete;

  const WorkerHello& hello() const { return hello_; }
  SharedMemory& memory() { return memory_; }

  /// The worker's answer, or how it died instead: "died of signal SIGSEGV (...)", "gave no answer within 60 s".
  /// After an error the process is gone; a driver's own refusal is no error here but in the reply.
  tl::expected<DrawReply, Error> draw(const DrawRequest& request, std::chrono::milliseconds time_limit);

 private:
  WorkerProcess() = default;
  tl::expected<void, Error> receive(void* message, std::size_t size, std::chrono::milliseconds time_limit);
  /// Reaps the process, after killing it if `kill`, and says how it ended.
  std::string end(bool kill);
  std::string last_words() const;

  pid_t pid_ = -1;
  int socket_ = -1;
  int log_ = -1;
  SharedMemory memory_;
  WorkerHello hello_;
};

}  // namespace edgecase::conformance
