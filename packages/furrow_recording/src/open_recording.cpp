#include <array>
#include <string_view>
#include <utility>

#include "bag_recording.hpp"
#include "bag_records.hpp"
#include "db3_recording.hpp"
#include "furrow_recording/recording_reader.hpp"
#include "mcap_recording.hpp"
#include "records.hpp"
#include "rosbag2_folder.hpp"
#include "unpacked_file.hpp"

namespace furrow::recording {
namespace {

using Opened = Result<std::unique_ptr<RecordingReader>>;

constexpr std::string_view kSqliteMagic = "SQLite format 3";
constexpr std::string_view kZstdFileMagic = "\x28\xB5\x2F\xFD";

std::string_view mcap_magic() {
  return {reinterpret_cast<const char*>(mcap::kMagic.data()), mcap::kMagic.size()};
}

bool begins_with(const mcap::Source& source, std::string_view magic) {
  std::array<std::byte, 16> head{};
  const auto part = std::span(head).first(magic.size());
  if (source.size() < magic.size() || !source.read(0, part)) {
    return false;
  }
  return std::string_view(reinterpret_cast<const char*>(part.data()), part.size()) == magic;
}

/// Names the file, where the message does not yet.
Error with_path(const std::filesystem::path& path, const Error& error) {
  const std::string name = path.string();
  return {error.code, error.message.find(name) != std::string::npos ? error.message
                                                                    : name + ": " + error.message};
}

Opened open_file_by_content(const std::filesystem::path& path, const OpenOptions& options,
                            bool temporary) {
  auto source = mcap::open_file(path);
  if (!source) {
    return source.error();
  }
  if (begins_with(**source, kSqliteMagic)) {
    return open_db3(path, options, temporary);
  }
  if (!temporary && begins_with(**source, kZstdFileMagic)) {
    const auto unpacked = UnpackedFile::make(path);
    if (!unpacked) {
      return unpacked.error();
    }
    // The open file outlives its name.
    return open_file_by_content(unpacked->path(), options, true);
  }
  return open_recording(std::move(*source), options);
}

}  // namespace

Opened open_recording(std::unique_ptr<mcap::Source> source, const OpenOptions& options) {
  if (begins_with(*source, mcap_magic())) {
    return open_mcap(std::move(source), options);
  }
  if (begins_with(*source, kAnyBagMagic)) {
    return open_bag(std::move(source), options);
  }
  return Error{ErrorCode::kParse, "not a recording: neither MCAP, a ROS 1 bag nor a ROS 2 bag"};
}

Opened open_recording(const std::filesystem::path& path, const OpenOptions& options) {
  std::error_code ignored;
  auto reader = std::filesystem::is_directory(path, ignored)
                    ? open_rosbag2_folder(path, options)
                    : open_file_by_content(path, options, false);
  return reader ? std::move(reader) : Opened(with_path(path, reader.error()));
}

Opened open_recordings(const std::vector<std::filesystem::path>& paths,
                       const OpenOptions& options) {
  std::vector<std::unique_ptr<RecordingReader>> readers;
  for (const std::filesystem::path& path : paths) {
    auto reader = open_recording(path, options);
    if (!reader) {
      return reader;
    }
    readers.push_back(std::move(*reader));
  }
  return merge_readers(std::move(readers));
}

}  // namespace furrow::recording
