#include "viewer/server/data_set.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <vector>

#include "archive/archive.h"
#include "core/errors.h"
#include "viewer/server/url_path.h"
#include "viewer/server/viewer_files.h"

namespace terrane::viewer {
namespace {

namespace fs = std::filesystem;

std::string name_of(const fs::path& path, bool is_archive) {
  const fs::path last = (fs::absolute(path) / "").lexically_normal().parent_path().filename();
  const std::string name = is_archive ? last.stem().string() : last.string();
  return name.empty() ? "data" : name;
}

/// The viewer of this binary, for data sets without one.
std::optional<DataSetFile> find_viewer_file(std::string_view path) {
  static const std::vector<DataSetFile> files = [] {
    std::vector<DataSetFile> made;
    for (const auto& part : {viewer_files(), tree_page_files(), engine_files()}) {
      for (const ViewerFile& file : part) {
        made.push_back({.name = std::string(file.path),
                        .content = FileContent(std::string(file.content)),
                        .tag = fmt::format("viewer-{:x}-{:x}", file.content.size(),
                                           std::hash<std::string_view>()(file.content))});
      }
    }
    return made;
  }();
  const std::string_view name = path == "/" ? "index.html" : path.substr(1);
  const auto found = std::ranges::find(files, name, &DataSetFile::name);
  return found == files.end() ? std::nullopt : std::optional(*found);
}

bool is_tree(const fs::path& path) { return path.extension() == ".tree"; }

/// A file below a folder, as it lies there.
std::optional<DataSetFile> find_below(const fs::path& root, std::string_view path) {
  auto file = open_served_file(root, path);
  if (!file) return std::nullopt;
  const OpenFile& content = *file->content;
  return DataSetFile{.name = file->path.lexically_relative(root).generic_string(),
                     .content = {file->content, {0, content.bytes()}},
                     .tag = fmt::format("{:x}-{:x}", content.modified_ns(), content.bytes()),
                     .modified_ns = content.modified_ns()};
}

class FolderDataSet final : public DataSet {
 public:
  explicit FolderDataSet(const fs::path& folder) : root_(fs::canonical(folder)) {
    name_ = name_of(folder, /*is_archive=*/false);
  }

  std::optional<DataSetFile> find(std::string_view path) const override {
    auto file = find_below(root_, path);
    return file || !is_to_see() ? std::move(file) : find_viewer_file(path);
  }

 private:
  /// Is there something that the viewer shows?
  bool is_to_see() const {
    if (fs::exists(root_ / "tileset.json")) return true;
    std::error_code error;
    return std::ranges::any_of(fs::directory_iterator(root_, error),
                               [](const fs::directory_entry& entry) { return is_tree(entry); });
  }

  fs::path root_;
};

/// One merge tree, with the viewer around it.
class TreeDataSet final : public DataSet {
 public:
  explicit TreeDataSet(const fs::path& file) : path_(fs::canonical(file)) {
    name_ = name_of(file, /*is_archive=*/true);
    query_ = "?tree=" + encode_url_path(path_.filename().string());
  }

  std::optional<DataSetFile> find(std::string_view path) const override {
    const bool is_it = path == "/" + path_.filename().string();
    return is_it ? find_below(path_.parent_path(), path) : find_viewer_file(path);
  }

 private:
  fs::path path_;
};

class ArchiveDataSet final : public DataSet {
 public:
  explicit ArchiveDataSet(const fs::path& path)
      : archive_(archive::open_archive(path)),
        file_(std::make_shared<const OpenFile>(::dup(archive_->file().descriptor()),
                                               archive_->file().bytes(),
                                               archive_->file().modified_ns())) {
    name_ = name_of(path, /*is_archive=*/true);
    archive_name_ = path.filename().string();
  }

  std::optional<DataSetFile> find(std::string_view path) const override try {
    if (!path.starts_with('/')) return std::nullopt;
    const std::string_view name = path.substr(1);
    if (name == archive_name_) return archive_itself();
    const auto content = archive_->find(name);
    if (content) return file_of(std::string(name), *content);
    return archive_->find("tileset.json") ? find_viewer_file(path) : std::nullopt;
  } catch (const InputError&) {
    return std::nullopt;  // damaged there: the others are served
  }

 private:
  DataSetFile archive_itself() const {
    return {.name = archive_name_,
            .content = {file_, {0, file_->bytes()}},
            .tag = fmt::format("{:x}-{:x}", file_->modified_ns(), file_->bytes()),
            .modified_ns = file_->modified_ns()};
  }

  DataSetFile file_of(std::string name, const archive::Content& content) const {
    DataSetFile file{.name = std::move(name), .modified_ns = file_->modified_ns()};
    const auto* stored = std::get_if<archive::StoredBytes>(&content);
    if (stored != nullptr && stored->coding != archive::Coding::kDeflate) {
      file.content = {file_, {stored->offset, stored->length}};
      file.is_gzipped = stored->coding == archive::Coding::kGzip;
      file.tag =
          fmt::format("{:x}-{:x}-{:x}", file_->modified_ns(), stored->offset, stored->length);
      return file;
    }
    file.content = FileContent(archive_->read(file.name).value());
    file.tag = fmt::format("{:x}-{:x}-{:x}", file_->modified_ns(),
                           std::hash<std::string_view>()(file.name), file.content.bytes());
    return file;
  }

  std::unique_ptr<archive::Archive> archive_;
  std::shared_ptr<const OpenFile> file_;
};

}  // namespace

std::unique_ptr<DataSet> open_data_set(const fs::path& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) return std::make_unique<FolderDataSet>(path);
  if (fs::is_regular_file(path, error) && is_tree(path)) {
    return std::make_unique<TreeDataSet>(path);
  }
  if (fs::is_regular_file(path, error)) return std::make_unique<ArchiveDataSet>(path);
  throw InputError(
      fmt::format("{}: no such folder, archive or tree. Give what 'terrane build', 'pack' or "
                  "'merge-tree' wrote",
                  path.string()));
}

}  // namespace terrane::viewer
