#include "ingest/rectilinear_grid.h"

#include <cpl_minixml.h>
#include <fmt/format.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>

#include "core/errors.h"
#include "ingest/gdal_scope.h"
#include "ingest/vtk_data_array.h"

namespace terrane::ingest {
namespace {

struct DestroyXml {
  void operator()(CPLXMLNode* node) const { CPLDestroyXMLNode(node); }
};
using Xml = std::unique_ptr<CPLXMLNode, DestroyXml>;

/// A VTK XML file: elements, and the bytes behind them that no XML reader would take.
struct VtkFile {
  Xml xml;
  const CPLXMLNode* root = nullptr;
  VtkEncoding encoding;
  std::string bytes;          ///< the whole file
  std::string_view appended;  ///< behind the underscore
  bool is_appended_base64 = true;
};

std::string attribute(const CPLXMLNode* node, const char* name, const char* otherwise = "") {
  return CPLGetXMLValue(node, name, otherwise);
}

std::string read_bytes(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream || !std::filesystem::is_regular_file(file)) {
    throw InputError("cannot be read. Give a VTK rectilinear grid (.vtr)");
  }
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Cuts the appended data off: raw bytes are not XML.
std::string without_appended(VtkFile& file) {
  const std::size_t element = file.bytes.find("<AppendedData");
  if (element == std::string::npos) return file.bytes;
  const std::size_t open = file.bytes.find('>', element);
  const std::size_t mark = file.bytes.find('_', open);
  if (open == std::string::npos || mark == std::string::npos) {
    throw InputError("its appended data have no beginning. Write the file again");
  }
  const std::string tag = file.bytes.substr(element, open - element);
  file.is_appended_base64 = tag.find("\"raw\"") == std::string::npos;
  file.appended = std::string_view(file.bytes).substr(mark + 1);
  return file.bytes.substr(0, element) + "</VTKFile>";
}

VtkEncoding encoding_of(const CPLXMLNode* root) {
  VtkEncoding encoding;
  encoding.is_big_endian = attribute(root, "byte_order", "LittleEndian") == "BigEndian";
  encoding.header_bytes = attribute(root, "header_type", "UInt32") == "UInt64" ? 8 : 4;
  const std::string compressor = attribute(root, "compressor");
  encoding.is_zlib = compressor == "vtkZLibDataCompressor";
  if (!compressor.empty() && !encoding.is_zlib) {
    throw InputError(fmt::format("is packed by {}. Write it with zlib, or unpacked", compressor));
  }
  return encoding;
}

void parse(VtkFile& file) {
  file.xml.reset(CPLParseXMLString(without_appended(file).c_str()));
  file.root = file.xml != nullptr ? CPLGetXMLNode(file.xml.get(), "=VTKFile") : nullptr;
  if (file.root == nullptr || attribute(file.root, "type") != "RectilinearGrid") {
    throw InputError("is no VTK rectilinear grid in XML. Give a .vtr file");
  }
  file.encoding = encoding_of(file.root);
}

std::vector<const CPLXMLNode*> elements_in(const CPLXMLNode* parent, const char* name) {
  std::vector<const CPLXMLNode*> found;
  for (const CPLXMLNode* node = parent != nullptr ? parent->psChild : nullptr; node != nullptr;
       node = node->psNext) {
    if (node->eType == CXT_Element && EQUAL(node->pszValue, name)) found.push_back(node);
  }
  return found;
}

std::vector<double> numbers_of(const VtkFile& file, const CPLXMLNode* array) {
  const std::string format = attribute(array, "format", "ascii");
  const std::string type = attribute(array, "type");
  try {
    if (format == "appended") {
      const std::string offset = attribute(array, "offset");
      const std::size_t at = std::strtoull(offset.c_str(), nullptr, 10);
      if (offset.empty() || at >= file.appended.size()) {
        throw InputError("its offset lies beyond the file. Write the file again");
      }
      return decode_vtk_binary(file.appended.substr(at), file.is_appended_base64, type,
                               file.encoding);
    }
    const std::string text = CPLGetXMLValue(array, "", "");
    return format == "binary" ? decode_vtk_binary(text, true, type, file.encoding)
                              : parse_vtk_ascii(text);
  } catch (const InputError& error) {
    throw InputError(fmt::format("array '{}': {}", attribute(array, "Name"), error.what()));
  }
}

const CPLXMLNode* only_piece(const VtkFile& file) {
  const CPLXMLNode* grid = CPLGetXMLNode(const_cast<CPLXMLNode*>(file.root), "RectilinearGrid");
  const auto pieces = elements_in(grid, "Piece");
  if (pieces.size() != 1) {
    throw InputError(fmt::format("has {} pieces. Write it as one", pieces.size()));
  }
  return pieces.front();
}

const CPLXMLNode* find_array(const CPLXMLNode* piece, const std::string& wanted) {
  const auto arrays = elements_in(
      elements_in(piece, "PointData").empty() ? nullptr : elements_in(piece, "PointData").front(),
      "DataArray");
  std::string names;
  for (const CPLXMLNode* array : arrays) {
    const std::string name = attribute(array, "Name");
    if (name == wanted || (wanted.empty() && arrays.size() == 1)) return array;
    names += (names.empty() ? "" : ", ") + name;
  }
  throw InputError(fmt::format("has no array '{}' at its points. There are: {}", wanted,
                               names.empty() ? "none" : names));
}

RectilinearGrid read_grid(const std::filesystem::path& path, const std::string& wanted) {
  VtkFile file;
  file.bytes = read_bytes(path);
  parse(file);
  const CPLXMLNode* piece = only_piece(file);
  const auto coordinates = elements_in(piece, "Coordinates");
  const auto axes = elements_in(coordinates.empty() ? nullptr : coordinates.front(), "DataArray");
  if (axes.size() != 3) throw InputError("has no three arrays of coordinates. Give a .vtr file");
  const CPLXMLNode* array = find_array(piece, wanted);
  const std::string components = attribute(array, "NumberOfComponents", "1");
  if (components != "1" && components != "0") {
    throw InputError(fmt::format("array '{}': has {} components. Give one of a single number",
                                 attribute(array, "Name"), components));
  }
  RectilinearGrid grid;
  for (std::size_t axis = 0; axis < 3; ++axis) grid.axes[axis] = numbers_of(file, axes[axis]);
  grid.values = numbers_of(file, array);
  const std::size_t posts = grid.axes[0].size() * grid.axes[1].size() * grid.axes[2].size();
  if (grid.values.size() != posts) {
    throw InputError(fmt::format("array '{}': has {} values for {} x {} x {} posts",
                                 attribute(array, "Name"), grid.values.size(), grid.axes[0].size(),
                                 grid.axes[1].size(), grid.axes[2].size()));
  }
  return grid;
}

}  // namespace

RectilinearGrid read_rectilinear_grid(const std::filesystem::path& file, const std::string& array) {
  const GdalScope gdal;  // keeps what its XML reader has to say
  try {
    return read_grid(file, array);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", file.string(), error.what()));
  }
}

}  // namespace terrane::ingest
