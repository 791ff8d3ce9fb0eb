#include "recording_file.hpp"

#include <utility>

#include "units.hpp"

namespace furrow::recording {
namespace {

mcap::Compression compression_of(const std::string& name) {
  if (name == "none") {
    return mcap::Compression::kNone;
  }
  return name == "lz4" ? mcap::Compression::kLz4 : mcap::Compression::kZstd;
}

}  // namespace

Result<std::unique_ptr<RecordingFile>> RecordingFile::open(std::unique_ptr<mcap::Sink> sink,
                                                           const RecorderParameters& parameters) {
  mcap::WriterOptions options;
  options.compression = compression_of(parameters.compression);
  options.chunk_bytes = static_cast<std::size_t>(parameters.chunk_kb) * 1000;
  auto writer = mcap::Writer::open(std::move(sink), options);
  if (!writer) {
    return writer.error();
  }
  return std::unique_ptr<RecordingFile>(new RecordingFile(std::move(*writer), parameters));
}

Result<mcap::ChannelId> RecordingFile::channel(const TopicDescription& topic, std::size_t number) {
  if (const auto known = channels_.find(number); known != channels_.end()) {
    return known->second;
  }
  mcap::SchemaId schema = 0;
  if (!topic.type_name.empty()) {
    const auto added =
        writer_->add_schema(schema_name(topic), topic.schema_encoding, topic.schema_text);
    if (!added) {
      return added.error();
    }
    schema = *added;
  }
  const auto added = writer_->add_channel(
      {0, schema, topic_in_file(topic.name), topic.message_encoding, channel_metadata(topic)});
  if (added) {
    channels_[number] = *added;
  }
  return added;
}

Status RecordingFile::write(const TopicDescription& topic, const KeptMessage& message) {
  const auto id = channel(topic, message.channel);
  if (!id) {
    // Only a failure of the file can cause this.
    return Error{ErrorCode::kIo, id.error().message};
  }
  if (Status status = writer_->write(
          {*id, message.sequence, message.log_time, message.publish_time, *message.payload});
      !status) {
    return status;
  }
  if (!start_) {
    start_ = message.log_time;
  }
  if (writer_->bytes_pending() == 0) {
    pending_since_.reset();
  } else if (!pending_since_) {
    pending_since_ = message.log_time;
  }
  return {};
}

Status RecordingFile::flush_if_due(Time now) {
  if (!pending_since_ || now - *pending_since_ < Duration::seconds(parameters_.flush_s)) {
    return {};
  }
  pending_since_.reset();
  return writer_->flush();
}

bool RecordingFile::is_full(Time now) const {
  const bool by_size = parameters_.split_mb > 0.0 &&
                       static_cast<double>(bytes()) >= parameters_.split_mb * kBytesPerMb;
  const bool by_time = parameters_.split_s > 0.0 && start_ &&
                       now - *start_ >= Duration::seconds(parameters_.split_s);
  return start_ && (by_size || by_time);
}

std::uint64_t RecordingFile::messages(std::size_t topic) const {
  const auto channel = channels_.find(topic);
  if (channel == channels_.end()) {
    return 0;
  }
  const auto counts = writer_->statistics().channel_message_counts;
  const auto count = counts.find(channel->second);
  return count == counts.end() ? 0 : count->second;
}

}  // namespace furrow::recording
