#include "archive/pack.h"

#include <fmt/format.h>

#include "archive/new_file.h"
#include "archive/packed_folder.h"
#include "archive/write_pmtiles.h"
#include "archive/write_three_tz.h"
#include "core/errors.h"

namespace terrane::archive {
namespace {

namespace fs = std::filesystem;

void claim(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder, error)) {
    throw OutputError(
        fmt::format("{}: the folder cannot be made. Choose another one", folder.string()));
  }
  if (fs::directory_iterator(folder) != fs::directory_iterator()) {
    throw OutputError(
        fmt::format("{}: holds files already. Choose an empty folder", folder.string()));
  }
}

}  // namespace

void pack(const fs::path& folder, const fs::path& out, const std::set<std::string>& leave_out,
          Progress& progress) {
  if (!is_archive_name(out)) {
    throw ConfigError(fmt::format(
        "{}: the extension says no format of an archive. Use .pmtiles or .3tz", out.string()));
  }
  const std::vector<PackedFile> files = list_folder(folder, leave_out);
  const std::string extension = out.extension().string();
  if (extension.ends_with('s') || extension.ends_with('S')) {
    write_pmtiles(folder, files, out, progress);
  } else {
    write_three_tz(files, out, progress);
  }
}

void unpack(const Archive& archive, const fs::path& folder, Progress& progress) {
  claim(folder);
  progress.begin("unpacking", static_cast<std::int64_t>(archive.facts().files));
  archive.for_each_name([&](const std::string& name) {
    NewFile file(folder / name);
    file.write(archive.read(name).value());
    file.finish();
    progress.advance(1);
  });
}

}  // namespace terrane::archive
