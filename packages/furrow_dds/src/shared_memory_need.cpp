#include "furrow_dds/shared_memory_need.hpp"

#include <sys/statvfs.h>

#include <algorithm>
#include <chrono>

#include "furrow_core/error.hpp"
#include "furrow_core/text.hpp"
#include "shared_memory.hpp"

namespace furrow::dds {
namespace {

constexpr char kFolder[] = "/dev/shm";
constexpr double kBytesPerMb = 1e6;
// Ports of a process: queues of 1024 descriptors for each of its locators.
constexpr std::int64_t kPorts_mb = 1;

}  // namespace

std::string shared_memory_shortage(const DdsParameters& parameters, std::size_t processes,
                                   std::uint64_t available_bytes) {
  const auto& transports = parameters.transports;
  if (processes == 0 || std::ranges::find(transports, "shm") == transports.end()) return "";
  const auto count = static_cast<std::int64_t>(processes);
  const std::int64_t need_mb = count * (parameters.shm_segment_mb + kPorts_mb);
  const double available_mb = static_cast<double>(available_bytes) / kBytesPerMb;
  if (available_mb >= static_cast<double>(need_mb)) return "";
  std::string text =
      "/dev/shm has " + fixed(available_mb, 1) + " MB free, and " + std::to_string(processes) +
      (processes == 1 ? " process needs " : " processes need ") + std::to_string(need_mb) +
      " MB; enlarge it (in Docker by --shm-size=" + std::to_string(2 * need_mb) +
      "m), or set --dds 'transports=[\"udp\"]'";
  const std::int64_t fitting_mb = static_cast<std::int64_t>(available_mb) / count - kPorts_mb;
  if (fitting_mb >= 1) text += ", or shm_segment_mb=" + std::to_string(fitting_mb);
  return text;
}

std::optional<std::uint64_t> shared_memory_available_bytes() {
  struct statvfs state {};
  if (statvfs(kFolder, &state) != 0) return std::nullopt;
  return static_cast<std::uint64_t>(state.f_bavail) * state.f_frsize;
}

void check_shared_memory(const DdsParameters& parameters, std::size_t processes) {
  remove_dead_shared_memory(kFolder, std::chrono::seconds(60));
  const auto available = shared_memory_available_bytes();
  if (!available) return;
  const std::string shortage = shared_memory_shortage(parameters, processes, *available);
  if (!shortage.empty()) throw ConfigError(shortage);
}

}  // namespace furrow::dds
