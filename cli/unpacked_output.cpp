#include "cli/unpacked_output.h"

#include <stdlib.h>

#include <string>

#include "archive/pack.h"
#include "core/errors.h"

namespace terrane::cli {
namespace {

namespace fs = std::filesystem;

/// A new empty folder, removed with all it holds.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / "terrane-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) {
      throw OutputError(name + ": the folder cannot be made. Set TMPDIR to one with space");
    }
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
    text.replace(at, from.size(), to);
  }
  return text;
}

}  // namespace

void with_output_folder(const fs::path& out, Progress& progress,
                        const std::function<void(const fs::path&)>& use) {
  if (!archive::is_archive_name(out) || fs::is_directory(out)) return use(out);
  const auto archive = archive::open_archive(out);
  const TemporaryFolder folder;
  try {
    archive::unpack(*archive, folder.path(), progress);
    use(folder.path());
  } catch (const InputError& error) {
    // the user knows nothing of the folder
    throw InputError(replaced(error.what(), folder.path().string(), out.string()));
  }
}

}  // namespace terrane::cli
