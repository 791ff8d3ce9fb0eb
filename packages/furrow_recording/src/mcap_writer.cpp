#include "furrow_recording/mcap_writer.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

#include "compression.hpp"
#include "crc32.hpp"
#include "records.hpp"

namespace furrow::mcap {

class Writer::Impl {
 public:
  Impl(std::unique_ptr<Sink> sink, const WriterOptions& options)
      : sink_(std::move(sink)),
        options_(options),
        packer_(options.compression, options.zstd_level) {
    chunk_.reserve(options.chunk_bytes + options.chunk_bytes / 8);
  }

  Status begin() {
    Bytes bytes(kMagic.begin(), kMagic.end());
    ByteWriter out(bytes);
    put(out, Header{options_.profile, options_.library});
    return append({bytes});
  }

  Result<SchemaId> add_schema(std::string_view name, std::string_view encoding,
                              std::string_view data) {
    if (Status status = writable(); !status) {
      return status.error();
    }
    for (const Schema& schema : schemas_) {
      if (schema.name == name && schema.encoding == encoding && schema.data == data) {
        return schema.id;
      }
    }
    if (schemas_.size() == std::numeric_limits<SchemaId>::max()) {
      return Error{ErrorCode::kOutOfRange, "an MCAP file holds at most 65535 schemas"};
    }
    Schema schema{static_cast<SchemaId>(schemas_.size() + 1), std::string(name),
                  std::string(encoding), std::string(data)};
    if (Status status = append_record(schema); !status) {
      return status.error();
    }
    schemas_.push_back(std::move(schema));
    return schemas_.back().id;
  }

  Result<ChannelId> add_channel(Channel channel) {
    if (Status status = writable(); !status) {
      return status.error();
    }
    if (channel.schema_id > schemas_.size()) {
      return Error{ErrorCode::kInvalidArgument, "topic " + channel.topic + " names no schema"};
    }
    if (channels_.size() == std::numeric_limits<ChannelId>::max()) {
      return Error{ErrorCode::kOutOfRange, "an MCAP file holds at most 65535 channels"};
    }
    channel.id = static_cast<ChannelId>(channels_.size());
    if (Status status = append_record(channel); !status) {
      return status.error();
    }
    channels_.push_back(std::move(channel));
    pending_.emplace_back();
    counts_.push_back(0);
    return channels_.back().id;
  }

  Status write(const Message& message) {
    if (Status status = writable(); !status) {
      return status;
    }
    if (message.channel_id >= channels_.size()) {
      return Error{ErrorCode::kInvalidArgument, "message of an unknown channel"};
    }
    if (message.log_time < Time() || message.publish_time < Time()) {
      return Error{ErrorCode::kInvalidArgument,
                   "message on " + channels_[message.channel_id].topic + " with a negative time"};
    }
    if (message.data.size() > options_.max_message_bytes) {
      return Error{ErrorCode::kOutOfRange, "message on " + channels_[message.channel_id].topic +
                                               " has " + std::to_string(message.data.size()) +
                                               " bytes, more than allowed"};
    }
    // A message that does not fit begins the next chunk, so that large ones stand alone.
    const std::size_t bytes = kRecordHeaderBytes + kMessageHeaderBytes + message.data.size();
    if (!chunk_.empty() && chunk_.size() + bytes > options_.chunk_bytes) {
      if (Status status = flush(); !status) {
        return status;
      }
    }
    pending_[message.channel_id].emplace_back(message.log_time, chunk_.size());
    ByteWriter out(chunk_);
    put_head(out, message);
    start_ = pending_messages_ == 0 ? message.log_time : std::min(start_, message.log_time);
    end_ = pending_messages_ == 0 ? message.log_time : std::max(end_, message.log_time);
    ++pending_messages_;
    if (chunk_.size() + message.data.size() < options_.chunk_bytes) {
      out.raw(message.data);
      return {};
    }
    if (options_.compression == Compression::kNone) {
      return end_chunk(message.data);
    }
    out.raw(message.data);
    return end_chunk({});
  }

  Status write(const Attachment& attachment) {
    if (Status status = writable(); !status) {
      return status;
    }
    const std::uint64_t at = position_;
    if (Status status = append_record(attachment); !status) {
      return status;
    }
    attachments_.push_back({at, position_ - at, attachment.log_time, attachment.create_time,
                            attachment.data.size(), attachment.name, attachment.media_type});
    return {};
  }

  Status write(const Metadata& metadata) {
    if (Status status = writable(); !status) {
      return status;
    }
    const std::uint64_t at = position_;
    if (Status status = append_record(metadata); !status) {
      return status;
    }
    metadata_.push_back({at, position_ - at, metadata.name});
    return {};
  }

  Status flush() {
    if (Status status = writable(); !status || pending_messages_ == 0) {
      return status;
    }
    return end_chunk({});
  }

  Status close() {
    if (closed_) {
      return {};
    }
    Status status = failed_ ? Status(*failed_) : flush();
    lost_ += pending_messages_;  // there are some after a failure only
    clear_chunk();
    closed_ = true;
    failed_.reset();
    const Status end = append({summary_section()});
    if (status && end) {
      status = sink_->sync();
    }
    sink_.reset();
    return status ? end : status;
  }

  [[nodiscard]] Statistics statistics() const {
    Statistics all = committed_;
    for (std::size_t id = 0; id < counts_.size(); ++id) {
      const std::uint64_t count = counts_[id] + pending_[id].size();
      if (count > 0) {
        all.channel_message_counts[static_cast<ChannelId>(id)] = count;
      }
    }
    if (pending_messages_ > 0) {
      all.start_time = all.message_count == 0 ? start_ : std::min(all.start_time, start_);
      all.end_time = all.message_count == 0 ? end_ : std::max(all.end_time, end_);
      all.message_count += pending_messages_;
    }
    all.schema_count = static_cast<std::uint16_t>(schemas_.size());
    all.channel_count = static_cast<std::uint32_t>(channels_.size());
    all.attachment_count = static_cast<std::uint32_t>(attachments_.size());
    all.metadata_count = static_cast<std::uint32_t>(metadata_.size());
    all.chunk_count = static_cast<std::uint32_t>(chunks_.size());
    return all;
  }

  [[nodiscard]] std::uint64_t position() const { return position_; }
  [[nodiscard]] std::size_t pending() const { return chunk_.size(); }
  [[nodiscard]] std::uint64_t lost() const { return lost_; }

 private:
  struct Part {
    ByteView bytes;
    std::optional<std::uint32_t> crc = std::nullopt;  ///< of the bytes, when it is known
    Part(const Bytes& content) : bytes(content) {}    // NOLINT(google-explicit-constructor)
    Part(ByteView content, std::uint32_t known) : bytes(content), crc(known) {}
  };

  [[nodiscard]] Status writable() const {
    if (closed_) {
      return Error{ErrorCode::kInvalidArgument, "the MCAP file is closed"};
    }
    return failed_ ? Status(*failed_) : Status();
  }

  /// All parts or none: what was begun is cut off again.
  Status append(std::initializer_list<Part> parts) {
    std::uint64_t position = position_;
    std::uint32_t crc = crc_;
    for (const Part& part : parts) {
      if (Status status = sink_->write(part.bytes); !status) {
        failed_ = status.error();
        if (Status cut = sink_->truncate(position_); !cut) {
          failed_->message += "; " + cut.error().message;
        }
        return *failed_;
      }
      position += part.bytes.size();
      crc = part.crc ? crc32_combine(crc, *part.crc, part.bytes.size()) : crc32(part.bytes, crc);
    }
    position_ = position;
    crc_ = crc;
    return {};
  }

  template <class Record>
  Status append_record(const Record& record) {
    scratch_.clear();
    ByteWriter out(scratch_);
    put(out, record);
    return append({scratch_});
  }

  /// `tail`: records' bytes behind those in memory, not copied; without compression only.
  Status end_chunk(ByteView tail) {
    Status status = write_chunk(tail);
    if (!status) {
      lost_ += pending_messages_;
    }
    clear_chunk();
    return status;
  }

  Status write_chunk(ByteView tail) {
    auto packed = packer_.pack(chunk_);
    if (!packed) {
      return packed.error();
    }
    const std::uint32_t head_crc = crc32(chunk_);
    const std::uint32_t tail_crc = crc32(tail);
    const std::uint32_t chunk_crc = crc32_combine(head_crc, tail_crc, tail.size());
    const std::uint64_t records = packed->size() + tail.size();
    ChunkIndex index;
    index.start_time = start_;
    index.end_time = end_;
    index.offset = position_;
    index.compression = compression_name(options_.compression);
    index.compressed_size = records;
    index.uncompressed_size = chunk_.size() + tail.size();

    scratch_.clear();
    ByteWriter out(scratch_);
    const std::size_t fields = 8 + 8 + 8 + 4 + 4 + index.compression.size() + 8;
    out.number(static_cast<std::uint8_t>(Opcode::kChunk));
    out.number(static_cast<std::uint64_t>(fields + records));
    out.time(index.start_time);
    out.time(index.end_time);
    out.number(index.uncompressed_size);
    out.number(chunk_crc);
    out.string(index.compression);
    out.number(index.compressed_size);
    index.length = scratch_.size() + records;

    indexes_.clear();
    ByteWriter index_out(indexes_);
    for (std::size_t id = 0; id < pending_.size(); ++id) {
      if (!pending_[id].empty()) {
        const auto channel = static_cast<ChannelId>(id);
        index.message_index_offsets[channel] = position_ + index.length + indexes_.size();
        put(index_out, MessageIndex{channel, pending_[id]});
      }
    }
    index.message_index_length = indexes_.size();

    const bool plain = options_.compression == Compression::kNone;
    const Part head(*packed, plain ? head_crc : crc32(*packed));
    if (Status status = append({scratch_, head, Part(tail, tail_crc), indexes_}); !status) {
      return status;
    }
    chunks_.push_back(std::move(index));
    for (std::size_t id = 0; id < pending_.size(); ++id) {
      counts_[id] += pending_[id].size();
    }
    const bool first = committed_.message_count == 0;
    committed_.start_time = first ? start_ : std::min(committed_.start_time, start_);
    committed_.end_time = first ? end_ : std::max(committed_.end_time, end_);
    committed_.message_count += pending_messages_;
    return {};
  }

  void clear_chunk() {
    chunk_.clear();
    pending_messages_ = 0;
    for (auto& entries : pending_) {
      entries.clear();
    }
  }

  [[nodiscard]] Bytes summary_section() const {
    Bytes bytes;
    ByteWriter out(bytes);
    put_data_end(out, crc_);
    const std::size_t summary_at = bytes.size();
    std::vector<std::tuple<Opcode, std::size_t, std::size_t>> groups;
    const auto group = [&](Opcode opcode, const auto& records) {
      const std::size_t at = bytes.size();
      for (const auto& record : records) {
        put(out, record);
      }
      if (bytes.size() > at) {
        groups.emplace_back(opcode, at, bytes.size() - at);
      }
    };
    group(Opcode::kSchema, schemas_);
    group(Opcode::kChannel, channels_);
    group(Opcode::kStatistics, std::array{statistics()});
    group(Opcode::kChunkIndex, chunks_);
    group(Opcode::kAttachmentIndex, attachments_);
    group(Opcode::kMetadataIndex, metadata_);
    const std::size_t offsets_at = bytes.size();
    for (const auto& [opcode, at, length] : groups) {
      put_summary_offset(out, opcode, position_ + at, length);
    }
    const auto footer_at = out.begin_record(static_cast<std::uint8_t>(Opcode::kFooter));
    out.number(static_cast<std::uint64_t>(position_ + summary_at));
    out.number(static_cast<std::uint64_t>(position_ + offsets_at));
    // The CRC takes the record's length in, so that it must stand there before.
    out.number(std::uint32_t{0});
    out.end_record(footer_at);
    bytes.resize(bytes.size() - sizeof(std::uint32_t));
    out.number(crc32(ByteView(bytes).subspan(summary_at)));
    out.raw(kMagic);
    return bytes;
  }

  std::unique_ptr<Sink> sink_;
  WriterOptions options_;
  Packer packer_;
  std::uint64_t position_ = 0;
  std::uint32_t crc_ = 0;
  std::optional<Error> failed_;
  bool closed_ = false;
  std::uint64_t lost_ = 0;

  std::vector<Schema> schemas_;    // id - 1
  std::vector<Channel> channels_;  // by id
  std::vector<std::uint64_t> counts_;
  std::vector<ChunkIndex> chunks_;
  std::vector<AttachmentIndex> attachments_;
  std::vector<MetadataIndex> metadata_;
  Statistics committed_;

  Bytes chunk_;
  std::vector<std::vector<IndexEntry>> pending_;  // by channel, of the chunk in memory
  std::uint64_t pending_messages_ = 0;
  Time start_;
  Time end_;
  Bytes scratch_;
  Bytes indexes_;
};

Writer::Writer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

Writer::~Writer() {
  (void)impl_->close();
}

Result<std::unique_ptr<Writer>> Writer::open(std::unique_ptr<Sink> sink,
                                             const WriterOptions& options) {
  auto impl = std::make_unique<Impl>(std::move(sink), options);
  if (Status status = impl->begin(); !status) {
    return status.error();
  }
  return std::unique_ptr<Writer>(new Writer(std::move(impl)));
}

Result<SchemaId> Writer::add_schema(std::string_view name, std::string_view encoding,
                                    std::string_view data) {
  return impl_->add_schema(name, encoding, data);
}
Result<ChannelId> Writer::add_channel(Channel channel) {
  return impl_->add_channel(std::move(channel));
}
Status Writer::write(const Message& message) {
  return impl_->write(message);
}
Status Writer::write(const Attachment& attachment) {
  return impl_->write(attachment);
}
Status Writer::write(const Metadata& metadata) {
  return impl_->write(metadata);
}
Status Writer::flush() {
  return impl_->flush();
}
Status Writer::close() {
  return impl_->close();
}
std::uint64_t Writer::bytes_written() const {
  return impl_->position();
}
std::size_t Writer::bytes_pending() const {
  return impl_->pending();
}
std::uint64_t Writer::lost_messages() const {
  return impl_->lost();
}
Statistics Writer::statistics() const {
  return impl_->statistics();
}

}  // namespace furrow::mcap
