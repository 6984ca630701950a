#include <fmt/format.h>

#include <csignal>
#include <cstdio>
#include <memory>
#include <thread>

#include "cli/commands.h"
#include "viewer/server/serve.h"

namespace terrane::cli {
namespace {

/// Serves until the user or the system asks to stop.
void run(const viewer::ServeOptions& options) {
  sigset_t asked_to_stop;
  sigemptyset(&asked_to_stop);
  sigaddset(&asked_to_stop, SIGINT);
  sigaddset(&asked_to_stop, SIGTERM);
  // before the server has threads, so that all of them leave these signals to sigwait
  pthread_sigmask(SIG_BLOCK, &asked_to_stop, nullptr);

  viewer::Server server(options);
  fmt::print("{}\n", server.url());
  std::fflush(stdout);
  std::thread answering([&server] { server.run(); });
  int signal = 0;
  sigwait(&asked_to_stop, &signal);
  server.stop();
  answering.join();
}

}  // namespace

void add_serve_command(CLI::App& app, const CommonOptions&) {
  auto options = std::make_shared<viewer::ServeOptions>();
  CLI::App* serve = app.add_subcommand("serve", "Show an output folder in the browser");
  serve->add_option("out", options->folder, "Folder that terrane build wrote")->required();
  serve->add_option("--port", options->port, "Port; if it is taken, the next free one")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  serve->add_option("--bind", options->bind, "Address to listen on; 0.0.0.0 for every network")
      ->capture_default_str();
  serve->callback([options] { run(*options); });
}

}  // namespace terrane::cli
