#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "viewer/server/file_content.h"

namespace terrane::viewer {

/// A file of a data set, as it lies there.
struct DataSetFile {
  std::string name;  ///< below the data set: "tiles/0/1/2.glb"
  FileContent content;
  std::string tag;  ///< changes with the content; for an ETag
  std::int64_t modified_ns = 0;
  bool is_gzipped = false;  ///< content is the file, gzipped
};

/// Files of one output folder or archive, as URLs see them. Thread-safe.
class DataSet {
 public:
  virtual ~DataSet() = default;

  /// The file at a path; nothing for whatever must not be seen, or is damaged.
  ///
  /// \param path  starts with '/', percent-decoded once. "/" and "/folder/" name an index.html.
  virtual std::optional<DataSetFile> find(std::string_view path) const = 0;

  /// "st_helens" of /data/st_helens/ or /data/st_helens.pmtiles.
  const std::string& name() const { return name_; }

  /// What to add to its address to see it: nothing, or "?tree=bunny.tree".
  const std::string& query() const { return query_; }

  /// The name under which the archive itself is served; empty for a folder.
  const std::string& archive_name() const { return archive_name_; }

 protected:
  std::string name_;
  std::string archive_name_;
  std::string query_;
};

/// Opens an output folder, an archive that terrane packed, or a merge tree (.tree).
///
/// Where it has no viewer of its own, but a tileset.json or a tree, the viewer of this binary is
/// added. An archive is also served itself, under its file name.
/// \throws InputError if it is none of them.
std::unique_ptr<DataSet> open_data_set(const std::filesystem::path& path);

}  // namespace terrane::viewer
