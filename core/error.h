#pragma once

// Exceptions of retrace, and the exit codes that they cause.

#include <stdexcept>
#include <string>
#include <string_view>

#include "api.h"  // without the folder core/, because the installed copies of both headers are in the same folder
#include "field.h"

namespace retrace {

/// Exit code of the process. Scripts depend on these numbers, so they must not change.
enum class ExitCode : int {
  done = 0,          ///< success
  answer_is_no = 1,  ///< success with a negative result, such as a failed test
  bad_input = 2,     ///< usage error, or an input that cannot be opened, read or understood
  failed = 3,        ///< an output cannot be written, or a budget of memory or time is exhausted
  interrupted = 130  ///< stopped by the user; finished results are valid
};

/// Base class of all errors that retrace throws. An error has a message of one line and an exit code. The text of
/// what() contains the C++ names of request fields; message() can spell the fields differently.
class RETRACE_API Error : public std::runtime_error {
 public:
  /// \param message text of one line; it may contain references to fields, which reference() creates (core/field.h)
  Error(ExitCode exit_code, const std::string& message)
      : std::runtime_error(with_field_names(message)), exit_code_(exit_code), message_(message) {}
  ExitCode exit_code() const noexcept { return exit_code_; }
  /// Returns the message, with each request field spelled by the function `spelling`.
  std::string message(FieldSpelling spelling) const { return with_fields(message_, spelling); }

 private:
  ExitCode exit_code_;
  std::string message_;
};

/// Position in an input. An empty file, an empty key or the line 0 means that this part of the position is unknown.
/// Messages omit unknown parts.
struct InputLocation {
  std::string file;
  int line = 0;
  std::string key;
};

/// Error in an input file or in a field of a request (exit code 2). The message has the form `file:line: key: text`.
class RETRACE_API InputError : public Error {
 public:
  InputError(const InputLocation& where, std::string_view text);
  /// Creates an error about a field of a request. The member `key` of where() is the name of the field.
  InputError(Field field, std::string_view text);
  explicit InputError(std::string_view text) : InputError(InputLocation{}, text) {}

  const InputLocation& where() const noexcept { return where_; }
  /// Returns the request field that has the error. Its name is empty if the error is not about a request field.
  Field field() const noexcept { return {field_}; }
  /// Returns the message without file, line and key. Request fields in the text have their C++ names.
  std::string text() const { return with_field_names(text_); }
  /// Returns the message without file, line and key, with each request field spelled by the function `spelling`.
  std::string text(FieldSpelling spelling) const { return with_fields(text_, spelling); }

 private:
  InputLocation where_;
  std::string text_;
  std::string field_;
};

/// Error that an output cannot be written (exit code 3).
class RETRACE_API OutputError : public Error {
 public:
  explicit OutputError(const std::string& message) : Error(ExitCode::failed, message) {}
};

/// Error that a limit on time, memory or accuracy was reached before the result was computed (exit code 3).
class RETRACE_API BudgetError : public Error {
 public:
  explicit BudgetError(const std::string& message) : Error(ExitCode::failed, message) {}
};

}  // namespace retrace
