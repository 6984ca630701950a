#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "core/errors.h"

namespace terrane::verify {

/// Parses a file and hands it to a reader; whatever is wrong in it becomes an InputError.
void read_json(const std::filesystem::path& file,
               const std::function<void(const nlohmann::json&)>& reader);

/// An InputError that says how a file is damaged and what to do.
InputError damaged(const std::filesystem::path& file, const std::string& what);

}  // namespace terrane::verify
