#include "compression.hpp"

#include <bzlib.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <string>

namespace furrow::mcap {
namespace {

constexpr std::size_t kGrowthBytes = 1u << 17;

struct ZstdDelete {
  void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
  void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
  void operator()(LZ4F_dctx* context) const { LZ4F_freeDecompressionContext(context); }
};

struct BzipEnd {
  void operator()(bz_stream* stream) const { BZ2_bzDecompressEnd(stream); }
};

Error malformed(std::string_view format, std::string_view why) {
  return {ErrorCode::kParse, "malformed " + std::string(format) + " data: " + std::string(why)};
}

/// Makes room for more output, at most `size` in all; false when there is no more room to make.
bool grow(Bytes& unpacked, std::size_t filled, std::uint64_t size) {
  if (filled < unpacked.size()) {
    return true;
  }
  if (unpacked.size() >= size) {
    return false;
  }
  const std::uint64_t wanted = std::max<std::uint64_t>(kGrowthBytes, 2 * unpacked.size());
  unpacked.resize(static_cast<std::size_t>(std::min(size, wanted)));
  return true;
}

Status check_size(const Bytes& unpacked, std::uint64_t size) {
  if (unpacked.size() != size) {
    return Error{ErrorCode::kParse, "a chunk unpacks to another size than it announces"};
  }
  return {};
}

Status unpack_zstd(ByteView packed, std::uint64_t size, Bytes& unpacked) {
  const std::unique_ptr<ZSTD_DCtx, ZstdDelete> context(ZSTD_createDCtx());
  ZSTD_inBuffer in{packed.data(), packed.size(), 0};
  std::size_t filled = 0;
  std::size_t hint = 1;
  while (hint != 0 || in.pos < in.size) {
    const bool room = grow(unpacked, filled, size);
    ZSTD_outBuffer out{unpacked.data(), unpacked.size(), filled};
    const std::size_t before = in.pos;
    hint = ZSTD_decompressStream(context.get(), &out, &in);
    if (ZSTD_isError(hint) != 0) {
      return malformed("zstd", ZSTD_getErrorName(hint));
    }
    if (out.pos == filled && in.pos == before && hint != 0) {
      return malformed("zstd", room ? "cut short" : "longer than announced");
    }
    filled = out.pos;
  }
  unpacked.resize(filled);
  return {};
}

Status unpack_lz4(ByteView packed, std::uint64_t size, Bytes& unpacked) {
  LZ4F_dctx* raw = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&raw, LZ4F_VERSION)) != 0) {
    return Error{ErrorCode::kUnavailable, "no memory to unpack lz4"};
  }
  const std::unique_ptr<LZ4F_dctx, ZstdDelete> context(raw);
  std::size_t filled = 0;
  std::size_t used = 0;
  std::size_t hint = 1;
  while (hint != 0 || used < packed.size()) {
    const bool room = grow(unpacked, filled, size);
    std::size_t out = unpacked.size() - filled;
    std::size_t in = packed.size() - used;
    hint = LZ4F_decompress(context.get(), unpacked.data() + filled, &out, packed.data() + used, &in,
                           nullptr);
    if (LZ4F_isError(hint) != 0) {
      return malformed("lz4", LZ4F_getErrorName(hint));
    }
    if (out == 0 && in == 0 && hint != 0) {
      return malformed("lz4", room ? "cut short" : "longer than announced");
    }
    filled += out;
    used += in;
  }
  unpacked.resize(filled);
  return {};
}

}  // namespace

std::string_view compression_name(Compression compression) {
  switch (compression) {
    case Compression::kNone:
      return "";
    case Compression::kLz4:
      return "lz4";
    case Compression::kZstd:
      return "zstd";
  }
  return "";
}

std::optional<Compression> compression_from_name(std::string_view name) {
  for (const auto compression : {Compression::kNone, Compression::kLz4, Compression::kZstd}) {
    if (name == compression_name(compression)) {
      return compression;
    }
  }
  return std::nullopt;
}

struct Packer::Contexts {
  std::unique_ptr<ZSTD_CCtx, ZstdDelete> zstd;
};

Packer::Packer(Compression compression, int zstd_level)
    : contexts_(std::make_unique<Contexts>()), compression_(compression) {
  if (compression == Compression::kZstd) {
    contexts_->zstd.reset(ZSTD_createCCtx());
    ZSTD_CCtx_setParameter(contexts_->zstd.get(), ZSTD_c_compressionLevel, zstd_level);
  }
}

Packer::~Packer() = default;

Result<ByteView> Packer::pack(ByteView bytes) {
  if (compression_ == Compression::kNone) {
    return bytes;
  }
  if (compression_ == Compression::kZstd) {
    packed_.resize(std::max(packed_.size(), ZSTD_compressBound(bytes.size())));
    const std::size_t size = ZSTD_compress2(contexts_->zstd.get(), packed_.data(), packed_.size(),
                                            bytes.data(), bytes.size());
    if (ZSTD_isError(size) != 0) {
      return Error{ErrorCode::kUnavailable,
                   std::string("zstd cannot pack: ") + ZSTD_getErrorName(size)};
    }
    return ByteView(packed_).first(size);
  }
  packed_.resize(std::max(packed_.size(), LZ4F_compressFrameBound(bytes.size(), nullptr)));
  const std::size_t size =
      LZ4F_compressFrame(packed_.data(), packed_.size(), bytes.data(), bytes.size(), nullptr);
  if (LZ4F_isError(size) != 0) {
    return Error{ErrorCode::kUnavailable,
                 std::string("lz4 cannot pack: ") + LZ4F_getErrorName(size)};
  }
  return ByteView(packed_).first(size);
}

Status unpack_bzip2(ByteView packed, std::uint64_t size, Bytes& unpacked) {
  unpacked.clear();
  bz_stream stream{};
  if (BZ2_bzDecompressInit(&stream, 0, 0) != BZ_OK) {
    return Error{ErrorCode::kUnavailable, "no memory to unpack bzip2"};
  }
  const std::unique_ptr<bz_stream, BzipEnd> end(&stream);
  // The library does not write to its input, but lacks the const.
  stream.next_in = reinterpret_cast<char*>(const_cast<std::byte*>(packed.data()));
  std::size_t fed = 0;
  std::size_t filled = 0;
  int state = BZ_OK;
  while (state == BZ_OK) {
    constexpr std::size_t kMaxFeed = 1u << 30;
    if (stream.avail_in == 0) {
      stream.avail_in = static_cast<unsigned>(std::min(packed.size() - fed, kMaxFeed));
      fed += stream.avail_in;
    }
    const bool room = grow(unpacked, filled, size);
    const auto space = static_cast<unsigned>(std::min(unpacked.size() - filled, kMaxFeed));
    stream.next_out = reinterpret_cast<char*>(unpacked.data() + filled);
    stream.avail_out = space;
    const unsigned in_before = stream.avail_in;
    state = BZ2_bzDecompress(&stream);
    filled += space - stream.avail_out;
    if (state == BZ_OK && stream.avail_out == space && stream.avail_in == in_before) {
      return malformed("bzip2", room ? "cut short" : "longer than announced");
    }
  }
  if (state != BZ_STREAM_END) {
    return malformed("bzip2", "error " + std::to_string(state));
  }
  unpacked.resize(filled);
  return check_size(unpacked, size);
}

Status unpack_zstd_frame(ByteView packed, std::uint64_t max_size, Bytes& unpacked) {
  unpacked.clear();
  return unpack_zstd(packed, max_size, unpacked);
}

Status unpack(Compression compression, ByteView packed, std::uint64_t size, Bytes& unpacked) {
  unpacked.clear();
  Status status;
  switch (compression) {
    case Compression::kNone:
      unpacked.assign(packed.begin(), packed.end());
      break;
    case Compression::kLz4:
      status = unpack_lz4(packed, size, unpacked);
      break;
    case Compression::kZstd:
      status = unpack_zstd(packed, size, unpacked);
      break;
  }
  return status ? check_size(unpacked, size) : status;
}

}  // namespace furrow::mcap
