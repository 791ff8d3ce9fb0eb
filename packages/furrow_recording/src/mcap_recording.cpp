#include "mcap_recording.hpp"

#include <utility>

namespace furrow::recording {
namespace {

class McapStream final : public MessageStream {
 public:
  explicit McapStream(mcap::MessageCursor cursor) : cursor_(std::move(cursor)) {}
  Result<std::optional<mcap::Message>> next() override { return cursor_.next(); }

 private:
  mcap::MessageCursor cursor_;
};

class McapRecording final : public RecordingReader {
 public:
  McapRecording(mcap::Reader reader, std::uint64_t bytes) : reader_(std::move(reader)) {
    info_.format = "mcap";
    info_.profile = reader_.header().profile;
    info_.library = reader_.header().library;
    info_.bytes = bytes;
    info_.summary = reader_.summary();
    for (const mcap::ChunkIndex& chunk : info_.summary.chunks) {
      info_.compressions.insert(chunk.compression.empty() ? "none" : chunk.compression);
    }
    info_.damage = reader_.damage();
    info_.bytes_ignored = reader_.bytes_ignored();
    info_.faults = reader_.faults();
  }

  const RecordingInfo& info() const override { return info_; }
  std::unique_ptr<MessageStream> messages(const mcap::ReadOptions& options) const override {
    return std::make_unique<McapStream>(reader_.messages(options));
  }
  Result<mcap::Attachment> attachment(std::size_t number) const override {
    return reader_.attachment(info_.summary.attachments.at(number));
  }
  Result<mcap::Metadata> metadata(std::size_t number) const override {
    return reader_.metadata(info_.summary.metadata.at(number));
  }

 private:
  mcap::Reader reader_;
  RecordingInfo info_;
};

}  // namespace

Result<std::unique_ptr<RecordingReader>> open_mcap(std::unique_ptr<mcap::Source> source,
                                                   const OpenOptions& options) {
  const std::uint64_t bytes = source->size();
  auto reader = options.scan ? mcap::Reader::scan(std::move(source), options.limits)
                             : mcap::Reader::open(std::move(source), options.limits);
  if (!reader) {
    return reader.error();
  }
  return std::unique_ptr<RecordingReader>(
      std::make_unique<McapRecording>(std::move(*reader), bytes));
}

}  // namespace furrow::recording
