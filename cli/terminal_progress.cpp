#include "cli/terminal_progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <mutex>
#include <string>

namespace terrane::cli {
namespace {

using Clock = std::chrono::steady_clock;

/// One line for each stage and note.
class PlainProgress final : public Progress {
 public:
  void begin(std::string_view stage, std::int64_t) override {
    const std::scoped_lock lock(mutex_);
    fmt::print(stderr, "{}\n", stage);
  }
  void advance(std::int64_t) override {}
  void note(std::string_view line) override {
    const std::scoped_lock lock(mutex_);
    fmt::print(stderr, "note: {}\n", line);
  }

 private:
  std::mutex mutex_;
};

/// One line that is drawn anew, a few times a second.
class BarProgress final : public Progress {
 public:
  ~BarProgress() override { end_stage(); }

  void begin(std::string_view stage, std::int64_t total) override {
    const std::scoped_lock lock(mutex_);
    end_stage();
    stage_ = stage;
    total_ = std::max<std::int64_t>(1, total);
    done_ = 0;
    started_ = Clock::now();
    draw();
  }

  void advance(std::int64_t steps) override {
    const std::scoped_lock lock(mutex_);
    done_ += steps;
    if (Clock::now() - drawn_ > std::chrono::milliseconds(200)) draw();
  }

  void note(std::string_view line) override {
    const std::scoped_lock lock(mutex_);
    fmt::print(stderr, "\r\033[Knote: {}\n", line);
    if (!stage_.empty()) draw();
  }

 private:
  void end_stage() {
    if (stage_.empty()) return;
    draw();
    fmt::print(stderr, "\n");
    stage_.clear();
  }

  void draw() {
    constexpr int kWidth = 24;
    drawn_ = Clock::now();
    const double seconds = std::chrono::duration<double>(drawn_ - started_).count();
    const double share = std::min(1.0, static_cast<double>(done_) / static_cast<double>(total_));
    const int filled = static_cast<int>(share * kWidth);
    const double rate = static_cast<double>(done_) / std::max(seconds, 1e-3);
    std::string left;
    if (done_ > 0 && done_ < total_) {
      left = fmt::format(", {:.0f} s left", static_cast<double>(total_ - done_) / rate);
    }
    fmt::print(stderr, "\r\033[K{:<16} [{:#<{}}{:<{}}] {}/{}, {:.1f}/s{}", stage_, "", filled, "",
               kWidth - filled, done_, total_, rate, left);
    std::fflush(stderr);
  }

  std::mutex mutex_;
  std::string stage_;
  std::int64_t total_ = 1;
  std::int64_t done_ = 0;
  Clock::time_point started_, drawn_;
};

}  // namespace

std::unique_ptr<Progress> make_progress(bool quiet) {
  if (quiet) return std::make_unique<NoProgress>();
  if (isatty(STDERR_FILENO) != 0) return std::make_unique<BarProgress>();
  return std::make_unique<PlainProgress>();
}

}  // namespace terrane::cli
