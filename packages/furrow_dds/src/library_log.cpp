#include "library_log.hpp"

#include <fastdds/dds/log/Log.hpp>
#include <iostream>
#include <memory>
#include <mutex>
#include <string>

#include "furrow_dds/log_redirect.hpp"

namespace furrow::dds {
namespace {

namespace fdds = eprosima::fastdds::dds;

// Fast DDS has one log per process, so that its destination is one per process too.
std::mutex destination_mutex;
log::Log* destination = nullptr;  ///< null: standard error

log::Level level_of(fdds::Log::Kind kind) {
  switch (kind) {
    case fdds::Log::Kind::Error:
      return log::Level::kError;
    case fdds::Log::Kind::Warning:
      return log::Level::kWarn;
    case fdds::Log::Kind::Info:
      break;
  }
  return log::Level::kDebug;
}

class Consumer final : public fdds::LogConsumer {
 public:
  void Consume(const fdds::Log::Entry& entry) override {
    const std::string category = entry.context.category == nullptr ? "" : entry.context.category;
    const std::string text = category.empty() ? entry.message : category + ": " + entry.message;
    const std::lock_guard lock(destination_mutex);
    if (destination != nullptr) {
      destination->write_foreign(level_of(entry.kind), "fastdds", text);
    } else {
      std::cerr << "fastdds: " << text << '\n';
    }
  }
};

}  // namespace

void take_over_library_log() {
  static std::once_flag once;
  std::call_once(once, [] {
    fdds::Log::ClearConsumers();
    fdds::Log::RegisterConsumer(std::make_unique<Consumer>());
  });
}

LogRedirect::LogRedirect(log::Log& log) {
  take_over_library_log();
  const std::lock_guard lock(destination_mutex);
  destination = &log;
}

LogRedirect::~LogRedirect() {
  fdds::Log::Flush();
  const std::lock_guard lock(destination_mutex);
  destination = nullptr;
}

}  // namespace furrow::dds
