#include "alarm.hpp"

#include <sys/timerfd.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <system_error>

namespace furrow::dds {

Alarm::Alarm() : timer_(::timerfd_create(CLOCK_MONOTONIC, TFD_CLOEXEC)) {
  if (timer_ < 0) throw std::system_error(errno, std::generic_category(), "timerfd_create");
}

Alarm::~Alarm() {
  ::close(timer_);
}

void Alarm::ring_in(std::chrono::nanoseconds delay) {
  constexpr std::int64_t kNsPerS = 1'000'000'000;
  // Zero would switch the timer off.
  const std::int64_t ns = std::max<std::int64_t>(delay.count(), 1);
  const itimerspec once{.it_interval = {}, .it_value = {ns / kNsPerS, ns % kNsPerS}};
  (void)::timerfd_settime(timer_, 0, &once, nullptr);
}

void Alarm::wait() {
  std::uint64_t rings = 0;
  while (::read(timer_, &rings, sizeof(rings)) < 0 && errno == EINTR) {
  }
}

}  // namespace furrow::dds
