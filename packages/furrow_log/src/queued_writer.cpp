#include "queued_writer.hpp"

#include <string>
#include <utility>

namespace furrow::log {

QueuedWriter::QueuedWriter(SinkList& sinks) : sinks_(sinks) {
  // So that push() moves no lines under the lock.
  queue_.reserve(kMaxQueued);
  batch_.reserve(kMaxQueued + 1);
  thread_ = std::thread([this] { run(); });
}

QueuedWriter::~QueuedWriter() {
  {
    const std::lock_guard lock(queue_mutex_);
    ending_ = true;
  }
  wake_.release();
  thread_.join();
}

bool QueuedWriter::push(Line line) {
  {
    const std::lock_guard lock(queue_mutex_);
    if (queue_.size() == kMaxQueued) {
      ++dropped_;
      return false;
    }
    queue_.push_back(std::move(line));
    ++pushed_;
  }
  wake_.release();
  return true;
}

void QueuedWriter::wait_until_written() {
  std::uint64_t target = 0;
  {
    const std::lock_guard lock(queue_mutex_);
    target = pushed_;
  }
  std::unique_lock lock(written_mutex_);
  written_changed_.wait(lock, [this, target] { return written_ >= target; });
}

std::uint64_t QueuedWriter::dropped() const {
  const std::lock_guard lock(queue_mutex_);
  return dropped_;
}

void QueuedWriter::run() {
  bool ending = false;
  while (!ending) {
    wake_.acquire();
    {
      const std::lock_guard lock(queue_mutex_);
      ending = ending_;
    }
    write_all();
  }
}

void QueuedWriter::write_all() {
  batch_.clear();
  std::uint64_t dropped = 0;
  {
    const std::lock_guard lock(queue_mutex_);
    std::swap(batch_, queue_);
    dropped = dropped_;
  }
  if (batch_.empty()) return;
  const std::uint64_t count = batch_.size();
  if (const std::uint64_t more = dropped - std::exchange(dropped_told_, dropped); more > 0) {
    batch_.push_back(
        {batch_.back().time, Level::kWarn, "log",
         std::to_string(more) + " lines were dropped; the queue to the disk was full"});
  }
  sinks_.write(batch_);
  sinks_.flush();  // a process that is killed leaves its lines
  {
    const std::lock_guard lock(written_mutex_);
    written_ += count;
  }
  written_changed_.notify_all();
}

}  // namespace furrow::log
