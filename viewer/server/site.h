#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "viewer/server/data_set.h"

namespace terrane::viewer {

/// What a server shows: one data set at "/", or several at "/NAME/" with a page at "/" that lists
/// them.
class Site {
 public:
  /// \throws InputError if one of the paths is no folder and no archive.
  explicit Site(const std::vector<std::filesystem::path>& paths);

  /// The file at a path (see DataSet::find).
  std::optional<DataSetFile> find(std::string_view path) const;

  /// Where "/NAME" without a slash leads: "/NAME/", encoded.
  std::optional<std::string> redirect(std::string_view path) const;

  /// Where the data sets show, encoded: "/", or "/NAME/" each, and what their pages ask for.
  std::vector<std::string> paths() const;

 private:
  struct Mount {
    std::string prefix;  ///< "/NAME", empty for the only one
    std::unique_ptr<DataSet> data;
  };

  const Mount* mount_of(std::string_view path) const;
  std::optional<DataSetFile> index_page() const;

  std::vector<Mount> mounts_;
};

}  // namespace terrane::viewer
