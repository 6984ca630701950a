#pragma once

#include <string>
#include <vector>

#include "viewer/server/data_set.h"

namespace terrane::viewer {

/// A data set and where it is served: "/NAME/", encoded.
struct IndexEntry {
  std::string name;  ///< "NAME"
  std::string url;
  const DataSet* data;
};

/// A page that lists data sets, with what each is and the addresses that clients want of it. No
/// script, nothing from elsewhere.
std::string make_index_page(const std::vector<IndexEntry>& entries);

}  // namespace terrane::viewer
