#include "tiler/files/work_file.h"

#include <fmt/format.h>

#include <cstring>

#include "core/errors.h"
#include "tiler/files/whole_file.h"

namespace terrane::tiler {

void WorkFileWriter::write(const std::filesystem::path& file) const {
  write_whole_file(file, bytes_);
}

WorkFileReader::WorkFileReader(const std::filesystem::path& file)
    : name_(file.string()), bytes_(read_whole_file(file)) {}

void WorkFileReader::refuse() const {
  throw InputError(
      fmt::format("{}: is damaged. Remove the output folder's .work and build again", name_));
}

void WorkFileReader::take(void* target, std::size_t size) {
  if (size > bytes_.size() - at_) refuse();
  if (size > 0) std::memcpy(target, bytes_.data() + at_, size);
  at_ += size;
}

}  // namespace terrane::tiler
