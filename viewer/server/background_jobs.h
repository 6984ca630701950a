#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

namespace terrane::viewer {

/// Work that would keep a thread from answering others, done one after the other in a thread of its
/// own. Thread-safe.
class BackgroundJobs {
 public:
  BackgroundJobs();
  ~BackgroundJobs();
  BackgroundJobs(const BackgroundJobs&) = delete;
  BackgroundJobs& operator=(const BackgroundJobs&) = delete;

  /// Calls \p work, and \p then when it has ended, even by an exception.
  /// \return false, and nothing is called, after end().
  bool add(std::function<void()> work, std::function<void()> then);

  /// Lets the work under way end, leaves out the rest, and calls each `then`.
  void end();

 private:
  struct Job {
    std::function<void()> work;
    std::function<void()> then;
  };

  void run();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Job> jobs_;
  bool must_end_ = false;
  std::thread thread_;
};

}  // namespace terrane::viewer
