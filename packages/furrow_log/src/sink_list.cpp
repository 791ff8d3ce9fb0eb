#include "sink_list.hpp"

#include <utility>

namespace furrow::log {

void SinkList::add(std::shared_ptr<Sink> sink) {
  const std::lock_guard lock(mutex_);
  sinks_.push_back(std::move(sink));
}

void SinkList::remove(const Sink& sink) {
  const std::lock_guard lock(mutex_);
  std::erase_if(sinks_, [&](const auto& own) { return own.get() == &sink; });
}

void SinkList::write(std::span<const Line> lines) {
  const std::lock_guard lock(mutex_);
  for (const Line& line : lines) {
    for (const auto& sink : sinks_) {
      if (!sink->write(line)) ++failed_;
    }
  }
}

void SinkList::flush() {
  const std::lock_guard lock(mutex_);
  for (const auto& sink : sinks_) sink->flush();
}

}  // namespace furrow::log
