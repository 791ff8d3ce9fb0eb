#include "sender.hpp"

#include "send_queue.hpp"

namespace furrow::dds {

SendThread::SendThread() : thread_([this] { run(); }) {}

SendThread::~SendThread() {
  {
    const MutexLock lock(mutex_);
    stop_ = true;
  }
  work_.notify_one();
  thread_.join();
}

void SendThread::schedule(SendQueue& queue) {
  {
    const MutexLock lock(mutex_);
    ready_.push_back(&queue);
  }
  work_.notify_one();
}

void SendThread::remove(SendQueue& queue) {
  const MutexLock lock(mutex_);
  while (current_ == &queue) served_.wait(mutex_);
  std::erase(ready_, &queue);
}

void SendThread::run() {
  MutexLock lock(mutex_);
  while (true) {
    while (!stop_ && ready_.empty()) work_.wait(mutex_);
    if (stop_) return;
    SendQueue& queue = *ready_.front();
    ready_.pop_front();
    current_ = &queue;
    lock.unlock();
    if (SendThread* next = queue.send_oldest()) next->schedule(queue);
    lock.lock();
    current_ = nullptr;
    served_.notify_all();
  }
}

}  // namespace furrow::dds
