#include "rosbag2_folder.hpp"

#include <algorithm>
#include <utility>

#include "furrow_core/file.hpp"
#include "rosbag2_metadata.hpp"

namespace furrow::recording {
namespace {

constexpr char kMetadataFile[] = "metadata.yaml";

/// A recording with what its folder adds to its information.
class FolderRecording final : public RecordingReader {
 public:
  FolderRecording(std::unique_ptr<RecordingReader> files, RecordingInfo info)
      : files_(std::move(files)), info_(std::move(info)) {}
  const RecordingInfo& info() const override { return info_; }
  std::unique_ptr<MessageStream> messages(const mcap::ReadOptions& options) const override {
    return files_->messages(options);
  }
  Result<mcap::Attachment> attachment(std::size_t number) const override {
    return files_->attachment(number);
  }
  Result<mcap::Metadata> metadata(std::size_t number) const override {
    return files_->metadata(number);
  }

 private:
  std::unique_ptr<RecordingReader> files_;
  RecordingInfo info_;
};

bool is_storage_file(const std::filesystem::path& path) {
  auto name = path.filename();
  if (name.extension() == ".zstd") {
    name = name.stem();
  }
  return name.extension() == ".db3" || name.extension() == ".mcap";
}

Result<std::vector<std::filesystem::path>> storage_files(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code failure;
  for (const auto& entry : std::filesystem::directory_iterator(folder, failure)) {
    if (is_storage_file(entry.path()) && entry.is_regular_file(failure)) {
      files.push_back(entry.path().filename());
    }
  }
  if (failure) {
    return Error{ErrorCode::kIo, folder.string() + ": " + failure.message()};
  }
  std::ranges::sort(files);
  return files;
}

class FolderOpening {
 public:
  FolderOpening(const std::filesystem::path& folder, const OpenOptions& options)
      : folder_(folder), options_(options) {}

  Result<std::unique_ptr<RecordingReader>> run() {
    const auto files = files_to_open();
    if (!files) {
      return files.error();
    }
    std::vector<std::unique_ptr<RecordingReader>> readers;
    for (const auto& file : *files) {
      auto reader = open_recording(folder_ / file, options_);
      if (reader) {
        readers.push_back(std::move(*reader));
        continue;
      }
      if (files->size() == 1) {
        return reader.error();
      }
      faults_.push_back(reader.error().message);
    }
    auto merged = merge_readers(std::move(readers));
    if (!merged) {
      return Error{merged.error().code, "no file of the folder can be read"};
    }
    RecordingInfo info = (*merged)->info();
    info.format = "rosbag2";
    if (info.damage.empty()) {
      info.damage = damage_;
    }
    info.faults.insert(info.faults.end(), faults_.begin(), faults_.end());
    info.notes.insert(info.notes.end(), notes_.begin(), notes_.end());
    return std::unique_ptr<RecordingReader>(
        std::make_unique<FolderRecording>(std::move(*merged), std::move(info)));
  }

 private:
  Result<std::vector<std::filesystem::path>> files_to_open() {
    auto there = storage_files(folder_);
    if (!there) {
      return there;
    }
    const auto yaml = read_file(folder_ / kMetadataFile);
    if (!yaml) {
      if (there->empty()) {
        return Error{ErrorCode::kParse,
                     "not a rosbag2 folder: it has neither metadata.yaml nor .db3 or .mcap files"};
      }
      damage_ = "metadata.yaml is missing: the recorder was not closed";
      return there;
    }
    const auto metadata = parse_rosbag2_metadata(*yaml);
    if (!metadata) {
      if (there->empty()) {
        return metadata.error();
      }
      damage_ = metadata.error().message;
      return there;
    }
    std::vector<std::filesystem::path> files;
    for (const auto& file : metadata->files) {
      add_listed(file, files);
    }
    for (const auto& file : *there) {
      if (std::ranges::find(files, file) == files.end()) {
        notes_.push_back(file.string() + " is not listed in metadata.yaml and is left out");
      }
    }
    if (files.empty()) {
      return Error{ErrorCode::kNotFound, "no file of metadata.yaml exists"};
    }
    return files;
  }

  /// Recorders that were killed while they compressed list names without or with ".zstd".
  void add_listed(const std::filesystem::path& file, std::vector<std::filesystem::path>& files) {
    std::error_code ignored;
    const std::filesystem::path unpacked =
        file.extension() == ".zstd" ? file.parent_path() / file.stem() : file;
    for (const auto& name : {file, unpacked, std::filesystem::path(unpacked.string() + ".zstd")}) {
      if (std::filesystem::exists(folder_ / name, ignored)) {
        files.push_back(name);
        return;
      }
    }
    faults_.push_back(file.string() + " of metadata.yaml is missing");
  }

  const std::filesystem::path& folder_;
  const OpenOptions& options_;
  std::string damage_;
  std::vector<std::string> faults_;
  std::vector<std::string> notes_;
};

}  // namespace

Result<std::unique_ptr<RecordingReader>> open_rosbag2_folder(const std::filesystem::path& folder,
                                                             const OpenOptions& options) {
  return FolderOpening(folder, options).run();
}

}  // namespace furrow::recording
