#pragma once

#include <string>
#include <vector>

namespace terrane::ingest {

/// A hash of all bytes of some files, whatever their names and order; 16 hex digits.
///
/// Read piece by piece, about as fast as a disk gives them.
/// \param files  anything that GDAL opens as a file ("/vsizip/..." too).
/// \throws InputError that names the file, if one cannot be read.
std::string hash_of_files(const std::vector<std::string>& files);

}  // namespace terrane::ingest
