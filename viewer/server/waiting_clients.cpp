#include "viewer/server/waiting_clients.h"

#include <sys/socket.h>

namespace terrane::viewer {
namespace {

constexpr std::chrono::milliseconds kBetweenLooks{250};

}  // namespace

WaitingClients::WaitingClients(const Patience& patience)
    : patience_(patience), watching_([this] { watch(); }) {}

WaitingClients::~WaitingClients() {
  {
    const std::scoped_lock lock(mutex_);
    must_end_ = true;
  }
  ends_.notify_all();
  watching_.join();
}

WaitingClient* WaitingClients::add(int descriptor) {
  const std::scoped_lock lock(mutex_);
  return &clients_.emplace_back(descriptor);
}

void WaitingClients::remove(const WaitingClient* client) {
  const std::scoped_lock lock(mutex_);
  clients_.remove_if([client](const WaitingClient& other) { return &other == client; });
}

void WaitingClients::watch() {
  std::unique_lock lock(mutex_);
  while (!ends_.wait_for(lock, kBetweenLooks, [this] { return must_end_; })) {
    hang_up_on_the_slow();
  }
}

void WaitingClients::hang_up_on_the_slow() {
  const bool is_crowded = clients_.size() >= patience_.crowd;
  const auto limit = is_crowded ? patience_.when_crowded : patience_.usual;
  for (const WaitingClient& client : clients_) {
    // the server sees an end, and closes; the lock keeps the descriptor from being another's by now
    if (client.waits_longer_than(limit)) ::shutdown(client.descriptor(), SHUT_RDWR);
  }
}

}  // namespace terrane::viewer
