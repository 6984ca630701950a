#include "tiler/tile_mesh.h"

#include <fmt/format.h>

#include <cstring>
#include <string>
#include <type_traits>

#include "core/errors.h"
#include "tiler/whole_file.h"

namespace terrane::tiler {
namespace {

// a work file is read only by the build that wrote it, on the same machine: plain memory will do
constexpr std::uint64_t kMagic = 0x31656c6974727274;  // "trrtile1"

class Writer {
 public:
  template <class T>
  void add(const T& value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof(T));
  }
  template <class T>
  void add(const std::vector<T>& values) {
    add(std::uint64_t{values.size()});
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

class Reader {
 public:
  Reader(std::string bytes, std::string name) : bytes_(std::move(bytes)), name_(std::move(name)) {}

  template <class T>
  T get() {
    T value;
    take(&value, sizeof(T));
    return value;
  }
  template <class T>
  std::vector<T> get_vector() {
    const auto size = get<std::uint64_t>();
    if (size > (bytes_.size() - at_) / sizeof(T)) refuse();
    std::vector<T> values(size);
    take(values.data(), size * sizeof(T));
    return values;
  }
  [[noreturn]] void refuse() const {
    throw InputError(
        fmt::format("{}: is damaged. Remove the output folder's .work and build again", name_));
  }

 private:
  void take(void* target, std::size_t size) {
    if (size > bytes_.size() - at_) refuse();
    if (size > 0) std::memcpy(target, bytes_.data() + at_, size);
    at_ += size;
  }

  std::string bytes_;
  std::string name_;
  std::size_t at_ = 0;
};

}  // namespace

void write_finished_tile(const FinishedTile& tile, const std::filesystem::path& file) {
  Writer writer;
  writer.add(kMagic);
  writer.add(tile.descendants);
  writer.add(tile.mesh.points);
  writer.add(tile.mesh.samples);
  writer.add(tile.mesh.normals);
  writer.add(tile.mesh.triangles);
  writer.add(tile.mesh.error);
  write_whole_file(file, writer.bytes());
}

FinishedTile read_finished_tile(const std::filesystem::path& file) {
  Reader reader(read_whole_file(file), file.string());
  if (reader.get<std::uint64_t>() != kMagic) reader.refuse();
  FinishedTile tile;
  tile.descendants = reader.get_vector<TileRecord>();
  tile.mesh.points = reader.get_vector<LatticePoint>();
  tile.mesh.samples = reader.get_vector<hierarchy::SampleId>();
  tile.mesh.normals = reader.get_vector<Eigen::Vector3f>();
  tile.mesh.triangles = reader.get_vector<hierarchy::Corners>();
  tile.mesh.error = reader.get<MeasuredError>();
  return tile;
}

}  // namespace terrane::tiler
