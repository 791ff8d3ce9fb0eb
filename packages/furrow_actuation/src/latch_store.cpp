#include "furrow_actuation/latch_store.hpp"

#include <algorithm>
#include <string_view>

#include "furrow_core/error.hpp"
#include "furrow_core/file.hpp"

namespace furrow::actuation {
namespace {

constexpr std::string_view kTitle = "furrow latches 1";
constexpr std::string_view kEnd = "end";

std::string text_of(const CauseSet& latched) {
  std::string text(kTitle);
  text += '\n';
  for (const SafetyCause cause : latched.list()) text.append(to_string(cause)) += '\n';
  return text.append(kEnd) += '\n';
}

CauseSet unknown() {
  CauseSet set;
  set.insert(SafetyCause::kLatchesUnknown);
  return set;
}

CauseSet parse(std::string_view text) {
  CauseSet set;
  bool titled = false;
  while (!text.empty()) {
    const std::size_t length = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, length);
    text.remove_prefix(std::min(length + 1, text.size()));
    if (!titled) {
      if (line != kTitle) return unknown();
      titled = true;
    } else if (line == kEnd) {
      return text.empty() ? set : unknown();
    } else if (const auto cause = safety_cause(line)) {
      set.insert(*cause);
    } else {
      return unknown();
    }
  }
  return unknown();
}

CauseSet load(const std::filesystem::path& file) {
  constexpr std::size_t kMostBytes = 4096;
  const auto text = read_file(file, kMostBytes);
  if (text.ok()) return parse(*text);
  return text.error().code == ErrorCode::kNotFound ? CauseSet() : unknown();
}

}  // namespace

LatchStore::LatchStore(std::filesystem::path file) : file_(std::move(file)), loaded_(load(file_)) {
  if (const Status written = write_file_atomically(file_, text_of(loaded_)); !written.ok()) {
    throw ConfigError("latches: " + written.error().message);
  }
  newest_ = loaded_;
  on_disk_ = loaded_;
  writer_ = std::jthread([this](const std::stop_token& stop) { write_as_told(stop); });
}

LatchStore::~LatchStore() {
  writer_.request_stop();
}

void LatchStore::keep(const CauseSet& latched) {
  const std::lock_guard lock(mutex_);
  if (newest_ == latched) return;
  newest_ = latched;
  pending_ = true;
  changed_.notify_one();
}

std::string LatchStore::failure() const {
  const std::lock_guard lock(mutex_);
  return failure_;
}

bool LatchStore::kept() const {
  const std::lock_guard lock(mutex_);
  return on_disk_ == newest_;
}

void LatchStore::write_as_told(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (changed_.wait(lock, stop, [this] { return pending_; })) {
    pending_ = false;
    const CauseSet set = newest_;
    lock.unlock();
    const Status written = write_file_atomically(file_, text_of(set));
    lock.lock();
    if (written.ok()) on_disk_ = set;
    failure_ = written.ok() ? "" : written.error().message;
  }
}

}  // namespace furrow::actuation
