#pragma once

#include <functional>
#include <string>
#include <thread>

namespace furrow::cli {

/// Calls back from its own thread with each line of standard input, until it is destroyed. An input
/// that has ended, or is not there, is ignored.
class ControlInput {
 public:
  explicit ControlInput(std::function<void(const std::string&)> on_line);
  ~ControlInput();
  ControlInput(const ControlInput&) = delete;
  ControlInput& operator=(const ControlInput&) = delete;

 private:
  void run(const std::function<void(const std::string&)>& on_line) const;
  int wake_[2] = {-1, -1};
  std::thread thread_;
};

}  // namespace furrow::cli
