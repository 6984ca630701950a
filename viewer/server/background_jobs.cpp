#include "viewer/server/background_jobs.h"

#include <exception>

namespace terrane::viewer {

BackgroundJobs::BackgroundJobs() : thread_([this] { run(); }) {}

BackgroundJobs::~BackgroundJobs() { end(); }

bool BackgroundJobs::add(std::function<void()> work, std::function<void()> then) {
  {
    const std::scoped_lock lock(mutex_);
    if (must_end_) return false;
    jobs_.push_back({std::move(work), std::move(then)});
  }
  changed_.notify_one();
  return true;
}

void BackgroundJobs::end() {
  {
    const std::scoped_lock lock(mutex_);
    must_end_ = true;
  }
  changed_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void BackgroundJobs::run() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return must_end_ || !jobs_.empty(); });
    if (jobs_.empty()) return;
    const Job job = std::move(jobs_.front());
    jobs_.pop_front();
    const bool is_wanted = !must_end_;
    lock.unlock();
    try {
      if (is_wanted) job.work();
    } catch (const std::exception&) {
      // out of memory: who asked finds the work not done, and does it or fails in its turn
    }
    job.then();
    lock.lock();
  }
}

}  // namespace terrane::viewer
