#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>

#include "furrow_core/result.hpp"
#include "furrow_recording/latched_messages.hpp"
#include "furrow_recording/mcap_writer.hpp"
#include "furrow_recording/recorder_parameters.hpp"
#include "furrow_recording/topic_description.hpp"

namespace furrow::recording {

/// One MCAP file of a recording, with a channel for each topic that has a message in it.
class RecordingFile {
 public:
  [[nodiscard]] static Result<std::unique_ptr<RecordingFile>> open(
      std::unique_ptr<mcap::Sink> sink, const RecorderParameters& parameters);

  /// Writes a message of a topic. kInvalidArgument and kOutOfRange concern this message only; after
  /// other errors the file takes no more messages.
  [[nodiscard]] Status write(const TopicDescription& topic, const KeptMessage& message);
  /// Writes a chunk that waits for longer than `flush_s`.
  [[nodiscard]] Status flush_if_due(Time now);
  [[nodiscard]] Status close() { return writer_->close(); }

  /// Its size or duration has reached what the parameters set.
  [[nodiscard]] bool is_full(Time now) const;
  /// Messages of a topic that are in the file; those of a chunk that could not be written are not.
  [[nodiscard]] std::uint64_t messages(std::size_t topic) const;
  /// Bytes on the medium, and with those that wait.
  [[nodiscard]] std::uint64_t bytes_written() const { return writer_->bytes_written(); }
  [[nodiscard]] std::uint64_t bytes() const { return bytes_written() + writer_->bytes_pending(); }

 private:
  RecordingFile(std::unique_ptr<mcap::Writer> writer, const RecorderParameters& parameters)
      : writer_(std::move(writer)), parameters_(parameters) {}
  [[nodiscard]] Result<mcap::ChannelId> channel(const TopicDescription& topic, std::size_t number);

  std::unique_ptr<mcap::Writer> writer_;
  const RecorderParameters& parameters_;
  std::map<std::size_t, mcap::ChannelId> channels_;  ///< by topic
  std::optional<Time> start_;                        ///< of the first message
  std::optional<Time> pending_since_;                ///< of the chunk in memory
};

}  // namespace furrow::recording
