#include "thread_scheduling.hpp"

#include <malloc.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <fstream>

namespace furrow::graph {
namespace {

bool may_lock_without_limit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY) return true;
  constexpr int kIpcLock = 14;  // CAP_IPC_LOCK
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    if (word != "CapEff:") continue;
    unsigned long long capabilities = 0;
    status >> std::hex >> capabilities;
    return (capabilities >> kIpcLock & 1) != 0;
  }
  return false;
}

}  // namespace

std::string use_fifo_scheduling(int priority) {
  sched_param parameters{};
  parameters.sched_priority = priority;
  const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
  return error == 0 ? "" : std::strerror(error);
}

std::string lock_memory() {
  if (!may_lock_without_limit()) return "the limit of locked memory (ulimit -l) is too low";
  // Freed image buffers stay with the process. Mapping and clearing their pages for each image
  // would stop every thread for milliseconds.
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, -1);
  return mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) == 0 ? "" : std::strerror(errno);
}

void touch_stack() {
  constexpr std::size_t kBytes = 256 * 1024;
  constexpr std::size_t kPage = 4096;
  std::array<char, kBytes> stack;
  volatile char* const bytes = stack.data();
  for (std::size_t i = 0; i < kBytes; i += kPage) bytes[i] = 0;
}

}  // namespace furrow::graph
