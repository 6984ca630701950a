#include <fmt/format.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <memory>
#include <thread>

#include "cli/commands.h"
#include "viewer/server/serve.h"

namespace terrane::cli {
namespace {

sigset_t signals_to_stop() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  return signals;
}

/// One address a line, so that a program can read them; who reads is told how to end it.
void print_addresses(const viewer::Server& server, bool is_quiet) {
  const auto urls = server.data_urls();
  if (urls.size() > 1) fmt::print("{}\n", server.url());
  for (const std::string& url : urls) fmt::print("{}\n", url);
  std::fflush(stdout);
  if (!is_quiet) fmt::print(stderr, "serving until Ctrl-C\n");
}

/// Serves until the user or the system asks to stop.
void run(const viewer::ServeOptions& options, const CommonOptions& common) {
  const sigset_t asked_to_stop = signals_to_stop();
  // before the server has threads, so that all of them leave these signals to sigwait
  pthread_sigmask(SIG_BLOCK, &asked_to_stop, nullptr);

  viewer::Server server(options);
  print_addresses(server, common.quiet);
  std::exception_ptr failure;
  std::thread answering([&] {
    try {
      server.run();
    } catch (...) {
      failure = std::current_exception();
      ::kill(::getpid(), SIGTERM);
    }
  });
  int signal = 0;
  sigwait(&asked_to_stop, &signal);
  server.stop();
  // a second Ctrl-C does not wait for slow clients
  pthread_sigmask(SIG_UNBLOCK, &asked_to_stop, nullptr);
  answering.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace

void add_serve_command(CLI::App& app, const CommonOptions& common) {
  auto options = std::make_shared<viewer::ServeOptions>();
  CLI::App* serve =
      app.add_subcommand("serve", "Show output folders, archives and merge trees in the browser");
  serve
      ->add_option("out", options->data,
                   "Folders that terrane build wrote, archives or merge trees; several get a page "
                   "that lists "
                   "them")
      ->required();
  CLI::Option* port =
      serve->add_option("--port", options->port, "Port; without this, the next free one from 8080")
          ->check(CLI::Range(0, 65535))
          ->capture_default_str();
  serve->add_option("--bind", options->bind, "Address to listen on; 0.0.0.0 for every network")
      ->capture_default_str();
  serve->add_option("--access-log", options->access_log,
                    "File to append a line to for each request (Combined Log Format)");
  serve
      ->add_option("--max-age", options->tiles_max_age_s,
                   "Seconds for which browsers keep tiles without asking again; 0: ask each time")
      ->check(CLI::Range(0, 31'536'000))
      ->capture_default_str();
  serve->add_option("--connections", options->connections, "Clients at the same time; others wait")
      ->check(CLI::Range(8, 100'000))
      ->capture_default_str();
  serve->callback([options, port, &common] {
    options->next_free_port = port->count() == 0;
    run(*options, common);
  });
}

}  // namespace terrane::cli
