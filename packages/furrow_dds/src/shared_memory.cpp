#include "shared_memory.hpp"

#include <fastdds/rtps/transport/TransportInterface.h>
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <charconv>
#include <cstdint>
#include <memory>
#include <random>
#include <set>
#include <string>
#include <string_view>

namespace furrow::dds {

namespace fs = std::filesystem;
using eprosima::fastdds::rtps::LocatorList;
using eprosima::fastdds::rtps::SharedMemTransportDescriptor;
using eprosima::fastdds::rtps::TransportInterface;

namespace {

constexpr std::string_view kPrefix = "fastrtps_";
constexpr std::string_view kPortPrefix = "port";
constexpr std::string_view kLockSuffix = "_el";
constexpr std::size_t kSegmentDigits = 16;

enum class Kind { kOther, kSegment, kPort };

/// The kind of a name without prefix and suffix; kPort only for ports of own_shm_locators().
Kind kind_of(std::string_view name) {
  if (name.starts_with(kPortPrefix)) {
    name.remove_prefix(kPortPrefix.size());
    std::uint32_t port = 0;
    const auto [end, failure] = std::from_chars(name.data(), name.data() + name.size(), port);
    const bool whole = failure == std::errc() && end == name.data() + name.size();
    return whole && port >= kFirstOwnShmPort ? Kind::kPort : Kind::kOther;
  }
  const bool segment = name.size() == kSegmentDigits &&
                       name.find_first_not_of("0123456789abcdef") == std::string_view::npos;
  return segment ? Kind::kSegment : Kind::kOther;
}

/// Fast DDS locks the file as long as the process lives.
bool is_unlocked(const fs::path& lock_file) {
  const int file = ::open(lock_file.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return false;
  const bool free = ::flock(file, LOCK_EX | LOCK_NB) == 0;
  ::close(file);
  return free;
}

bool is_newer(const fs::path& file, fs::file_time_type than) {
  std::error_code unread;
  const fs::file_time_type time = fs::last_write_time(file, unread);
  return !unread && time >= than;
}

/// A port without a lock file was created by a process that wrote to a dead reader.
bool is_dead(const fs::path& folder, const std::string& name, fs::file_time_type newest) {
  const Kind kind = kind_of(std::string_view(name).substr(kPrefix.size()));
  if (kind == Kind::kOther) return false;
  const fs::path lock_file = folder / (name + std::string(kLockSuffix));
  if (is_newer(folder / name, newest) || is_newer(lock_file, newest)) return false;
  std::error_code unread;
  if (!fs::exists(lock_file, unread)) return !unread && kind == Kind::kPort;
  return is_unlocked(lock_file);
}

}  // namespace

LocatorList own_shm_locators(const SharedMemTransportDescriptor& transport) {
  std::random_device random;
  std::uniform_int_distribution<std::uint32_t> port(kFirstOwnShmPort, 0x7fffffff);
  LocatorList own;
  // Only a transport knows the name of this host in its locators.
  const std::unique_ptr<TransportInterface> maker(transport.create_transport());
  if (maker != nullptr) maker->getDefaultUnicastLocators(own, port(random));
  return own;
}

std::size_t remove_dead_shared_memory(const fs::path& folder, std::chrono::seconds age) {
  const auto newest = fs::file_time_type::clock::now() - age;
  std::error_code failure;
  std::set<std::string> dead;
  for (fs::directory_iterator it(folder, failure); !failure && it != fs::directory_iterator();
       it.increment(failure)) {
    std::string name = it->path().filename().string();
    if (!name.starts_with(kPrefix)) continue;
    if (name.ends_with(kLockSuffix)) name.resize(name.size() - kLockSuffix.size());
    if (is_dead(folder, name, newest)) dead.insert(name);
  }
  for (const std::string& name : dead) {
    for (const std::string& file :
         {name, "sem." + name + "_mutex", name + std::string(kLockSuffix)}) {
      std::error_code unremoved;
      fs::remove(folder / file, unremoved);
    }
  }
  return dead.size();
}

}  // namespace furrow::dds
