#include "tests/support/refusals.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <stdexcept>

namespace retrace {
namespace {

const std::string kGoldenFile = std::string(RETRACE_SOURCE_DIR) + "/tests/messages.txt";

std::set<std::string> golden_lines() {
  std::set<std::string> lines;
  std::ifstream stream(kGoldenFile);
  for (std::string line; std::getline(stream, line);) lines.insert(line);
  return lines;
}

/// Adds a line to the golden file. The lock is necessary because test programs run in parallel.
void add_golden_line(const std::string& line) {
  const int lock = ::open(kGoldenFile.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (lock < 0 || ::flock(lock, LOCK_EX) != 0) throw std::runtime_error("cannot lock " + kGoldenFile);
  std::set<std::string> lines = golden_lines();
  lines.insert(line);
  std::ofstream stream(kGoldenFile);
  for (const std::string& each : lines) stream << each << '\n';
  stream.close();
  ::close(lock);
  if (!stream) throw std::runtime_error("cannot write " + kGoldenFile);
}

std::string without_folders(std::string text) {
  const std::string temporary = std::filesystem::temp_directory_path().string();
  text = std::regex_replace(text, std::regex(temporary + "/[^/ :;,\"]+"), "TMP");
  return std::regex_replace(text, std::regex(RETRACE_SOURCE_DIR "/"), "");
}

/// Rounds the numbers of a text that have more than seven decimals to six digits, because the last digits may depend on
/// the compiler.
std::string with_short_numbers(const std::string& text) {
  static const std::regex number("[0-9]+\\.[0-9]{8,}");
  std::string shortened;
  auto end = text.cbegin();
  for (std::sregex_iterator match(text.begin(), text.end(), number), last; match != last; ++match) {
    std::ostringstream rounded;
    rounded << std::stod(match->str());
    shortened += std::string(end, (*match)[0].first) + rounded.str();
    end = (*match)[0].second;
  }
  return shortened + std::string(end, text.cend());
}

void record_line(const std::string& text) {
  const std::string line = with_short_numbers(text);
  EXPECT_EQ(line.find('\n'), std::string::npos) << line;
  static const std::set<std::string> golden = golden_lines();
  if (golden.contains(line)) return;
  if (std::getenv("RETRACE_WRITE_GOLDEN") != nullptr)
    add_golden_line(line);
  else
    ADD_FAILURE() << "not in tests/messages.txt: " << line << "\nrun with RETRACE_WRITE_GOLDEN=1 to add it";
}

}  // namespace

std::string recorded_place_of(std::string_view message) {
  static const std::regex of_file(R"(^(standard input|--set [^:]+|/dev/[a-z]+|[^ :]+(?=:[0-9])|[^ :]+\.)"
                                  R"((?:toml|csv|agf|yml|txt|ngc|nc|stl|pgm|png|ldt|ies|json))(:[0-9]+)?: )");
  static const std::regex of_key(R"(^(--)?[A-Za-z_][^ :"]*(?=: ))");
  std::string rest = without_folders(std::string(message));
  std::string place;
  std::smatch match;
  if (std::regex_search(rest, match, of_file)) {
    place = match.str();
    rest = match.suffix();
  }
  record_line(rest);
  if (std::regex_search(rest, match, of_key)) return place + match.str();
  return place.substr(0, place.find_last_not_of(": ") + 1);
}

void record_message(std::string_view message) {
  recorded_place_of(message);
}

std::string facts_of(const Warning& warning) {
  const std::string place = recorded_place_of(warning.text);
  return std::string(warning.id) + (place.empty() ? "" : " at " + place);
}

std::vector<std::string> facts_of(const Warnings& warnings) {
  std::vector<std::string> facts;
  for (const Warning& warning : warnings) facts.push_back(facts_of(warning));
  return facts;
}

std::string place_of(const Error& error) {
  const auto* refused = dynamic_cast<const InputError*>(&error);
  EXPECT_EQ(error.exit_code(), refused == nullptr ? ExitCode::failed : ExitCode::bad_input) << error.what();
  if (refused == nullptr) return "failed";
  const InputLocation& where = refused->where();
  std::string place = without_folders(where.file);
  if (where.line > 0) place += ":" + std::to_string(where.line);
  if (!place.empty() && !where.key.empty()) place += ": ";
  place += where.key;
  return place.empty() ? "refused" : place;
}

std::string recorded_place_of(const Error& error) {
  const auto* refused = dynamic_cast<const InputError*>(&error);
  if (refused == nullptr)
    record_message(error.what());
  else
    record_line(without_folders((refused->where().key.empty() ? "" : refused->where().key + ": ") + refused->text()));
  return place_of(error);
}

}  // namespace retrace
