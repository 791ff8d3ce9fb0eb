#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include "bytes.hpp"
#include "furrow_core/result.hpp"
#include "furrow_recording/mcap_types.hpp"

namespace furrow::mcap {

/// As it stands in a chunk: "", "lz4", "zstd".
[[nodiscard]] std::string_view compression_name(Compression compression);
[[nodiscard]] std::optional<Compression> compression_from_name(std::string_view name);

/// Packs chunks; keeps its working memory between them.
class Packer {
 public:
  Packer(Compression compression, int zstd_level);
  ~Packer();
  Packer(const Packer&) = delete;
  Packer& operator=(const Packer&) = delete;
  /// A view of `bytes` itself without compression, else of memory that lives until the next call.
  [[nodiscard]] Result<ByteView> pack(ByteView bytes);

 private:
  struct Contexts;
  std::unique_ptr<Contexts> contexts_;
  Compression compression_;
  Bytes packed_;
};

/// Unpacks to exactly `size` bytes, else kParse. Memory grows with what comes out, so that a wrong
/// `size` takes none.
[[nodiscard]] Status unpack(Compression compression, ByteView packed, std::uint64_t size,
                            Bytes& unpacked);

}  // namespace furrow::mcap
