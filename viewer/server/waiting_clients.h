#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <list>
#include <mutex>
#include <thread>

namespace terrane::viewer {

/// One connection. It waits from its beginning, or from the end of an answer, until a whole request
/// is there.
class WaitingClient {
 public:
  using Clock = std::chrono::steady_clock;

  explicit WaitingClient(int descriptor) : descriptor_(descriptor) { begins_to_wait(); }

  void begins_to_wait() {
    since_ = Clock::now().time_since_epoch();
    waits_ = true;
  }
  void has_asked() { waits_ = false; }

  bool waits_longer_than(Clock::duration limit) const {
    return waits_ && Clock::now().time_since_epoch() - since_.load() > limit;
  }
  int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
  std::atomic<Clock::duration> since_;
  std::atomic<bool> waits_;
};

/// Hangs up on clients that do not come to the point: idle ones, and those that send a request a
/// byte at a time (slowloris), which a time-out between two bytes does not catch.
///
/// Where many are connected, patience is short, so that others get in. Thread-safe.
class WaitingClients {
 public:
  struct Patience {
    std::chrono::milliseconds usual{15'000};
    std::chrono::milliseconds when_crowded{1'000};
    std::size_t crowd = 0;  ///< so many connections and more
  };

  explicit WaitingClients(const Patience& patience);
  ~WaitingClients();
  WaitingClients(const WaitingClients&) = delete;
  WaitingClients& operator=(const WaitingClients&) = delete;

  /// \param descriptor  socket of the connection; stays open until remove().
  WaitingClient* add(int descriptor);
  void remove(const WaitingClient* client);

 private:
  void watch();
  void hang_up_on_the_slow();

  Patience patience_;
  std::mutex mutex_;
  std::condition_variable ends_;
  bool must_end_ = false;
  std::list<WaitingClient> clients_;
  std::thread watching_;
};

}  // namespace terrane::viewer
