#pragma once

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace furrow::dds {

/// For tests: a DDS domain from 10 to 100 that no other test on this host uses while this process
/// lives. It locks a file in the temporary folder. The ports of domains above 100 are ephemeral.
/// Throws std::runtime_error if all domains are in use.
[[nodiscard]] inline std::int64_t test_domain() {
  static const std::int64_t claimed = [] {
    constexpr int kFirst = 10;
    constexpr int kCount = 91;
    for (int i = 0; i < kCount; ++i) {
      const int domain = kFirst + (getpid() + i) % kCount;
      const auto path =
          std::filesystem::temp_directory_path() / ("furrow_test_domain_" + std::to_string(domain));
      const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
      if (file >= 0 && ::flock(file, LOCK_EX | LOCK_NB) == 0) return domain;
      if (file >= 0) ::close(file);
    }
    throw std::runtime_error("all DDS domains from 10 to 100 are used by other tests");
  }();
  return claimed;
}

}  // namespace furrow::dds
