#include "viewer/server/gzip_cache.h"

namespace terrane::viewer {

std::shared_ptr<const std::string> GzipCache::get(const std::string& key,
                                                  const std::function<std::string()>& make) {
  {
    const std::scoped_lock lock(mutex_);
    if (const auto found = by_key_.find(key); found != by_key_.end()) {
      by_use_.splice(by_use_.begin(), by_use_, found->second);
      return found->second->text;
    }
  }
  const auto text = std::make_shared<const std::string>(make());
  const std::scoped_lock lock(mutex_);
  keep(key, text);
  return text;
}

bool GzipCache::holds(const std::string& key) {
  const std::scoped_lock lock(mutex_);
  return by_key_.contains(key);
}

void GzipCache::keep(const std::string& key, const std::shared_ptr<const std::string>& text) {
  if (text->size() > most_bytes_ || by_key_.contains(key)) return;
  by_use_.push_front({key, text});
  by_key_[key] = by_use_.begin();
  bytes_ += text->size();
  while (bytes_ > most_bytes_) {
    bytes_ -= by_use_.back().text->size();
    by_key_.erase(by_use_.back().key);
    by_use_.pop_back();
  }
}

}  // namespace terrane::viewer
