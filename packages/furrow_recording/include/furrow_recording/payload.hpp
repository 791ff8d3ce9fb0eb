#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace furrow::recording {

/// A serialized message. It never changes, so that several threads may share it.
using Payload = std::shared_ptr<const std::vector<std::byte>>;

}  // namespace furrow::recording
