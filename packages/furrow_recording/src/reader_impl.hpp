#pragma once

#include <memory>
#include <string>
#include <vector>

#include "data_section.hpp"
#include "furrow_recording/mcap_reader.hpp"

namespace furrow::mcap {

class Reader::Impl {
 public:
  std::unique_ptr<Source> source;
  ReaderLimits limits;
  Header header;
  Summary summary;
  std::vector<Span> spans;  ///< in the order of the file
  std::string damage;
  std::uint64_t bytes_ignored = 0;
  std::vector<std::string> faults;
};

}  // namespace furrow::mcap
