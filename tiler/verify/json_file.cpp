#include "tiler/verify/json_file.h"

#include <fmt/format.h>

#include <fstream>

namespace terrane::verify {

using nlohmann::json;

InputError damaged(const std::filesystem::path& file, const std::string& what) {
  return InputError(
      fmt::format("{}: damaged ({}). Run 'terrane build' again with --force", file.string(), what));
}

void read_json(const std::filesystem::path& file, const std::function<void(const json&)>& reader) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) {
    throw InputError(fmt::format(
        "{}: missing or unreadable. Run 'terrane build' again with --force", file.string()));
  }
  try {
    reader(json::parse(stream));
  } catch (const json::exception& error) {
    throw damaged(file, error.what());
  }
}

}  // namespace terrane::verify
