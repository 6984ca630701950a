#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "peer.h"

namespace terrane::peers {
namespace {

namespace fs = std::filesystem;

template <class T>
std::vector<T> read_values(std::istream& stream, std::size_t count) {
  std::vector<T> values(count);
  stream.read(reinterpret_cast<char*>(values.data()),
              static_cast<std::streamsize>(count * sizeof(T)));
  return values;
}

/// Runs simplify.mjs: heights go in as floats, CPU time and mesh come back as described there.
std::optional<Answer> run_script(const std::string& which, const Terrain& terrain,
                                 double tolerance_m) {
  const fs::path heights = fs::temp_directory_path() / fmt::format("peer_{}.in", getpid());
  const fs::path result = fs::temp_directory_path() / fmt::format("peer_{}.out", getpid());
  std::ofstream(heights, std::ios::binary)
      .write(reinterpret_cast<const char*>(terrain.grid.heights_m.data()),
             static_cast<std::streamsize>(terrain.grid.heights_m.size() * sizeof(float)));
  const std::string command =
      fmt::format("node '{}/simplify.mjs' {} '{}' {} {} {} '{}'", TERRANE_PEERS_NODE_DIR, which,
                  heights.string(), terrain.grid.window.columns, terrain.grid.window.rows,
                  tolerance_m, result.string());
  const int status = std::system(command.c_str());
  std::ifstream stream(result, std::ios::binary);
  std::optional<Answer> answer;
  if (status == 0 && stream) {
    const double seconds = read_values<double>(stream, 1)[0];
    const auto counts = read_values<std::uint32_t>(stream, 2);
    answer = Answer{.cpu_s = seconds};
    answer->mesh.points = read_values<std::array<double, 3>>(stream, counts[0]);
    answer->mesh.triangles = read_values<Triangle>(stream, counts[1]);
  }
  fs::remove(heights);
  fs::remove(result);
  return answer;
}

}  // namespace

std::vector<Peer> node_peers() {
  if (!fs::exists(fs::path(TERRANE_PEERS_NODE_DIR) / "node_modules/delatin")) return {};
  std::vector<Peer> peers;
  for (const char* name : {"delatin", "martini"}) {
    peers.push_back({.name = name, .by_tolerance = [name](const Terrain& terrain, double m) {
                       return run_script(name, terrain, m);
                     }});
  }
  return peers;
}

}  // namespace terrane::peers
