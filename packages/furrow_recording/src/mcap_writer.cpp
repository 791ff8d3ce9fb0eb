#include "furrow_recording/mcap_writer.hpp"

#include <limits>
#include <utility>
#include <vector>

#include "chunk_builder.hpp"
#include "chunk_pipeline.hpp"
#include "file_appender.hpp"
#include "message_tally.hpp"
#include "summary_section.hpp"

namespace furrow::mcap {

class Writer::Impl {
 public:
  Impl(std::unique_ptr<Sink> sink, const WriterOptions& options)
      : file_(std::move(sink)),
        options_(options),
        packer_(options.compression, options.zstd_level) {
    chunk_.records.reserve(options.chunk_bytes + options.chunk_bytes / 8);
    if (options.threads > 0 && options.compression != Compression::kNone) {
      pipeline_ =
          std::make_unique<ChunkPipeline>(options.threads, options.compression, options.zstd_level);
    }
  }

  Status begin() {
    Bytes bytes(kMagic.begin(), kMagic.end());
    ByteWriter out(bytes);
    put(out, Header{options_.profile, options_.library});
    return file_.append({bytes});
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
      return Error{ErrorCode::kInvalidArgument,
                   "topic " + channel.topic + " has an unknown schema"};
    }
    if (channels_.size() == std::numeric_limits<ChannelId>::max()) {
      return Error{ErrorCode::kOutOfRange, "an MCAP file holds at most 65535 channels"};
    }
    channel.id = static_cast<ChannelId>(channels_.size());
    if (Status status = append_record(channel); !status) {
      return status.error();
    }
    channels_.push_back(std::move(channel));
    return channels_.back().id;
  }

  Status write(const Message& message) {
    if (Status status = check(message); !status) {
      return status;
    }
    // A message that does not fit begins the next chunk, so that large messages have their own.
    const std::size_t bytes = kRecordHeaderBytes + kMessageHeaderBytes + message.data.size();
    if (has_messages() && chunk_.records.size() + bytes > options_.chunk_bytes) {
      if (Status status = end_chunk({}); !status) {
        return status;
      }
    }
    chunk_.add_head(message);
    const bool full = chunk_.records.size() + message.data.size() >= options_.chunk_bytes;
    if (full && options_.compression == Compression::kNone) {
      return end_chunk(message.data);
    }
    chunk_.add_data(message.data);
    return full ? end_chunk({}) : Status();
  }

  Status write(const Attachment& attachment) {
    if (Status status = writable(); !status) {
      return status;
    }
    const std::uint64_t at = file_.position();
    if (Status status = append_record(attachment); !status) {
      return status;
    }
    attachments_.push_back({at, file_.position() - at, attachment.log_time, attachment.create_time,
                            attachment.data.size(), attachment.name, attachment.media_type});
    return {};
  }

  Status write(const Metadata& metadata) {
    if (Status status = writable(); !status) {
      return status;
    }
    const std::uint64_t at = file_.position();
    if (Status status = append_record(metadata); !status) {
      return status;
    }
    metadata_.push_back({at, file_.position() - at, metadata.name});
    return {};
  }

  Status flush() {
    Status status = writable();
    if (status && has_messages()) {
      status = end_chunk({});
    }
    while (status && pipeline_ && !pipeline_->empty()) {
      status = append_oldest();
    }
    return status;
  }

  Status close() {
    if (closed_) {
      return {};
    }
    Status status = file_.failure();
    if (status) {
      status = flush();
    }
    drop_pending();  // there are such messages after a failure only
    closed_ = true;
    file_.resume();
    const Status end = file_.append({end_of_file()});
    if (status && end) {
      status = file_.sync();
    }
    file_.close();
    return status ? end : status;
  }

  [[nodiscard]] Statistics statistics() const {
    Statistics all = written_;
    if (pipeline_) {
      for (const MessageTally& tally : pipeline_->tallies()) {
        add_to(all, tally);
      }
    }
    add_to(all, chunk_.tally);
    all.schema_count = static_cast<std::uint16_t>(schemas_.size());
    all.channel_count = static_cast<std::uint32_t>(channels_.size());
    all.attachment_count = static_cast<std::uint32_t>(attachments_.size());
    all.metadata_count = static_cast<std::uint32_t>(metadata_.size());
    all.chunk_count = static_cast<std::uint32_t>(chunks_.size());
    return all;
  }

  [[nodiscard]] std::uint64_t position() const { return file_.position(); }
  [[nodiscard]] std::size_t pending() const { return chunk_.records.size(); }
  [[nodiscard]] std::uint64_t lost() const { return lost_; }

 private:
  [[nodiscard]] Status writable() const {
    if (closed_) {
      return Error{ErrorCode::kInvalidArgument, "the MCAP file is closed"};
    }
    return file_.failure();
  }

  [[nodiscard]] Status check(const Message& message) const {
    if (Status status = writable(); !status) {
      return status;
    }
    if (message.channel_id >= channels_.size()) {
      return Error{ErrorCode::kInvalidArgument, "a message has an unknown channel"};
    }
    const std::string& topic = channels_[message.channel_id].topic;
    if (message.log_time < Time()) {
      return Error{ErrorCode::kInvalidArgument, "a message on " + topic + " has a negative time"};
    }
    if (message.data.size() > options_.max_message_bytes) {
      return Error{ErrorCode::kOutOfRange, "a message on " + topic + " has " +
                                               std::to_string(message.data.size()) +
                                               " bytes, more than the limit of " +
                                               std::to_string(options_.max_message_bytes)};
    }
    return {};
  }

  template <class Record>
  Status append_record(const Record& record) {
    record_.clear();
    ByteWriter out(record_);
    put(out, record);
    return file_.append({record_});
  }

  [[nodiscard]] bool has_messages() const { return chunk_.tally.messages > 0; }

  /// `tail`: data of the last message that are not in the chunk yet.
  Status end_chunk(ByteView tail) {
    if (pipeline_) {
      if (pipeline_->full()) {
        if (Status status = append_oldest(); !status) {
          return status;
        }
      }
      pipeline_->add(std::exchange(chunk_, std::exchange(spare_, {})));
      return {};
    }
    auto packed = pack_chunk(packer_, options_.compression, chunk_);
    Status status = packed ? append(chunk_, *packed, tail) : Status(packed.error());
    chunk_.clear();
    return status;
  }

  Status append(const ChunkContent& content, const PackedChunk& packed, ByteView tail) {
    auto index = append_chunk(file_, content, packed, options_.compression, tail);
    if (!index) {
      lost_ += content.tally.messages;
      return index.error();
    }
    add_to(written_, content.tally);
    chunks_.push_back(std::move(*index));
    return {};
  }

  /// Appends the oldest chunk of the pipeline.
  Status append_oldest() {
    ChunkPipeline::Done done = pipeline_->take();
    Status status;
    if (done.failure) {
      lost_ += done.content.tally.messages;
      status = *done.failure;
    } else {
      status = append(done.content, {done.packed, done.packed_crc, done.unpacked_crc}, {});
    }
    done.content.clear();
    spare_ = std::move(done.content);
    return status;
  }

  void drop_pending() {
    lost_ += chunk_.tally.messages;
    chunk_.clear();
    while (pipeline_ && !pipeline_->empty()) {
      lost_ += pipeline_->take().content.tally.messages;
    }
  }

  [[nodiscard]] Bytes end_of_file() const {
    Summary summary;
    for (const Schema& schema : schemas_) {
      summary.schemas[schema.id] = schema;
    }
    for (const Channel& channel : channels_) {
      summary.channels[channel.id] = channel;
    }
    summary.chunks = chunks_;
    summary.attachments = attachments_;
    summary.metadata = metadata_;
    summary.statistics = statistics();
    return put_end_of_file(summary, file_.position(), file_.crc());
  }

  FileAppender file_;
  WriterOptions options_;
  Packer packer_;
  ChunkContent chunk_;  ///< that messages are added to
  ChunkContent spare_;  ///< memory of a chunk that was written
  std::unique_ptr<ChunkPipeline> pipeline_;
  bool closed_ = false;
  std::uint64_t lost_ = 0;
  std::vector<Schema> schemas_;    ///< by id - 1
  std::vector<Channel> channels_;  ///< by id
  std::vector<ChunkIndex> chunks_;
  std::vector<AttachmentIndex> attachments_;
  std::vector<MetadataIndex> metadata_;
  Statistics written_;  ///< of the chunks in the file
  Bytes record_;
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
