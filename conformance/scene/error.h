// What went wrong, for a person, in one line.
#pragma once

#include <string>

namespace edgecase::conformance {

enum class ErrorKind {
  bad_input,  ///< A file, argument or environment the user can put right: exit status 2.
  absent,     ///< A named subject, driver or device that is not there: exit status 3.
  subject,    ///< The subject itself failed: it crashed, hung or refused a draw it said it could do.
};

struct Error {
  ErrorKind kind = ErrorKind::bad_input;
  /// Names the file, the field and the value, where there are such; no line break, no final stop.
  std::string message;
};

}  // namespace edgecase::conformance
