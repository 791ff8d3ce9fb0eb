#include "sqlite_database.hpp"

#include <algorithm>
#include <cstdio>
#include <limits>

namespace furrow::recording {
namespace {

Error sqlite_error(sqlite3* database, int code) {
  const bool unreadable = code == SQLITE_IOERR || code == SQLITE_CANTOPEN || code == SQLITE_PERM ||
                          code == SQLITE_BUSY || code == SQLITE_LOCKED || code == SQLITE_NOMEM;
  return {unreadable ? ErrorCode::kIo : ErrorCode::kParse,
          std::string("SQLite: ") +
              (database != nullptr ? sqlite3_errmsg(database) : sqlite3_errstr(code))};
}

/// "file:PATH?mode=ro", with the characters escaped that mean something in a URI.
std::string uri_of(const std::filesystem::path& path, bool immutable) {
  std::string uri = "file:";
  for (const char c : path.string()) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '/' || c == '.' || c == '_' || c == '-';
    if (plain) {
      uri += c;
    } else {
      char escaped[4];
      std::snprintf(escaped, sizeof escaped, "%%%02X", static_cast<unsigned char>(c));
      uri += escaped;
    }
  }
  return uri + (immutable ? "?mode=ro&immutable=1" : "?mode=ro");
}

}  // namespace

Result<bool> SqliteQuery::next() {
  const int code = sqlite3_step(statement_.get());
  if (code == SQLITE_ROW) {
    return true;
  }
  if (code == SQLITE_DONE) {
    return false;
  }
  return sqlite_error(sqlite3_db_handle(statement_.get()), code & 0xFF);
}

Status SqliteQuery::restart(std::int64_t parameter) {
  sqlite3_reset(statement_.get());
  const int code = sqlite3_bind_int64(statement_.get(), 1, parameter);
  return code == SQLITE_OK ? Status()
                           : Status(sqlite_error(sqlite3_db_handle(statement_.get()), code));
}

std::int64_t SqliteQuery::integer(int column) const {
  return sqlite3_column_int64(statement_.get(), column);
}

std::string SqliteQuery::text(int column) const {
  const mcap::ByteView bytes = blob(column);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

mcap::ByteView SqliteQuery::blob(int column) const {
  const void* data = sqlite3_column_blob(statement_.get(), column);
  const int size = sqlite3_column_bytes(statement_.get(), column);
  return {static_cast<const std::byte*>(data),
          data == nullptr ? 0 : static_cast<std::size_t>(size)};
}

Result<SqliteDatabase> SqliteDatabase::open(const std::filesystem::path& path,
                                            std::uint64_t max_value_bytes, bool immutable) {
  sqlite3* handle = nullptr;
  const int code =
      sqlite3_open_v2(uri_of(path, immutable).c_str(), &handle,
                      SQLITE_OPEN_READONLY | SQLITE_OPEN_URI | SQLITE_OPEN_NOMUTEX, nullptr);
  SqliteDatabase database(handle);
  if (code != SQLITE_OK) {
    return sqlite_error(handle, code);
  }
  database.restrict_use(max_value_bytes);
  return database;
}

Result<SqliteDatabase> SqliteDatabase::open(std::vector<std::byte>& bytes,
                                            std::uint64_t max_value_bytes) {
  sqlite3* handle = nullptr;
  int code =
      sqlite3_open_v2(":memory:", &handle, SQLITE_OPEN_READWRITE | SQLITE_OPEN_NOMUTEX, nullptr);
  SqliteDatabase database(handle);
  if (code == SQLITE_OK) {
    code =
        sqlite3_deserialize(handle, "main", reinterpret_cast<unsigned char*>(bytes.data()),
                            static_cast<sqlite3_int64>(bytes.size()),
                            static_cast<sqlite3_int64>(bytes.size()), SQLITE_DESERIALIZE_READONLY);
  }
  if (code != SQLITE_OK) {
    return sqlite_error(handle, code);
  }
  database.restrict_use(max_value_bytes);
  return database;
}

void SqliteDatabase::restrict_use(std::uint64_t max_value_bytes) const {
  sqlite3* const handle = database_.get();
  sqlite3_db_config(handle, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(handle, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_db_config(handle, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
  sqlite3_db_config(handle, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
  constexpr std::uint64_t kMaxLimit = std::numeric_limits<int>::max();
  sqlite3_limit(handle, SQLITE_LIMIT_LENGTH,
                static_cast<int>(std::min(max_value_bytes, kMaxLimit)));
  sqlite3_exec(handle, "PRAGMA cell_size_check=ON; PRAGMA cache_size=-8000; PRAGMA mmap_size=0;",
               nullptr, nullptr, nullptr);
}

Result<std::vector<std::string>> SqliteDatabase::columns(const std::string& table) const {
  auto kind = query("SELECT type, sql FROM sqlite_master WHERE lower(name) = '" + table + "'");
  if (!kind) {
    return kind.error();
  }
  std::vector<std::string> names;
  const auto found = kind->next();
  if (!found) {
    return found.error();
  }
  if (!*found || kind->text(0) != "table" || kind->text(1).starts_with("CREATE VIRTUAL")) {
    return names;
  }
  auto info = query("SELECT name FROM pragma_table_info('" + table + "')");
  if (!info) {
    return info.error();
  }
  while (true) {
    const auto row = info->next();
    if (!row) {
      return row.error();
    }
    if (!*row) {
      return names;
    }
    names.push_back(info->text(0));
  }
}

Result<SqliteQuery> SqliteDatabase::query(const std::string& sql) const {
  sqlite3_stmt* statement = nullptr;
  const int code = sqlite3_prepare_v2(database_.get(), sql.c_str(), -1, &statement, nullptr);
  if (code != SQLITE_OK) {
    return sqlite_error(database_.get(), code);
  }
  return SqliteQuery(statement);
}

}  // namespace furrow::recording
