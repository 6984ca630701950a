#pragma once

#include <stdexcept>
#include <string>

namespace terrane {

/// Base of every error that a user can mend. The message is one line that says where, what, and
/// what to do. `terrane` ends with exit_status().
class Error : public std::runtime_error {
 public:
  Error(const std::string& message, int exit_status)
      : std::runtime_error(message), exit_status_(exit_status) {}

  int exit_status() const { return exit_status_; }

 private:
  int exit_status_;
};

/// A file that cannot be read, or whose content cannot be used. Exit status 3.
class InputError : public Error {
 public:
  explicit InputError(const std::string& message) : Error(message, 3) {}
};

/// A setting that is out of range or unknown. Exit status 2, as for wrong arguments.
class ConfigError : public Error {
 public:
  explicit ConfigError(const std::string& message) : Error(message, 2) {}
};

/// A mesh that is not what an algorithm needs (not manifold, folded, singular). Exit status 4.
class TopologyError : public Error {
 public:
  explicit TopologyError(const std::string& message) : Error(message, 4) {}
};

/// A file or folder that cannot be written. Exit status 5.
class OutputError : public Error {
 public:
  explicit OutputError(const std::string& message) : Error(message, 5) {}
};

}  // namespace terrane
