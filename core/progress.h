#pragma once

#include <cstdint>
#include <string_view>

namespace terrane {

/// Receives what long work reports. Libraries report here and never print.
///
/// Thread-safe: advance() and note() may be called from any thread.
class Progress {
 public:
  virtual ~Progress() = default;

  /// A stage begins; it ends when the next one begins or the sink is destroyed.
  /// \param total  steps that advance() will count.
  virtual void begin(std::string_view stage, std::int64_t total) = 0;
  virtual void advance(std::int64_t steps) = 0;

  /// One line that the user should read: a suspicion, a decision made for them.
  virtual void note(std::string_view line) = 0;
};

/// Swallows everything.
class NoProgress final : public Progress {
 public:
  void begin(std::string_view, std::int64_t) override {}
  void advance(std::int64_t) override {}
  void note(std::string_view) override {}
};

}  // namespace terrane
