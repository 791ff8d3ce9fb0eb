#pragma once

#include <bzlib.h>
#include <gtest/gtest.h>
#include <lz4frame.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "bytes.hpp"

namespace furrow::recording {

/// Serializes ROS 1 messages: little endian, without alignment.
class Ros1Message {
 public:
  template <class T>
  Ros1Message& number(T value) {
    const auto view = std::as_bytes(std::span(&value, 1));
    bytes.insert(bytes.end(), view.begin(), view.end());
    return *this;
  }
  Ros1Message& text(const std::string& value) {
    number(static_cast<std::uint32_t>(value.size()));
    const auto view = std::as_bytes(std::span(value));
    bytes.insert(bytes.end(), view.begin(), view.end());
    return *this;
  }
  Ros1Message& header(std::uint32_t seq, std::uint32_t sec, std::uint32_t nsec,
                      const std::string& frame) {
    return number(seq).number(sec).number(nsec).text(frame);
  }
  mcap::Bytes bytes;
};

/// Writes ROS 1 bags, format 2.0, as the recorder of ROS 1 does.
class TestBag {
 public:
  explicit TestBag(std::string compression = "none") : compression_(std::move(compression)) {
    append("#ROSBAG V2.0\n");
    put_bag_header(0);
  }

  std::uint32_t connect(const std::string& topic, const std::string& type,
                        const std::string& definition, bool latching = false,
                        const std::string& publisher = "/node") {
    const auto number = static_cast<std::uint32_t>(connections_.size());
    std::map<std::string, std::string> fields = {{"topic", topic},
                                                 {"type", type},
                                                 {"md5sum", "*"},
                                                 {"message_definition", definition},
                                                 {"callerid", publisher}};
    if (latching) {
      fields["latching"] = "1";
    }
    connections_.push_back(
        record({{"op", "\x07"}, {"conn", raw(number)}, {"topic", topic}}, header_of(fields)));
    add(chunk_, connections_.back());
    return number;
  }

  void message(std::uint32_t connection, std::uint32_t sec, std::uint32_t nsec,
               const mcap::Bytes& data) {
    index_[connection] += raw(sec) + raw(nsec) + raw(static_cast<std::uint32_t>(chunk_.size()));
    add(chunk_, record({{"op", "\x02"}, {"conn", raw(connection)}, {"time", raw(sec) + raw(nsec)}},
                       text_of(data)));
    const std::uint64_t time = std::uint64_t{sec} << 32 | nsec;
    start_ = index_.size() == 1 && count_ == 0 ? time : std::min(start_, time);
    end_ = std::max(end_, time);
    ++count_;
  }

  void end_chunk(bool with_index = true) {
    const std::string packed = pack(chunk_);
    const auto position = bytes.size();
    append(record({{"op", "\x05"},
                   {"compression", compression_},
                   {"size", raw(static_cast<std::uint32_t>(chunk_.size()))}},
                  packed));
    std::string counts;
    for (const auto& [connection, entries] : index_) {
      const auto count = static_cast<std::uint32_t>(entries.size() / 12);
      counts += raw(connection) + raw(count);
      if (with_index) {
        append(record({{"op", "\x04"},
                       {"ver", raw(std::uint32_t{1})},
                       {"conn", raw(connection)},
                       {"count", raw(count)}},
                      entries));
      }
    }
    const auto time = [](std::uint64_t value) {
      return raw(static_cast<std::uint32_t>(value >> 32)) + raw(static_cast<std::uint32_t>(value));
    };
    infos_ += record({{"op", "\x06"},
                      {"ver", raw(std::uint32_t{1})},
                      {"chunk_pos", raw(static_cast<std::uint64_t>(position))},
                      {"start_time", time(start_)},
                      {"end_time", time(end_)},
                      {"count", raw(static_cast<std::uint32_t>(index_.size()))}},
                     counts);
    ++chunks_;
    chunk_.clear();
    index_.clear();
    count_ = 0;
    start_ = end_ = 0;
  }

  /// Ends the last chunk and the file.
  const mcap::Bytes& close() {
    if (!chunk_.empty()) {
      end_chunk();
    }
    const auto index = static_cast<std::uint64_t>(bytes.size());
    for (const std::string& connection : connections_) {
      append(connection);
    }
    append(infos_);
    put_bag_header(index);
    return bytes;
  }

  mcap::Bytes bytes;

 private:
  template <class T>
  static std::string raw(T value) {
    return {reinterpret_cast<const char*>(&value), sizeof value};
  }
  static std::string text_of(const mcap::Bytes& data) {
    return {reinterpret_cast<const char*>(data.data()), data.size()};
  }
  static std::string header_of(const std::map<std::string, std::string>& fields) {
    std::string header;
    for (const auto& [name, value] : fields) {
      const std::string field = name + "=" + value;
      header += raw(static_cast<std::uint32_t>(field.size())) + field;
    }
    return header;
  }
  static std::string record(const std::map<std::string, std::string>& fields,
                            const std::string& data) {
    const std::string header = header_of(fields);
    return raw(static_cast<std::uint32_t>(header.size())) + header +
           raw(static_cast<std::uint32_t>(data.size())) + data;
  }
  static void add(std::string& to, const std::string& what) { to += what; }
  void append(const std::string& text) {
    const auto view = std::as_bytes(std::span(text));
    bytes.insert(bytes.end(), view.begin(), view.end());
  }

  /// Padded to 4096 bytes, so that it can be overwritten at the end.
  void put_bag_header(std::uint64_t index) {
    const std::map<std::string, std::string> fields = {
        {"op", "\x03"},
        {"index_pos", raw(index)},
        {"conn_count", raw(static_cast<std::uint32_t>(connections_.size()))},
        {"chunk_count", raw(chunks_)}};
    const std::string padding(4096 - header_of(fields).size() - 8, ' ');
    const std::string text = record(fields, padding);
    constexpr std::size_t kMagicBytes = 13;
    if (index == 0) {
      append(text);
      return;
    }
    const auto view = std::as_bytes(std::span(text));
    std::copy(view.begin(), view.end(), bytes.begin() + kMagicBytes);
  }

  [[nodiscard]] std::string pack(const std::string& data) const {
    if (compression_ == "bz2") {
      auto size = static_cast<unsigned>(data.size() + data.size() / 100 + 600);
      std::string packed(size, '\0');
      EXPECT_EQ(BZ2_bzBuffToBuffCompress(packed.data(), &size, const_cast<char*>(data.data()),
                                         static_cast<unsigned>(data.size()), 9, 0, 0),
                BZ_OK);
      packed.resize(size);
      return packed;
    }
    if (compression_ == "lz4") {
      std::string packed(LZ4F_compressFrameBound(data.size(), nullptr), '\0');
      packed.resize(
          LZ4F_compressFrame(packed.data(), packed.size(), data.data(), data.size(), nullptr));
      return packed;
    }
    return data;
  }

  std::string compression_;
  std::vector<std::string> connections_;
  std::string chunk_;
  std::map<std::uint32_t, std::string> index_;
  std::string infos_;
  std::uint32_t chunks_ = 0;
  std::uint64_t count_ = 0;
  std::uint64_t start_ = 0;
  std::uint64_t end_ = 0;
};

/// Definitions as bags carry them.
inline const std::string kHeaderDefinition =
    "uint32 seq\n# two-integer timestamp\ntime stamp\nstring frame_id\n";
inline std::string with_header(const std::string& fields) {
  return fields + std::string(80, '=') + "\nMSG: std_msgs/Header\n" + kHeaderDefinition;
}

}  // namespace furrow::recording
