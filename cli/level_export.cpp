#include "cli/level_export.h"

#include <fmt/format.h>

#include <charconv>
#include <cstdio>

#include "core/errors.h"
#include "hierarchy/levels/level_sequence.h"
#include "hierarchy/levels/levels_file.h"
#include "hierarchy/levels/write_surface.h"
#include "tiler/files/whole_file.h"
#include "tiler/gltf/write_morphing_glb.h"

namespace terrane::cli {
namespace {

using hierarchy::LevelSequence;
using hierarchy::MorphingMesh;

struct Wanted {
  std::uint32_t level = 0;
  double t = 0;
};

Wanted wanted_of(const std::string& text) {
  Wanted wanted;
  const char* const end = text.data() + text.size();
  auto result = std::from_chars(text.data(), end, wanted.level);
  if (result.ec == std::errc{} && result.ptr != end && *result.ptr == ':') {
    result = std::from_chars(result.ptr + 1, end, wanted.t);
  }
  if (result.ec != std::errc{} || result.ptr != end) {
    throw ConfigError(
        fmt::format("--extract {}: is neither a level nor level:t, like 7 or 7:0.5", text));
  }
  return wanted;
}

std::string encode(const hierarchy::SurfaceMesh& mesh, const std::string& format) {
  if (format == "ply") return hierarchy::encode_ply(mesh);
  if (format == "obj") return hierarchy::encode_obj(mesh);
  if (format == "glb") return tiler::encode_morphing_glb(mesh.points, {}, mesh.triangles);
  throw ConfigError(fmt::format("{}: is no format of meshes. Use ply, obj or glb", format));
}

void extract(const LevelSequence& sequence, const std::string& text,
             const std::filesystem::path& out) {
  const Wanted wanted = wanted_of(text);
  const hierarchy::SurfaceMesh mesh = hierarchy::blended(sequence, wanted.level, wanted.t);
  const std::string extension = out.extension().string();
  tiler::write_whole_file(out, encode(mesh, extension.empty() ? "" : extension.substr(1)));
  fmt::print("{}: level {}, blend {}: {} triangles\n", out.string(), wanted.level, wanted.t,
             mesh.triangles.size());
}

void write_level(const MorphingMesh& morphing, const std::filesystem::path& stem,
                 const std::string& format) {
  const auto& [mesh, targets] = morphing;
  const auto file = [&](std::string_view ending) {
    return std::filesystem::path(stem.string() + std::string(ending));
  };
  if (format == "glb") {
    tiler::write_whole_file(file(".glb"),
                            tiler::encode_morphing_glb(mesh.points, targets, mesh.triangles));
  } else if (format == "ply") {
    tiler::write_whole_file(file(".ply"), hierarchy::encode_ply(mesh, targets));
  } else {
    tiler::write_whole_file(file(".obj"), encode(mesh, format));
    // an OBJ holds one shape: the other end of the morph is a second one
    tiler::write_whole_file(file("_morphed.obj"), encode({targets, mesh.triangles}, format));
  }
}

void export_every(const LevelSequence& sequence, const ExportOptions& options,
                  const std::filesystem::path& out) {
  if (options.format != "glb" && options.format != "ply" && options.format != "obj") {
    throw ConfigError(fmt::format("--format {}: is none of ply, obj, glb", options.format));
  }
  const auto step = static_cast<std::uint32_t>(options.every);
  int count = 0;
  for (std::uint32_t level = 0; level <= sequence.level_count(); level += step, ++count) {
    write_level(hierarchy::morphing(sequence, level, step), out / fmt::format("level_{:03}", level),
                options.format);
  }
  fmt::print("{}: {} levels of {}\n", out.string(), count, sequence.level_count() + 1);
}

}  // namespace

bool is_given(const ExportOptions& options) {
  return !options.extract.empty() || options.every != 0;
}

bool is_levels_file(const std::filesystem::path& file) { return file.extension() == ".levels"; }

void export_levels(const std::filesystem::path& levels, const ExportOptions& options,
                   const std::filesystem::path& out) {
  if (options.extract.empty() == (options.every == 0)) {
    throw ConfigError(fmt::format("{}: say what to take from it, with --extract or with --every",
                                  levels.string()));
  }
  if (options.every < 0) {
    throw ConfigError(fmt::format("--every {}: has to be 1 or more", options.every));
  }
  const LevelSequence sequence =
      hierarchy::decode_levels(tiler::read_whole_file(levels), levels.string());
  if (options.every > 0) {
    export_every(sequence, options, out);
  } else {
    extract(sequence, options.extract, out);
  }
}

}  // namespace terrane::cli
