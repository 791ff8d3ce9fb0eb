#pragma once

#include <gtest/gtest.h>
#include <sqlite3.h>
#include <zstd.h>

#include <cstdint>
#include <filesystem>
#include <string>

namespace furrow::recording {

inline std::string zstd_of(const std::string& data) {
  std::string packed(ZSTD_compressBound(data.size()), '\0');
  packed.resize(ZSTD_compress(packed.data(), packed.size(), data.data(), data.size(), 1));
  return packed;
}

/// A std_msgs/String in CDR.
inline std::string cdr_text(const std::string& text) {
  const auto length = static_cast<std::uint32_t>(text.size() + 1);
  return std::string("\0\1\0\0", 4) +
         std::string(reinterpret_cast<const char*>(&length), sizeof length) + text + '\0';
}

struct Db3Options {
  bool indexed = true;
  bool message_compression = false;
  bool definitions = true;
  bool old_columns = false;  ///< of ROS 2 Dashing: topics without QoS
};

/// Writes SQLite files as rosbag2 does.
class TestDb3 {
 public:
  explicit TestDb3(const std::filesystem::path& path, const Db3Options& options = {})
      : options_(options) {
    EXPECT_EQ(sqlite3_open(path.c_str(), &database_), SQLITE_OK);
    run(options.old_columns
            ? "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
              "serialization_format TEXT NOT NULL)"
            : "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
              "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL)");
    run("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, "
        "timestamp INTEGER NOT NULL, data BLOB NOT NULL)");
    if (options.indexed) run("CREATE INDEX timestamp_idx ON messages (timestamp ASC)");
    if (options.definitions) {
      run("CREATE TABLE message_definitions(id INTEGER PRIMARY KEY, topic_type TEXT NOT NULL, "
          "encoding TEXT NOT NULL, encoded_message_definition TEXT NOT NULL, "
          "type_description_hash TEXT NOT NULL)");
      run("INSERT INTO message_definitions VALUES (1, 'std_msgs/msg/String', 'ros2msg', "
          "'string data', '')");
    }
  }
  ~TestDb3() { sqlite3_close(database_); }
  TestDb3(const TestDb3&) = delete;
  TestDb3& operator=(const TestDb3&) = delete;

  void topic(int id, const std::string& name, const std::string& qos = "",
             const std::string& encoding = "cdr") {
    run("INSERT INTO topics VALUES (" + std::to_string(id) + ", '" + name +
        "', 'std_msgs/msg/String', '" + encoding + "'" +
        (options_.old_columns ? "" : ", '" + qos + "'") + ")");
  }

  void message(int topic, std::int64_t ms, const std::string& text) {
    sqlite3_stmt* insert = nullptr;
    EXPECT_EQ(sqlite3_prepare_v2(database_,
                                 "INSERT INTO messages (topic_id, timestamp, data) VALUES (?,?,?)",
                                 -1, &insert, nullptr),
              SQLITE_OK);
    std::string data = cdr_text(text);
    if (options_.message_compression) data = zstd_of(data);
    sqlite3_bind_int(insert, 1, topic);
    sqlite3_bind_int64(insert, 2, ms * 1'000'000);
    sqlite3_bind_blob(insert, 3, data.data(), static_cast<int>(data.size()), SQLITE_TRANSIENT);
    EXPECT_EQ(sqlite3_step(insert), SQLITE_DONE);
    sqlite3_finalize(insert);
  }

  void run(const std::string& sql) {
    char* failure = nullptr;
    EXPECT_EQ(sqlite3_exec(database_, sql.c_str(), nullptr, nullptr, &failure), SQLITE_OK)
        << (failure != nullptr ? failure : "");
    sqlite3_free(failure);
  }

 private:
  Db3Options options_;
  sqlite3* database_ = nullptr;
};

}  // namespace furrow::recording
