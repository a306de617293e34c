#pragma once

// The exceptions of retrace and the exit codes of the process that they lead to.

#include <stdexcept>
#include <string>
#include <string_view>

#include "api.h"  // of this folder: these headers are installed with the library

namespace retrace {

/// What the process returns to the shell. The numbers are part of the contract with scripts.
enum class ExitCode : int {
  done = 0,          ///< what was asked is done
  answer_is_no = 1,  ///< done, and the answer to what was asked is no
  bad_input = 2,     ///< usage, or an input that cannot be opened, read or understood
  failed = 3,        ///< an output that cannot be written, memory, or a budget that ran out
  interrupted = 130  ///< stopped by the user; what is finished is valid
};

/// Base of every error that retrace throws on purpose: one line of text and the exit code it leads to.
class RETRACE_API Error : public std::runtime_error {
 public:
  Error(ExitCode exit_code, const std::string& message) : std::runtime_error(message), exit_code_(exit_code) {}
  ExitCode exit_code() const noexcept { return exit_code_; }

 private:
  ExitCode exit_code_;
};

/// Where in an input something was found. An empty file or key and a line of 0 mean "not known" and are left out.
struct InputLocation {
  std::string file;
  int line = 0;
  std::string key;
};

/// An input that cannot be used. The message reads `file:line: key: text` (exit code 2).
class RETRACE_API InputError : public Error {
 public:
  InputError(const InputLocation& where, std::string_view text);
  explicit InputError(std::string_view text) : InputError(InputLocation{}, text) {}

  const InputLocation& where() const noexcept { return where_; }
  /// The message without the location.
  const std::string& text() const noexcept { return text_; }

 private:
  InputLocation where_;
  std::string text_;
};

/// An output that cannot be written (exit code 3).
class RETRACE_API OutputError : public Error {
 public:
  explicit OutputError(const std::string& message) : Error(ExitCode::failed, message) {}
};

/// A limit on time, memory or accuracy that was reached before the answer was (exit code 3).
class RETRACE_API BudgetError : public Error {
 public:
  explicit BudgetError(const std::string& message) : Error(ExitCode::failed, message) {}
};

}  // namespace retrace
