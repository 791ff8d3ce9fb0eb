#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bytes.hpp"
#include "furrow_core/result.hpp"

namespace furrow::recording {

/// A query that is stepped through. kParse for a damaged database, kIo when it cannot be read.
class SqliteQuery {
 public:
  /// True when there is a row. After false or an error there are no more.
  [[nodiscard]] Result<bool> next();
  /// Starts again with another parameter, the first one of the query.
  [[nodiscard]] Status restart(std::int64_t parameter);

  [[nodiscard]] std::int64_t integer(int column) const;
  [[nodiscard]] std::string text(int column) const;
  /// A view that lives until the next step.
  [[nodiscard]] mcap::ByteView blob(int column) const;

 private:
  friend class SqliteDatabase;
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
  };
  explicit SqliteQuery(sqlite3_stmt* statement) : statement_(statement) {}
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
};

/// A database that is only read, and not trusted: its views, triggers and virtual tables are never
/// run, and no value is larger than the limit.
class SqliteDatabase {
 public:
  /// `immutable`: the file cannot change, and SQLite looks for no journal beside it.
  [[nodiscard]] static Result<SqliteDatabase> open(const std::filesystem::path& path,
                                                   std::uint64_t max_value_bytes, bool immutable);
  /// Opens the bytes of a database, which must outlive it.
  [[nodiscard]] static Result<SqliteDatabase> open(std::vector<std::byte>& bytes,
                                                   std::uint64_t max_value_bytes);

  /// Columns of a table; empty when there is no such ordinary table.
  [[nodiscard]] Result<std::vector<std::string>> columns(const std::string& table) const;
  [[nodiscard]] Result<SqliteQuery> query(const std::string& sql) const;

 private:
  struct Close {
    void operator()(sqlite3* database) const { sqlite3_close_v2(database); }
  };
  explicit SqliteDatabase(sqlite3* database) : database_(database) {}
  void restrict_use(std::uint64_t max_value_bytes) const;
  std::unique_ptr<sqlite3, Close> database_;
};

}  // namespace furrow::recording
