#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace terrane::ingest {

/// Values at the posts of a grid whose planes are upright to the axes, at any distances.
struct RectilinearGrid {
  std::array<std::vector<double>, 3> axes;  ///< places of the posts along x, y and z
  std::vector<double> values;               ///< one per post, x fastest, then y
};

/// Reads one array of a VTK rectilinear grid (XML, `.vtr`): of its points, one component, one
/// piece; numbers as ascii, base64 or raw, plain or packed by zlib, of any integer or float type.
///
/// Axes and values come as they are in the file: neither is checked for order or NaN.
///
/// \param array  name of the array; empty: the only one.
/// \throws InputError naming the file, if it is no such grid, or the array is not there (lists
/// those
///         that are).
/// \par Source
/// VTK File Formats, "XML file formats".
RectilinearGrid read_rectilinear_grid(const std::filesystem::path& file, const std::string& array);

}  // namespace terrane::ingest
