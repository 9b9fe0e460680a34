#include "conformance/subjects/worker_server.h"

#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <thread>

#include "conformance/scene/standard_samples.h"
#include "conformance/subjects/shared_memory.h"
#include "conformance/subjects/worker_protocol.h"

namespace edgecase::conformance {
namespace {

// The program is gone or wants no more. _exit: a driver's own clean-up, which may hang or crash, is nobody's concern.
[[noreturn]] void leave() { _exit(0); }

// The kernel closes the program's end of the socket when it dies, however it dies. A thread of its own watches for
// that, so that a driver that hangs does not outlive the program. (PR_SET_PDEATHSIG would not do: it fires when the
// thread that started the worker ends.)
void watch_program() {
  std::thread([] {
    pollfd watched{kWorkerSocket, POLLRDHUP, 0};
    while (poll(&watched, 1, -1) < 0 && errno == EINTR) {
    }
    leave();
  }).detach();
}

template <typename Message>
void send_message(const Message& message) {
  if (send(kWorkerSocket, &message, sizeof message, MSG_NOSIGNAL) != static_cast<ssize_t>(sizeof message)) leave();
}

template <typename Message>
Message receive_message() {
  Message message;
  ssize_t received = 0;
  do {
    received = recv(kWorkerSocket, &message, sizeof message, 0);
  } while (received < 0 && errno == EINTR);
  if (received != static_cast<ssize_t>(sizeof message)) leave();
  return message;
}

WorkerHello describe(const Driver& driver) {
  const SubjectInfo& info = driver.info();
  WorkerHello hello;
  hello.device.assign(info.device);
  hello.rules = info.rules;
  hello.sample_count_number =
      static_cast<std::uint32_t>(std::min(info.sample_counts.size(), hello.sample_counts.size()));
  std::copy_n(info.sample_counts.begin(), hello.sample_count_number, hello.sample_counts.begin());
  hello.max_target = info.max_target;
  hello.scissor = info.scissor;
  hello.cull = info.cull;
  hello.assembly = info.assembly;
  hello.clip = info.clip;
  hello.flipped_viewport = info.flipped_viewport;
  hello.max_viewport = info.max_viewport;
  hello.viewport_bound = info.viewport_bound;
  hello.max_coordinate = info.max_coordinate;
  hello.max_mask_bytes = driver.max_mask_bytes();
  return hello;
}

DrawReply draw(Driver& driver, SharedMemory& memory, const DrawRequest& request) {
  DrawReply reply;
  if (memory.size() < request.memory_bytes) {
    driver.use_memory({});
    if (auto mapped = memory.map(request.memory_bytes); !mapped) {
      reply.status.set(mapped.error());
      return reply;
    }
    driver.use_memory({memory.data(), memory.size()});
  }
  const auto locations = standard_sample_locations(request.samples);
  Setting setting;
  setting.target = {request.width, request.height};
  setting.sample_locations.assign(locations.begin(), locations.end());
  if (request.has_scissor) setting.scissor = request.scissor;
  setting.cull = request.cull;
  setting.front_face = request.front_face;
  Primitives primitives;
  primitives.viewport = request.viewport;
  primitives.coordinates = {reinterpret_cast<const float*>(memory.data()), request.vertices * request.components};
  primitives.components = request.components;
  primitives.topology = request.topology;
  primitives.indices = {reinterpret_cast<const std::uint32_t*>(memory.data() + request.indices_offset),
                        request.indices};
  primitives.triangles = request.triangles;
  const std::span masks(reinterpret_cast<std::uint32_t*>(memory.data() + request.masks_offset),
                        MaskLayout(setting).driver_words() * request.triangles);
  if (auto seconds = driver.draw(setting, primitives, masks)) {
    reply.driver_seconds = *seconds;
  } else {
    reply.status.set(seconds.error());
  }
  return reply;
}

}  // namespace

void serve_driver(const std::function<tl::expected<std::unique_ptr<Driver>, Error>()>& open) {
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  watch_program();
  const auto driver = open();
  if (!driver) {
    WorkerHello refusal;
    refusal.status.set(driver.error());
    send_message(refusal);
    leave();
  }
  send_message(describe(**driver));
  SharedMemory memory(kWorkerMemory);
  for (;;) send_message(draw(**driver, memory, receive_message<DrawRequest>()));
}

}  // namespace edgecase::conformance
