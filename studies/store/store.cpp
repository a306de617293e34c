#include "studies/store/store.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>
#include <sqlite3.h>

#include <chrono>
#include <mutex>
#include <system_error>
#include <thread>

#include "core/error.h"
#include "core/version.h"
#include "studies/store/process_locks.h"

namespace retrace::studies {
namespace fs = std::filesystem;
namespace {

/// Number of the format, in the file's user_version. It changes when an older program would misread the file.
constexpr int kFormat = 1;
/// "rtrc": tells these files from other SQLite files.
constexpr int kApplication = 0x72747263;
constexpr int kWaitMs = 60'000;
/// Columns of a point that are no parameter and no quantity.
constexpr int kFixedColumns = 5;

std::string quoted(const std::string& name) {
  std::string text = "\"";
  for (const char c : name) text += c == '"' ? std::string("\"\"") : std::string(1, c);
  return text + '"';
}

std::vector<std::string> output_columns(const StoreLayout& layout) {
  std::vector<std::string> columns;
  for (const std::string& name : layout.outputs) {
    columns.push_back(name);
    columns.push_back(name + "_std_error");
  }
  return columns;
}

/// Whether nothing is stored at that place yet.
bool is_new(const fs::path& file) {
  std::error_code ignored;
  return file.empty() || !fs::exists(file, ignored) || fs::file_size(file, ignored) == 0;
}

void remove_store(const fs::path& file) {
  std::error_code error;
  for (const char* suffix : {"", "-wal", "-shm"}) {
    fs::remove(file.string() + suffix, error);
    if (error) throw OutputError(file.string() + ": cannot be replaced: " + error.message());
  }
}

}  // namespace

struct ResultStore::Database {
  fs::path file;
  StoreLayout layout;
  std::unique_ptr<ProcessLocks> locks;  ///< null in memory
  std::unique_ptr<SQLite::Database> sqlite;
  std::unique_ptr<SQLite::Statement> claim;
  std::unique_ptr<SQLite::Statement> insert;
  std::unique_ptr<SQLite::Statement> unclaim;
  mutable std::mutex mutex;

  std::string name() const { return file.empty() ? "the store in memory" : file.string(); }
  std::int64_t owner() const { return locks ? locks->own() : 0; }

  [[noreturn]] void fail(const SQLite::Exception& error) const {
    throw OutputError(
        fmt::format("{}: cannot be written: {}; the points that are finished are kept", name(), error.getErrorStr()));
  }
  /// Runs `work`, alone among the threads, with errors of SQLite as ours.
  template <class Work>
  auto guarded(Work work) const {
    const std::lock_guard lock(mutex);
    try {
      return work();
    } catch (const SQLite::Exception& error) {
      fail(error);
    }
  }

  void open();
  void switch_to_log();
  void check_kind();
  void make_tables();
  void check_study() const;
  void prepare();
};

void ResultStore::Database::open() {
  sqlite = std::make_unique<SQLite::Database>(file.empty() ? ":memory:" : file.string(),
                                              SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE, kWaitMs);
  check_kind();
  // A commit in the write-ahead log survives the death of the process without waiting for the disk; a power cut may
  // cost the last points, never the file.
  if (!file.empty()) switch_to_log();
  sqlite->exec("PRAGMA synchronous = NORMAL");
  SQLite::Transaction transaction(*sqlite, SQLite::TransactionBehavior::IMMEDIATE);
  if (!sqlite->tableExists("study"))
    make_tables();
  else
    check_study();
  transaction.commit();
}

/// The switch fails at once, whatever the time-out, where another process is about it too.
void ResultStore::Database::switch_to_log() {
  for (int attempt = 0;; ++attempt) {
    try {
      sqlite->exec("PRAGMA journal_mode = WAL");
      return;
    } catch (const SQLite::Exception& error) {
      if (error.getErrorCode() != SQLITE_BUSY || attempt == 200) throw;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }
}

void ResultStore::Database::check_kind() {
  if (sqlite->execAndGet("SELECT count(*) FROM sqlite_master").getInt() == 0) return;
  const int application = sqlite->execAndGet("PRAGMA application_id").getInt();
  const int format = sqlite->execAndGet("PRAGMA user_version").getInt();
  if (application != kApplication) throw InputError({name(), 0, ""}, "is no store of retrace");
  if (format > kFormat)
    throw InputError(
        {name(), 0, ""},
        fmt::format("is of a newer version of retrace (format {}), this one reads up to {}", format, kFormat));
}

void ResultStore::Database::make_tables() {
  sqlite->exec(fmt::format("PRAGMA application_id = {}", kApplication));
  sqlite->exec(fmt::format("PRAGMA user_version = {}", kFormat));
  sqlite->exec("CREATE TABLE study (name TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID");
  sqlite->exec("CREATE TABLE claims (point INTEGER PRIMARY KEY, owner INTEGER NOT NULL)");
  std::string columns =
      "point INTEGER PRIMARY KEY, failed INTEGER NOT NULL, reason TEXT, elapsed_s REAL NOT NULL, version TEXT NOT NULL";
  for (const std::string& input : layout.inputs) columns += ", " + quoted(input);
  for (const std::string& output : output_columns(layout)) columns += ", " + quoted(output) + " REAL";
  sqlite->exec("CREATE TABLE points (" + columns + ")");
  SQLite::Statement insert_part(*sqlite, "INSERT INTO study VALUES (?, ?)");
  const auto add = [&](const std::string& key, const std::string& value) {
    insert_part.bind(1, key);
    insert_part.bind(2, value);
    insert_part.exec();
    insert_part.reset();
  };
  add("kind", layout.kind);
  add("begun_with_version", kVersion);
  for (const auto& [key, value] : layout.parts) add("part." + key, value);
}

void ResultStore::Database::check_study() const {
  SQLite::Statement query(*sqlite, "SELECT value FROM study WHERE name = ?");
  const auto stored = [&](const std::string& key) {
    query.reset();
    query.bind(1, key);
    return query.executeStep() ? query.getColumn(0).getString() : std::string();
  };
  if (const std::string kind = stored("kind"); kind != layout.kind)
    throw InputError({name(), 0, ""}, fmt::format("is a store of {}, not of {}", kind, layout.kind));
  for (const auto& [key, value] : layout.parts)
    if (stored("part." + key) != value)
      throw InputError(
          {layout.source, 0, ""},
          fmt::format("{} differs from that of {}: --overwrite starts anew, another --out keeps both", key, name()));
}

void ResultStore::Database::prepare() {
  claim = std::make_unique<SQLite::Statement>(
      *sqlite,
      "INSERT INTO claims SELECT ?1, ?2 WHERE NOT EXISTS (SELECT 1 FROM points WHERE point = ?1) "
      "ON CONFLICT DO NOTHING");
  unclaim = std::make_unique<SQLite::Statement>(*sqlite, "DELETE FROM claims WHERE point = ? AND owner = ?");
  std::string places = "?, ?, ?, ?, ?";
  for (std::size_t k = 0; k < layout.inputs.size() + 2 * layout.outputs.size(); ++k) places += ", ?";
  insert = std::make_unique<SQLite::Statement>(*sqlite, "INSERT OR IGNORE INTO points VALUES (" + places + ")");
}

ResultStore::ResultStore(const fs::path& file, const StoreLayout& layout, IfExists if_exists)
    : database_(std::make_unique<Database>()) {
  database_->file = file;
  database_->layout = layout;
  if (!is_new(file) && if_exists == IfExists::refuse)
    throw InputError({file.string(), 0, ""},
                     "exists: --resume goes on with it, --overwrite starts anew, another --out keeps it");
  try {
    if (!file.empty()) {
      database_->locks = std::make_unique<ProcessLocks>(file.string() + "-lock");
      if (if_exists == IfExists::overwrite && database_->owner() != 0)
        throw InputError({file.string(), 0, ""}, "is in use by another process and cannot be overwritten");
    }
    if (if_exists == IfExists::overwrite) remove_store(file);
    database_->open();
    database_->prepare();
  } catch (const SQLite::Exception& error) {
    if (error.getErrorCode() == SQLITE_NOTADB) throw InputError({file.string(), 0, ""}, "is no store of retrace");
    database_->fail(error);
  }
  // Claims in our name are those of a process that died.
  if (!file.empty())
    database_->guarded(
        [&] { database_->sqlite->exec(fmt::format("DELETE FROM claims WHERE owner = {}", database_->owner())); });
}

ResultStore::~ResultStore() = default;

bool ResultStore::claim(std::uint64_t point) {
  return database_->guarded([&] {
    SQLite::Statement& statement = *database_->claim;
    statement.reset();
    statement.bind(1, static_cast<std::int64_t>(point));
    statement.bind(2, database_->owner());
    return statement.exec() == 1;
  });
}

void ResultStore::give_up(std::uint64_t point) {
  database_->guarded([&] {
    database_->unclaim->reset();
    database_->unclaim->bind(1, static_cast<std::int64_t>(point));
    database_->unclaim->bind(2, database_->owner());
    database_->unclaim->exec();
  });
}

void ResultStore::record(const StoredPoint& point) {
  database_->guarded([&] {
    Database& database = *database_;
    SQLite::Transaction transaction(*database.sqlite, SQLite::TransactionBehavior::IMMEDIATE);
    SQLite::Statement& insert = *database.insert;
    insert.reset();
    insert.clearBindings();
    insert.bind(1, static_cast<std::int64_t>(point.point));
    insert.bind(2, point.failed ? 1 : 0);
    if (point.failed) insert.bind(3, point.reason);
    insert.bind(4, point.elapsed_s);
    insert.bind(5, point.version);
    int column = kFixedColumns;
    for (const StoredValue& input : point.inputs)
      std::visit([&](const auto& value) { insert.bind(++column, value); }, input);
    for (const StoredOutput& output : point.outputs) {
      if (output.value) insert.bind(column + 1, *output.value);
      if (output.value) insert.bind(column + 2, output.std_error);
      column += 2;
    }
    insert.exec();
    insert.reset();
    database.unclaim->reset();
    database.unclaim->bind(1, static_cast<std::int64_t>(point.point));
    database.unclaim->bind(2, database.owner());
    database.unclaim->exec();
    database.unclaim->reset();
    transaction.commit();
  });
}

std::size_t ResultStore::claimed_by_others() {
  if (!database_->locks) return 0;
  return database_->guarded([&] {
    std::size_t claimed = 0;
    std::vector<std::int64_t> dead;
    {
      SQLite::Statement query(*database_->sqlite, "SELECT owner, count(*) FROM claims WHERE owner <> ? GROUP BY owner");
      query.bind(1, database_->owner());
      while (query.executeStep()) {
        const std::int64_t owner = query.getColumn(0).getInt64();
        if (database_->locks->is_alive(owner))
          claimed += static_cast<std::size_t>(query.getColumn(1).getInt64());
        else
          dead.push_back(owner);
      }
    }
    if (dead.empty()) return claimed;
    // Another process may take the byte of a dead one, but claims nothing before this transaction ends.
    SQLite::Transaction transaction(*database_->sqlite, SQLite::TransactionBehavior::IMMEDIATE);
    for (const std::int64_t owner : dead)
      if (!database_->locks->is_alive(owner))
        database_->sqlite->exec(fmt::format("DELETE FROM claims WHERE owner = {}", owner));
    transaction.commit();
    return claimed;
  });
}

std::vector<std::uint64_t> ResultStore::finished() const {
  return database_->guarded([&] {
    std::vector<std::uint64_t> numbers;
    SQLite::Statement query(*database_->sqlite, "SELECT point FROM points ORDER BY point");
    while (query.executeStep()) numbers.push_back(static_cast<std::uint64_t>(query.getColumn(0).getInt64()));
    return numbers;
  });
}

namespace {

StoredPoint point_of(SQLite::Statement& row, const StoreLayout& layout) {
  StoredPoint point;
  point.point = static_cast<std::uint64_t>(row.getColumn(0).getInt64());
  point.failed = row.getColumn(1).getInt() != 0;
  if (point.failed) point.reason = row.getColumn(2).getString();
  point.elapsed_s = row.getColumn(3).getDouble();
  point.version = row.getColumn(4).getString();
  int column = kFixedColumns;
  for (std::size_t k = 0; k < layout.inputs.size(); ++k, ++column) {
    const SQLite::Column value = row.getColumn(column);
    if (value.isFloat() || value.isInteger())
      point.inputs.emplace_back(value.getDouble());
    else
      point.inputs.emplace_back(value.getString());
  }
  if (point.failed) return point;
  for (std::size_t k = 0; k < layout.outputs.size(); ++k, column += 2) {
    StoredOutput output;
    if (!row.getColumn(column).isNull())
      output = {row.getColumn(column).getDouble(), row.getColumn(column + 1).getDouble()};
    point.outputs.push_back(output);
  }
  return point;
}

}  // namespace

std::vector<StoredPoint> ResultStore::points() const {
  return database_->guarded([&] {
    std::vector<StoredPoint> points;
    SQLite::Statement query(*database_->sqlite, "SELECT * FROM points ORDER BY point");
    while (query.executeStep()) points.push_back(point_of(query, database_->layout));
    return points;
  });
}

}  // namespace retrace::studies
