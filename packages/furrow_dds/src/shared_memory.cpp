#include "shared_memory.hpp"

#include <fastdds/rtps/transport/TransportInterface.h>
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <charconv>
#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <string_view>
#include <vector>

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

/// Whether a name without prefix and suffix is that of a segment, or of a port that is never used
/// again.
bool may_be_removed(std::string_view name) {
  if (name.starts_with(kPortPrefix)) {
    name.remove_prefix(kPortPrefix.size());
    std::uint32_t port = 0;
    const auto [end, failure] = std::from_chars(name.data(), name.data() + name.size(), port);
    return failure == std::errc() && end == name.data() + name.size() && port >= kFirstOwnShmPort;
  }
  return name.size() == kSegmentDigits &&
         name.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

/// Fast DDS holds a lock on the file as long as the process lives.
bool nobody_holds(const fs::path& lock_file) {
  const int file = ::open(lock_file.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return false;
  const bool free = ::flock(file, LOCK_EX | LOCK_NB) == 0;
  ::close(file);
  return free;
}

}  // namespace

LocatorList own_shm_locators(const SharedMemTransportDescriptor& transport) {
  std::random_device random;
  std::uniform_int_distribution<std::uint32_t> port(kFirstOwnShmPort, 0x7fffffff);
  LocatorList own;
  // Only the transport knows what its locators call this host.
  const std::unique_ptr<TransportInterface> maker(transport.create_transport());
  if (maker != nullptr) maker->getDefaultUnicastLocators(own, port(random));
  return own;
}

std::size_t remove_dead_shared_memory(const fs::path& folder, std::chrono::seconds age) {
  const auto newest = fs::file_time_type::clock::now() - age;
  std::error_code failure;
  std::vector<std::string> dead;
  for (fs::directory_iterator it(folder, failure); !failure && it != fs::directory_iterator();
       it.increment(failure)) {
    const std::string file = it->path().filename().string();
    if (!file.starts_with(kPrefix) || !file.ends_with(kLockSuffix)) continue;
    const std::string name = file.substr(0, file.size() - kLockSuffix.size());
    std::error_code unread;
    if (may_be_removed(std::string_view(name).substr(kPrefix.size())) &&
        it->last_write_time(unread) < newest && !unread && nobody_holds(it->path())) {
      dead.push_back(name);
    }
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
