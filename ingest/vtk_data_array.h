#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace terrane::ingest {

/// How the numbers of a VTK XML file are stored: what its root element says.
struct VtkEncoding {
  bool is_big_endian = false;
  int header_bytes = 4;  ///< of each count that goes before binary data: 4 or 8
  bool is_zlib = false;  ///< binary data are blocks of vtkZLibDataCompressor
};

/// Reads the numbers of a `format="ascii"` array.
/// \throws InputError if something is no number (says what).
std::vector<double> parse_vtk_ascii(std::string_view text);

/// Reads the numbers of a `format="binary"` or `"appended"` array.
///
/// \param data  begins at the array's header and may go on beyond its end: base64 (white space is
///              passed over, header and data coded together or each by itself) or raw bytes.
/// \param type  of VTK: "Float64", "UInt8", ...
/// \throws InputError if the data end too early or are damaged, or the type is not known.
std::vector<double> decode_vtk_binary(std::string_view data, bool is_base64,
                                      const std::string& type, const VtkEncoding& encoding);

}  // namespace terrane::ingest
