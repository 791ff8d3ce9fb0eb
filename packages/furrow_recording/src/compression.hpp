#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include "bytes.hpp"
#include "furrow_core/result.hpp"
#include "furrow_recording/mcap_types.hpp"

namespace furrow::mcap {

/// The name in a chunk: "", "lz4", "zstd".
[[nodiscard]] std::string_view compression_name(Compression compression);
[[nodiscard]] std::optional<Compression> compression_from_name(std::string_view name);

/// Compresses chunks. Keeps its working memory between them.
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

/// Unpacks to exactly `size` bytes, else kParse. Memory grows with the output, so that a wrong
/// `size` takes none.
[[nodiscard]] Status unpack(Compression compression, ByteView packed, std::uint64_t size,
                            Bytes& unpacked);
/// As unpack(), of bzip2, which ROS 1 uses.
[[nodiscard]] Status unpack_bzip2(ByteView packed, std::uint64_t size, Bytes& unpacked);
/// Unpacks one zstd frame of at most `max_size` bytes; kParse when it is malformed or larger.
[[nodiscard]] Status unpack_zstd_frame(ByteView packed, std::uint64_t max_size, Bytes& unpacked);

}  // namespace furrow::mcap
