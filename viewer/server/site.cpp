#include "viewer/server/site.h"

#include <fmt/format.h>

#include <algorithm>

#include "viewer/server/index_page.h"
#include "viewer/server/url_path.h"

namespace terrane::viewer {

Site::Site(const std::vector<std::filesystem::path>& paths) {
  for (const auto& path : paths) mounts_.push_back({"", open_data_set(path)});
  if (mounts_.size() == 1) return;
  for (Mount& mount : mounts_) {
    // two folders called "out" become /out/ and /out-2/
    std::string prefix = "/" + mount.data->name();
    for (int number = 2; mount_of(prefix + "/") != nullptr; ++number) {
      prefix = fmt::format("/{}-{}", mount.data->name(), number);
    }
    mount.prefix = std::move(prefix);
  }
}

const Site::Mount* Site::mount_of(std::string_view path) const {
  const auto found = std::ranges::find_if(mounts_, [&](const Mount& mount) {
    const bool is_single = mounts_.size() == 1;
    return is_single || (!mount.prefix.empty() && path.starts_with(mount.prefix) &&
                         path.substr(mount.prefix.size()).starts_with('/'));
  });
  return found == mounts_.end() ? nullptr : &*found;
}

std::optional<DataSetFile> Site::find(std::string_view path) const {
  const Mount* mount = mount_of(path);
  auto file =
      mount != nullptr ? mount->data->find(path.substr(mount->prefix.size())) : std::nullopt;
  const bool is_front = path == "/" || (mount != nullptr && path == mount->prefix + "/");
  return file || !is_front ? std::move(file) : index_page();
}

std::optional<std::string> Site::redirect(std::string_view path) const {
  const bool is_mount = std::ranges::any_of(
      mounts_, [&](const Mount& mount) { return !mount.prefix.empty() && path == mount.prefix; });
  if (!is_mount) return std::nullopt;
  return encode_url_path(path) + "/";
}

std::vector<std::string> Site::paths() const {
  std::vector<std::string> paths;
  for (const Mount& mount : mounts_) {
    paths.push_back(encode_url_path(mount.prefix) + "/" + mount.data->query());
  }
  return paths;
}

std::optional<DataSetFile> Site::index_page() const {
  std::vector<IndexEntry> entries;
  for (const Mount& mount : mounts_) {
    const std::string name = mount.prefix.empty() ? mount.data->name() : mount.prefix.substr(1);
    entries.push_back({name, encode_url_path(mount.prefix) + "/", mount.data.get()});
  }
  std::string page = make_index_page(entries);
  std::string tag = fmt::format("index-{:x}", std::hash<std::string>()(page));
  return DataSetFile{
      .name = "index.html", .content = FileContent(std::move(page)), .tag = std::move(tag)};
}

}  // namespace terrane::viewer
