#include "compute/store/store.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>
#include <sqlite3.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <mutex>
#include <new>
#include <system_error>
#include <thread>

#include "compute/store/process_locks.h"
#include "core/error.h"
#include "core/message_text.h"
#include "core/version.h"

namespace retrace::compute {
namespace fs = std::filesystem;
namespace {

/// Number of the file format, stored as user_version. It is increased when the format changes in a way that older
/// programs would misinterpret.
constexpr int kFormat = 1;
/// SQLite application id ("rtrc"), which distinguishes these files from other SQLite files.
constexpr int kApplication = 0x72747263;
constexpr int kWaitMs = 60'000;
/// Number of columns of the table `points` that are neither parameters nor quantities.
constexpr int kFixedColumns = 5;
constexpr const char* kAllPoints = "SELECT * FROM points ORDER BY point";
/// Maximum number of characters of an SQLite message or other reason that is quoted in an error message.
constexpr std::size_t kMaxReasonLength = 160;

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

/// Returns true if the file does not exist or is empty.
bool is_new(const fs::path& file) {
  std::error_code ignored;
  return file.empty() || !fs::exists(file, ignored) || fs::file_size(file, ignored) == 0;
}

/// Returns true if an existing file must not be replaced. A store is replaced if no point in it has succeeded, for
/// example because of a wrong key in the study.
bool has_results(const fs::path& file) {
  try {
    SQLite::Database sqlite(file.string(), SQLite::OPEN_READONLY, kWaitMs);
    if (sqlite.execAndGet("PRAGMA application_id").getInt() != kApplication) return true;
    return sqlite.execAndGet("SELECT count(*) FROM points WHERE failed = 0").getInt() > 0;
  } catch (const SQLite::Exception&) {
    return true;  // the file is damaged or is not a store, and is not replaced either
  }
}

void remove_store(const fs::path& file) {
  std::error_code error;
  for (const char* suffix : {"", "-journal", "-wal", "-shm"}) {
    fs::remove(file.string() + suffix, error);
    if (error) throw OutputError(file.string() + ": cannot be replaced: " + error.message());
  }
}

/// Returns the names of the tables of a store and the SQL statements that create them.
std::vector<std::pair<std::string, std::string>> tables_of(const StoreLayout& layout) {
  std::string columns =
      "point INTEGER PRIMARY KEY, failed INTEGER NOT NULL, reason TEXT, elapsed_s REAL NOT NULL, version TEXT NOT NULL";
  for (const std::string& input : layout.inputs) columns += ", " + quoted(input);
  for (const std::string& output : output_columns(layout)) columns += ", " + quoted(output) + " REAL";
  return {{"study", "CREATE TABLE study (name TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID"},
          {"claims", "CREATE TABLE claims (point INTEGER PRIMARY KEY, owner INTEGER NOT NULL)"},
          {"points", "CREATE TABLE points (" + columns + ")"}};
}

/// Returns true if an SQLite error has a cause outside of the file. Examples are a full disk, a missing permission and
/// a lock of another process.
bool is_of_the_system(int code) {
  constexpr std::array kOfTheSystem = {SQLITE_BUSY, SQLITE_CANTOPEN, SQLITE_FULL,     SQLITE_IOERR, SQLITE_INTERRUPT,
                                       SQLITE_AUTH, SQLITE_LOCKED,   SQLITE_READONLY, SQLITE_PERM,  SQLITE_NOLFS};
  return std::ranges::find(kOfTheSystem, code) != kOfTheSystem.end();
}

}  // namespace

struct ResultStore::Database {
  fs::path file;
  StoreLayout layout;
  std::unique_ptr<ProcessLocks> locks;  ///< null for a store in memory
  std::unique_ptr<SQLite::Database> sqlite;
  std::unique_ptr<SQLite::Statement> claim;
  std::unique_ptr<SQLite::Statement> insert;
  std::unique_ptr<SQLite::Statement> unclaim;
  bool is_checked = false;
  mutable std::mutex mutex;

  std::string name() const { return file.empty() ? "the store in memory" : file.string(); }
  std::int64_t owner() const { return locks ? locks->own() : 0; }

  [[noreturn]] void refuse(const std::string& what) const {
    throw InputError({name(), 0, ""}, fmt::format("{}; use {} to replace it, or another output folder to keep it", what,
                                                  reference({"overwrite"})));
  }
  [[noreturn]] void refuse_damaged(const std::string& why) const {
    refuse("the store is damaged: " + printable(why, kMaxReasonLength));
  }
  [[noreturn]] void fail(const SQLite::Exception& error) const {
    const int code = error.getErrorCode() & 0xff;
    if (code == SQLITE_NOMEM) throw std::bad_alloc();
    if (code == SQLITE_NOTADB) refuse("the file does not contain a store of retrace");
    if (!is_of_the_system(code)) refuse_damaged(error.getErrorStr());
    throw OutputError(
        fmt::format("{}: cannot be written: {}; the finished points are kept", name(), error.getErrorStr()));
  }
  /// Calls `work` while the mutex is locked. Converts errors of SQLite to errors of this program.
  template <class Work>
  auto guarded(Work work) const {
    const std::lock_guard lock(mutex);
    try {
      return work();
    } catch (const SQLite::Exception& error) {
      fail(error);
    }
  }

  void connect();
  void open();
  bool is_empty() const;
  void keep_log(bool keep) const;
  void check_existing();
  void check();
  void check_kind() const;
  void check_tables() const;
  void check_study() const;
  void switch_to_log();
  void make_tables();
  void prepare();
  std::uint64_t number_in(const SQLite::Statement& row) const;
  StoredPoint point_in(const SQLite::Statement& row) const;
};

void ResultStore::Database::connect() {
  sqlite = std::make_unique<SQLite::Database>(file.empty() ? ":memory:" : file.string(),
                                              SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE, kWaitMs);
}

/// Returns true if the file has no tables yet. A file with only its first page also counts as empty, because SQLite
/// writes this page when the first transaction begins.
bool ResultStore::Database::is_empty() const {
  return sqlite->execAndGet("PRAGMA page_count").getInt() <= 1 &&
         sqlite->execAndGet("PRAGMA application_id").getInt() == 0 &&
         sqlite->execAndGet("SELECT count(*) FROM sqlite_master").getInt() == 0;
}

/// Sets whether the write-ahead log of a killed process remains when the file is closed. If it does not remain, SQLite
/// merges it into the file.
void ResultStore::Database::keep_log(bool keep) const {
  sqlite3_db_config(sqlite->getHandle(), SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, keep ? 1 : 0, nullptr);
}

/// Opens and checks an existing store. A store that is refused is not changed. An empty store is accepted, because a
/// process may have been killed while it created the store.
void ResultStore::Database::check_existing() {
  const bool has_log = !is_new(file.string() + "-wal");
  connect();
  if (has_log) keep_log(true);
  if (!is_empty()) check();
  keep_log(false);
}

void ResultStore::Database::open() {
  if (!sqlite) connect();
  sqlite->exec("PRAGMA synchronous = NORMAL");
  SQLite::Transaction transaction(*sqlite, SQLite::TransactionBehavior::IMMEDIATE);
  if (is_empty())
    make_tables();
  else if (!is_checked)
    check();  // another process has created the store in the meantime
  transaction.commit();
  // With `synchronous = NORMAL`, a commit is only written to the write-ahead log, without waiting for the disk. The
  // commit survives the death of the process. A power failure can lose the last points, but never damages the file.
  if (!file.empty()) switch_to_log();
}

/// Switches SQLite to a write-ahead log. Several attempts may be needed, because the switch fails immediately if
/// another process is switching at the same time.
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

/// Checks everything in a store: format, pages, tables, study and points.
void ResultStore::Database::check() {
  check_kind();
  const std::string pages = sqlite->execAndGet("PRAGMA integrity_check(1)").getString();
  if (pages != "ok") refuse_damaged(pages);
  check_study();
  check_tables();
  SQLite::Statement rows(*sqlite, kAllPoints);
  while (rows.executeStep()) static_cast<void>(point_in(rows));
  is_checked = true;
}

void ResultStore::Database::check_kind() const {
  const int application = sqlite->execAndGet("PRAGMA application_id").getInt();
  const int format = sqlite->execAndGet("PRAGMA user_version").getInt();
  if (application != kApplication) refuse("the file does not contain a store of retrace");
  if (format > kFormat)
    throw InputError(
        {name(), 0, ""},
        fmt::format(
            "the store was written by a newer version of retrace (format {}); this version reads formats up to {}",
            format, kFormat));
}

void ResultStore::Database::make_tables() {
  sqlite->exec(fmt::format("PRAGMA application_id = {}", kApplication));
  sqlite->exec(fmt::format("PRAGMA user_version = {}", kFormat));
  for (const auto& [table, statement] : tables_of(layout)) sqlite->exec(statement);
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

void ResultStore::Database::check_tables() const {
  SQLite::Statement query(*sqlite, "SELECT sql FROM sqlite_master WHERE type = 'table' AND name = ?");
  for (const auto& [table, statement] : tables_of(layout)) {
    query.reset();
    query.bind(1, table);
    if (!query.executeStep() || query.getColumn(0).getString() != statement)
      refuse_damaged("its table " + table + " is missing or has other columns");
  }
}

void ResultStore::Database::check_study() const {
  SQLite::Statement query(*sqlite, "SELECT value FROM study WHERE name = ?");
  const auto stored = [&](const std::string& key) {
    query.reset();
    query.bind(1, key);
    return query.executeStep() ? query.getColumn(0).getString() : std::string();
  };
  const std::string kind = stored("kind");
  if (kind.empty()) refuse_damaged("its kind of study is missing");
  if (kind != layout.kind)
    throw InputError({name(), 0, ""},
                     fmt::format("the store contains results of another kind of study: its format must be {1}, got {0}",
                                 kind, layout.kind));
  for (const auto& [key, value] : layout.parts)
    if (stored("part." + key) != value)
      throw InputError({layout.source, 0, ""},
                       fmt::format("this input has changed since {1} was begun: {0}; use {2} to replace the store, or "
                                   "another output folder to keep both",
                                   key, name(), reference({"overwrite"})));
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
  if (!is_new(file) && if_exists == IfExists::refuse) {
    if (has_results(file))
      throw InputError(
          {file.string(), 0, ""},
          fmt::format(
              "the store exists already; use {} to continue it, {} to replace it, or another output folder to keep it",
              reference({"resume"}), reference({"overwrite"})));
    if_exists = IfExists::overwrite;
  }
  try {
    // An existing store is checked before other files are created. If the store is refused, no new files remain next to
    // it.
    if (!is_new(file) && if_exists == IfExists::resume) database_->check_existing();
    if (!file.empty()) {
      database_->locks = std::make_unique<ProcessLocks>(file.string() + "-lock");
      if (if_exists == IfExists::overwrite && database_->owner() != 0)
        throw InputError({file.string(), 0, ""}, "the store is in use by another process and cannot be overwritten");
    }
    if (if_exists == IfExists::overwrite) remove_store(file);
    database_->open();
    database_->prepare();
  } catch (const SQLite::Exception& error) {
    database_->fail(error);
  }
  // Each process has an owner number: the index of its byte in the lock file. Existing claims with the owner number of
  // this process were made by a dead process that had the same number. They are deleted.
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
    // A new process can get the owner number of a dead process, so is_alive() is checked again. The new process cannot
    // claim points before this transaction ends.
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
    while (query.executeStep()) numbers.push_back(database_->number_in(query));
    return numbers;
  });
}

std::vector<StoredPoint> ResultStore::points() const {
  return database_->guarded([&] {
    std::vector<StoredPoint> points;
    SQLite::Statement query(*database_->sqlite, kAllPoints);
    while (query.executeStep()) points.push_back(database_->point_in(query));
    return points;
  });
}

std::uint64_t ResultStore::Database::number_in(const SQLite::Statement& row) const {
  const std::int64_t number = row.getColumn(0).getInt64();
  if (number < 0) refuse_damaged(fmt::format("the number of a point must be >= 0, got {}", number));
  return static_cast<std::uint64_t>(number);
}

namespace {

using IsRight = bool (*)(const SQLite::Column&);

bool is_nothing(const SQLite::Column& value) {
  return value.isNull();
}
bool is_text(const SQLite::Column& value) {
  return value.isText();
}
bool is_number(const SQLite::Column& value) {
  return (value.isFloat() || value.isInteger()) && std::isfinite(value.getDouble());
}
bool is_number_or_text(const SQLite::Column& value) {
  return is_number(value) || is_text(value);
}
bool is_flag(const SQLite::Column& value) {
  return value.isInteger() && (value.getInt64() == 0 || value.getInt64() == 1);
}
bool is_duration(const SQLite::Column& value) {
  return is_number(value) && value.getDouble() >= 0.0;
}
bool is_output(const SQLite::Column& value) {
  return is_nothing(value) || is_number(value);
}
/// Returns true if the value is a valid standard error: >= 0 or missing. It can be missing because SQLite stores NaN as
/// NULL.
bool is_std_error(const SQLite::Column& value) {
  return is_nothing(value) || (value.isFloat() && value.getDouble() >= 0.0);
}

}  // namespace

StoredPoint ResultStore::Database::point_in(const SQLite::Statement& row) const {
  StoredPoint point;
  point.point = number_in(row);
  std::string fault;
  int column = 1;
  const auto next = [&](const std::string& name, IsRight is_right) {
    const SQLite::Column value = row.getColumn(column++);
    if (fault.empty() && !is_right(value))
      fault = fmt::format("{} cannot be {}", name, value.isNull() ? "empty" : value.getString());
    return value;
  };
  point.failed = next("failed", is_flag).getInt() != 0;
  point.reason = next("reason", point.failed ? is_text : is_nothing).getText();
  point.elapsed_s = next("elapsed_s", is_duration).getDouble();
  point.version = next("version", is_text).getText();
  for (const std::string& name : layout.inputs) {
    const SQLite::Column value = next(name, is_number_or_text);
    point.inputs.push_back(value.isText() ? StoredValue(value.getString()) : StoredValue(value.getDouble()));
  }
  for (const std::string& name : layout.outputs) {
    const SQLite::Column value = next(name, point.failed ? is_nothing : is_output);
    const SQLite::Column error = next(name + "_std_error", value.isNull() ? is_nothing : is_std_error);
    if (point.failed) continue;
    StoredOutput output;
    if (!value.isNull()) output = {value.getDouble(), error.getDouble()};
    point.outputs.push_back(output);
  }
  if (fault.empty() && layout.fault_of) fault = layout.fault_of(point);
  if (!fault.empty()) refuse_damaged(fmt::format("point {}: {}", point.point, fault));
  return point;
}

}  // namespace retrace::compute
