#pragma once

#include <cstdint>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <string>

namespace terrane::viewer {

/// Texts that took time to make, the last used ones up to a number of bytes. Thread-safe.
class GzipCache {
 public:
  explicit GzipCache(std::uint64_t most_bytes) : most_bytes_(most_bytes) {}

  /// The text of a key; made by \p make, and kept, if it is not there. Two threads that ask for the
  /// same key at the same time may both make it.
  std::shared_ptr<const std::string> get(const std::string& key,
                                         const std::function<std::string()>& make);

  bool holds(const std::string& key);

 private:
  struct Entry {
    std::string key;
    std::shared_ptr<const std::string> text;
  };

  void keep(const std::string& key, const std::shared_ptr<const std::string>& text);

  std::mutex mutex_;
  std::list<Entry> by_use_;  ///< last used first
  std::map<std::string, std::list<Entry>::iterator> by_key_;
  std::uint64_t bytes_ = 0;
  std::uint64_t most_bytes_;
};

}  // namespace terrane::viewer
