#include <algorithm>
#include <map>
#include <utility>

#include "bytes.hpp"
#include "furrow_recording/mcap_tools.hpp"

namespace furrow::mcap {
namespace {

constexpr std::size_t kMaxFaults = 100;

/// Writes what a reader reads, with the channels as they are used.
class Copier {
 public:
  Copier(const Reader& reader, Writer& writer) : reader_(reader), writer_(writer) {}

  Status message(Message message) {
    auto at = channels_.find(message.channel_id);
    if (at == channels_.end()) {
      const auto id = add_channel(message.channel_id);
      if (!id) {
        return id.error();
      }
      at = channels_.emplace(message.channel_id, *id).first;
    }
    message.channel_id = at->second;
    if (Status status = writer_.write(message); !status) {
      return status;
    }
    ++report.messages;
    return {};
  }

  /// All that the options ask for; damaged chunks become faults.
  Status messages(const ReadOptions& options) {
    MessageCursor cursor = reader_.messages(options);
    while (true) {
      const auto next = cursor.next();
      if (!next) {
        if (next.error().code == ErrorCode::kIo) {
          return next.error();
        }
        fault(next.error().message);
        continue;
      }
      if (!*next) {
        return {};
      }
      if (Status status = message(**next); !status) {
        return status;
      }
    }
  }

  /// The last message before `begin` of each channel that `latched` names.
  Status latched(Time begin, const std::function<bool(const Channel&)>& accept,
                 const std::function<bool(const Channel&)>& latched) {
    if (!latched) {
      return {};
    }
    struct Last {
      Message message;
      Bytes data;
    };
    std::map<ChannelId, Last> last;
    ReadOptions options;
    options.end = begin;
    options.accept = [&](const Channel& channel) {
      return latched(channel) && (!accept || accept(channel));
    };
    MessageCursor cursor = reader_.messages(options);
    while (true) {
      const auto next = cursor.next();
      if (!next) {
        if (next.error().code == ErrorCode::kIo) {
          return next.error();
        }
        fault(next.error().message);
        continue;
      }
      if (!*next) {
        break;
      }
      Last& entry = last[(*next)->channel_id];
      entry.data.assign((*next)->data.begin(), (*next)->data.end());
      entry.message = **next;
    }
    for (auto& [id, entry] : last) {
      entry.message.data = entry.data;
      entry.message.log_time = begin;
      if (Status status = message(entry.message); !status) {
        return status;
      }
    }
    return {};
  }

  Status metadata() {
    for (const MetadataIndex& index : reader_.summary().metadata) {
      const auto record = reader_.metadata(index);
      if (!record) {
        fault(record.error().message);
      } else if (Status status = writer_.write(*record); !status) {
        return status;
      }
    }
    return {};
  }

  Status attachments(Time begin, Time end) {
    for (const AttachmentIndex& index : reader_.summary().attachments) {
      if (index.log_time < begin || index.log_time >= end) {
        continue;
      }
      const auto record = reader_.attachment(index);
      if (!record) {
        fault(record.error().message);
      } else if (Status status = writer_.write(*record); !status) {
        return status;
      }
    }
    return {};
  }

  CopyReport report;

 private:
  void fault(const std::string& what) {
    const bool known =
        std::find(report.faults.begin(), report.faults.end(), what) != report.faults.end();
    if (!known && report.faults.size() < kMaxFaults) {
      report.faults.push_back(what);
    }
  }

  Result<ChannelId> add_channel(ChannelId id) {
    Channel channel = *reader_.channel(id);
    const auto schema = reader_.summary().schemas.find(channel.schema_id);
    channel.schema_id = 0;
    if (schema != reader_.summary().schemas.end()) {
      const auto added =
          writer_.add_schema(schema->second.name, schema->second.encoding, schema->second.data);
      if (!added) {
        return added.error();
      }
      channel.schema_id = *added;
    }
    return writer_.add_channel(std::move(channel));
  }

  const Reader& reader_;
  Writer& writer_;
  std::map<ChannelId, ChannelId> channels_;
};

Result<CopyReport> copy(const Reader& reader, std::unique_ptr<Sink> sink, WriterOptions options,
                        const CutOptions& cut) {
  options.profile = reader.header().profile;
  auto writer = Writer::open(std::move(sink), options);
  if (!writer) {
    return writer.error();
  }
  Copier copier(reader, **writer);
  copier.report.faults = reader.faults();
  copier.report.bytes_ignored = reader.bytes_ignored();
  Status status = copier.metadata();
  if (status) {
    status = copier.attachments(cut.read.begin, cut.read.end);
  }
  if (status) {
    status = copier.latched(cut.read.begin, cut.read.accept, cut.latched);
  }
  if (status) {
    status = copier.messages(cut.read);
  }
  const Status closed = (*writer)->close();
  if (!status || !closed) {
    return status ? closed.error() : status.error();
  }
  return std::move(copier.report);
}

}  // namespace

Result<CopyReport> recover(std::unique_ptr<Source> source, std::unique_ptr<Sink> sink,
                           const WriterOptions& writer, const ReaderLimits& limits) {
  const auto reader = Reader::scan(std::move(source), limits);
  if (!reader) {
    return reader.error();
  }
  return copy(*reader, std::move(sink), writer, {});
}

Result<CopyReport> cut(std::unique_ptr<Source> source, std::unique_ptr<Sink> sink,
                       const CutOptions& options, const WriterOptions& writer,
                       const ReaderLimits& limits) {
  const auto reader = Reader::open(std::move(source), limits);
  if (!reader) {
    return reader.error();
  }
  return copy(*reader, std::move(sink), writer, options);
}

}  // namespace furrow::mcap
