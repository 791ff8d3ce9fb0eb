#pragma once

#include <chrono>

namespace furrow::dds {

/// Wakes one thread, at once or after a while, on behalf of others. Unlike a condition variable's
/// notification, a late ring takes nothing from the processors in the meantime.
class Alarm {
 public:
  /// Throws std::system_error when the system has no timer left.
  Alarm();
  ~Alarm();
  Alarm(const Alarm&) = delete;
  Alarm& operator=(const Alarm&) = delete;

  /// Takes the place of a ring that is still to come. Never blocks.
  void ring_in(std::chrono::nanoseconds delay);
  /// Until it rings; at once when it has rung since the last wait.
  void wait();

 private:
  int timer_;
};

}  // namespace furrow::dds
