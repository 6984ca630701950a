#include "tiler/verify/terrain_file.h"

#include <zlib.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>

#include "tiler/verify/json_file.h"

namespace terrane::verify {
namespace {

constexpr double kLast = 32767;

std::string read_bytes(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw damaged(file, "missing or unreadable");
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::string unzip(const std::string& packed, const std::filesystem::path& file) {
  constexpr int kGzipFormat = 15 + 16;
  // more than any tile has: what claims to be larger is damaged
  constexpr std::size_t kMostBytes = std::size_t{1} << 28;
  z_stream stream{};
  if (inflateInit2(&stream, kGzipFormat) != Z_OK) throw damaged(file, "zlib cannot be started");
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  std::string bytes;
  int verdict = Z_OK;
  while (verdict == Z_OK && bytes.size() < kMostBytes) {
    constexpr std::size_t kStep = std::size_t{1} << 16;
    const std::size_t before = bytes.size();
    bytes.resize(before + kStep);
    stream.next_out = reinterpret_cast<Bytef*>(bytes.data() + before);
    stream.avail_out = static_cast<uInt>(kStep);
    verdict = inflate(&stream, Z_NO_FLUSH);
    bytes.resize(before + kStep - stream.avail_out);
  }
  const bool is_all_read = stream.avail_in == 0;
  inflateEnd(&stream);
  if (verdict != Z_STREAM_END || !is_all_read) throw damaged(file, "is not whole gzip");
  return bytes;
}

/// Little-endian values one after the other, none beyond the end.
class Reader {
 public:
  Reader(const std::string& bytes, const std::filesystem::path& file)
      : bytes_(bytes), file_(file) {}

  template <class T>
  T take() {
    T value;
    std::memcpy(&value, piece(sizeof(T)), sizeof(T));
    return value;
  }
  template <class T>
  std::vector<T> take_list(std::size_t count) {
    if (count > bytes_.size() / sizeof(T)) throw damaged(file_, "a count is larger than the file");
    std::vector<T> values(count);
    const char* from = piece(count * sizeof(T));
    if (count > 0) std::memcpy(values.data(), from, count * sizeof(T));
    return values;
  }
  std::string take_text(std::size_t count) {
    const char* from = piece(count);
    return {from, count};
  }
  void align(std::size_t size) { piece((size - at_ % size) % size); }
  bool is_at_end() const { return at_ == bytes_.size(); }

 private:
  const char* piece(std::size_t size) {
    if (size > bytes_.size() - at_) throw damaged(file_, "is cut short");
    at_ += size;
    return bytes_.data() + at_ - size;
  }

  const std::string& bytes_;
  const std::filesystem::path& file_;
  std::size_t at_ = 0;
};

/// Undoes the zigzag, and adds up the differences.
template <class Number>
std::vector<Number> take_coordinates(Reader& reader, std::size_t count) {
  std::vector<Number> values;
  std::int32_t at = 0;
  for (const std::uint16_t code : reader.take_list<std::uint16_t>(count)) {
    at += (code >> 1) ^ -(code & 1);
    values.push_back(at);
  }
  return values;
}

template <class Index>
void take_indices(Reader& reader, TerrainFile& tile) {
  reader.align(sizeof(Index));
  const auto triangle_count = reader.take<std::uint32_t>();
  const std::vector<Index> codes = reader.take_list<Index>(std::size_t{triangle_count} * 3);
  std::uint32_t highest = 0;
  tile.triangles.resize(triangle_count);
  for (std::size_t k = 0; k < codes.size(); ++k) {
    if (codes[k] > highest) tile.has_sound_indices = false;
    tile.triangles[k / 3][k % 3] = highest - codes[k];
    if (codes[k] == 0) ++highest;
  }
  for (auto& border : tile.border) {
    const std::vector<Index> list = reader.take_list<Index>(reader.take<std::uint32_t>());
    border.assign(list.begin(), list.end());
  }
}

/// Octahedral, two bytes each.
Eigen::Vector3d normal_of(const char* code) {
  const auto part = [](char c) {
    return static_cast<double>(static_cast<unsigned char>(c)) / 255 * 2 - 1;
  };
  double x = part(code[0]), y = part(code[1]);
  const double z = 1 - std::abs(x) - std::abs(y);
  if (z < 0) {
    const double folded_x = (1 - std::abs(y)) * (x < 0 ? -1 : 1);
    y = (1 - std::abs(x)) * (y < 0 ? -1 : 1);
    x = folded_x;
  }
  return Eigen::Vector3d(x, y, z).normalized();
}

std::vector<Eigen::Vector3d> normals_of(const std::string& codes) {
  std::vector<Eigen::Vector3d> normals;
  for (std::size_t k = 0; k + 1 < codes.size(); k += 2) normals.push_back(normal_of(&codes[k]));
  return normals;
}

void take_extensions(Reader& reader, const std::filesystem::path& file, TerrainFile& tile) {
  enum : std::uint8_t { kNormals = 1, kWater = 2, kMetadata = 4 };
  while (!reader.is_at_end()) {
    const auto id = reader.take<std::uint8_t>();
    std::string content = reader.take_text(reader.take<std::uint32_t>());
    if (id == kNormals) tile.normals = normals_of(content);
    if (id == kWater) tile.water = std::move(content);
    if (id != kMetadata) continue;
    std::uint32_t length = 0;
    if (content.size() >= sizeof length) std::memcpy(&length, content.data(), sizeof length);
    if (content.size() != sizeof length + length) {
      throw damaged(file, "the length of its metadata is wrong");
    }
    tile.metadata = content.substr(sizeof length);
  }
}

}  // namespace

TerrainFile read_terrain_file(const std::filesystem::path& file) {
  const std::string packed = read_bytes(file);
  const std::string bytes = unzip(packed, file);
  Reader reader(bytes, file);
  TerrainFile tile;
  tile.bytes = static_cast<std::int64_t>(packed.size());
  for (int axis = 0; axis < 3; ++axis) reader.take<double>();  // the middle, which nobody needs
  tile.min_height_m = reader.take<float>();
  tile.max_height_m = reader.take<float>();
  for (double& c : tile.sphere_centre) c = reader.take<double>();
  tile.sphere_radius_m = reader.take<double>();
  for (double& c : tile.horizon) c = reader.take<double>();
  const auto count = reader.take<std::uint32_t>();
  tile.u = take_coordinates<double>(reader, count);
  tile.v = take_coordinates<double>(reader, count);
  tile.height_steps = take_coordinates<std::int32_t>(reader, count);
  for (const std::int32_t step : tile.height_steps) {
    // as clients interpolate
    const double t = step / kLast;
    tile.height_m.push_back((1 - t) * tile.min_height_m + t * tile.max_height_m);
  }
  constexpr std::uint32_t kMostFor16Bits = 65536;
  if (count <= kMostFor16Bits) {
    take_indices<std::uint16_t>(reader, tile);
  } else {
    take_indices<std::uint32_t>(reader, tile);
  }
  take_extensions(reader, file, tile);
  return tile;
}

}  // namespace terrane::verify
