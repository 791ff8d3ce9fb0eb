#include "file_appender.hpp"

#include "crc32.hpp"

namespace furrow::mcap {

Status FileAppender::append(std::initializer_list<Part> parts) {
  if (failed_) {
    return *failed_;
  }
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

}  // namespace furrow::mcap
